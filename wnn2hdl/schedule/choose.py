"""Choosing the stages of a pipeline: by their number, or by the clock."""

from bisect import bisect_left
from collections.abc import Callable

from wnn2hdl.errors import InputError
from wnn2hdl.ir.circuit import Circuit, Instance
from wnn2hdl.schedule.delays import XC7, Delays
from wnn2hdl.schedule.solve import Program
from wnn2hdl.schedule.stages import Stages
from wnn2hdl.schedule.timing import Paths

MAX_STAGES = 64
"""The most stages that can be asked for."""


def for_stages(circuit: Circuit, stages: int, delays: Delays = XC7) -> Stages:
    """The fastest pipeline of so many stages, and of these the one whose registers have the fewest bits.

    A new input enters in every cycle, and each stage ends in registers, the last one too.

    Args:
        circuit: its tables are mapped to LUTs.
        stages: its latency in cycles, at least 1.
        delays: the delay model.
    """
    paths = Paths(circuit, delays)
    program = Program(paths)
    latency = program.least_latency
    period = _first(
        paths.periods(), lambda period: (least := latency(period)) is not None and least <= stages
    )
    return program.fewest_registers(period, stages)


def for_clock(circuit: Circuit, megahertz: float, delays: Delays = XC7) -> Stages:
    """The pipeline of the fewest stages that a clock allows; see `for_stages`.

    Raises:
        InputError: one cell alone takes longer than a cycle.
    """
    return _for_period(circuit, _period(megahertz), delays)


def for_instances(
    circuit: Circuit, *, stages: int | None = None, megahertz: float | None = None, delays: Delays = XC7
) -> Stages | None:
    """Pipelines of the circuits inside a circuit, each by itself, as between the registers of a video core.

    A circuit without registers has a multiplexer behind it, of one LUT for each bit. What meets the period
    with that gets no registers of its own.

    Args:
        circuit: holds nothing but instances.
        stages: of the first of them; the period of its pipeline is that of the others.
        megahertz: the clock that decides the period instead.
        delays: the delay model.

    Returns:
        The stages of all; None if no circuit has registers, or if neither stages nor clock are given.

    Raises:
        InputError: one cell alone takes longer than a cycle.
    """
    parts = [node.circuit for node in circuit.nodes if isinstance(node, Instance)]
    if stages is not None:
        chosen = [for_stages(parts[0], stages, delays)]
        period = chosen[0].period
    elif megahertz is not None:
        chosen, period = [], _period(megahertz)
    else:
        return None
    for part in parts[len(chosen) :]:
        unregistered = for_stages(part, 1, delays).period + delays.net + delays.lut
        if unregistered > period:
            chosen.append(_for_period(part, period, delays))
    if not chosen:
        return None
    latencies = dict.fromkeys(circuit.definitions(), 0)
    for pipeline in chosen:
        latencies |= pipeline.latencies
    places = {place: stage for pipeline in chosen for place, stage in pipeline.places.items()}
    return Stages(places, latencies, max(pipeline.period for pipeline in chosen))


def _period(megahertz: float) -> int:
    """The picoseconds of a cycle, of any positive clock: 1 at least, and a second at most."""
    return int(min(max(1e6 / megahertz, 1), 1e12))


def _for_period(circuit: Circuit, period: int, delays: Delays) -> Stages:
    paths = Paths(circuit, delays)
    program = Program(paths)
    latency = program.least_latency(period)
    if latency is None:
        shortest = _first(paths.periods(), lambda period: program.least_latency(period) is not None)
        raise InputError(
            "no number of stages meets the clock",
            value=f"{1e6 / period:.0f} MHz, {period} ps",
            hint=f"a stage takes at least {shortest} ps, so give at most --clock {1_000_000 // shortest}",
        )
    return program.fewest_registers(period, latency)


def _first(periods: list[int], does: Callable[[int], bool]) -> int:
    """The first period that does; all later ones do, too, and the last one does."""
    return periods[bisect_left(periods, True, hi=len(periods) - 1, key=does)]
