"""Sound speed from the period of a standing wave. Oracle: c k t = pi between minima of the kinetic energy."""

from pathlib import Path

import pytest

from support import assert_correct, judged


@pytest.mark.parametrize("method", ["transport", "classic"])
def test_sound_speed(tmp_path: Path, method: str) -> None:
    _, outcomes = judged("sound_wave", tmp_path, f"fluid.method={method}")
    assert_correct(outcomes["sound_speed"], goal=0.01)
