"""Networks by gradient read thresholds of ratios, and become tables that answer alike."""

import numpy as np

from benchmarks.pixel_networks import (
    COMPARED,
    LEVELS,
    PAIRS,
    Candidate,
    most_accurate,
    tabulated,
    thermometers,
)
from wnn2hdl.ir import BitSelect, Comparison, codes_to_bits
from wnn2hdl.ir.relational import pixel_codes
from wnn2hdl.training.bitselect import look_up_table
from wnn2hdl.training.gradient.layer import VotingLayer


def test_comparisons_stand_for_thresholds_of_ratios() -> None:
    pixels = np.random.default_rng(0).integers(30, 120, (4000, 3)).astype(np.uint8)
    names = thermometers(pixels)
    assert len(names) == LEVELS * len(PAIRS)
    assert all(len(Comparison.parse(name).bits) <= COMPARED for name in names)
    ratio = (pixels[:, 0] + 0.5) / (pixels[:, 2] + 0.5)
    for name, share in zip(names[:LEVELS], (np.arange(LEVELS) + 1) / (LEVELS + 1), strict=True):
        threshold = ratio >= np.quantile(ratio, share)
        assert (Comparison.parse(name).evaluate(pixels) == threshold).mean() > 0.93


def test_a_table_answers_as_the_network_whose_votes_it_holds() -> None:
    rng = np.random.default_rng(1)
    names = ("R7", "G6", "2R>=3B", "B5", "G7", "R[7:2]>=G[7:2]+1", "B7")
    layer = VotingLayer(rng.integers(0, 6, (6, 4)), rng.uniform(-1, 1, (4, 64)).astype(np.float32), 2)
    pixels = rng.integers(0, 256, (500, 3)).astype(np.uint8)
    rows = codes_to_bits(pixel_codes(names, pixels), len(names)).T.astype(np.uint8)
    model = tabulated(layer, names)
    assert "B7" not in model.encoder.names
    answers = model.evaluate_all_codes()[pixel_codes(model.encoder.names, pixels)]
    assert np.array_equal(answers, layer.predict(rows))


def test_the_most_accurate_network_that_fits_is_taken() -> None:
    tables = [look_up_table(BitSelect(("R7",)), ("a", "b"), np.array([0, 1]), {}) for _ in range(3)]
    networks = [
        Candidate(table, *of) for table, of in zip(tables, [(9, 0.7), (8, 0.9), (12, 0.95)], strict=True)
    ]
    assert most_accurate(networks, 10) is tables[1]
