"""What a circuit has to compute, and on which inputs: the model itself, in NumPy."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import (
    CHANNELS,
    WINDOW_BITS,
    WINDOW_CODES,
    BitSelect,
    EdgeFilter,
    Neighbourhood,
    WisardModel,
    bits_to_codes,
    codes_to_bits,
)

Samples = dict[str, NDArray[Any]]
"""Values of ports, by name: int64 ``[samples]``, except that ``rgb`` is uint8 ``[samples, 3]`` and ``window``
uint8 ``[samples, pixels, 3]``, pixels row by row, channels in the order of `wnn2hdl.ir.CHANNELS`."""

PartName = Literal["pixel", "edge", "match", "block", "block_match", "neighbourhood"]
"""The circuits that are emitted: a block is nine pixels and the edge filter; block_match adds the matcher. A
neighbourhood stands alone."""

PART_NAMES: tuple[PartName, ...] = ("pixel", "edge", "match", "block", "block_match")
"""The circuits of a `Specification`."""


@dataclass(frozen=True)
class Part:
    """The ports of an emitted circuit.

    Attributes:
        module: its Verilog module.
        inputs: width of each input port, by name.
        outputs: width of each output port, by name.
    """

    module: str
    inputs: dict[str, int]
    outputs: dict[str, int]


@dataclass(frozen=True, eq=False)
class Specification:
    """The model, the edge filter and the inputs on which a circuit must equal them.

    Attributes:
        model: a pixel model; its encoder is a `BitSelect`.
        edge_filter: the filter behind the nine pixels.
        pixel_care: bool ``[2**encoder.width]``, the pixel codes that matter; all of them in exact mode.
        window_care: bool ``[512]``, the binary windows on which the edge bit matters.
    """

    model: WisardModel
    edge_filter: EdgeFilter
    pixel_care: NDArray[np.bool_]
    window_care: NDArray[np.bool_]

    def __post_init__(self) -> None:
        if not isinstance(self.model.encoder, BitSelect):
            raise InputError(
                "a pixel circuit needs an encoder that selects pixel bits", value=self.model.encoder.kind
            )
        for name, care, size in (
            ("pixel", self.pixel_care, 1 << self.model.encoder.width),
            ("window", self.window_care, WINDOW_CODES),
        ):
            if care.shape != (size,) or care.dtype != np.bool_:
                raise ValueError(f"the {name} care set holds {size} bools, not {care.dtype} {care.shape}")
            if not care.any():
                # Any circuit equals the model on no input at all.
                raise InputError(
                    f"the {name} care set is empty, so there is nothing to prove",
                    hint="give imagery that holds pixels",
                )

    @classmethod
    def exact(cls, model: WisardModel, edge_filter: EdgeFilter) -> "Specification":
        """The model on every input."""
        codes = np.ones(1 << model.encoder.width, dtype=np.bool_)
        return cls(model, edge_filter, codes, np.ones(WINDOW_CODES, dtype=np.bool_))

    @property
    def encoder(self) -> BitSelect:
        """The model's encoder."""
        assert isinstance(self.model.encoder, BitSelect)
        return self.model.encoder

    @property
    def care(self) -> NDArray[np.bool_]:
        """The codes of the encoder that matter."""
        return self.pixel_care

    @property
    def class_width(self) -> int:
        """Bits of a class index: 1 for two classes."""
        return (len(self.model.classes) - 1).bit_length()

    def part(self, name: PartName) -> Part:
        """The ports of a circuit; widths depend on the number of classes only."""
        pixel, window = 8 * len(CHANNELS), WINDOW_BITS
        count = window.bit_length()
        return {
            "pixel": Part("pixel", {"rgb": pixel}, {"class_bits": self.class_width}),
            "edge": Part("edge_filter", {"bits": window}, {"edge_bit": 1}),
            "match": Part("bit_match", {"bits": window, "reference": window}, {"match_count": count}),
            "block": Part("block", {"window": window * pixel}, {"bits": window, "edge_bit": 1}),
            "block_match": Part(
                "block_match",
                {"window": window * pixel, "reference": window},
                {"bits": window, "edge_bit": 1, "match_count": count},
            ),
        }[name]

    def nearest_cared(self, pixels: ArrayLike) -> NDArray[np.uint8]:
        """Pixels, those outside the care set replaced by one fixed pixel inside it.

        Args:
            pixels: uint8 ``S + (3,)``.

        Returns:
            uint8, same shape; a pixel of the care set stays as it is.
        """
        array: NDArray[np.uint8] = np.array(pixels, dtype=np.uint8)
        cared = self.pixel_care[self.encoder.codes(array)]
        array[~cared] = self.cared_pixel()
        return array

    def cared_pixel(self) -> NDArray[np.uint8]:
        """The pixel of the lowest code in the care set whose other bits are 0: uint8 ``[3]``."""
        code = int(np.flatnonzero(self.pixel_care)[0])
        word = sum((code >> bit & 1) << position for bit, position in enumerate(self.encoder.pixel_positions))
        return np.asarray(word_to_pixels(word, 1)[0])

    def evaluate(self, part: PartName, inputs: Samples) -> Samples:
        """The model's outputs, on every input, cared for or not.

        Args:
            part: the circuit.
            inputs: a value for each input port.

        Returns:
            A value for each output port.
        """
        if part == "pixel":
            return {"class_bits": self._classes(inputs["rgb"])}
        if part == "edge":
            return {"edge_bit": self.edge_filter.evaluate(inputs["bits"]).astype(np.int64)}
        if part == "match":
            same = ~codes_to_bits(inputs["bits"] ^ inputs["reference"], WINDOW_BITS)
            return {"match_count": same.sum(axis=-1, dtype=np.int64)}
        bits = bits_to_codes(self._classes(inputs["window"]) != 0)
        block: Samples = {"bits": bits, **self.evaluate("edge", {"bits": bits})}
        if part == "block":
            return block
        return block | self.evaluate("match", {"bits": bits, "reference": inputs["reference"]})

    def _classes(self, pixels: NDArray[np.uint8]) -> NDArray[np.int64]:
        codes = self.encoder.codes(pixels)
        bits = codes_to_bits(codes.reshape(-1), self.encoder.width)
        return self.model.evaluate(bits).reshape(codes.shape)


