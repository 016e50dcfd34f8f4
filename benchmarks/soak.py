"""Run random commands for an hour, disturb them, and look at what they leave.

``python -m benchmarks.soak --minutes 15`` works in its own folder. Commands run undisturbed, are killed,
interrupted or terminated at a random moment, run twice at once into one place, or get a damaged file. After
each of them, what lies in the folder has to be whole or absent, no process may be left, and only a killed
command may leave something hidden, which the next one at the same place removes. Now and then a finished
build is verified. The table counts how commands ended; every fault is a line, and the status is then 1.
"""

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from PIL import Image

from benchmarks.damage import damaged
from wnn2hdl.build.folder import is_build
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.errors import Wnn2hdlError
from wnn2hdl.files import read_json
from wnn2hdl.ir import WisardModel
from wnn2hdl.markdown import table

WNN2HDL = (sys.executable, "-m", "wnn2hdl")

COMMANDS: Mapping[str, Sequence[str]] = {
    "train": ("train", "--images", "{scene}/images", "--masks", "{scene}/masks", "-o", "{out}/model.json"),
    "compile": ("compile", "{model}", "--target", "pixel", "-o", "{out}/build"),
    "samples": ("samples", "--count", "4", "-o", "{out}/samples"),
    "evaluate": ("evaluate", "{model}", "--images", "{scene}/images", "--masks", "{scene}/masks", "--json"),
    "scan": ("scan", "{model}", "{scene}/images", "-o", "{out}/scan"),
    "sweep": ("sweep", "--address-bits", "2", "--rams", "2..4", "--trials", "2", "-o", "{out}/sweep"),
    "report": ("report", "{build}", "-o", "{out}/index.html"),
    "gate": ("report", "{build}", "--max-luts", "0", "--format", "junit", "-o", "{out}/gate.xml"),
    "verify": ("verify", "{build}"),
}
"""Commands; ``{out}`` is one of a few folders, what else is in braces is there from the start."""

SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)

PLACES = 3
"""Folders that are written into, so that commands meet what earlier ones left."""

LONGEST_S = 300.0
GRACE_S = 20.0
"""Seconds that a command may take, and that what it started may live longer than a killed command."""

MARK = "WNN2HDL_SOAK"
"""In the environment of all processes that a soak starts."""


