"""Processes end in time, leave nothing behind, and tell why they failed."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from wnn2hdl.errors import ToolError, ToolStoppedError
from wnn2hdl.tools import cores, in_parallel, run

# A shell that starts a grandchild, prints its number and waits for it.
WITH_GRANDCHILD = ["sh", "-c", "sleep 60 & echo $!; wait"]


def is_alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state not in "ZX"


def ends_soon(pid: int) -> bool:
    for _ in range(100):
        if not is_alive(pid):
            return True
        time.sleep(0.05)
    return False


def test_output_holds_both_streams_in_order() -> None:
    done = run(["sh", "-c", "echo one; echo two >&2; echo three"], timeout=10)
    assert done.output == "one\ntwo\nthree\n"
    assert 0 < done.seconds < 10


def test_standard_input_folder_and_environment_reach_the_program(tmp_path: Path) -> None:
    done = run(
        ["sh", "-c", "cat; pwd; echo $WORD $LC_ALL"],
        stdin="hello\n",
        cwd=tmp_path,
        environment={"WORD": "yes"},
        timeout=10,
    )
    assert done.output == f"hello\n{tmp_path}\nyes C\n"


def test_without_input_a_program_that_reads_ends() -> None:
    assert run(["cat"], timeout=10).output == ""


@pytest.mark.parametrize(
    ("name", "stopped"), [("KILL", True), ("TERM", True), ("ABRT", False), ("SEGV", False)]
)
def test_a_program_that_was_killed_is_told_from_one_that_crashed(name: str, stopped: bool) -> None:
    with pytest.raises(ToolError, match=f"^sh was killed by SIG{name}") as caught:
        run(["sh", "-c", f"kill -{name} $$"], timeout=10)
    assert isinstance(caught.value, ToolStoppedError) == stopped


def test_a_missing_binary_is_named() -> None:
    with pytest.raises(
        ToolError, match=r"^cannot start no-such-tool: .*No such file.*; check that it is inst"
    ):
        run(["no-such-tool"], timeout=10)


def test_a_bad_status_carries_command_and_output() -> None:
    with pytest.raises(ToolError, match=r"^sh failed with exit status 3: the reason$") as caught:
        run(["sh", "-c", "echo first; echo the reason; exit 3"], timeout=10)
    assert caught.value.command == "sh -c 'echo first; echo the reason; exit 3'"
    assert caught.value.output == "first\nthe reason\n"


def test_other_statuses_can_be_allowed() -> None:
    assert run(["sh", "-c", "echo fine; exit 3"], timeout=10, ok_statuses=(0, 3)).output == "fine\n"


def test_an_error_line_is_a_failure_in_spite_of_status_0() -> None:
    command = ["sh", "-c", "echo no Error: here; echo Error: broken; echo Error: again"]
    with pytest.raises(ToolError, match=r"^sh failed with exit status 0: Error: broken$"):
        run(command, timeout=10, error_line=re.compile("Error: "))


def test_a_crash_is_named_by_its_signal() -> None:
    with pytest.raises(ToolError, match=r"^sh was killed by SIGSEGV: it printed nothing$"):
        run(["sh", "-c", "kill -SEGV $$"], timeout=10)


def test_when_time_is_up_the_whole_process_group_dies() -> None:
    started = time.perf_counter()
    with pytest.raises(ToolError, match=r"^sh did not finish in 0\.3 s; allow it more time") as caught:
        run(WITH_GRANDCHILD, timeout=0.3)
    assert time.perf_counter() - started < 5
    assert ends_soon(int(caught.value.output))


def test_ctrl_c_kills_the_whole_process_group(tmp_path: Path) -> None:
    command = ["sh", "-c", f"sleep 60 & echo $! > {tmp_path}/pid; wait"]
    threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT]).start()
    with pytest.raises(KeyboardInterrupt):
        run(command, timeout=30)
    assert ends_soon(int((tmp_path / "pid").read_text()))


RUNS_IN_THREADS = """
import os, pathlib, sys, time
from wnn2hdl.tools import in_parallel, run

run(["true"], timeout=10)
if os.fork() == 0:
    # A copy that outlives the original, as workers of a pool may.
    pathlib.Path("copy").write_text(str(os.getpid()))
    time.sleep(60)
    os._exit(0)
script = "sleep 60 & echo $! > $0; wait"
list(in_parallel(lambda name: run(["sh", "-c", script, name], timeout=60), ["one", "two"], workers=2))
"""


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_what_runs_dies_with_a_process_that_is_killed(tmp_path: Path, number: signal.Signals) -> None:
    def written(name: str) -> int:
        while not (path := tmp_path / name).exists() or not path.read_text().strip():
            assert parent.poll() is None
            time.sleep(0.05)
        return int(path.read_text())

    with subprocess.Popen([sys.executable, "-c", RUNS_IN_THREADS], cwd=tmp_path) as parent:
        copy, *started = map(written, ["copy", "one", "two"])
        parent.send_signal(number)
    assert all(map(ends_soon, started))
    assert is_alive(copy)
    os.kill(copy, signal.SIGKILL)


def test_bytes_that_are_no_text_do_not_matter() -> None:
    assert run([sys.executable, "-c", r"import os; os.write(1, b'a\xffb')"], timeout=10).output == "a\ufffdb"


def test_in_parallel_gives_each_item_its_result() -> None:
    results = dict(in_parallel(lambda word: run(["echo", word], timeout=10).output, ["a", "b", "c"]))
    assert results == {0: "a\n", 1: "b\n", 2: "c\n"}


def test_in_parallel_stops_all_others_at_the_first_failure(tmp_path: Path) -> None:
    def job(script: str) -> None:
        run(["sh", "-c", script], cwd=tmp_path, timeout=60)

    waits = "echo $$ > pid; sleep 60"
    fails = "while ! [ -s pid ]; do sleep 0.05; done; exit 1"
    started = time.perf_counter()
    with pytest.raises(ToolError, match="failed with exit status 1"):
        list(in_parallel(job, [waits, fails, "touch never"], workers=2))
    assert time.perf_counter() - started < 10
    assert ends_soon(int((tmp_path / "pid").read_text()))
    assert not (tmp_path / "never").exists()


def test_in_parallel_stops_all_on_ctrl_c(tmp_path: Path) -> None:
    def job(name: str) -> None:
        run(["sh", "-c", f"echo $$ > {name}; sleep 60"], cwd=tmp_path, timeout=60)

    threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT]).start()
    with pytest.raises(KeyboardInterrupt):
        list(in_parallel(job, ["one", "two"], workers=2))
    assert all(ends_soon(int((tmp_path / name).read_text())) for name in ("one", "two"))


def test_cores_are_those_this_process_may_use(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {3, 5, 7})
    assert cores() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert cores() == 1
