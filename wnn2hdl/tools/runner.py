"""Starting processes: with a time limit, without orphans, and with a `ToolError` for every way to fail."""

import contextlib
import os
import re
import shlex
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from wnn2hdl.errors import ToolError, ToolStoppedError
from wnn2hdl.tools.watchdog import watched

_FROM_OUTSIDE = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
"""Signals that a program does not send itself; it aborts or faults by others."""

Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Completed:
    """A process that did its job.

    Attributes:
        output: standard output and standard error, in the order they were written.
        seconds: wall-clock time.
    """

    output: str
    seconds: float


def run(
    command: Sequence[str | Path],
    *,
    timeout: float,
    stdin: str | None = None,
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
    ok_statuses: Sequence[int] = (0,),
    error_line: re.Pattern[str] | None = None,
) -> Completed:
    """Run a program to its end.

    The program leads its own process group, which is killed as a whole when the time is up or when this
    call is interrupted, so no grandchild (an ABC that Yosys started) stays behind; nor does it when this
    process itself is killed.

    Args:
        command: the binary, then its arguments; no shell is involved.
        timeout: seconds.
        stdin: text for standard input; None gives it an empty one.
        cwd: the folder to run in.
        environment: variables on top of this process's own and of ``LC_ALL=C``, since output is parsed.
        ok_statuses: exit statuses that mean success.
        error_line: a failure shows itself by a line that this matches from the line's start, whatever the
            exit status.

    Raises:
        ToolStoppedError: the time is up, or someone killed the program, as a system without memory does.
        ToolError: the binary cannot be started, the exit status is not one of `ok_statuses`, or a line of the
            output matches `error_line`. Its value is the line that says why, if there is one.
    """
    line = shlex.join(str(word) for word in command)
    binary = Path(command[0]).name
    started = time.perf_counter()
    try:
        process = subprocess.Popen(  # noqa: S603  # the commands are our own, without a shell
            [str(word) for word in command],
            stdin=subprocess.DEVNULL if stdin is None else subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            cwd=cwd,
            env={**os.environ, "LC_ALL": "C", **(environment or {})},
            encoding="utf-8",
            errors="replace",
            start_new_session=True,
        )
    except OSError as error:
        raise ToolError(
            f"cannot start {binary}",
            value=f"{error.filename} ({error.strerror})",
            hint="check that it is installed",
            command=line,
        ) from error
    batch: _Batch | None = getattr(_thread, "batch", None)
    try:
        if batch is not None:
            batch.add(process)
        with watched(process.pid):
            output, _ = process.communicate(stdin, timeout=timeout)
    except subprocess.TimeoutExpired:
        raise ToolStoppedError(
            f"{binary} did not finish in {timeout:g} s",
            hint="allow it more time or give it less to do",
            command=line,
            output=_kill(process),
        ) from None
    except BaseException:
        _kill(process)
        raise
    finally:
        if batch is not None:
            batch.remove(process)
    found = _first_match(error_line, output)
    if found is not None or process.returncode not in ok_statuses:
        lines = output.strip().splitlines()
        kind = ToolStoppedError if -process.returncode in _FROM_OUTSIDE else ToolError
        raise kind(
            f"{binary} {_ending(process.returncode)}",
            value=found or (lines[-1] if lines else "it printed nothing"),
            command=line,
            output=output,
        )
    return Completed(output, time.perf_counter() - started)


def cores() -> int:
    """How many processor cores this process may use; all that there are where the system does not say."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def in_parallel(
    function: Callable[[Item], Result], items: Iterable[Item], *, workers: int | None = None
) -> Iterator[tuple[int, Result]]:
    """Call a function that waits for outside programs on many items at once, in threads.

    Args:
        function: called once for each item.
        items: its arguments.
        workers: threads; by default one for each core this process may use.

    Yields:
        The item's position and its result, in the order in which they get done.

    Raises:
        Exception: the first one that a call raises. Then, on Ctrl-C, and when the caller stops iterating,
            what has not started never does and every process that `run` started for these items is killed.
    """
    batch = _Batch()
    pool = ThreadPoolExecutor(workers or cores(), initializer=batch.join)
    failures: list[BaseException] = []

    def call(item: Item) -> Result:
        try:
            batch.require_open()
            return function(item)
        except BaseException as error:
            # Closed here, since this thread may take the next item before the one that waits hears of it.
            failures.append(error)
            batch.close()
            raise

    try:
        waiting: dict[Future[Result], int] = {
            pool.submit(call, item): position for position, item in enumerate(items)
        }
        while waiting:
            done, _ = wait(waiting, return_when=FIRST_COMPLETED)
            for future in done:
                if failures:
                    raise failures[0]
                yield waiting.pop(future), future.result()
    finally:
        batch.close()
        pool.shutdown(cancel_futures=True)


@dataclass
class _Batch:
    """The processes that the threads of one `in_parallel` have running."""

    closed: bool = False
    processes: set["subprocess.Popen[str]"] = field(default_factory=set)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def join(self) -> None:
        """Make the current thread one of this batch."""
        _thread.batch = self

    def require_open(self) -> None:
        """Raise ToolStoppedError if nothing may start any more."""
        if self.closed:
            raise ToolStoppedError("stopped, because the work around it has ended")

    def add(self, process: "subprocess.Popen[str]") -> None:
        with self.lock:
            self.require_open()
            self.processes.add(process)

    def remove(self, process: "subprocess.Popen[str]") -> None:
        with self.lock:
            self.processes.discard(process)

    def close(self) -> None:
        """Kill what still runs; what starts later is refused."""
        with self.lock:
            self.closed = True
            for process in self.processes:
                _kill_group(process)


_thread = threading.local()


def _kill(process: "subprocess.Popen[str]") -> str:
    """Kill a process and all it started; return what it had printed."""
    _kill_group(process)
    try:
        output, _ = process.communicate(timeout=2)
    except (subprocess.TimeoutExpired, ValueError):
        # Something left the process group and still holds the pipe: its output is not worth waiting for.
        return ""
    return output


def _kill_group(process: "subprocess.Popen[str]") -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def _first_match(pattern: re.Pattern[str] | None, output: str) -> str | None:
    if pattern is None:
        return None
    return next((line for line in output.splitlines() if pattern.match(line)), None)


def _ending(status: int) -> str:
    if status < 0:
        return f"was killed by {signal.Signals(-status).name}"
    return f"failed with exit status {status}"
