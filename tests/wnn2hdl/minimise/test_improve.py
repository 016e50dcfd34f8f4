import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.minimise.draft import Draft
from wnn2hdl.minimise.improve import improve, separators


def random_draft(width: int, cells: int, rng: np.random.Generator) -> Draft:
    draft = Draft(width)
    signals = list(range(width))
    for _ in range(cells):
        fanins = tuple(int(x) for x in rng.choice(signals, min(4, len(signals)), replace=False))
        signals.append(draft.add(fanins, rng.integers(0, 2, 1 << len(fanins), dtype=np.uint8)))
    draft.outputs = signals[-2:]
    return draft


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 999), care=st.sampled_from([0.1, 1.0]))
def test_improving_keeps_the_function_and_never_costs_more(seed: int, care: float) -> None:
    rng = np.random.default_rng(seed)
    codes = np.flatnonzero(rng.random(1 << 8) < care)
    bits = (codes >> np.arange(8)[:, np.newaxis] & 1).astype(np.uint8)
    draft = random_draft(8, 12, rng)
    better = improve(draft, bits, rng, moves=20)
    before, after = draft.evaluate(bits), better.evaluate(bits)
    for old, new in zip(draft.outputs, better.outputs, strict=True):
        assert (before[old] == after[new]).all()
    draft.sweep()
    assert better.cost() <= draft.cost()


def test_a_redundant_lut_disappears() -> None:
    parity = np.bitwise_count(np.arange(64)) % 2
    draft = Draft(8)
    first = draft.add((0, 1, 2, 3, 4, 5), parity)
    # The parity of the first five inputs again, though the first LUT and input 5 tell it.
    second = draft.add((0, 1, 2, 3, 4), parity[:32])
    draft.outputs = [
        draft.add((first, 7), parity[:4]),
        draft.add((second, 5, 6, 7), np.arange(16, dtype=np.uint8) // 7 % 2),
    ]
    codes = np.arange(256)
    bits = (codes >> np.arange(8)[:, np.newaxis] & 1).astype(np.uint8)
    assert improve(draft, bits, np.random.default_rng(0), moves=50).cost()[0] == 3


@given(seed=st.integers(0, 999))
def test_separators_tell_the_rows_apart(seed: int) -> None:
    rng = np.random.default_rng(seed)
    columns = rng.integers(0, 2, (6, 12), dtype=np.uint8)
    wanted = rng.random(12) < 0.5

    def apart(chosen: tuple[int, ...]) -> bool:
        rows: dict[tuple[int, ...], bool] = {}
        return all(rows.setdefault(tuple(columns[[*chosen], x]), wanted[x]) == wanted[x] for x in range(12))

    added = separators(columns, wanted, 1, 1)
    if added is None:
        assert not any(apart((0, x)) for x in range(1, 6))
    else:
        assert apart((0, *added))
        assert len(added) <= 1
    assert not apart(()) or separators(columns, wanted, 0, 1) == []