@dataclass
class Soak:
    """A folder in which commands run.

    Attributes:
        folder: the folder.
        chance: draws everything.
        ends: how often a command ended how.
        faults: what was not as it has to be.
    """

    folder: Path
    chance: random.Random
    ends: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)

    @property
    def given(self) -> dict[str, str]:
        """What the words in braces stand for."""
        names = {"scene": "scene", "model": "model.json", "build": "given"}
        return {name: str(self.folder / place) for name, place in names.items()}

    def prepare(self) -> None:
        """Make what commands are given."""
        for place in range(PLACES):
            (self.folder / f"out{place}").mkdir()
        (self.folder / "tmp").mkdir()
        for words in (
            ("samples", "--count", "3", "--side", "200", "-o", "{scene}"),
            ("train", "-o", "{model}"),
            ("compile", "{model}", "--target", "pixel", "-o", "{build}"),
        ):
            status, text = self._end(self._start([word.format(**self.given) for word in words]), None)
            if status:
                raise SystemExit(text)

    def step(self) -> None:
        """Run one command, disturbed or not, and look at what is there."""
        name = self.chance.choice([*COMMANDS])
        place = self.folder / f"out{self.chance.randrange(PLACES)}"
        words = [word.format(**self.given, out=place) for word in COMMANDS[name]]
        how = self.chance.choice(("undisturbed", "signal", "signal", "twice", "garbage"))
        before = {*(self.folder / "tmp").iterdir()}
        {"undisturbed": self._once, "signal": self._signal, "twice": self._twice, "garbage": self._garbage}[
            how
        ](name, words)
        self._look(name, place)
        if how != "signal" and (left := {*(self.folder / "tmp").iterdir()} - before):
            self._fault(name, how, f"left {sorted(path.name for path in left)}")

    def verify(self) -> None:
        """Verify a finished build, if there is one."""
        builds = [path / "build" for path in self.folder.glob("out*") if is_build(path / "build")]
        if builds:
            self._once("verify", ["verify", str(self.chance.choice(builds))])

    def _once(self, name: str, words: Sequence[str]) -> None:
        status, text = self._end(self._start(words), None)
        expected = 1 if name == "gate" else 0
        self._note(name, "undisturbed", status, text, {expected})

    def _signal(self, name: str, words: Sequence[str]) -> None:
        number = self.chance.choice(SIGNALS)
        status, text = self._end(self._start(words), number)
        expected = {0, 1 if name == "gate" else 0, -number, 128 + number}
        self._note(name, number.name, status, text, expected)

    def _twice(self, name: str, words: Sequence[str]) -> None:
        both = [self._start(words), self._start(words)]
        ends = [self._end(process, None) for process in both]
        done = 1 if name == "gate" else 0
        for status, text in ends:
            self._note(name, "two at once", status, text, {done, 2})
        if done not in [status for status, _ in ends]:
            self._fault(name, "two at once", "neither ended well")

    def _garbage(self, name: str, words: Sequence[str]) -> None:
        names = {self.given["model"], self.given["build"]} & {*words}
        if not names:
            return
        (given,) = names
        copy = self.folder / "garbage"
        if Path(given).is_dir():
            shutil.copytree(given, copy)
            victim = self.chance.choice(sorted(path for path in copy.iterdir() if path.is_file()))
        else:
            shutil.copy(given, copy)
            victim = copy
        victim.write_bytes(damaged(victim.read_bytes(), self.chance))
        elsewhere = str(self.folder / "aside")
        wrong = [
            str(copy) if word == given else word.replace(str(self.folder / "out"), elsewhere)
            for word in words
        ]
        status, text = self._end(self._start(wrong), None)
        self._note(name, "garbage", status, text, {0, 1, 2})
        for path in (copy, *self.folder.glob("aside*")):
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def _start(self, words: Sequence[str]) -> "subprocess.Popen[str]":
        extra = {MARK: str(self.folder), "TMPDIR": str(self.folder / "tmp")}
        return subprocess.Popen(
            [*WNN2HDL, *words],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            env=os.environ | extra,
            start_new_session=True,
        )

    def _end(self, process: "subprocess.Popen[str]", number: signal.Signals | None) -> tuple[int, str]:
        """The status of a process and its standard error; a signal comes at a random moment."""
        if number is not None:
            try:
                process.wait(self.chance.expovariate(1 / 4))
            except subprocess.TimeoutExpired:
                process.send_signal(number)
        try:
            _, text = process.communicate(timeout=LONGEST_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return process.wait(), "took too long"
        return process.returncode, text

    def _note(self, name: str, how: str, status: int, text: str, expected: set[int]) -> None:
        self.ends[name, how, str(status)] += 1
        last = text.strip().splitlines()[-1:] or [""]
        # Before a command is there to catch it, Python reports an interrupt in its own way.
        early = how == "SIGINT" and last == ["KeyboardInterrupt"]
        if status not in expected and not early:
            self._fault(name, how, f"status {status}: {last[0][:300]}")
        elif "Traceback" in text and not early:
            self._fault(name, how, text[-1500:])

    def _fault(self, name: str, how: str, text: str) -> None:
        self.faults.append(f"{name}, {how}: {text}")

    def _look(self, name: str, place: Path) -> None:
        for path, check in _whole(place):
            try:
                check()
            except (Wnn2hdlError, AssertionError, OSError, SyntaxError) as error:
                self._fault(name, "afterwards", f"{path} is there, but not whole: {error}")
        deadline = time.monotonic() + GRACE_S
        while (left := _living(str(self.folder))) and time.monotonic() < deadline:
            time.sleep(0.2)
        if left:
            self._fault(name, "afterwards", f"processes are left: {left}")


def _whole(place: Path) -> Iterator[tuple[Path, Callable[[], object]]]:
    """What is there by its final name, and a function that raises if it is not whole."""
    if (path := place / "model.json").exists():
        yield path, partial(WisardModel.load, path)
    if (path := place / "build").exists():
        yield path, partial(_unchanged, path)
    pages = {"index.html": "</html>", "gate.xml": "</testsuites>", "sweep/index.html": "</html>"}
    for name, last in pages.items():
        if (path := place / name).exists():
            yield path, partial(_ends, path, last)
    for path in place.glob("s*/**/*.json"):
        yield path, partial(read_json, path, "a result")
    for path in (*place.glob("s*/**/*.png"), *place.glob("s*/**/*.tif")):
        yield path, partial(_decoded, path)


def _unchanged(build: Path) -> None:
    changed = check_manifest(build)
    assert not changed, changed


def _ends(page: Path, last: str) -> None:
    assert page.read_text().rstrip().endswith(last)


def _decoded(picture: Path) -> None:
    with Image.open(picture) as image:
        image.load()


def _living(mark: str) -> list[str]:
    """Command lines of processes that a soak has started and that still run."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            environment = (entry / "environ").read_bytes()
            words = (entry / "cmdline").read_bytes().replace(b"\0", b" ")
        except OSError:
            continue
        if f"{MARK}={mark}".encode() in environment and words:
            found.append(words.decode(errors="replace")[:200])
    return found


def main() -> None:
    """Print a table of how commands ended."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        soak = Soak(Path(name), random.Random(options.seed))
        soak.prepare()
        deadline = time.monotonic() + 60 * options.minutes
        steps = 0
        while time.monotonic() < deadline:
            soak.step()
            steps += 1
            if steps % 10 == 0:
                soak.verify()
        left = len([*(Path(name) / "tmp").iterdir()])
        hidden = [str(path.relative_to(name)) for path in Path(name).glob("out*/**/.*")]
    rows = [[*key, count] for key, count in sorted(soak.ends.items())]
    print(table(["command", "disturbed by", "status", "times"], rows, ["left", "left", "right", "right"]))
    print(f"{sum(soak.ends.values())} commands; left in the system's folder for temporary files: {left}")
    print(f"left beside results, until the next command there: {len(hidden)} {hidden[:10]}")
    print(f"{len(soak.faults)} faults", *soak.faults, sep="\n")
    sys.exit(bool(soak.faults))


if __name__ == "__main__":
    main()
