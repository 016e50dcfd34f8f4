"""Sparse RAMs are trained as dense ones are, and hold addresses that dense ones cannot."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import Words
from wnn2hdl.wisard import WisardClassifier, draw_mapping
from wnn2hdl.wisard.sparse import train_sparse


@given(
    st.integers(2, 4), st.booleans(), st.sampled_from([None, 1, 3]), st.integers(2, 40), st.integers(0, 2**32)
)
def test_a_sparse_network_is_the_dense_one(
    classes: int, per_class: bool, bleaching: int | None, samples: int, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    owners = rng.integers(0, classes, samples)
    bits = rng.random((samples, 12)) < (1 + owners[:, np.newaxis]) / (classes + 2)
    mapping = draw_mapping(12, 4, 3, seed, classes if per_class else 1)
    names = tuple("abcd"[:classes])
    sparse = train_sparse(bits, owners, Words(12), names, mapping, bleaching)
    dense = WisardClassifier(mapping=mapping, bleaching=bleaching or "auto")
    dense.partial_fit(bits, owners, classes=np.arange(classes))
    assert sparse.bleaching == dense.bleaching_
    every = rng.random((50, 12)) < 0.5
    assert np.array_equal(sparse.responses(every), dense.responses(every))


def test_addresses_of_64_bits_are_told_apart() -> None:
    bits = np.zeros((2, 64), dtype=np.bool_)
    bits[1, 63] = True
    mapping = np.arange(64)[np.newaxis, np.newaxis]
    model = train_sparse(bits, np.array([0, 1]), Words(64), ("low", "high"), mapping, 1, {"seed": 5})
    assert model.contents(1, 0)[0].tolist() == [1 << 63]
    assert model.evaluate(bits).tolist() == [0, 1]
    assert model.origin == {"seed": 5}


def test_a_class_without_samples_never_fires() -> None:
    bits = np.array([[False, True], [True, True]])
    model = train_sparse(bits, np.array([0, 2]), Words(2), ("a", "b", "c"), np.array([[[0, 1]]]), bleaching=1)
    assert model.responses(bits).tolist() == [[1, 0, 0], [0, 0, 1]]
