"""The trained network: RAM discriminators, their mapping, their counts and the bleaching threshold."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.files import write_json
from wnn2hdl.ir.codes import MAX_TABLE_INPUTS, all_codes, bits_to_codes, codes_to_bits
from wnn2hdl.ir.encoder import Encoder, PictureEncoder, encoder_from_json
from wnn2hdl.ir.modelfile import answers_digest, contradicting, header, read_model_file
from wnn2hdl.ir.relational import PixelEncoder

MAX_COUNTS = 1 << 27
"""The most counts of a model, all discriminators together: 1 GiB."""

MAX_PICTURE_CLASSES = 256
"""The most classes of a model of pictures, whose answers are bytes."""

COMMAND = "command"
"""Key in `WisardModel.training` of the command line that trained the model, all but its ``-o``."""


@dataclass(frozen=True, eq=False)
class WisardModel:
    """A WiSARD: one discriminator per class, each of ``k`` RAMs with ``n`` address bits.

    A RAM fires if the count at its address reaches the bleaching threshold; a discriminator's response is how
    many of its RAMs fire (the reference design's r_i(x)); the highest response wins, and among equal ones the
    class named first. A network of one RAM per class that reads every bit is a plain look-up table.

    Attributes:
        encoder: what turns a pixel or features into the ``encoder.width`` input bits.
        classes: class names; for a pixel model the first is the background (forest), and an output bit of the
            3x3 block is set for any other.
        mapping: int64 ``[m, k, n]``, indices of input bits; ``m`` is 1 (all classes share it) or the number
            of classes. Entry 0 of the last axis is the RAM's least significant address bit.
        counts: int64 ``[classes, k, 2**n]``, how often each address was seen in training.
        bleaching: the threshold, at least 1.
        training: where the model comes from (seed, data, chosen threshold …), any JSON object.
        colours: int64, codes of `COLOURS` that occur in the training images, ascending; None if they are not
            known. They decide no answer, but distinguish imagery of the kind that was trained on from foreign
            imagery.
    """

    kind: ClassVar[str] = "wisard"
    ties: ClassVar[Literal["first", "last"]] = "first"
    encoder: Encoder
    classes: tuple[str, ...]
    mapping: NDArray[np.int64]
    counts: NDArray[np.int64]
    bleaching: int
    training: Mapping[str, Any] = field(default_factory=dict)
    colours: NDArray[np.int64] | None = None

    def __post_init__(self) -> None:
        if len(self.classes) < 2 or len(set(self.classes)) != len(self.classes):
            raise ValueError(f"a model needs at least two different classes, not {list(self.classes)}")
        if self.mapping.ndim != 3 or self.mapping.shape[0] not in (1, len(self.classes)):
            raise ValueError(f"the mapping has shape {self.mapping.shape}; it must be [1 or classes, k, n]")
        if self.mapping.min() < 0 or self.mapping.max() >= self.encoder.width:
            raise ValueError(
                f"the mapping reads input bits {self.mapping.min()} to {self.mapping.max()}; "
                f"there are 0 to {self.encoder.width - 1}"
            )
        expected = (len(self.classes), self.rams, 1 << self.address_bits)
        if self.counts.shape != expected:
            raise ValueError(f"the counts have shape {self.counts.shape}; the mapping asks for {expected}")
        if self.counts.min() < 0:
            raise ValueError(f"a count is negative: {self.counts.min()}")
        if self.bleaching < 1:
            raise ValueError(f"the bleaching threshold is {self.bleaching}; the lowest is 1")

    @property
    def rams(self) -> int:
        """k, the RAMs of a discriminator."""
        return int(self.mapping.shape[1])

    @property
    def address_bits(self) -> int:
        """n, the address bits of a RAM."""
        return int(self.mapping.shape[2])

    @property
    def saturation(self) -> NDArray[np.float64]:
        """Share of the addresses that fire, ``[classes, k]``; a RAM at 1 answers yes to everything."""
        return np.asarray((self.counts >= self.bleaching).mean(axis=2))

    def responses(self, bits: ArrayLike, threshold: int | None = None) -> NDArray[np.int64]:
        """Firing RAMs of each discriminator.

        Args:
            bits: bool ``[samples, encoder.width]``.
            threshold: a count that makes a RAM fire; `bleaching` if left out.

        Returns:
            int64 ``[samples, classes]``, each from 0 to ``rams``.
        """
        flags = np.asarray(bits, dtype=np.bool_)
        fires = self.counts >= (self.bleaching if threshold is None else threshold)
        result = np.zeros((len(flags), len(self.classes)), dtype=np.int64)
        for group, mapping in enumerate(self.mapping):
            owners = range(len(self.classes)) if len(self.mapping) == 1 else (group,)
            for ram, inputs in enumerate(mapping):
                address = bits_to_codes(flags[:, inputs])
                for owner in owners:
                    result[:, owner] += fires[owner, ram, address]
        return result

    def evaluate(self, bits: ArrayLike) -> NDArray[np.int64]:
        """Index of the winning class for bits ``[samples, encoder.width]``: int64 ``[samples]``."""
        return np.asarray(self.responses(bits).argmax(axis=1))

    def evaluate_all_codes(self) -> NDArray[np.int64]:
        """The class of every code, int64 ``[2**encoder.width]``; a pixel model is this table.

        Raises:
            InputError: the codes have more than `MAX_TABLE_INPUTS` bits.
        """
        return self.evaluate(codes_to_bits(all_codes(self.encoder.width), self.encoder.width))

    def digest(self) -> str:
        """SHA-256 of all that decides the model's answers (not of `training` and `colours`), hexadecimal."""
        return answers_digest(self.to_json())

    def to_json(self) -> dict[str, Any]:
        """The model file's object; RAMs are stored as their non-zero addresses and counts."""
        data = {
            **header(self.kind),
            "encoder": self.encoder.to_json(),
            "classes": list(self.classes),
            "address_bits": self.address_bits,
            "rams": self.rams,
            "bleaching": self.bleaching,
            "mapping": self.mapping.tolist(),
            "counts": [[_sparse(ram) for ram in discriminator] for discriminator in self.counts],
            "training": dict(self.training),
        }
        return data if self.colours is None else data | {"colours": self.colours.tolist()}

    def save(self, path: Path) -> None:
        """Write the model file."""
        write_json(path, self.to_json())

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read and check a model file.

        Raises:
            ModelFileError: the file is missing, damaged, of a newer version, or no model.
        """
        data = read_model_file(path)
        if data["kind"] != cls.kind:
            raise ModelFileError(
                "the model is of another kind", value=f"{path} ({data['kind']})", hint="give one of pixels"
            )
        try:
            return cls.from_json(data)
        except (ValueError, TypeError, IndexError, OverflowError) as error:
            raise contradicting(path, error) from error

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The model of an object that fits the schema; raises ValueError if it contradicts itself."""
        mapping = np.array(data["mapping"], dtype=np.int64)
        shape = (data["rams"], data["address_bits"])
        if mapping.shape[1:] != shape:
            raise ValueError(f"the mapping has shape {mapping.shape}; rams and address_bits say {shape}")
        if len(data["counts"]) != len(data["classes"]) or any(len(d) != shape[0] for d in data["counts"]):
            raise ValueError("counts must hold one list per class with one entry per RAM")
        # A RAM takes a few bytes in the file, however many addresses it has.
        check_size(len(data["classes"]), *shape)
        counts = np.stack([[_dense(ram, shape[1]) for ram in rams] for rams in data["counts"]])
        return cls(
            encoder=encoder_from_json(data["encoder"]),
            classes=tuple(data["classes"]),
            mapping=mapping,
            counts=counts,
            bleaching=data["bleaching"],
            training=data["training"],
            colours=np.array(data["colours"], dtype=np.int64) if "colours" in data else None,
        )


def check_size(classes: int, rams: int, address_bits: int) -> None:
    """Raise ValueError if discriminators have more addresses than `MAX_COUNTS` all together."""
    if not 1 <= address_bits <= MAX_TABLE_INPUTS or classes * rams << address_bits > MAX_COUNTS:
        raise ValueError(
            f"{classes} discriminators of {rams} RAMs with {address_bits} address bits take more than "
            f"{MAX_COUNTS} counts"
        )


def pixel_encoder(model: WisardModel) -> PixelEncoder:
    """The encoder of a model of single pixels.

    Raises:
        InputError: as `picture_encoder`, or the model looks at a pixel's neighbours.
    """
    encoder = picture_encoder(model)
    if not isinstance(encoder, PixelEncoder):
        side = 2 * encoder.halo + 1
        raise InputError(
            "the model looks at more than one pixel",
            value=f"at {side}x{side}",
            hint="use one that was trained without --neighbourhood and --context",
        )
    return encoder


def picture_encoder(model: WisardModel) -> PictureEncoder:
    """The encoder of a model of pixels or of neighbourhoods, which can be a table of all codes.

    Raises:
        InputError: the model reads features, not the bits of pixels; or too many bits for a table, or it has
            more than `MAX_PICTURE_CLASSES`.
    """
    if not isinstance(model.encoder, PictureEncoder):
        raise InputError(
            "the model does not read pixels",
            value=f"its encoder is of kind {model.encoder.kind}",
            hint="use one that was trained on images",
        )
    if model.encoder.width > MAX_TABLE_INPUTS or len(model.classes) > MAX_PICTURE_CLASSES:
        raise InputError(
            "the model is too large for a table",
            value=f"{model.encoder.width} bits, {len(model.classes)} classes",
            hint=f"choose at most {MAX_TABLE_INPUTS} bits and {MAX_PICTURE_CLASSES} classes",
        )
    return model.encoder


def _sparse(ram: NDArray[np.int64]) -> dict[str, list[int]]:
    addresses = np.flatnonzero(ram)
    return {"addresses": addresses.tolist(), "counts": ram[addresses].tolist()}


def _dense(ram: dict[str, list[int]], address_bits: int) -> NDArray[np.int64]:
    addresses, counts = ram["addresses"], ram["counts"]
    if len(addresses) != len(counts) or len(set(addresses)) != len(addresses):
        raise ValueError("a RAM needs as many counts as addresses, and no address twice")
    if addresses and max(addresses) >= 1 << address_bits:
        raise ValueError(f"address {max(addresses)} does not fit {address_bits} address bits")
    dense = np.zeros(1 << address_bits, dtype=np.int64)
    dense[addresses] = counts
    return dense
