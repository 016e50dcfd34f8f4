import lzma
import pickle
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.stats import norm

from wnn2hdl.errors import InputError
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.bthowen import ALLOWED, _decompressed, read, recognises
from wnn2hdl.importers.pickles import Record, read_pickle
from wnn2hdl.ir.models import BloomWisardModel

NAMES = ("wisard.WiSARD", "wisard.Discriminator", "bloom_filter.BloomFilter")
Write = Callable[..., Path]
Parts = dict[str, Any]


@pytest.fixture
def write(named_classes: Callable[..., dict[str, type]], tmp_path: Path) -> Write:
    """``write(change)`` writes a model of three features, two bits each, after ``change(info, model)``."""
    made = named_classes(*NAMES)

    def write_model(change: Callable[[Parts, Any], None] = lambda *_: None) -> Path:
        rng = np.random.default_rng(0)
        hashes = rng.integers(0, 8, (2, 4))
        model = made["wisard.WiSARD"]()
        info = {
            "num_inputs": 3,
            "num_classes": 2,
            "bits_per_input": 2,
            "num_filter_inputs": 4,
            "num_filter_entries": 8,
            "num_filter_hashes": 2,
            "hash_values": hashes,
        }

        def discriminator() -> Any:
            filters = []
            for _ in range(2):
                each = made["bloom_filter.BloomFilter"]()
                each.__dict__.update(
                    data=rng.integers(0, 4, 8), hash_values=hashes, index_bits=3, bleach=np.array(2)
                )
                filters.append(each)
            owner = made["wisard.Discriminator"]()
            owner.__dict__.update(num_filters=2, filters=filters)
            return owner

        model.__dict__.update(
            input_order=rng.permutation(8), discriminators=[discriminator(), discriminator()]
        )
        change(info, model)
        path = tmp_path / "model.pickle.lzma"
        path.write_bytes(lzma.compress(pickle.dumps({"info": info, "model": model}, 4)))
        return path

    return write_model


def published_inference(path: Path, samples: NDArray[np.bool_]) -> list[int]:
    """The answers as BTHOWeN's description has them, sample by sample, filter by filter."""
    data = read_pickle(_decompressed(Source(path)), ALLOWED.get)
    model: Record = data["model"]
    order = model.state["input_order"].array
    answers = []
    for sample in samples:
        padded = np.pad(sample, (0, len(order) - len(sample)))[order]
        responses = []
        for discriminator in model.state["discriminators"]:
            filters = discriminator.state["filters"]
            response = 0
            for inputs, each in zip(padded.reshape(len(filters), -1), filters, strict=True):
                places = np.bitwise_xor.reduce(np.where(inputs, each.state["hash_values"].array, 0), axis=1)
                response += int(each.state["data"].array[places].min() >= each.state["bleach"].array)
            responses.append(response)
        answers.append(int(np.flatnonzero(np.array(responses) == max(responses))[0]))
    return answers


def test_padded_inputs_read_zero_and_counts_are_bleached(write: Write) -> None:
    path = write()
    model = read(Source(path), ImportOptions())
    assert recognises(Source(path))
    assert (model.width, model.classes, int((model.mapping < 0).sum())) == (6, ("0", "1"), 2)
    bits = np.random.default_rng(1).random((200, 6)) < 0.5
    assert model.evaluate(bits).tolist() == published_inference(path, bits)
    assert "the model reads bits" in model.origin["encoder"]


class Evil:
    def __reduce__(self) -> Any:
        return sys.exit, (3,)


