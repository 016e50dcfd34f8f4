import subprocess
import sys
from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.dwn import read, recognises
from wnn2hdl.ir import Thermometer, Words
from wnn2hdl.ir.models import LutGroupModel

Save = Callable[..., Path]
Arrays = dict[str, Any]

NAMES = (
    "torch.nn.modules.container.Sequential",
    "torch_dwn.lut_layer.LUTLayer",
    "torch_dwn.mapping.LearnableMapping",
    "torch_dwn.utils.GroupSum",
    "torch_dwn.binarization.DistributiveThermometer",
)

rng = np.random.default_rng(5)
WEIGHTS = rng.normal(size=(4, 6)).astype(np.float32)
"""Learned mapping of three nodes with two inputs over four bits."""

LUTS = [rng.normal(size=(3, 4)).astype(np.float32), rng.normal(size=(4, 4)).astype(np.float32)]
SECOND = np.array([[0, 1], [1, 2], [2, 0], [2, 2]], dtype=np.int32)
# Saved transposed, as the quantiles of PyTorch are.
THRESHOLDS = np.array([[0.25, 0.5], [1.0, 2.0]], dtype=np.float32).T

EXAMPLE = Path(__file__).parents[3] / "examples" / "import_a_dwn.py"


def state() -> Arrays:
    """A state dictionary of two layers, the first with a learned mapping and the decoy beside it."""
    return {
        "0._LUTLayer__dummy_mapping": np.arange(6, dtype=np.int32).reshape(3, 2),
        "0.luts": LUTS[0],
        "0.mapping.weights": WEIGHTS,
        "1.mapping": SECOND,
        "1.luts": LUTS[1],
    }


def dictionary(**changes: Any) -> Arrays:
    return {
        "config": {"num_classes": 2, "n": 2, "layers": [3, 4]},
        "state_dict": OrderedDict(state()),
        "thermometer": {"kind": "distributive", "num_bits": 2, "thresholds": THRESHOLDS},
        "scaler": {"mean": np.zeros(2, dtype=np.float32), "scale": np.ones(2, dtype=np.float32)},
        "classes": ["quark", "gluon"],
    } | changes


def without(data: Arrays, *keys: str) -> Arrays:
    return {key: value for key, value in data.items() if key not in keys}


def upstream(features: Any) -> list[int]:
    """The answers as the authors' description has them."""
    bits = (np.asarray(features)[:, :, np.newaxis] > THRESHOLDS).reshape(len(features), -1)
    for luts, mapping in zip(LUTS, (WEIGHTS.argmax(0).reshape(3, 2), SECOND), strict=True):
        address = (bits[:, mapping] * [1, 2]).sum(axis=2)
        bits = luts[np.arange(len(luts)), address] > 0
    return list(map(int, bits.reshape(-1, 2, 2).sum(axis=2).argmax(axis=1)))


FEATURES = np.array([[a, b] for a in (0.25, 0.3, 1.0, 1.5) for b in (0.5, 0.6, 2.0, 3.0)])


def loaded(path: Path, **options: Any) -> LutGroupModel:
    assert recognises(Source(path))
    return read(Source(path), ImportOptions(**options))


def test_a_dictionary_answers_as_its_network(save_checkpoint: Save, tmp_path: Path) -> None:
    model = loaded(save_checkpoint(tmp_path / "a.pt", dictionary()))
    assert model.encoder == Thermometer(((0.25, 1.0), (0.5, 2.0)), strict=True)
    assert model.classes == ("quark", "gluon")
    assert model.evaluate(model.encoder.bits(FEATURES)).tolist() == upstream(FEATURES)
    assert model.origin["scaler"] == {"mean": [0.0, 0.0], "scale": [1.0, 1.0]}


