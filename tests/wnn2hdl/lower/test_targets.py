"""Which circuits a model can be compiled to."""

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, EdgeFilter, Neighbourhood, Tap, VideoFormat, WisardModel
from wnn2hdl.ir.care import Codes
from wnn2hdl.lower.targets import TARGETS, Ingredients, target_for
from wnn2hdl.verify.specify import care_sets

PIXEL = BitSelect(("R7", "G7", "B7"))
TAPS = tuple(Tap.of(1, column, PIXEL, np.arange(8) < 3) for column in range(3))
EDGES = EdgeFilter("none", np.zeros(512, dtype=np.bool_))


def model(encoder: BitSelect | Neighbourhood) -> WisardModel:
    counts = np.random.default_rng(0).integers(0, 3, (2, 2, 8))
    return WisardModel(encoder, ("a", "b"), np.array([[[0, 1, 2], [2, 1, 0]]]), counts, 1)


@pytest.mark.parametrize(
    ("name", "circuit"),
    [
        ("block", "block_match"),
        ("pixel", "pixel"),
        ("edge", "edge"),
        ("match", "match"),
        ("neighbourhood", "neighbourhood"),
    ],
)
def test_each_target_makes_its_circuit(name: str, circuit: str) -> None:
    target = TARGETS[name]
    encoder = Neighbourhood(3, TAPS) if name == "neighbourhood" else PIXEL
    assert target.fits(model(encoder))
    made = target.lower(Ingredients(model(encoder), EDGES))
    assert made.name == circuit
    assert ("edge" in made.definitions()) == target.has_edges


def test_a_video_core_of_neighbourhoods_sees_a_table_once_and_decides_by_their_answers() -> None:
    shared = (*TAPS, Tap.of(0, 0, PIXEL, np.arange(8) == 5))
    counts = np.random.default_rng(0).integers(0, 3, (2, 1, 16))
    of = WisardModel(Neighbourhood(3, shared), ("a", "b"), np.array([[[0, 1, 2, 3]]]), counts, 1)
    care = Codes(np.arange(16) > 2)
    target = TARGETS["video"]
    assert target.fits(of)
    made = target.lower(Ingredients(of, EDGES, {"decision": care}, VideoFormat()))
    assert list(made.definitions()) == ["taps", "decision", "edge", "video"]
    assert made.definitions()["taps"].widths == ({"rgb": 24}, {"tap_bits": 2})
    assert made.definitions()["decision"].widths == ({"code": 4}, {"class_bits": 1})
    assert care_sets(made)["decision"] == care
    assert list(made.tables()) == ["tap0", "tap3", "decision", "edge"]


def test_care_sets_go_to_the_circuits_of_their_names() -> None:
    pixels, windows = np.arange(8) > 2, np.arange(512) % 2 == 0
    care = {"pixel": Codes(pixels), "edge": Codes(windows)}
    given = care_sets(TARGETS["block"].lower(Ingredients(model(PIXEL), EDGES, care)))
    assert given == care
    alone = care_sets(TARGETS["pixel"].lower(Ingredients(model(PIXEL))))
    assert {name: allowed.kind for name, allowed in alone.items()} == {"pixel": "everything"}


def test_without_a_name_the_first_fitting_target_is_taken() -> None:
    assert target_for(model(PIXEL), None).name == "block"
    assert target_for(model(PIXEL), "edge").name == "edge"
    assert target_for(model(Neighbourhood(3, TAPS)), None).name == "neighbourhood"


def test_a_target_of_another_kind_of_model_is_refused() -> None:
    line = "the model reads a pixel's neighbours: target pixel; choose neighbourhood or video, or "
    line += "another model"
    with pytest.raises(InputError, match=line):
        target_for(model(Neighbourhood(3, TAPS)), "pixel")
    with pytest.raises(InputError, match="the model reads single pixels: target neighbourhood"):
        target_for(model(PIXEL), "neighbourhood")
    with pytest.raises(InputError, match="there is no such target: pixels; choose block, pixel, "):
        target_for(model(PIXEL), "pixels")
