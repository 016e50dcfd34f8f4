"""Simulation of a component in Amaranth's simulator, compared with the model's answers vector by vector."""

import time
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from amaranth.hdl import Cat
from amaranth.sim import Simulator

from hdl_templates.hierarchy import Part
from hdl_templates.vectors import pack, port_widths
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.verify.specification import Samples

Progress = Callable[[int, int], None]
"""Called with the vectors done and their total."""

Bench = Callable[[Any], Coroutine[Any, Any, None]]
"""A testbench, as Amaranth's simulator calls it."""

_REPORT_EVERY = 2048
_PERIOD = 10e-9
"""Seconds from edge to edge of the clock, and that a vector takes in a recording."""


@dataclass(frozen=True)
class SimulationResult:
    """A simulation without a mismatch: how many vectors, in how many seconds of wall-clock time."""

    vectors: int
    seconds: float

    @property
    def vectors_per_second(self) -> float:
        """The simulator's speed."""
        return self.vectors / self.seconds


def simulate(
    component: Part,
    inputs: Samples,
    expected: Samples,
    *,
    progress: Progress | None = None,
    vcd: Path | None = None,
    vcd_vectors: int = 256,
) -> SimulationResult:
    """Simulate a component on all vectors and compare every output bit.

    A new vector is applied in each cycle, settles, and is compared as many cycles later as the component's
    latency says; with latency 0 there is no clock.

    Args:
        component: the circuit, as yet unused.
        inputs: for each input port its values, bool ``[vectors, width]``.
        expected: for each output port the model's answers.
        progress: called now and then.
        vcd: where to record the waves of the first ``vcd_vectors`` vectors, 10 ns each, and for as many
            more as the latency; the recording ends at a mismatch among them.
        vcd_vectors: how many vectors are recorded.

    Raises:
        CheckError: an output differs from the model.
        InputError: the waves cannot be written.
        ValueError: the arrays do not fit the ports.
    """
    stimulus, answers = pack(component, inputs, expected)
    total = len(next(iter(answers.values())))
    started = time.perf_counter()
    if vcd is not None:
        _record(component, _bench(component, stimulus, answers, min(vcd_vectors, total), recorded=True), vcd)
    simulator = _simulator(component)
    simulator.add_testbench(_bench(component, stimulus, answers, total, progress))
    simulator.run()
    return SimulationResult(total, time.perf_counter() - started)


def _bench(
    component: Part,
    stimulus: dict[str, list[int]],
    answers: dict[str, list[int]],
    total: int,
    progress: Progress | None = None,
    *,
    recorded: bool = False,
) -> Bench:
    """A testbench that applies the first vectors in turn.

    Where there is no clock, each takes `_PERIOD` if it is recorded, and no time otherwise.
    """
    sources = [getattr(component, name) for name in stimulus]
    offsets = [sum(len(port) for port in sources[:i]) for i in range(len(sources))]
    everything = Cat(*sources)
    sinks = [(name, getattr(component, name), values) for name, values in answers.items()]
    rows = list(zip(*stimulus.values(), strict=True))

    async def bench(ctx: Any) -> None:
        last: tuple[int | None, ...] = (None,) * len(sources)
        for cycle in range(total + component.latency):
            row = rows[min(cycle, total - 1)]
            changed = [port for port, value in enumerate(row) if value != last[port]]
            last = row
            # `set` returns once all that depends on its ports has settled, so it is called once per vector.
            if len(changed) == 1:
                ctx.set(sources[changed[0]], row[changed[0]])
            elif changed:
                ctx.set(everything, sum(value << offset for value, offset in zip(row, offsets, strict=True)))
            i = cycle - component.latency
            for name, port, values in sinks if i >= 0 else ():
                if ctx.get(port) != values[i]:
                    inputs = {source: values[i] for source, values in stimulus.items()}
                    raise _mismatch(component, i, inputs, name, values[i], ctx.get(port))
            if component.clocked:
                await ctx.tick()
            elif recorded:
                await ctx.delay(_PERIOD)
            if progress and ((i + 1) % _REPORT_EVERY == 0 or i + 1 == total) and i >= 0:
                progress(i + 1, total)

    return bench


def _simulator(component: Part) -> Simulator:
    simulator = Simulator(component)
    if component.clocked:
        simulator.add_clock(_PERIOD)
    return simulator


def _record(component: Part, bench: Bench, path: Path) -> None:
    simulator = _simulator(component)
    with recorded(simulator, path):
        simulator.add_testbench(bench)
        simulator.run()


@contextmanager
def recorded(simulator: Simulator, path: Path) -> Iterator[None]:
    """Record the waves of what a simulator does meanwhile; raises InputError if they cannot be written."""
    try:
        with path.open("w", encoding="utf-8") as stream, simulator.write_vcd(stream):
            yield
    except OSError as error:
        raise InputError(
            "cannot record the waves",
            value=f"{path} ({error.strerror})",
            hint="choose a folder you may write to",
        ) from error


def _mismatch(
    component: Part, vector: int, inputs: dict[str, int], output: str, expected: int, got: int
) -> CheckError:
    inputs_widths, outputs_widths = port_widths(component)
    applied = ", ".join(f"{name} = {_literal(value, inputs_widths[name])}" for name, value in inputs.items())
    width = outputs_widths[output]
    return CheckError(
        f"the circuit differs from the model at vector {vector}",
        value=f"{output} is {_literal(got, width)}, the model says {_literal(expected, width)}, at {applied}",
    )


def _literal(value: int, width: int) -> str:
    return f"{width}'h{value:x}"
