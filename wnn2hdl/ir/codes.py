"""Codes and bits: the one place that fixes the order of bits in an address.

A *code* is an unsigned integer whose bit ``i`` (weight ``2**i``) is input ``i``. Everything that crosses a
stage uses this order, and so does the Verilog: ``code[i]`` is input ``i``.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

MAX_TABLE_INPUTS = 20
"""The widest truth table that is built: 2**20 rows."""


def codes_to_bits(codes: ArrayLike, width: int) -> NDArray[np.bool_]:
    """Unpack codes into bits.

    Args:
        codes: unsigned integers of any shape ``S``, each below ``2**width``.
        width: number of bits, at most 63.

    Returns:
        bool array of shape ``S + (width,)``; element ``i`` of the last axis is bit ``i``.
    """
    values = np.asarray(codes, dtype=np.int64)
    return (values[..., np.newaxis] >> np.arange(width) & 1).astype(np.bool_)


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
