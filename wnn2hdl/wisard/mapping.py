"""The tuple mapping: which input bits each RAM reads."""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir.models.wisard import MAX_ADDRESS_BITS


def draw_mapping(bits: int, rams: int, address_bits: int, seed: int, groups: int = 1) -> NDArray[np.int64]:
    """Draw a random mapping, the same for all classes or one for each.

    Each RAM takes the ``address_bits`` inputs that have been read least so far, ties broken at random. So no
    RAM reads an input twice, and how often two inputs are read differs by at most one, whether or not
    ``rams * address_bits`` is a multiple of ``bits``.

    Args:
        bits: input bits of the network.
        rams: k, RAMs of a discriminator.
        address_bits: n, address bits of a RAM.
        seed: of `numpy.random.default_rng`.
        groups: mappings drawn: 1, or the number of classes.

    Returns:
        int64 ``[groups, k, n]``, indices of input bits, as `WisardModel.mapping`.

    Raises:
        InputError: no RAM, or more address bits than input bits or than a RAM may have.
    """
    if rams < 1:
        raise InputError("a discriminator needs at least one RAM", value=rams, hint="choose 1 or more")
    if not 1 <= address_bits <= MAX_ADDRESS_BITS:
        raise InputError(
            "a RAM cannot have this number of address bits",
            value=address_bits,
            hint=f"choose 1 to {MAX_ADDRESS_BITS}",
        )
    if address_bits > bits:
        raise InputError(
            "a RAM has more address bits than the network has input bits",
            value=f"{address_bits} of {bits}",
            hint=f"choose at most {bits} address bits or more input bits",
        )
    rng = np.random.default_rng(seed)
    mapping = np.empty((groups, rams, address_bits), dtype=np.int64)
    for group in range(groups):
        reads = np.zeros(bits, dtype=np.int64)
        for ram in range(rams):
            chosen = np.lexsort((rng.random(bits), reads))[:address_bits]
            reads[chosen] += 1
            mapping[group, ram] = chosen
    return mapping
