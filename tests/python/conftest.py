"""Of all tests. A file whose tests were all skipped ends with 77, which ctest shows as skipped."""

from collections.abc import Iterator
from pathlib import Path

import pytest

SKIPPED_CODE = 77
ROOT = Path(__file__).resolve().parents[2]


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if exitstatus == pytest.ExitCode.OK and reporter and reporter.stats.get("skipped") and not reporter.stats.get("passed"):
        session.exitstatus = SKIPPED_CODE


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> Iterator[list]:
    """Figures of the report, as they were written."""
    from verification.report import canvas

    figures: list = []
    monkeypatch.setattr(canvas.plt, "close", figures.append)
    yield figures
    monkeypatch.undo()
    canvas.plt.close("all")


@pytest.fixture
def shear_wave(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a copy of the shear wave, the only case that there is: studies may be written beside it."""
    folder = tmp_path / "cases" / "shear_wave"
    folder.mkdir(parents=True)
    for name in ("case.toml", "measure.py"):
        (folder / name).write_text((ROOT / "cases" / "shear_wave" / name).read_text())
    monkeypatch.setenv("MAPPM_CASES", str(tmp_path / "cases"))
    return folder