def test_a_malicious_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.lzma"
    path.write_bytes(lzma.compress(pickle.dumps({"info": Evil()}, 4)))
    with pytest.raises(InputError, match=r"it asks for sys\.exit, which no such model needs"):
        read(Source(path), ImportOptions())


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda info, _: info.update(num_classes=3), "2 discriminators for 3 classes"),
        (lambda info, _: info.update(num_filter_entries=2**60), "more entries than the file can"),
        (lambda info, _: info.update(num_inputs=10**12), "not an order of"),
        (lambda info, _: info.pop("hash_values"), "hash_values"),
        (lambda info, _: info.update(hash_values=np.full((2, 4), 8)), "not an index of 8 entries"),
        (lambda info, _: info.update(hash_values=np.full((2, 4), np.nan)), "hash_values has shape"),
        (lambda info, _: info.update(hash_values=np.zeros((2, 4), dtype=int)), "its own hashes"),
        (
            lambda _, model: model.__dict__.update(input_order=np.zeros(8, dtype=int)),
            "not an order of 8 inputs",
        ),
        (lambda _, model: model.__dict__.update(input_order=np.arange(6)), "not an order of 8 inputs"),
        (lambda _, model: model.discriminators[1].filters.pop(), "has 1 filters, not 2"),
        (lambda _, model: model.discriminators[1].filters[0].__dict__.update(data=np.zeros(4)), "not 8"),
    ],
)
def test_a_model_that_contradicts_itself_gets_one_line(
    write: Write, change: Callable[[Parts, Any], None], reason: str
) -> None:
    with pytest.raises(InputError, match=f"not a BTHOWeN model, or a damaged one: .*{reason}"):
        read(Source(write(change)), ImportOptions())


def test_a_bomb_is_refused_before_it_fills_the_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wnn2hdl.importers.bthowen.MAX_PICKLE_BYTES", 1 << 24)
    path = tmp_path / "bomb.lzma"
    path.write_bytes(lzma.compress(bytes(1 << 25)))
    with pytest.raises(InputError, match=r"damaged or too large: .*holds more than 16777216 bytes"):
        read(Source(path), ImportOptions())


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60)
@given(st.data())
def test_any_damage_gives_a_model_or_one_line(write: Write, data: st.DataObject) -> None:
    path = write()
    content = bytearray(path.read_bytes())
    if data.draw(st.booleans()):
        content = content[: data.draw(st.integers(0, len(content) - 1))]
    else:
        inner = bytearray(lzma.decompress(content))
        inner[data.draw(st.integers(0, len(inner) - 1))] = data.draw(st.integers(0, 255))
        content = bytearray(lzma.compress(inner))
    path.write_bytes(content)
    with suppress(InputError):
        read(Source(path), ImportOptions())


FILES = [
    *("ecoli", "iris", "letter", "mnist_medium", "mnist_small"),
    *("satimage", "shuttle", "vehicle", "vowel", "wine"),
]


def published(realdata: Path, name: str) -> BloomWisardModel:
    return read(Source(realdata / "bthowen" / f"{name}.pickle.lzma"), ImportOptions())


@pytest.mark.realdata
@pytest.mark.parametrize("name", FILES)
def test_published_models_answer_as_their_own_inference(realdata: Path, name: str) -> None:
    model = published(realdata, name)
    bits = np.random.default_rng(0).random((40, model.width)) < 0.5
    path = realdata / "bthowen" / f"{name}.pickle.lzma"
    assert model.evaluate(bits).tolist() == published_inference(path, bits)


def gaussian(samples: NDArray[Any], fitted: NDArray[Any], bits: int) -> NDArray[np.bool_]:
    """BTHOWeN's thermometer: thresholds at equal shares of a normal distribution, threshold-major."""
    shares = norm.ppf(np.arange(1, bits + 1) / (bits + 1))
    return np.concatenate([samples >= fitted.mean(0) + share * fitted.std(0) for share in shares], axis=1)


@pytest.mark.realdata
@pytest.mark.parametrize(("name", "accuracy"), [("mnist_small", 0.934), ("mnist_medium", 0.943)])
def test_published_accuracy_on_mnist_is_about_reproduced(realdata: Path, name: str, accuracy: float) -> None:
    digits = np.load(realdata / "mnist" / "mnist.npz")
    train, test = (digits[key].reshape(-1, 784) for key in ("x_train", "x_test"))
    model = published(realdata, name)
    answers = model.evaluate(gaussian(test, train, model.width // 784))
    assert (answers == digits["y_test"]).mean() == pytest.approx(accuracy, abs=0.005)
