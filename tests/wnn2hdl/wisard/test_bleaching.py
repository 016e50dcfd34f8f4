from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.encode import high_bits, parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WisardModel, codes_to_bits
from wnn2hdl.wisard import WisardClassifier, choose_bleaching, draw_mapping, train_histogram
from wnn2hdl.wisard.bleaching import CANDIDATES, candidates

ENCODER = parse_bits("R7,R6,G7,B7")
ONE_RAM = np.arange(4).reshape(1, 1, 4)


def right(model: WisardModel, histogram: NDArray[np.int64]) -> int:
    """Pixels of a histogram ``[classes, 16]`` that the model classifies as labelled."""
    return int(histogram[model.evaluate_all_codes(), np.arange(16)].sum())


def test_candidates_are_one_and_counts_that_occur() -> None:
    assert candidates(np.array([[0, 7, 3], [3, 0, 9]])).tolist() == [1, 3, 7, 9]
    assert candidates(np.zeros(4, dtype=np.int64)).tolist() == [1]


@given(st.lists(st.integers(1, 10**12), min_size=1, max_size=300))
def test_candidates_are_few_and_span_the_counts(counts: list[int]) -> None:
    found = candidates(np.array(counts)).tolist()
    assert found == sorted(set(found))
    assert len(found) <= CANDIDATES + 1
    assert set(found) <= {1, *counts}
    assert {1, min(counts), max(counts)} <= set(found)


def test_label_noise_is_bleached_away() -> None:
    # Each class's codes carry a few labels of the other: at threshold 1 everything is a tie, at 5 nothing is.
    image = np.full((2, 16), 3)
    image[0, :8] = 100
    image[1, 8:] = 100
    histograms = np.stack([image] * 6)
    threshold = choose_bleaching(histograms, ONE_RAM)
    model = train_histogram(histograms.sum(axis=0), ENCODER, ("a", "b"), ONE_RAM, threshold)
    assert threshold == 600
    assert model.evaluate_all_codes().tolist() == [0] * 8 + [1] * 8
    unbleached = train_histogram(histograms.sum(axis=0), ENCODER, ("a", "b"), ONE_RAM, 1)
    assert not unbleached.evaluate_all_codes().any()


@pytest.mark.parametrize("images", [1, 2, 5, 13])
def test_folds_are_trained_without_the_images_they_judge(images: int) -> None:
    rng = np.random.default_rng(images)
    histograms = rng.integers(0, 50, (images, 2, 16)) * (rng.random((images, 2, 16)) < 0.3)
    histograms[0, :, 0] += 1
    mapping = draw_mapping(4, 3, 2, seed=images)
    total = histograms.sum(axis=0)
    trained = train_histogram(total, ENCODER, ("a", "b"), mapping, 1)
    scores = {}
    for threshold in candidates(trained.counts).tolist():
        score = 0
        for fold in range(min(5, images)):
            held_out = histograms[fold::5].sum(axis=0)
            rest = total if images == 1 else total - held_out
            scaled = max(1, -(-threshold * int(rest.sum()) // int(total.sum())))
            model = WisardModel(ENCODER, ("a", "b"), mapping, _counts(rest, mapping), scaled)
            score += right(model, held_out)
        scores[threshold] = score
    best = max(scores.values())
    assert choose_bleaching(histograms, mapping) == min(t for t, s in scores.items() if s == best)


def _counts(histogram: NDArray[np.int64], mapping: NDArray[np.int64]) -> NDArray[np.int64]:
    counts = np.zeros((2, mapping.shape[1], 1 << mapping.shape[2]), dtype=np.int64)
    for owner, code in np.ndindex(histogram.shape):
        for ram, inputs in enumerate(mapping[0]):
            counts[owner, ram, sum((code >> int(i) & 1) << j for j, i in enumerate(inputs))] += histogram[
                owner, code
            ]
    return counts


def test_counts_of_a_whole_satellite_swath_do_not_overflow() -> None:
    image = np.full((2, 16), 10**9)
    image[0, :8] = 4 * 10**10
    image[1, 8:] = 4 * 10**10
    threshold = choose_bleaching(np.stack([image] * 5), ONE_RAM)
    assert threshold == 2 * 10**11


def test_no_pixels_get_one_line() -> None:
    with pytest.raises(InputError, match="no pixels to train on; give labelled images"):
        choose_bleaching(np.zeros((3, 2, 16), dtype=np.int64), ONE_RAM)


@pytest.mark.parametrize("seed", range(4))
def test_samples_are_judged_by_leaving_each_out(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bits = rng.random((40, 8)) < 0.4
    labels = (bits[:, :3].sum(axis=1) + (rng.random(40) < 0.2)) % 3
    chosen = WisardClassifier(address_bits=3, rams=6, random_state=seed).fit(bits, labels)
    scores = {}
    for threshold in candidates(chosen.counts_).tolist():
        correct = 0
        for i in range(len(bits)):
            keep = np.arange(len(bits)) != i
            other = WisardClassifier(3, 6, chosen.mapping_[0], bleaching=threshold)
            other.partial_fit(bits[keep], labels[keep], classes=[0, 1, 2])
            correct += int(other.predict(bits[[i]])[0] == labels[i])
        scores[threshold] = correct
    best = max(scores.values())
    assert chosen.bleaching_ == min(t for t, s in scores.items() if s == best)


def test_wide_patterns_and_codes_lead_to_the_same_choice() -> None:
    # Bits past the twentieth that no RAM reads only switch off the counting by code.
    rng = np.random.default_rng(5)
    bits = codes_to_bits(rng.integers(0, 256, 300), 8)
    labels = bits[:, 0] ^ (rng.random(300) < 0.2)
    mapping = draw_mapping(8, 5, 4, seed=1)[0]
    narrow = WisardClassifier(mapping=mapping).fit(bits, labels)
    wide = WisardClassifier(mapping=mapping).fit(np.hstack([bits, rng.random((300, 20)) < 0.5]), labels)
    assert np.array_equal(narrow.counts_, wide.counts_)
    assert narrow.bleaching_ == wide.bleaching_


@pytest.mark.realdata
def test_a_threshold_chosen_on_twenty_scenes_serves_ten_others(realdata: Path) -> None:
    encoder = high_bits()
    images = sorted((realdata / "amazon_masks" / "images").glob("*.tif"))
    histograms = np.zeros((len(images), 2, 1 << encoder.width), dtype=np.int64)
    for image, histogram in zip(images, histograms, strict=True):
        codes = encoder.codes(np.asarray(Image.open(image)))
        mask = np.asarray(Image.open(realdata / "amazon_masks" / "masks" / f"{image.stem}.png")) > 0
        for label in (0, 1):
            histogram[label] = np.bincount(codes[mask == label], minlength=histogram.shape[1])
    training, test = histograms[:20], histograms[20:].sum(axis=0)
    accuracies: list[float] = []
    unbleached: list[float] = []
    for seed in range(20):
        mapping = draw_mapping(encoder.width, 16, 4, seed)
        for threshold, results in ((choose_bleaching(training, mapping), accuracies), (1, unbleached)):
            model = train_histogram(
                training.sum(axis=0), encoder, ("forest", "deforested"), mapping, threshold
            )
            winner = model.evaluate_all_codes()
            results.append(test[winner, np.arange(len(winner))].sum() / test.sum())
    assert np.mean(accuracies) > 0.84
    assert max(accuracies) > 0.86
    assert np.mean(unbleached) < 0.6
