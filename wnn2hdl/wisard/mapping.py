"""The tuple mapping: which input bits each RAM reads."""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import MAX_TABLE_INPUTS


def draw_mapping(bits: int, rams: int, address_bits: int, seed: int) -> NDArray[np.int64]:
    """Draw a random mapping, the same for all classes.

    Each RAM takes the ``address_bits`` inputs that have been read least so far, ties broken at random. So no
    RAM reads an input twice, and how often two inputs are read differs by at most one, whether or not
    ``rams * address_bits`` is a multiple of ``bits``.

    Args:
        bits: input bits of the network.
        rams: k, RAMs of a discriminator.
        address_bits: n, address bits of a RAM.
        seed: of `numpy.random.default_rng`.

    Returns:
        int64 ``[1, k, n]``, indices of input bits, as `WisardModel.mapping`.

    Raises:
        InputError: no RAM, or more address bits than input bits or than a RAM may have.
    """
    if rams < 1:
        raise InputError("a discriminator needs at least one RAM", value=rams, hint="choose 1 or more")
    if not 1 <= address_bits <= MAX_TABLE_INPUTS:
        raise InputError(
            "a RAM cannot have this number of address bits",
            value=address_bits,
            hint=f"choose 1 to {MAX_TABLE_INPUTS}",
        )
    if address_bits > bits:
        raise InputError(
            "a RAM has more address bits than the network has input bits",
            value=f"{address_bits} of {bits}",
            hint=f"choose at most {bits} address bits or more input bits",
        )
    rng = np.random.default_rng(seed)
    reads = np.zeros(bits, dtype=np.int64)
    mapping = np.empty((1, rams, address_bits), dtype=np.int64)
    for ram in range(rams):
        chosen = np.lexsort((rng.random(bits), reads))[:address_bits]
        reads[chosen] += 1
        mapping[0, ram] = chosen
    return mapping
