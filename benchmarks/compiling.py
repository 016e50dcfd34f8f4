"""A whole compile in a process of its own, with what it took: time, and memory with its children's."""

import json
import os
import resource
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.ir.models import AnyModel


@dataclass(frozen=True)
class Compiled:
    """What a compile gave and took.

    Attributes:
        luts: of the whole circuit; None if there is no build.
        proof: the report's word, or the exit status if there is no build.
        wall: seconds of wall clock.
        cpu: seconds of CPU time (user time), children included.
        peak: the most resident memory at once, in bytes, children included.
    """

    luts: int | None
    proof: str
    wall: float
    cpu: float
    peak: int


def compile_apart(model: AnyModel, folder: Path, *options: str) -> Compiled:
    """Compile a model into an empty folder, with an empty cache.

    Args:
        model: any model whose circuit is a network.
        folder: where model, cache and build go.
        options: of ``wnn2hdl compile``.
    """
    model.save(folder / "model.json")
    command = [sys.executable, "-m", "wnn2hdl", "compile", str(folder / "model.json"), *options]
    before, started, peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.perf_counter(), 0
    process = subprocess.Popen(
        [*command, "-o", str(folder / "network")],
        env=os.environ | {"WNN2HDL_CACHE": str(folder / "cache")},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    while process.poll() is None:
        peak = max(peak, _family_bytes(process.pid))
        time.sleep(0.2)
    wall = time.perf_counter() - started
    cpu = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    path = folder / "network" / "report.json"
    if not path.exists():
        return Compiled(None, f"exit status {process.returncode}", wall, cpu, peak)
    report = json.loads(path.read_text(encoding="utf-8"))
    return Compiled(report["parts"]["network"]["luts"], report["proof"]["status"], wall, cpu, peak)


def _family_bytes(root: int) -> int:
    """Resident memory of a process and all its children (Linux)."""
    parents: dict[int, int] = {}
    resident: dict[int, int] = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                fields = (folder / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            parents[int(folder.name)] = int(fields[1])
            resident[int(folder.name)] = int(fields[21]) * os.sysconf("SC_PAGE_SIZE")
    family, waiting = 0, [root]
    while waiting:
        process = waiting.pop()
        family += resident.get(process, 0)
        waiting += [child for child, parent in parents.items() if parent == process]
    return family
