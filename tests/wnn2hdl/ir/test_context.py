"""Context encoders: counts of a bit in the squares around a pixel."""

import json
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import Context, WisardModel, pixel_encoder
from wnn2hdl.ir.context import Count, box_sums
from wnn2hdl.ir.encoder import encoder_from_json
from wnn2hdl.ir.relational import Comparison, signal_name

BITS = ("R7", "7x7(3R>=2B)>=13", "3x3(G[7:2]>=B[7:2])>=5", "7x7(3R>=2B)>=25")


def test_a_code_counts_bits_in_squares() -> None:
    encoder = Context(BITS)
    pictures = np.random.default_rng(0).integers(0, 256, size=(2, 12, 10, 3), dtype=np.uint8)
    codes = encoder.codes(pictures)
    assert codes.shape == (2, 6, 4)
    for place, code in np.ndenumerate(codes):
        picture, row, column = place
        square = pictures[picture, row : row + 7, column : column + 7]
        ratio = Comparison.parse("3R>=2B").evaluate(square).sum()
        inner = Comparison.parse("G[7:2]>=B[7:2]").evaluate(square[2:5, 2:5]).sum()
        bits = [square[3, 3, 0] >= 128, ratio >= 13, inner >= 5, ratio >= 25]
        assert code == sum(1 << i for i, bit in enumerate(bits) if bit)
    assert encoder.codes(pictures[0, :6]).shape == (0, 4)


def test_an_encoder_says_what_hardware_needs() -> None:
    encoder = Context(BITS)
    assert encoder.halo == 3
    assert encoder.planes == ("R7", "3R>=2B", "G[7:2]>=B[7:2]")
    assert encoder.sums == (("R7", 1), ("3R>=2B", 7), ("G[7:2]>=B[7:2]", 3))
    assert encoder.widths == (1, 6, 4)
    # Nothing has 25 pixels without having 13.
    assert [code for code in range(16) if not encoder.possible[code]] == [8, 9, 12, 13]


def test_sums_of_squares_that_lie_inside() -> None:
    plane = np.arange(20).reshape(4, 5)
    assert box_sums(plane, 3).tolist() == [[54, 63, 72], [99, 108, 117]]
    assert box_sums(plane, 1).tolist() == plane.tolist()


@pytest.mark.parametrize("name", BITS)
def test_names_are_read_back(name: str) -> None:
    assert str(Count.parse(name)) == name
    assert signal_name(name).isidentifier()


@pytest.mark.parametrize(
    ("bits", "fault"),
    [
        (("R7", "3R>=2B"), "counts in a square at least once"),
        (("5x5(R7)>=3",), "side of 3, 7, 15, 31 pixels, not 5"),
        (("3x3(R7)>=10",), "of 9 pixels 1 to 9 can be asked for, not 10"),
        (("3x7(R7)>=3",), "compares no channels"),
        (("3x3(X7)>=3",), "compares no channels"),
        (("1x1(R7)>=1", "3x3(R7)>=1"), "is written R7"),
        (("03x03(R7)>=1",), "is written 3x3"),
        (("3x3(R7)>=1", "3x3(R7)>=1"), "named twice"),
    ],
)
def test_what_no_encoder_can_be_is_refused(bits: tuple[str, ...], fault: str) -> None:
    with pytest.raises(ValueError, match=fault):
        Context(bits)


def test_a_model_file_keeps_the_encoder(tmp_path: Path) -> None:
    counts = np.zeros((2, 1, 16), dtype=np.int64)
    counts[0, 0, :8] = counts[1, 0, 8:] = 1
    model = WisardModel(Context(BITS), ("forest", "deforested"), np.arange(4).reshape(1, 1, 4), counts, 1)
    path = tmp_path / "model.json"
    model.save(path)
    again = WisardModel.load(path)
    assert again.encoder == model.encoder == encoder_from_json(model.encoder.to_json())
    assert again.digest() == model.digest()
    with pytest.raises(Exception, match="more than one pixel: at 7x7"):
        pixel_encoder(model)
    data = json.loads(path.read_text())
    data["encoder"]["bits"][1] = "7x7(3R>=2B)>=50"
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError, match=r"contradicts itself: .*of 49 pixels 1 to 49"):
        WisardModel.load(path)
