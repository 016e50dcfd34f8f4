"""Small random networks of features, for tests of lowering, proof and builds."""

import numpy as np

from wnn2hdl.ir import FeatureEncoder, Thermometer, ThermometerBits
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import BloomWisardModel, LutGroupModel, LutLayer, SparseWisardModel

WORDS = FixedPoint(6, 3)


def thermometer(seed: int, *, features: int = 3, thresholds: int = 4) -> Thermometer:
    """Rising thresholds, some of which every word reaches, no word reaches, or are equal as words."""
    rng = np.random.default_rng(seed)
    levels = np.sort(rng.uniform(-5, 5, (features, thresholds)), axis=1)
    return Thermometer(tuple(tuple(row) for row in levels.tolist()), strict=True, input=WORDS)


def encoder_of(model: LutGroupModel | SparseWisardModel) -> Thermometer:
    """The thermometer of a small network."""
    assert isinstance(model.encoder, Thermometer)
    return model.encoder


def lut_network(seed: int, *, layers: tuple[int, ...] = (12,), classes: int = 3) -> LutGroupModel:
    """Layers of tables of three inputs; an input may repeat."""
    rng = np.random.default_rng(seed)
    encoder = thermometer(seed)
    width, made = encoder.width, []
    for nodes in layers:
        mapping = rng.integers(0, width, (nodes, 3)).astype(np.int32)
        made.append(LutLayer(mapping, rng.random((nodes, 8)) < 0.5))
        width = nodes
    groups = (np.arange(layers[-1]) % classes).astype(np.int32)
    return LutGroupModel(encoder, tuple(f"class {i}" for i in range(classes)), tuple(made), groups)


def wisard(seed: int, *, ties: str = "last") -> SparseWisardModel:
    """Two classes of four RAMs that store half of their addresses."""
    rng = np.random.default_rng(seed)
    encoder = thermometer(seed)
    stored = [np.flatnonzero(rng.random(16) < 0.5) for _ in range(8)]
    return SparseWisardModel(
        encoder,
        ("a", "b"),
        rng.integers(0, encoder.width, (1, 4, 4)).astype(np.int32),
        np.cumsum([0, *map(len, stored)]).astype(np.int64),
        np.concatenate(stored).astype(np.uint64),
        rng.integers(1, 4, sum(map(len, stored))),
        bleaching=2,
        ties="last" if ties == "last" else "first",
    )


def bloom(
    seed: int, *, encoder: FeatureEncoder | None = None, entries: int = 16, density: float = 0.6
) -> BloomWisardModel:
    """Three classes of two Bloom filters of twelve inputs with two hashes, over six thermometers."""
    rng = np.random.default_rng(seed)
    encoder = encoder or ThermometerBits(6, 4)
    order = rng.permutation(24)
    return BloomWisardModel(
        encoder,
        ("a", "b", "c"),
        np.where(order < encoder.width, order, -1).reshape(2, 12).astype(np.int32),
        rng.integers(0, entries, (2, 12)).astype(np.uint32),
        rng.random((3, 2, entries)) < density,
    )
