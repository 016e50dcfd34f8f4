"""The circuits of a classifier that counts bits in squares."""

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Context, EdgeFilter, TruthTable, VideoFormat, WisardModel, bits_to_codes
from wnn2hdl.ir.care import Codes, Everything
from wnn2hdl.lower.context import context, planes
from wnn2hdl.lower.deforestation import DECISION
from wnn2hdl.lower.targets import TARGETS, Ingredients, target_for
from wnn2hdl.verify.specify import care_sets, specify

ENCODER = Context(("7x7(3R[7:1]>=2B[7:1])>=13", "R7", "7x7(3R[7:1]>=2B[7:1])>=37", "3x3(R7)>=5"))
EDGES = EdgeFilter("none", np.zeros(512, dtype=np.bool_))


def model() -> WisardModel:
    counts = np.random.default_rng(0).integers(0, 3, (3, 1, 16))
    return WisardModel(ENCODER, ("a", "b", "c"), np.arange(4).reshape(1, 1, 4), counts, 1)


def test_a_video_core_finds_bits_of_pixels_and_decides_by_counts() -> None:
    care = Codes(np.arange(16) % 3 > 0)
    made = TARGETS["video"].lower(Ingredients(model(), EDGES, {"context": care}, VideoFormat()))
    assert list(made.definitions()) == ["planes", "context", "edge", "video"]
    assert made.definitions()["planes"].widths == ({"rgb": 24}, {"plane_bits": 2})
    # The pixel's own bit, and counts of up to 49 and of up to 9.
    assert made.definitions()["context"].widths == ({"counts": 1 + 6 + 4}, {"class_bits": 2})
    assert care_sets(made)["context"] == care


def test_circuits_answer_as_claimed() -> None:
    claims = specify(model(), None, {}).claims
    made = {"planes": planes(ENCODER), "context": context(model(), ENCODER, Everything(4))}
    for part, circuit in made.items():
        stimulus = claims[part].stimulus
        assert stimulus is not None
        for port, bits in claims[part].answers(stimulus()).items():
            answers = bits_to_codes(circuit.evaluate(stimulus())[port])
            assert np.array_equal(answers, bits_to_codes(bits))
            assert len(np.unique(answers)) > 2


def test_codes_that_contradict_themselves_are_free() -> None:
    made = context(model(), ENCODER, Everything(4))
    (decision,) = (table.function for table in made.tables().values() if table.name == DECISION)
    assert isinstance(decision, TruthTable)
    care = np.asarray(decision.care)
    assert np.array_equal(care.reshape(16, -1).all(axis=1), ENCODER.possible)


def test_a_model_that_counts_is_compiled_to_a_video_core_of_one_pixel_per_clock_alone() -> None:
    assert target_for(model(), None).name == "video"
    with pytest.raises(InputError, match="reads counts around a pixel: target block; choose video"):
        target_for(model(), "block")
    with pytest.raises(InputError, match="takes one pixel per clock: 2"):
        TARGETS["video"].lower(Ingredients(model(), EDGES, video=VideoFormat(pixels_per_clock=2)))
