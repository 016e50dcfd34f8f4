"""The contract between stages: encoders, models, tables, covers, LUT networks, windows and their files."""

from wnn2hdl.ir.codes import MAX_TABLE_INPUTS, all_codes, bits_to_codes, codes_to_bits, spread_codes
from wnn2hdl.ir.context import Context
from wnn2hdl.ir.cover import Cover, Cube, Term, irredundant_cover
from wnn2hdl.ir.encoder import Encoder, Neighbourhood, PictureEncoder, Tap
from wnn2hdl.ir.equation import Equation, equation
from wnn2hdl.ir.features import FeatureEncoder, Thermometer, ThermometerBits, Words
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.model import WisardModel, picture_encoder, pixel_encoder
from wnn2hdl.ir.network import (
    CONSTANTS,
    LUT_INPUTS,
    MUX_CONTENTS,
    Column,
    Lut,
    LutNetwork,
    Mux,
    Style,
    look_up,
)
from wnn2hdl.ir.pixel_bits import CHANNELS, COLOURS, PIXEL_BIT_NAMES, PIXEL_BITS, BitSelect
from wnn2hdl.ir.relational import Comparison, PixelEncoder, Relational
from wnn2hdl.ir.tables import TruthTable, pack_contents, unpack_contents
from wnn2hdl.ir.video import VideoFormat
from wnn2hdl.ir.window import CENTRE, WINDOW_BITS, WINDOW_CODES, EdgeFilter, window_codes

__all__ = [
    "CENTRE",
    "CHANNELS",
    "COLOURS",
    "CONSTANTS",
    "LUT_INPUTS",
    "MAX_TABLE_INPUTS",
    "MUX_CONTENTS",
    "PIXEL_BITS",
    "PIXEL_BIT_NAMES",
    "WINDOW_BITS",
    "WINDOW_CODES",
    "BitSelect",
    "Column",
    "Comparison",
    "Context",
    "Cover",
    "Cube",
    "EdgeFilter",
    "Encoder",
    "Equation",
    "FeatureEncoder",
    "FixedPoint",
    "Lut",
    "LutNetwork",
    "Mux",
    "Neighbourhood",
    "PictureEncoder",
    "PixelEncoder",
    "Relational",
    "Style",
    "Tap",
    "Term",
    "Thermometer",
    "ThermometerBits",
    "TruthTable",
    "VideoFormat",
    "WisardModel",
    "Words",
    "all_codes",
    "bits_to_codes",
    "codes_to_bits",
    "equation",
    "irredundant_cover",
    "look_up",
    "pack_contents",
    "picture_encoder",
    "pixel_encoder",
    "spread_codes",
    "unpack_contents",
    "window_codes",
]
