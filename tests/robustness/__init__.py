"""Campaigns against the solver as a whole: kills, and the summary of all campaigns."""

import os
import sys
from pathlib import Path

# As in `verification`: a -m call needs the packages of .venv, whichever python3 it was called by. While the package of
# the call is being imported, argv[0] is "-m".
_environment = Path(__file__).resolve().parent.parent.parent / ".venv"
if sys.argv[0] == "-m" and Path(sys.prefix) != _environment and (_environment / "bin" / "python").exists():
    _python = str(_environment / "bin" / "python")
    os.execv(_python, [_python, *sys.orig_argv[1:]])
