"""Kill a command at random moments, run it again, and compare what it writes with an undisturbed run.

``python benchmarks/kills.py`` tries the long commands on embedded data;
``python benchmarks/kills.py --kills 20 -- wnn2hdl scan model.json earth.tif -o {out}`` tries one: ``{out}``
stands for what it writes, a file or a folder. Every other kill hits a run over finished results.

A kill is survived if the same command, run again, ends well and leaves the very files that an undisturbed run
leaves, byte for byte, and no others. Files that differ between two undisturbed runs (they tell seconds, or
the order in which workers ended) are only asked to be there; they are named.
"""

import argparse
import hashlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.markdown import head, row

PLACE = "{out}"
"""In a command: where it writes."""

WNN2HDL = (sys.executable, "-c", "import sys; from wnn2hdl.cli import main; sys.exit(main())")

COMMANDS: Mapping[str, Sequence[str]] = {
    "samples": ("samples", "--count", "8", "-o", PLACE),
    "train": ("train", "-o", f"{PLACE}/model.json"),
    "compile": ("compile", "{given}/model.json", "--target", "pixel", "-o", f"{PLACE}/build"),
    "sweep": ("sweep", "--address-bits", "2..3", "--rams", "2..5", "--trials", "4", "-o", PLACE),
    "scan": ("scan", "{given}/model.json", "{given}/scene/images", "--square", "5", "-o", PLACE),
    "locate": ("locate", "-o", PLACE),
    "demo": ("demo", "-o", PLACE),
}
"""The long commands; ``{given}`` is a folder with a model and pictures."""

POLL_SECONDS = 0.005

ATTEMPTS = 3
"""How many times as often as it has to be killed a command is started: on a busy machine it may end
before."""


@dataclass(frozen=True)
class Survival:
    """What became of a command that was killed again and again.

    Attributes:
        tried: how often it was killed before it ended.
        survived: how often running it again gave the same files.
        varying: files that differ between undisturbed runs.
        faults: what differed, a line for each kill that was not survived.
    """

    tried: int
    survived: int
    varying: tuple[str, ...]
    faults: tuple[str, ...]


def survival(command: Sequence[str], kills: int, seed: int, folder: Path) -> Survival:
    """Kill a command at random moments.

    Args:
        command: words, `PLACE` among them.
        kills: how often.
        seed: of the moments, which are drawn between its first output and its end.
        folder: an empty one to work in.
    """
    started, seconds = _undisturbed(command, folder / "first")
    _undisturbed(command, folder / "second")
    expected, again = digests(folder / "first"), digests(folder / "second")
    varying = tuple(name for name in expected if expected[name] != again.get(name))
    chance = random.Random(seed)
    tried, faults = 0, []
    for number in range(ATTEMPTS * kills):
        if tried == kills:
            break
        place = folder / "killed"
        shutil.rmtree(place, ignore_errors=True)
        if number % 2:
            shutil.copytree(folder / "first", place)
        moment = chance.uniform(0.9 * started, seconds)
        killed = _run(command, place, moment) == -signal.SIGKILL
        tried += killed
        status = _run(command, place, None)
        found = digests(place)
        different = sorted(
            name
            for name in expected.keys() | found.keys()
            if name not in found or (name not in varying and found[name] != expected.get(name))
        )
        if killed and (status or different):
            faults.append(f"killed after {moment:.2f} s: status {status}, different: {', '.join(different)}")
    return Survival(tried, tried - len(faults), varying, tuple(faults))


def digests(folder: Path) -> dict[str, str]:
    """SHA-256 of each file below a folder, by its path there."""
    return {
        str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


def _undisturbed(command: Sequence[str], place: Path) -> tuple[float, float]:
    """Seconds until a command has made its place, and until it ends."""
    started = time.perf_counter()
    process = _start(command, place)
    first = None
    while process.poll() is None:
        if first is None and place.exists():
            first = time.perf_counter() - started
        time.sleep(POLL_SECONDS)
    if process.returncode:
        raise SystemExit(f"the command fails undisturbed, status {process.returncode}")
    seconds = time.perf_counter() - started
    return (seconds if first is None else first), seconds


def _run(command: Sequence[str], place: Path, kill_after: float | None) -> int:
    """The status of a command, killed with all its children after some seconds if it still runs then."""
    process = _start(command, place)
    try:
        return process.wait(kill_after)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return process.wait()


def _start(command: Sequence[str], place: Path) -> "subprocess.Popen[bytes]":
    words = [word.replace(PLACE, str(place)) for word in command]
    return subprocess.Popen(
        words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )


def _embedded(names: Sequence[str], given: Path) -> dict[str, list[str]]:
    """The long commands in full, and what they need."""
    subprocess.run([*WNN2HDL, "train", "-o", str(given / "model.json")], check=True, capture_output=True)
    samples = ["samples", "--count", "3", "--side", "700", "-o", str(given / "scene")]
    subprocess.run([*WNN2HDL, *samples], check=True, capture_output=True)
    return {
        name: [*WNN2HDL, *(word.replace("{given}", str(given)) for word in COMMANDS[name])] for name in names
    }


def main() -> None:
    """Print a table of kills survived of tried."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", choices=COMMANDS, action="append", help="Of the long commands.")
    parser.add_argument("command", nargs="*", help="A command of one's own, after --.")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "given").mkdir()
        commands = (
            {"command": options.command}
            if options.command
            else _embedded(options.only or [*COMMANDS], folder / "given")
        )
        print(head(["command", "kills survived", "of", "files that vary undisturbed"]))
        faults = []
        for label, command in commands.items():
            (folder / label).mkdir()
            result = survival(command, options.kills, options.seed, folder / label)
            varying = ", ".join(result.varying) or "none"
            print(row([label, result.survived, result.tried, varying]), flush=True)
            faults += [f"{label}: {fault}" for fault in result.faults]
    print("\n".join(faults))
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
