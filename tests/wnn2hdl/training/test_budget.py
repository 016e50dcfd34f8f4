import numpy as np
import pytest

from wnn2hdl.dataset import Dataset, colour_histogram, from_samples
from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, Lut, LutNetwork, WisardModel
from wnn2hdl.lower.table import pixel_table
from wnn2hdl.minimise import map_luts
from wnn2hdl.training.bitselect import look_up_table
from wnn2hdl.training.budget import (
    Point,
    circuit_model,
    measure,
    pareto_front,
    saturates,
    train_under_budget,
)
from wnn2hdl.training.crossval import pixels_right

TABLE = look_up_table(BitSelect(("R7",)), ("a", "b"), np.array([0, 1]), {})

Measured = tuple[tuple[Point, ...], list[tuple[str, int, int]]]


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    return from_samples(3, 48, seed=0)


@pytest.fixture(scope="module")
def measured(dataset: Dataset) -> Measured:
    reported: list[tuple[str, int, int]] = []
    points = measure(
        dataset, trials=1, seed=0, progress=lambda step, done, total: reported.append((step, done, total))
    )
    return points, reported


@pytest.fixture(scope="module")
def points(measured: Measured) -> tuple[Point, ...]:
    return measured[0]


def test_front_holds_the_points_that_no_cheaper_one_equals() -> None:
    figures = [(3, 0.8), (1, 0.7), (2, 0.7), (2, 0.9), (3, 0.9), (9, 0.95), (1, 0.6)]
    front = pareto_front([Point(luts, accuracy, "", TABLE) for luts, accuracy in figures])
    assert [(point.luts, point.accuracy) for point in front] == [(1, 0.7), (2, 0.9), (9, 0.95)]
    assert pareto_front([]) == ()


def test_candidates_are_bit_selections_discriminators_and_their_circuits(points: tuple[Point, ...]) -> None:
    kinds = {point.method.split(",")[0] for point in points}
    assert kinds >= {"bit selection", "comparisons", "WiSARD"}
    assert any("codes of" in point.method for point in points)


def test_light_decides_between_classifiers_that_are_as_good_without_it() -> None:
    light = np.array([[0.9, 0.9, 0.5, 0.5], [0.7, 0.9, 0.9, 0.9]])
    point = Point(1, 0.9, "", TABLE, light)
    assert point.steady == pytest.approx(light.mean())


def test_cost_is_that_of_the_models_exact_circuit(points: tuple[Point, ...]) -> None:
    for point in points:
        if point.luts <= 3:  # mapping a large one once more takes its time
            assert point.luts == len(map_luts(pixel_table(point.model)).network.luts)


def test_bit_selections_keep_the_number_of_luts_they_were_asked_for(points: tuple[Point, ...]) -> None:
    for luts in (1, 2, 3):
        (point,) = (point for point in points if point.method == f"bit selection, {luts} LUT")
        assert point.luts <= luts


def test_a_circuit_on_its_care_set_is_cheaper_than_the_exact_one(points: tuple[Point, ...]) -> None:
    exact = [
        point.luts for point in points if point.method.startswith("WiSARD") and "codes" not in point.method
    ]
    cared = [point.luts for point in points if "codes of" in point.method]
    assert min(cared) < min(exact)


def test_the_most_accurate_that_fits_is_returned_with_its_figures(
    dataset: Dataset, points: tuple[Point, ...]
) -> None:
    model = train_under_budget(dataset, 1, trials=0, seed=0, progress=silent)
    figures = model.training
    assert figures["luts"] == len(map_luts(pixel_table(model)).network.luts) == 1
    (single,) = (point for point in points if point.method == "bit selection, 1 LUT")
    assert figures["cross_validated_accuracy"] == single.accuracy
    assert model.digest() == single.model.digest()
    assert figures["images"] == list(dataset.names)