def test_a_module_and_its_thermometer_are_read_without_their_packages(
    save_checkpoint: Save, named_classes: Callable[..., dict[str, type]], tmp_path: Path
) -> None:
    sequential, layer, learnable, group_sum, thermometer = named_classes(*NAMES).values()

    def module(kind: type, parameters: Arrays, modules: Arrays, **attributes: Any) -> Any:
        made = kind()
        parts = {
            "_parameters": OrderedDict(parameters),
            "_buffers": OrderedDict(),
            "_modules": OrderedDict(modules),
        }
        made.__dict__.update(training=False, _non_persistent_buffers_set=set(), **parts, **attributes)
        return made

    values = state()
    mapping = module(learnable, {"weights": values["0.mapping.weights"]}, {}, tau=0.001)
    decoy = {"_LUTLayer__dummy_mapping": values["0._LUTLayer__dummy_mapping"]}
    first = module(layer, {**decoy, "luts": values["0.luts"]}, {"mapping": mapping}, n=2)
    second = module(layer, {"mapping": values["1.mapping"], "luts": values["1.luts"]}, {}, n=2)
    last = module(group_sum, {}, {}, k=2, tau=3.3)
    model = module(sequential, {}, {"0": first, "1": second, "2": last})
    encoder = thermometer()
    encoder.__dict__.update(num_bits=2, feature_wise=True, thresholds=THRESHOLDS)
    whole = loaded(save_checkpoint(tmp_path / "a.pt", {"model": model, "thermometer": encoder}))
    assert whole.evaluate(whole.encoder.bits(FEATURES)).tolist() == upstream(FEATURES)
    bare = loaded(save_checkpoint(tmp_path / "b.pt", model))
    assert (bare.encoder, bare.classes) == (Words(4), ("0", "1"))


def test_a_state_dictionary_does_not_say_how_many_classes_there_are(
    save_checkpoint: Save, tmp_path: Path
) -> None:
    path = save_checkpoint(tmp_path / "a.pt", {"model": state(), "thermometer": THRESHOLDS})
    with pytest.raises(
        InputError, match=r"does not say how many classes .*; give their number with --classes"
    ):
        read(Source(path), ImportOptions())
    model = loaded(path, classes=2)
    assert model.evaluate(model.encoder.bits(FEATURES)).tolist() == upstream(FEATURES)


def test_a_network_without_a_thermometer_reads_bits_and_says_so(
    save_checkpoint: Save, tmp_path: Path
) -> None:
    model = loaded(save_checkpoint(tmp_path / "a.pt", state()), classes=2)
    assert model.encoder == Words(4)
    assert model.origin["encoder"] == "the file holds no thresholds: the model reads bits"


def test_groups_are_as_large_as_the_padded_network_makes_them(save_checkpoint: Save, tmp_path: Path) -> None:
    model = loaded(save_checkpoint(tmp_path / "a.pt", dictionary(config={"num_classes": 3}, classes=None)))
    assert model.groups.tolist() == [0, 0, 1, 1]
    assert model.classes == ("0", "1", "2")


def test_thresholds_that_all_features_share(save_checkpoint: Save, tmp_path: Path) -> None:
    shared = np.array([0.5, 1.0])
    model = loaded(save_checkpoint(tmp_path / "a.pt", dictionary(thermometer=shared)))
    assert model.encoder == Thermometer(((0.5, 1.0), (0.5, 1.0)), strict=True)


def test_an_option_that_says_otherwise_is_refused(save_checkpoint: Save, tmp_path: Path) -> None:
    path = save_checkpoint(tmp_path / "a.pt", dictionary())
    with pytest.raises(InputError, match="the checkpoint says otherwise: --classes 4, not 2"):
        read(Source(path), ImportOptions(classes=4))


def changed(key: str, value: Any) -> Arrays:
    return dictionary(state_dict={**state(), key: value})


