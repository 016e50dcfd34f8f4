"""The circuits of the reference design answer as their models do."""

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.ir import (
    BitSelect,
    EdgeFilter,
    Neighbourhood,
    PictureEncoder,
    Relational,
    Tap,
    Thermometer,
    WisardModel,
    codes_to_bits,
)
from wnn2hdl.ir.care import Codes, Everything
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.pixels import pixel_bits
from wnn2hdl.ir.wires import Port
from wnn2hdl.lower import deforestation

ENCODER = BitSelect(("R7", "R6", "G7", "B0"))
WINDOWS = codes_to_bits(np.arange(512), 9)
CENTRE_WITHOUT_TOP = EdgeFilter("test", WINDOWS[:, 4] & ~WINDOWS[:, 1])


def random_model(encoder: PictureEncoder, classes: int = 2) -> WisardModel:
    rng = np.random.default_rng(classes)
    mapping = np.stack([rng.permutation(encoder.width)[:3] for _ in range(4)])[np.newaxis]
    counts = rng.integers(0, 3, (classes, 4, 8))
    return WisardModel(encoder, tuple(f"class {i}" for i in range(classes)), mapping, counts, 1)


def classes_of(model: WisardModel, codes: np.ndarray) -> np.ndarray:
    return model.evaluate(codes_to_bits(codes.reshape(-1), model.encoder.width)).reshape(codes.shape)


def pixel(model: WisardModel) -> Circuit:
    return deforestation.pixel(model, Everything(model.encoder.width))


def edge() -> Circuit:
    return deforestation.edge(CENTRE_WITHOUT_TOP, Everything(9))


@pytest.mark.parametrize(("classes", "width"), [(2, 1), (3, 2), (5, 3)])
def test_a_pixel_gives_the_index_of_its_class(classes: int, width: int) -> None:
    model = random_model(ENCODER, classes)
    pixels = np.random.default_rng(0).integers(0, 256, (500, 3), dtype=np.uint8)
    circuit = pixel(model)
    assert circuit.inputs == (Port("rgb", 24),)
    assert circuit.outputs == (Port("class_bits", width),)
    expected = codes_to_bits(classes_of(model, ENCODER.codes(pixels)), width)
    assert np.array_equal(circuit.evaluate({"rgb": pixel_bits(pixels)})["class_bits"], expected)


def test_what_is_not_cared_for_is_free_in_the_table_and_known_to_the_circuit() -> None:
    allowed = np.arange(16) % 3 == 0
    circuit = deforestation.pixel(random_model(ENCODER), Codes(allowed))
    (table,) = circuit.tables().values()
    assert table.function.care.tolist() == allowed.tolist()  # type: ignore[union-attr]
    (care,) = circuit.care
    assert [part.low for part in care.word] == [23, 22, 15, 0]


RELATIONAL = Relational(("3R[7:2]>=2B[7:2]", "R7", "3R[7:2]>=2B[7:2]+9"))


def test_comparisons_are_tables_before_the_one_that_decides() -> None:
    model = random_model(RELATIONAL)
    circuit = pixel(model)
    decision, *rest = reversed(circuit.tables().values())
    assert [table.name for table in rest] == ["is_3R_7_2_ge_2B_7_2_plus_9", "is_3R_7_2_ge_2B_7_2"]
    pixels = np.random.default_rng(0).integers(0, 256, (500, 3), dtype=np.uint8)
    expected = codes_to_bits(classes_of(model, RELATIONAL.codes(pixels)), 1)
    assert np.array_equal(circuit.evaluate({"rgb": pixel_bits(pixels)})["class_bits"], expected)
    # The second comparison implies the first.
    assert decision.function.care.tolist() == [  # type: ignore[union-attr]
        bool(code & 1) or not code & 4 for code in range(8)
    ]


def test_a_model_of_features_is_no_pixel_classifier() -> None:
    counts = np.ones((2, 1, 2), dtype=np.int64)
    model = WisardModel(Thermometer(((0.5,),)), ("a", "b"), np.zeros((1, 1, 1), dtype=np.int64), counts, 1)
    with pytest.raises(InputError, match="pixel"):
        deforestation.pixel(model, Everything(1))


