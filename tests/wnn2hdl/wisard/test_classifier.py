from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, clone
from sklearn.exceptions import NotFittedError
from sklearn.pipeline import Pipeline
from sklearn.utils.estimator_checks import parametrize_with_checks

from wnn2hdl.encode import ThermometerEncoder, parse_bits
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.wisard import WisardClassifier

HAND_X = codes_to_bits([0b0000, 0b0001, 0b1111, 0b1110, 0b1100], 4)
HAND_Y = np.array(["forest", "forest", "burnt", "burnt", "burnt"])
HAND_MAPPING = [[0, 1], [3, 2]]


@st.composite
def data(draw: st.DrawFn) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    width, classes = draw(st.sampled_from([3, 6, 30])), draw(st.integers(2, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    samples = draw(st.integers(classes, 40))
    labels = np.r_[np.arange(classes), rng.integers(0, classes, samples - classes)]
    return rng.random((samples, width)) < 0.5, labels * 10


def test_counts_responses_and_winners_by_hand() -> None:
    # RAM 0 reads bit 0 as the low address bit and bit 1 as the high one, RAM 1 bit 3 low and bit 2 high.
    classifier = WisardClassifier(mapping=HAND_MAPPING, bleaching=1).fit(HAND_X, HAND_Y)
    assert classifier.classes_.tolist() == ["burnt", "forest"]
    assert classifier.counts_.tolist() == [[[1, 0, 1, 1], [0, 0, 0, 3]], [[1, 1, 0, 0], [2, 0, 0, 0]]]
    assert classifier.responses(codes_to_bits([0b0000, 0b1111, 0b0101], 4)).tolist() == [
        [1, 2],
        [2, 0],
        [0, 1],
    ]
    assert classifier.predict(codes_to_bits([0b0000, 0b1111], 4)).tolist() == ["forest", "burnt"]
    assert classifier.decision_function(codes_to_bits([0b0000, 0b1111], 4)).tolist() == [1, -2]
    assert classifier.saturation_.tolist() == [[0.75, 0.25], [0.5, 0.25]]


def test_bleaching_raises_the_bar_for_a_ram() -> None:
    classifier = WisardClassifier(mapping=HAND_MAPPING, bleaching=2).fit(HAND_X, HAND_Y)
    assert classifier.responses(codes_to_bits([0b0000, 0b1111], 4)).tolist() == [[0, 1], [1, 0]]
    assert classifier.saturation_.tolist() == [[0.0, 0.25], [0.0, 0.25]]


def test_a_tie_goes_to_the_first_class() -> None:
    classifier = WisardClassifier(mapping=HAND_MAPPING, bleaching=99).fit(HAND_X, HAND_Y)
    assert classifier.predict(HAND_X).tolist() == ["burnt"] * 5


def test_a_mapping_a_class() -> None:
    both = [HAND_MAPPING, [[2, 3], [0, 1]]]
    classifier = WisardClassifier(mapping=both, bleaching=1).fit(HAND_X, HAND_Y)
    assert classifier.counts_.tolist() == [[[1, 0, 1, 1], [0, 0, 0, 3]], [[2, 0, 0, 0], [1, 1, 0, 0]]]
    assert classifier.predict(HAND_X).tolist() == HAND_Y.tolist()


@given(data(), st.sampled_from(["auto", 1, 3]), st.integers(0, 9))
def test_the_model_answers_as_the_classifier_does(
    case: tuple[NDArray[np.bool_], NDArray[np.int64]], bleaching: Any, seed: int
) -> None:
    bits, labels = case
    if bits.shape[1] > 24:
        bits = bits[:, :24]
    classifier = WisardClassifier(3, 5, bleaching=bleaching, random_state=seed).fit(bits, labels)
    names = [f"{c}{b}" for c in "RGB" for b in range(8)]
    model = classifier.model(parse_bits(",".join(names[: bits.shape[1]])))
    assert model.classes == tuple(str(label) for label in classifier.classes_)
    assert np.array_equal(model.responses(bits), classifier.responses(bits))
    assert np.array_equal(classifier.classes_[model.evaluate(bits)], classifier.predict(bits))
    assert np.array_equal(model.saturation, classifier.saturation_)


@given(data(), st.integers(1, 39))
def test_training_in_parts_gives_the_same_counts(
    case: tuple[NDArray[np.bool_], NDArray[np.int64]], cut: int
) -> None:
    bits, labels = case
    cut = min(cut, len(bits) - 1)
    whole = WisardClassifier(3, 5, bleaching=1).fit(bits, labels)
    parts = WisardClassifier(3, 5, bleaching=1)
    parts.partial_fit(bits[:cut], labels[:cut], classes=np.unique(labels)).partial_fit(
        bits[cut:], labels[cut:]
    )
    assert np.array_equal(parts.mapping_, whole.mapping_)
    assert np.array_equal(parts.counts_, whole.counts_)


def test_fitting_again_forgets() -> None:
    classifier = WisardClassifier(2, 3).fit(HAND_X, HAND_Y)
    again = classifier.fit(HAND_X[1:], HAND_Y[1:])
    assert again.counts_.sum() == 4 * 3


def test_many_samples_of_few_bits_are_answered_from_a_table() -> None:
    rng = np.random.default_rng(1)
    bits = rng.random((500, 5)) < 0.5
    classifier = WisardClassifier(3, 4).fit(bits, bits[:, 0])
    one_by_one = np.vstack([classifier.responses(row[np.newaxis]) for row in bits])
    assert np.array_equal(classifier.responses(bits), one_by_one)


def test_a_seed_decides_the_mapping() -> None:
    fits = [WisardClassifier(2, 8, random_state=s).fit(HAND_X, HAND_Y).mapping_ for s in (0, 0, 1)]
    assert np.array_equal(fits[0], fits[1])
    assert not np.array_equal(fits[0], fits[2])


def test_wide_input_of_several_classes_is_learnt() -> None:
    rng = np.random.default_rng(0)
    prototypes = rng.random((5, 900)) < 0.5
    labels = rng.integers(0, 5, 400)
    bits = prototypes[labels] ^ (rng.random((400, 900)) < 0.15)
    classifier = WisardClassifier(address_bits=8, rams=120).fit(bits[:300], labels[:300])
    assert (classifier.predict(bits[300:]) == labels[300:]).all()


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"bleaching": 0}, "bleaching is 0; give 'auto' or a count of at least 1"),
        ({"bleaching": "often"}, "bleaching is 'often'; give 'auto' or a count of at least 1"),
        ({"bleaching": 1.5}, "bleaching is 1.5; give 'auto' or a count of at least 1"),
        ({"address_bits": 5}, "minimum of 5 is required by WisardClassifier"),
        ({"mapping": [0, 1]}, r"the mapping has shape \(2,\)"),
        ({"mapping": [HAND_MAPPING] * 3}, r"the mapping has shape \(3, 2, 2\)"),
        ({"mapping": [[0, 4]]}, "the mapping reads inputs 0 to 4; there are 4, from 0"),
        ({"mapping": [[0, -1]]}, "the mapping reads inputs -1 to 0; there are 4, from 0"),
    ],
)
def test_parameters_that_do_not_fit(parameters: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        WisardClassifier(**parameters).fit(HAND_X, HAND_Y)


@pytest.mark.parametrize("values", [[[0, 2]], [[0.5, 1]], [[-1, 1]]])
def test_input_must_be_binary(values: list[list[float]]) -> None:
    with pytest.raises(ValueError, match="X must be binary: bools, or numbers that are all 0 or 1"):
        WisardClassifier(1, 2).fit(np.vstack([values, [[0, 1]]]), [0, 1])


def test_zeros_and_ones_of_any_type_are_bits() -> None:
    expected = WisardClassifier(2, 3).fit(HAND_X, HAND_Y).counts_
    for kind in (np.uint8, np.int64, np.float32):
        assert np.array_equal(WisardClassifier(2, 3).fit(HAND_X.astype(kind), HAND_Y).counts_, expected)


def test_one_class_cannot_be_told_from_others() -> None:
    with pytest.raises(ValueError, match=r"one class only, \['burnt'\]; at least two are needed"):
        WisardClassifier(2, 3).fit(HAND_X[2:], HAND_Y[2:])


def test_partial_fit_needs_all_classes_first_and_the_same_ones_later() -> None:
    with pytest.raises(ValueError, match="the first call of partial_fit needs classes"):
        WisardClassifier(2, 3).partial_fit(HAND_X, HAND_Y)
    with pytest.raises(ValueError, match="are not among the classes"):
        WisardClassifier(2, 3).partial_fit(HAND_X, HAND_Y, classes=["burnt", "water"])
    classifier = WisardClassifier(2, 3).partial_fit(HAND_X[:2], HAND_Y[:2], classes=["forest", "burnt"])
    with pytest.raises(ValueError, match="not those of the first call"):
        classifier.partial_fit(HAND_X, HAND_Y, classes=["forest", "water"])
    with pytest.raises(ValueError, match="are not among the classes"):
        classifier.partial_fit(HAND_X[:1], ["water"])
    assert classifier.partial_fit(HAND_X[2:], HAND_Y[2:]).counts_.sum() == 5 * 3


def test_partial_fit_chooses_bleaching_on_the_last_samples() -> None:
    rng = np.random.default_rng(2)
    bits = rng.random((200, 8)) < 0.5
    labels = bits[:, 0] ^ (rng.random(200) < 0.3)
    classifier = WisardClassifier(4, 6, random_state=3).partial_fit(bits, labels, classes=[False, True])
    assert classifier.bleaching_ == WisardClassifier(4, 6, random_state=3).fit(bits, labels).bleaching_
    assert classifier.bleaching_ > 1


def test_an_untrained_classifier_answers_nothing() -> None:
    for ask in (WisardClassifier().predict, WisardClassifier().responses):
        with pytest.raises(NotFittedError):
            ask(HAND_X)
    with pytest.raises(NotFittedError):
        WisardClassifier().model(parse_bits("R7"))


def test_a_model_needs_the_encoder_that_made_its_bits() -> None:
    with pytest.raises(ValueError, match="the encoder makes 2 bits; the classifier was trained on 4"):
        WisardClassifier(2, 3).fit(HAND_X, HAND_Y).model(parse_bits("R7,R6"))


def test_a_clone_has_the_parameters_and_no_memory() -> None:
    fitted = WisardClassifier(2, 3, random_state=5).fit(HAND_X, HAND_Y)
    copy = clone(fitted)
    assert copy.get_params() == fitted.get_params()
    assert not hasattr(copy, "counts_")


BINARY = "feeds numbers that are not 0 or 1; the pipeline with a thermometer runs this check"

NOT_FOR_BITS = dict.fromkeys(
    [
        "check_classifier_data_not_an_array",
        "check_classifiers_classes",
        "check_classifiers_one_label",
        "check_classifiers_train",
        "check_dict_unchanged",
        "check_dtype_object",
        "check_estimators_dtypes",
        "check_estimators_fit_returns_self",
        "check_estimators_nan_inf",
        "check_estimators_pickle",
        "check_f_contiguous_array_estimator",
        "check_fit2d_1feature",
        "check_fit2d_1sample",
        "check_fit2d_predict1d",
        "check_fit_check_is_fitted",
        "check_fit_idempotent",
        "check_fit_score_takes_y",
        "check_methods_sample_order_invariance",
        "check_methods_subset_invariance",
        "check_n_features_in",
        "check_n_features_in_after_fitting",
        "check_pipeline_consistency",
        "check_positive_only_tag_during_fit",
        "check_readonly_memmap_input",
        "check_supervised_y_2d",
    ],
    BINARY,
) | dict.fromkeys(
    [
        "check_dont_overwrite_parameters",
        "check_estimators_overwrite_params",
        "check_estimators_partial_fit_n_features",
    ],
    "feeds numbers that are not 0 or 1, and a pipeline cannot run it; a test here does so with bits",
)

NOT_FOR_PIPELINES = dict.fromkeys(
    ["check_estimators_overwrite_params", "check_dont_overwrite_parameters"],
    "a pipeline fits its steps in place, whatever they are",
)


def expected_failures(estimator: BaseEstimator) -> dict[str, str]:
    return NOT_FOR_PIPELINES if isinstance(estimator, Pipeline) else NOT_FOR_BITS


@parametrize_with_checks(
    [
        WisardClassifier(address_bits=1),
        Pipeline([("encode", ThermometerEncoder()), ("classify", WisardClassifier())]),
    ],
    expected_failed_checks=expected_failures,
    xfail_strict=True,
)
@pytest.mark.filterwarnings("ignore::sklearn.exceptions.SkipTestWarning")
def test_scikit_learns_contract(estimator: object, check: object) -> None:
    check(estimator)  # type: ignore[operator]


def test_fitting_changes_no_parameter_and_adds_only_learned_attributes() -> None:
    classifier = WisardClassifier(2, 3, mapping=None)
    before = dict(vars(classifier))
    classifier.fit(HAND_X, HAND_Y)
    assert {name: vars(classifier)[name] for name in before} == before
    assert all(name.endswith("_") for name in vars(classifier) if name not in before)


def test_partial_fit_minds_the_number_of_bits() -> None:
    classifier = WisardClassifier(2, 3).partial_fit(HAND_X, HAND_Y, classes=["burnt", "forest"])
    with pytest.raises(ValueError, match="3 features, but WisardClassifier is expecting 4"):
        classifier.partial_fit(HAND_X[:, :3], HAND_Y)
