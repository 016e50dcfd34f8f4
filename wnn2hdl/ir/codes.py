"""Codes and bits: the one place that fixes the order of bits in an address.

A *code* is an unsigned integer whose bit ``i`` (weight ``2**i``) is input ``i``. Everything that crosses a
stage uses this order, and so does the Verilog: ``code[i]`` is input ``i``.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import InputError

MAX_TABLE_INPUTS = 20
"""The widest truth table that is built: 2**20 rows."""


def all_codes(width: int) -> NDArray[np.int64]:
    """Every code of ``width`` bits, ascending: int64 ``[2**width]``.

    Raises:
        InputError: there are more than a truth table may have rows.
    """
    if width > MAX_TABLE_INPUTS:
        raise InputError(
            "too many input bits for one truth table",
            value=f"{width} bits",
            hint=f"choose at most {MAX_TABLE_INPUTS}",
        )
    return np.arange(1 << width)


def codes_to_bits(codes: ArrayLike, width: int) -> NDArray[np.bool_]:
    """Unpack codes into bits.

    Args:
        codes: unsigned integers of any shape ``S``, each below ``2**width``.
        width: number of bits, at most 63.

    Returns:
        bool array of shape ``S + (width,)``; element ``i`` of the last axis is bit ``i``.
    """
    values = np.asarray(codes, dtype=np.int64)
    bits = np.empty((*values.shape, width), dtype=np.bool_)
    # Bit by bit, since all bits at once would take eight times as much memory as the result.
    for position in range(width):
        bits[..., position] = values >> position & 1
    return bits


def spread_codes(positions: Sequence[int]) -> NDArray[np.int64]:
    """Every code of a few bits, ascending, with bit ``i`` moved to ``positions[i]``: int64 ``[2**len]``."""
    return codes_to_bits(np.arange(1 << len(positions)), len(positions)) @ (1 << np.array(positions))


def bits_to_codes(bits: ArrayLike) -> NDArray[np.int64]:
    """Pack bits into codes, the inverse of `codes_to_bits`.

    Args:
        bits: bool array of shape ``S + (width,)``, width at most 63; element 0 is the least significant.

    Returns:
        int64 array of shape ``S``.
    """
    flags = np.asarray(bits, dtype=np.bool_)
    codes = np.zeros(flags.shape[:-1], dtype=np.int64)
    for position in range(flags.shape[-1]):
        codes |= flags[..., position].astype(np.int64) << position
    return codes
