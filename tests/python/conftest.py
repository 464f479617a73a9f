"""Of all tests. A file whose tests were all skipped ends with 77, which ctest shows as skipped."""

from collections.abc import Iterator

import pytest

SKIPPED_CODE = 77


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