def test_a_nested_choice_is_judged_by_images_that_had_no_part_in_it() -> None:
    five = from_samples(5, 32, seed=1)
    model = train_under_budget(five, 1, trials=0, seed=0, progress=silent, nested=True)
    chosen_with_all = train_under_budget(five, 1, trials=0, seed=0, progress=silent)
    assert model.digest() == chosen_with_all.digest()
    worst = []
    for fold, name in enumerate(five.names):
        others = five.subset(set(five.names) - {name})
        inside = train_under_budget(others, 1, trials=0, seed=0, progress=silent)
        assert inside.training["method"] == "bit selection"
        assert model.training["nested"][fold].startswith("bit selection")
        image = colour_histogram(five.load(name), 2)
        worst.append(pixels_right(inside, image) / image.counts.sum())
    assert model.training["in_light"]["1"]["accuracy"] == pytest.approx(np.mean(worst))
    assert model.training["in_light"]["1"]["worst_image"] == pytest.approx(min(worst))


def test_a_nested_choice_needs_three_images() -> None:
    with pytest.raises(InputError, match="nested cross-validation needs three images: 2; give more"):
        train_under_budget(from_samples(2, 32, seed=0), 1, trials=0, seed=0, progress=silent, nested=True)


def test_a_budget_below_one_lut_is_refused(dataset: Dataset) -> None:
    with pytest.raises(InputError, match="at least one LUT per pixel: 0; allow 1 or more"):
        train_under_budget(dataset, 0, trials=0, seed=0, progress=silent)


def test_a_budget_that_nothing_fits_is_refused() -> None:
    several = from_samples(2, 32, seed=0, every_kind=True)
    with pytest.raises(InputError, match="no classifier of at most 1 LUTs per pixel was found: 0 candidates"):
        train_under_budget(several, 1, trials=0, seed=0, progress=silent)


def test_progress_tells_of_images_and_candidates(measured: Measured) -> None:
    points, reported = measured
    assert [step for step in reported if step[0] == "reading images"] == [
        ("reading images", done, 3) for done in (0, 1, 2, 3)
    ]
    assert ("drawing mappings", 1, 1) in reported
    assert reported[-1] == ("measuring candidates", len(points), len(points))


def test_a_discriminator_that_says_yes_to_everything_saturates() -> None:
    counts = np.zeros((2, 3, 16), np.int64)
    counts[0, :, :4] = counts[1, :, :14] = 5
    mapping = np.arange(12).reshape(1, 3, 4)
    bits = BitSelect(tuple(f"{channel}{bit}" for channel in "RGB" for bit in (7, 6, 5, 4)))
    assert not saturates(WisardModel(bits, ("a", "b"), mapping, counts, 1))
    counts[1, :, :15] = 5
    assert saturates(WisardModel(bits, ("a", "b"), mapping, counts, 1))


def test_a_circuit_becomes_a_model_over_the_bits_it_reads() -> None:
    model = look_up_table(BitSelect(("R7", "G7", "B7")), ("a", "b"), np.array([0] * 7 + [1]), {"seed": 4})
    network = LutNetwork(("R7", "G7", "B7"), (Lut("t", ("B7", "R7"), 0b0110),), (("class_bit0", "t"),))
    circuit = circuit_model(model, network, {"care_share": 0.5})
    assert circuit.encoder == BitSelect(("R7", "B7"))
    assert circuit.evaluate_all_codes().tolist() == [0, 1, 1, 0]
    assert circuit.training == {"seed": 4, "care_share": 0.5}


@pytest.mark.parametrize(("signal", "answers"), [("1", [1, 1]), ("R7", [0, 1])])
def test_a_circuit_without_luts_is_a_model_too(signal: str, answers: list[int]) -> None:
    network = LutNetwork(("R7",), (), (("class_bit0", signal),))
    assert circuit_model(TABLE, network, {}).evaluate_all_codes().tolist() == answers


def test_a_class_that_does_not_exist_is_never_answered() -> None:
    model = look_up_table(BitSelect(("R7",)), ("a", "b", "c"), np.array([0, 2]), {})
    network = LutNetwork(("R7",), (), (("class_bit0", "R7"), ("class_bit1", "R7")))
    assert circuit_model(model, network, {}).evaluate_all_codes().tolist() == [0, 2]