def test_an_edge_filter_looks_windows_up() -> None:
    answers = edge().evaluate({"bits": WINDOWS})["edge_bit"]
    assert np.array_equal(answers[:, 0], CENTRE_WITHOUT_TOP.patterns)
    (care,) = edge().care
    assert care.word == Port("bits", 9).word


def test_the_matcher_counts_places_that_agree() -> None:
    circuit = deforestation.match()
    assert circuit.inputs == (Port("bits", 9), Port("reference_bits", 9))
    rng = np.random.default_rng(0)
    bits, reference = rng.random((500, 9)) < 0.5, rng.random((500, 9)) < 0.5
    count = circuit.evaluate({"bits": bits, "reference_bits": reference})["match_count"]
    assert np.array_equal(count, codes_to_bits((bits == reference).sum(axis=1), 4))


@pytest.mark.parametrize("classes", [2, 3])
def test_a_block_classifies_nine_pixels_and_matches_them(classes: int) -> None:
    model = random_model(ENCODER, classes)
    block = deforestation.block(pixel(model), edge())
    circuit = deforestation.block_match(block, deforestation.match())
    assert list(circuit.definitions()) == ["pixel", "edge", "block", "match", "block_match"]
    rng = np.random.default_rng(classes)
    pixels = rng.integers(0, 256, (1000, 9, 3), dtype=np.uint8)
    reference = rng.random((1000, 9)) < 0.5
    bits = classes_of(model, ENCODER.codes(pixels)) != 0
    answers = circuit.evaluate({"window": pixel_bits(pixels), "reference_bits": reference})
    assert len(np.unique(bits, axis=0)) > 100
    assert np.array_equal(answers["bits"], bits)
    assert np.array_equal(answers["edge_bit"][:, 0], bits[:, 4] & ~bits[:, 1])
    assert np.array_equal(answers["match_count"], codes_to_bits((bits == reference).sum(axis=1), 4))
    alone = block.evaluate({"window": pixel_bits(pixels)})
    assert all(np.array_equal(alone[port], answers[port]) for port in ("bits", "edge_bit"))


def test_windows_are_read_row_by_row() -> None:
    model = WisardModel(
        BitSelect(("R7",)),
        ("a", "b"),
        np.zeros((1, 1, 1), dtype=np.int64),
        np.array([[[1, 0]], [[0, 1]]]),
        bleaching=1,
    )
    window = np.zeros((1, 9, 3), dtype=np.uint8)
    window[0, 4, 0] = 128
    answers = deforestation.block(pixel(model), edge()).evaluate({"window": pixel_bits(window)})
    assert np.flatnonzero(answers["bits"]).tolist() == [4]
    assert answers["edge_bit"].all()


def test_a_neighbourhood_asks_each_tap_about_its_pixel() -> None:
    rng = np.random.default_rng(0)
    names = [("R7", "G6"), ("G6", "B5"), ("R3",), ("R7", "B7", "G2")]
    places = [(1, 1), (1, 1), (0, 0), (2, 1)]
    taps = tuple(
        Tap.of(row, column, BitSelect(bits), rng.permutation(np.arange(1 << len(bits)) % 2 == 0))
        for bits, (row, column) in zip(names, places, strict=True)
    )
    encoder = Neighbourhood(3, taps)
    model = random_model(encoder)
    allowed = rng.random(16) < 0.7
    circuit = deforestation.neighbourhood(model, encoder, Codes(allowed))
    pictures = rng.integers(0, 256, (500, 3, 3, 3), dtype=np.uint8)
    answers = circuit.evaluate({"window": pixel_bits(pictures.reshape(500, 9, 3))})
    classes = classes_of(model, encoder.codes(pictures)[:, 0, 0])
    assert 0 < classes.sum() < 500
    assert np.array_equal(answers["class_bits"], codes_to_bits(classes, 1))
    assert list(circuit.tables()) == [*encoder.names, "decision"]
    decision = circuit.nodes[-1]
    assert isinstance(decision, Table)
    assert decision.function.care.tolist() == allowed.tolist()  # type: ignore[union-attr]
