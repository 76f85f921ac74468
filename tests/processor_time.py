"""Processor time of a test run by folder, printed at its end, so that the growth of the suite is seen.

Counted is what the processes of the run spend and those that they start and wait for. It fails nothing: times depend on
the machine. ``pytest --processor-files N`` adds the N files that cost most.
"""

import os
from collections import defaultdict
from pathlib import PurePosixPath

import pytest

from tests import ready


def spent_s() -> float:
    """Return the processor time of this process and of the children that it has waited for, s."""
    now = os.times()
    return now.user + now.system + now.children_user + now.children_system + ready.spent_s()


class Meter:
    """Measures each phase of each test where it runs, and adds up where the run is reported."""

    def __init__(self, config: pytest.Config) -> None:
        self.config = config
        self.files: dict[str, float] = defaultdict(float)
        self.workers = 0.0
        self._phase = 0.0

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_setup(self):
        self._phase = spent_s()
        return (yield)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_call(self):
        self._phase = spent_s()
        return (yield)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_teardown(self):
        self._phase = spent_s()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self):
        spent = spent_s() - self._phase
        report = yield
        report.processor_s = spent
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.files[report.nodeid.partition("::")[0]] += getattr(report, "processor_s", 0.0)

    def pytest_sessionfinish(self) -> None:
        ready.close()
        if hasattr(self.config, "workeroutput"):
            self.config.workeroutput["processor_s"] = spent_s()

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node) -> None:
        self.workers += getattr(node, "workeroutput", {}).get("processor_s", 0.0)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        for line in summary(self.files, self.workers or spent_s(), self.config.getoption("processor_files")):
            terminalreporter.write_line(line)


def summary(files: dict[str, float], whole: float, longest: int) -> list[str]:
    """Return the lines to print: each folder, starting and collecting, the sum, the files that cost most."""
    folders: dict[str, float] = defaultdict(float)
    for path, spent in files.items():
        folders["/".join(PurePosixPath(path).parts[1:-1]) or path] += spent
    folders["starting and collecting"] = max(0.0, whole - sum(files.values()))
    lines = ["processor time, s"]
    lines += [f"{spent:8.1f}  {name}" for name, spent in sorted(folders.items(), key=lambda item: -item[1])]
    lines.append(f"{whole:8.1f}  in all")
    costly = sorted(files.items(), key=lambda item: -item[1])[:longest]
    return lines + [f"{spent:8.1f}  {path}" for path, spent in costly]