NAN = np.full((3, 4), np.nan, dtype=np.float32)


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (changed("0.luts", NAN), "0.luts holds numbers that are not finite"),
        (changed("0.luts", LUTS[0][:, :3]), "power of two"),
        (changed("0.luts", LUTS[0][:2]), "there are 4 slots"),
        (changed("0.luts", [1, 2]), "0.luts is not an array"),
        (changed("0.mapping.weights", WEIGHTS[:, :5]), "there are 6 slots"),
        (changed("0.mapping.weights", WEIGHTS[:3]), "the thermometer has 4 bits; the network reads 3"),
        (changed("1.mapping", SECOND + 1), "reads inputs 1 to 3; there are 3"),
        (changed("1.mapping", SECOND - 1), "1.mapping reads inputs -1"),
        (changed("1.mapping", LUTS[1]), "1.mapping has shape"),
        (dictionary(state_dict=without(state(), "1.mapping")), "1.mapping"),
        (dictionary(state_dict={}), "not those of LUT layers"),
        (dictionary(state_dict=3), "a int where a dictionary"),
        (dictionary(thermometer=THRESHOLDS[::-1, ::-1]), "do not rise"),
        (dictionary(thermometer=THRESHOLDS * np.inf), "are not finite numbers"),
        (dictionary(thermometer={}), "thresholds"),
        (dictionary(scaler={"mean": THRESHOLDS[0], "scale": THRESHOLDS[0] * 0}), "the scaler divides by 0"),
        (dictionary(config={"num_classes": 1}), "there are 1 classes"),
        (dictionary(config=[1]), "a list where a dictionary"),
        ([1, 2], "a list where a dictionary"),
    ],
)
def test_a_checkpoint_that_contradicts_itself_gets_one_line(
    save_checkpoint: Save, tmp_path: Path, data: Any, reason: str
) -> None:
    path = save_checkpoint(tmp_path / "a.pt", data)
    with pytest.raises(InputError, match=f"not a DWN checkpoint, or a damaged one: .*{reason}"):
        read(Source(path), ImportOptions())


def test_modules_that_contain_themselves_are_refused(
    save_checkpoint: Save, named_classes: Callable[..., dict[str, type]], tmp_path: Path
) -> None:
    model = named_classes(NAMES[0])[NAMES[0]]()
    model.__dict__.update(_modules={"0": model})
    with pytest.raises(InputError, match="contain one another too deeply"):
        read(Source(save_checkpoint(tmp_path / "a.pt", model)), ImportOptions())


@pytest.mark.slow
def test_the_example_imports_and_compiles_a_checkpoint(save_checkpoint: Save, tmp_path: Path) -> None:
    checkpoint = save_checkpoint(tmp_path / "a.pt", dictionary())
    np.savez(tmp_path / "vectors.npz", x_raw=FEATURES, pred=upstream(FEATURES))
    done = subprocess.run(
        [sys.executable, EXAMPLE, checkpoint, tmp_path / "vectors.npz", tmp_path / "output"],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "100.0% of the recorded answers are the model's" in done.stdout
    # None of the thresholds is between two words.
    assert "100.0% of them are the circuit's" in done.stdout


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(st.data())
def test_any_damage_gives_a_model_or_one_line(
    save_checkpoint: Save, tmp_path: Path, data: st.DataObject
) -> None:
    content = bytearray(save_checkpoint(tmp_path / "a.pt", dictionary()).read_bytes())
    start = content.index(b"\x80\x02")  # of the pickle, stored as it is
    at = data.draw(st.integers(start, len(content) - 1))
    content[at] = data.draw(st.integers(0, 255))
    path = tmp_path / "b.pt"
    path.write_bytes(content)
    with suppress(InputError):
        read(Source(path), ImportOptions())


@pytest.mark.realdata
@pytest.mark.parametrize(
    "name", ["dwn_jsc_t200_distributive_50_l_b100", "dwn_jsc_t4_distributive_300-100_lr"]
)
def test_all_recorded_bits_and_answers_are_reproduced(realdata: Path, name: str) -> None:
    model = loaded(realdata / "dwn" / f"{name}_checkpoint.pt")
    vectors = np.load(realdata / "dwn" / f"{name}_testvectors.npz")
    bits = model.encoder.bits(vectors["x_raw"])
    assert np.array_equal(bits, vectors["x_binarized"])
    assert np.array_equal(model.evaluate(bits), vectors["pred"])
    assert model.classes == ("g", "q", "t", "w", "z")
