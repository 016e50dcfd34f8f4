"""A process that kills the programs this one has running, should this one be killed before it can do that.

Nothing can catch SIGKILL, which a system without memory or a job scheduler sends. So the watchdog waits at
the end of a pipe that this process alone holds open: however this process ends, the pipe closes.
"""

import atexit
import contextlib
import os
import threading
from collections.abc import Iterator

# Reads which process groups run; at the end of its input it kills those that still do.
_SCRIPT = """
groups=
while read -r group state; do
  if [ "$state" = started ]; then groups="$groups $group"; continue; fi
  kept=
  for one in $groups; do [ "$one" = "$group" ] || kept="$kept $one"; done
  groups=$kept
done
for group in $groups; do kill -s KILL -- "-$group"; done
"""


@contextlib.contextmanager
def watched(group: int) -> Iterator[None]:
    """Have a process group killed if this process is killed within the context."""
    watchdog = _running()
    watchdog.tell(group, "started")
    try:
        yield
    finally:
        watchdog.tell(group, "ended")


class _Watchdog:
    """One such process, in a process group of its own so that Ctrl-C does not reach it."""

    def __init__(self) -> None:
        reading, self._pipe = os.pipe()
        quiet = [(os.POSIX_SPAWN_OPEN, stream, os.devnull, os.O_WRONLY, 0) for stream in (1, 2)]
        self._process = os.posix_spawn(
            "/bin/sh",
            ["sh", "-c", _SCRIPT],
            {},
            file_actions=[(os.POSIX_SPAWN_DUP2, reading, 0), *quiet],
            setpgroup=0,
        )
        os.close(reading)

    def tell(self, group: int, state: str) -> None:
        """Say what became of a process group; so short a line is written whole, from any thread."""
        # A watchdog that somebody killed protects nothing any more, which is no reason to stop the work.
        with contextlib.suppress(BrokenPipeError):
            os.write(self._pipe, f"{group} {state}\n".encode())

    def leave(self) -> None:
        """Hold the pipe no longer."""
        os.close(self._pipe)

    def end(self) -> None:
        """Let it end, with nothing left to kill."""
        self.leave()
        os.waitpid(self._process, 0)


_lock = threading.Lock()
_watchdog: _Watchdog | None = None


def _running() -> _Watchdog:
    global _watchdog
    with _lock:
        if _watchdog is None:
            _watchdog = _Watchdog()
            atexit.register(_watchdog.end)
        return _watchdog


def _in_a_copy() -> None:
    """After a fork: the copy has started nothing, and must not keep the original's pipe open."""
    global _lock, _watchdog
    _lock = threading.Lock()
    if _watchdog is not None:
        atexit.unregister(_watchdog.end)
        _watchdog.leave()
        _watchdog = None


os.register_at_fork(after_in_child=_in_a_copy)
