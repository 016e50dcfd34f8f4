"""The contract between stages: encoders, models, tables, covers, LUT networks, windows and their files."""

from wnn2hdl.ir.codes import MAX_TABLE_INPUTS, bits_to_codes, codes_to_bits
from wnn2hdl.ir.encoder import (
    CHANNELS,
    COLOURS,
    PIXEL_BIT_NAMES,
    PIXEL_BITS,
    BitSelect,
    Encoder,
    Neighbourhood,
    PictureEncoder,
    Tap,
    Thermometer,
)
from wnn2hdl.ir.model import WisardModel, picture_encoder, pixel_encoder
from wnn2hdl.ir.network import CONSTANTS, LUT_INPUTS, Lut, LutNetwork, Mux, Style
from wnn2hdl.ir.tables import Cover, Cube, TruthTable
from wnn2hdl.ir.window import CENTRE, WINDOW_BITS, WINDOW_CODES, EdgeFilter, window_codes

__all__ = [
    "CENTRE",
    "CHANNELS",
    "COLOURS",
    "CONSTANTS",
    "LUT_INPUTS",
    "MAX_TABLE_INPUTS",
    "PIXEL_BITS",
    "PIXEL_BIT_NAMES",
    "WINDOW_BITS",
    "WINDOW_CODES",
    "BitSelect",
    "Cover",
    "Cube",
    "EdgeFilter",
    "Encoder",
    "Lut",
    "LutNetwork",
    "Mux",
    "Neighbourhood",
    "PictureEncoder",
    "Style",
    "Tap",
    "Thermometer",
    "TruthTable",
    "WisardModel",
    "bits_to_codes",
    "codes_to_bits",
    "picture_encoder",
    "pixel_encoder",
    "window_codes",
]
