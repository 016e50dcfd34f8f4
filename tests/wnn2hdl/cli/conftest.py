"""Commands run in this process, since starting one takes a second."""

from collections.abc import Callable
from typing import NamedTuple

import pytest

from wnn2hdl.cli import main


class Done(NamedTuple):
    """How a command ended."""

    status: int
    stdout: str
    stderr: str

    def complaint(self) -> str:
        """The one line that reports bad usage or bad input."""
        assert self.status == 2, self.stderr
        assert self.stdout == ""
        (line,) = self.stderr.splitlines()
        assert line.startswith("wnn2hdl: ")
        return line

    def complaint_after_work(self) -> str:
        """The same for what went wrong after some progress was shown."""
        assert " % " in self.stderr
        return self._replace(stderr=self.stderr.splitlines()[-1]).complaint()


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Done]:
    """``run("scan", model, picture, "--jobs", 1)`` gives a `Done`."""

    def call(*words: object) -> Done:
        monkeypatch.setattr("sys.argv", ["wnn2hdl", *map(str, words)])
        status = main()
        printed = capsys.readouterr()
        return Done(status, printed.out, printed.err)

    return call
