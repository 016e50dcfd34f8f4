"""Values of ports as arrays, for benches of every kind."""

from collections.abc import Mapping

import numpy as np
from amaranth.hdl import Shape
from amaranth.lib.wiring import Component, In
from numpy.typing import NDArray


def port_widths(component: Component) -> tuple[dict[str, int], dict[str, int]]:
    """Width in bits of each input and of each output, in the order of declaration."""
    members = component.signature.members.items()
    widths = {name: Shape.cast(member.shape).width for name, member in members}
    inputs = {name: widths[name] for name, member in members if member.flow == In}
    return inputs, {name: width for name, width in widths.items() if name not in inputs}


def port_values(values: NDArray[np.generic], width: int) -> list[int]:
    """One number for each vector.

    Args:
        values: non-negative integers or bools, ``[vectors]``, or ``[vectors, words]`` for a port of several
            equally wide words, the least significant first.
        width: bits of the port.

    Raises:
        ValueError: other dimensions, words that do not divide the port, or a value that does not fit.
    """
    array = np.asarray(values)
    if array.ndim not in (1, 2) or array.dtype.kind not in "iub":
        raise ValueError(
            f"a port takes whole numbers [vectors] or [vectors, words], not {array.dtype} {array.shape}"
        )
    words = array.astype(np.int64)[:, np.newaxis] if array.ndim == 1 else array.astype(np.int64)
    count = words.shape[1]
    if count == 0 or width % count:
        raise ValueError(f"a port of {width} bits cannot take {count} words")
    size = width // count
    if words.size and (words.min() < 0 or int(words.max()) >> size):
        raise ValueError(f"a word of {size} bits cannot hold {words.min()} to {words.max()}")
    totals: list[int] = [0] * len(words)
    for i in reversed(range(count)):
        totals = [total << size | word for total, word in zip(totals, words[:, i].tolist(), strict=True)]
    return totals


def pack(
    component: Component,
    inputs: Mapping[str, NDArray[np.generic]],
    outputs: Mapping[str, NDArray[np.generic]],
) -> tuple[dict[str, list[int]], dict[str, list[int]]]:
    """`port_values` of every port of a component.

    Raises:
        ValueError: ports are missing or unknown, or arrays differ in length; also as `port_values`.
    """
    input_widths, output_widths = port_widths(component)
    for given, known in ((inputs, input_widths), (outputs, output_widths)):
        if set(given) != set(known):
            raise ValueError(f"vectors are given for {sorted(given)}; the ports are {sorted(known)}")
    lengths = {len(values) for values in (*inputs.values(), *outputs.values())}
    if len(lengths) != 1:
        raise ValueError(f"ports are given different numbers of vectors: {sorted(lengths)}")
    return (
        {name: port_values(inputs[name], width) for name, width in input_widths.items()},
        {name: port_values(outputs[name], width) for name, width in output_widths.items()},
    )