@dataclass(frozen=True, eq=False)
class NeighbourhoodSpecification:
    """A model of a pixel and its neighbours, and the inputs on which a circuit must equal it.

    Attributes:
        model: its encoder is a `Neighbourhood`.
        care: bool ``[2**encoder.width]``, the codes of windows that matter; all of them in exact mode.
    """

    model: WisardModel
    care: NDArray[np.bool_]

    def __post_init__(self) -> None:
        if not isinstance(self.model.encoder, Neighbourhood):
            raise InputError("the model does not look at neighbours", value=self.model.encoder.kind)
        if self.care.shape != (1 << self.model.encoder.width,) or self.care.dtype != np.bool_:
            raise ValueError(f"the care set does not fit the model: {self.care.dtype} {self.care.shape}")
        if not self.care.any():
            raise InputError("the care set is empty, so there is nothing to prove", hint="give other imagery")

    @property
    def encoder(self) -> Neighbourhood:
        """The model's encoder."""
        assert isinstance(self.model.encoder, Neighbourhood)
        return self.model.encoder

    @property
    def class_width(self) -> int:
        """Bits of a class index: 1 for two classes."""
        return (len(self.model.classes) - 1).bit_length()

    def part(self, name: PartName) -> Part:
        """The ports of the one circuit, ``neighbourhood``."""
        pixels = self.encoder.size**2
        return {
            "neighbourhood": Part(
                "neighbourhood", {"window": pixels * 8 * len(CHANNELS)}, {"class_bits": self.class_width}
            )
        }[name]

    def codes(self, windows: NDArray[np.uint8]) -> NDArray[np.uint32]:
        """Codes of windows, uint8 ``[samples, size * size, 3]``: uint32 ``[samples]``."""
        size = self.encoder.size
        return self.encoder.codes(windows.reshape(-1, size, size, len(CHANNELS)))[:, 0, 0]

    def evaluate(self, part: PartName, inputs: Samples) -> Samples:
        """The model's outputs, on every input, cared for or not; as `Specification.evaluate`."""
        (output,) = self.part(part).outputs
        bits = codes_to_bits(self.codes(inputs["window"]), self.encoder.width)
        return {output: self.model.evaluate(bits)}


AnySpecification = Specification | NeighbourhoodSpecification


def word_to_pixels(word: int, pixels: int) -> NDArray[np.uint8]:
    """The pixels of a port, uint8 ``[pixels, 3]``: pixel ``i`` is ``word[24*i +: 24]``, red its high byte."""
    channels = word.to_bytes(3 * pixels, "little")
    return np.frombuffer(channels, dtype=np.uint8).reshape(pixels, 3)[:, ::-1]


def pixels_to_word(pixels: ArrayLike) -> int:
    """The inverse of `word_to_pixels`."""
    array = np.asarray(pixels, dtype=np.uint8)
    return int.from_bytes(array.reshape(-1, 3)[:, ::-1].tobytes(), "little")
