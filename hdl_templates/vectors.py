"""Values of ports as arrays, for benches of every kind."""

from collections.abc import Mapping

import numpy as np
from amaranth.hdl import Shape
from amaranth.lib.wiring import Component, In
from numpy.typing import NDArray

from wnn2hdl.ir.wires import word_values


def port_widths(component: Component) -> tuple[dict[str, int], dict[str, int]]:
    """Width in bits of each input and of each output, in the order of declaration."""
    members = component.signature.members.items()
    widths = {name: Shape.cast(member.shape).width for name, member in members}
    inputs = {name: widths[name] for name, member in members if member.flow == In}
    return inputs, {name: width for name, width in widths.items() if name not in inputs}


def pack(
    component: Component,
    inputs: Mapping[str, NDArray[np.bool_]],
    outputs: Mapping[str, NDArray[np.bool_]],
) -> tuple[dict[str, list[int]], dict[str, list[int]]]:
    """Values of every port of a component as one number for each vector.

    Args:
        component: the component.
        inputs: for each input port its values, bool ``[vectors, width]``, the least significant bit first.
        outputs: for each output port its values, in the same form.

    Raises:
        ValueError: ports are missing or unknown, or arrays have other widths or differ in length.
    """
    packed = []
    for given, known in zip((inputs, outputs), port_widths(component), strict=True):
        if set(given) != set(known):
            raise ValueError(f"vectors are given for {sorted(given)}; the ports are {sorted(known)}")
        for name, width in known.items():
            if given[name].dtype != np.bool_ or given[name].shape[1:] != (width,):
                raise ValueError(
                    f"port {name} takes bools [vectors, {width}], not {given[name].dtype} {given[name].shape}"
                )
        packed.append({name: word_values(given[name]) for name in known})
    lengths = {len(values) for values in (*inputs.values(), *outputs.values())}
    if len(lengths) != 1:
        raise ValueError(f"ports are given different numbers of vectors: {sorted(lengths)}")
    return packed[0], packed[1]
