"""Runs cases, judges them against independent references and reports. It sees only files and programs."""

import os
import sys
from pathlib import Path

# `python3 -m verification`, and so its modules, need the packages of .venv, whichever python3 they were called by. While the
# package of a -m call is being imported, argv[0] is "-m".
_environment = Path(__file__).resolve().parent.parent / ".venv"
if sys.argv[0] == "-m" and Path(sys.prefix).resolve() != _environment.resolve() and (_environment / "bin" / "python").exists():
    _python = str(_environment / "bin" / "python")
    os.execv(_python, [_python, *sys.orig_argv[1:]])
