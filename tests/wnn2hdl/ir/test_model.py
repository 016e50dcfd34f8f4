import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.ir import (
    PIXEL_BIT_NAMES,
    BitSelect,
    Neighbourhood,
    Tap,
    Thermometer,
    WisardModel,
    codes_to_bits,
    picture_encoder,
)
from wnn2hdl.ir.modelfile import VERSION


def hand_worked() -> WisardModel:
    """Two classes, two RAMs of two bits each over four input bits, threshold 2."""
    return WisardModel(
        encoder=BitSelect(("R7", "R6", "G7", "B7")),
        classes=("forest", "deforested"),
        mapping=np.array([[[0, 1], [3, 2]]]),
        counts=np.array([[[2, 0, 0, 1], [0, 3, 0, 0]], [[0, 0, 0, 2], [0, 2, 0, 5]]]),
        bleaching=2,
        training={"seed": 7},
    )


@st.composite
def models(draw: st.DrawFn) -> WisardModel:
    width, rams, classes = draw(st.integers(1, 6)), draw(st.integers(1, 4)), draw(st.integers(2, 4))
    address_bits = draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    groups = draw(st.sampled_from([1, classes]))
    return WisardModel(
        encoder=BitSelect(tuple(draw(st.permutations(sorted(PIXEL_BIT_NAMES)))[:width])),
        classes=tuple(f"class {i}" for i in range(classes)),
        mapping=rng.integers(0, width, (groups, rams, address_bits)),
        counts=rng.integers(0, 4, (classes, rams, 1 << address_bits)),
        bleaching=draw(st.integers(1, 3)),
        training=draw(st.dictionaries(st.text(max_size=5), st.integers() | st.text(max_size=5), max_size=3)),
        colours=draw(st.none() | st.sets(st.integers(0, 4095), max_size=4).map(sorted).map(np.array)),
    )


def slow_winner(model: WisardModel, bits: NDArray[np.bool_]) -> int:
    """The definition, one RAM and one pattern at a time."""
    best, winner = -1, -1
    for index, discriminator in enumerate(model.counts):
        mapping = model.mapping[index if len(model.mapping) > 1 else 0]
        response = 0
        for ram, inputs in zip(discriminator, mapping, strict=True):
            address = sum(int(bits[position]) << j for j, position in enumerate(inputs))
            response += int(ram[address] >= model.bleaching)
        if response > best:
            best, winner = response, index
    return winner


def test_responses_by_hand() -> None:
    # Code 0b1000: RAM 0 reads bits 0, 1 -> address 0; RAM 1 reads bits 3, 2 -> address 1.
    model = hand_worked()
    assert model.responses(codes_to_bits([0b1000, 0b0011, 0b1111], 4)).tolist() == [[2, 1], [0, 1], [0, 2]]
    assert model.evaluate(codes_to_bits([0b1000, 0b0011, 0b1111], 4)).tolist() == [0, 1, 1]


def test_a_tie_goes_to_the_class_named_first() -> None:
    model = replace(hand_worked(), bleaching=9)
    assert not model.responses(codes_to_bits(range(16), 4)).any()
    assert not model.evaluate_all_codes().any()


def test_saturation_is_the_share_of_firing_addresses() -> None:
    assert hand_worked().saturation.tolist() == [[0.25, 0.25], [0.25, 0.5]]


@given(models())
def test_evaluation_follows_the_definition(model: WisardModel) -> None:
    bits = codes_to_bits(range(1 << model.encoder.width), model.encoder.width)
    assert model.evaluate_all_codes().tolist() == [slow_winner(model, row) for row in bits]


@given(model=models())
@settings(max_examples=50)
def test_saving_and_loading_is_the_identity(
    tmp_path_factory: pytest.TempPathFactory, model: WisardModel
) -> None:
    path = tmp_path_factory.mktemp("model") / "m.json"
    model.save(path)
    loaded = WisardModel.load(path)
    assert loaded.to_json() == model.to_json()
    assert loaded.digest() == model.digest()
    assert np.array_equal(loaded.counts, model.counts)
    assert np.array_equal(loaded.mapping, model.mapping)
    again = path.with_name("again.json")
    loaded.save(again)
    assert again.read_bytes() == path.read_bytes()


def test_the_digest_sees_what_decides_answers_and_nothing_else() -> None:
    model = hand_worked()
    counts = model.counts.copy()
    counts[1, 1, 3] += 1
    noted = replace(model, training={"seed": 8}, colours=np.array([7]))
    assert model.digest() == noted.digest()
    others = [
        replace(model, counts=counts),
        replace(model, bleaching=3),
        replace(model, mapping=model.mapping[:, ::-1]),
        replace(model, classes=("a", "b")),
        replace(model, encoder=BitSelect(("R7", "R6", "G7", "B6"))),
    ]
    assert len({model.digest(), *(other.digest() for other in others)}) == 6


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"classes": ("one",)}, "at least two different classes"),
        ({"classes": ("a", "a")}, "at least two different classes"),
        ({"mapping": np.zeros((2, 2), dtype=np.int64)}, "the mapping has shape"),
        ({"mapping": np.array([[[0, 1], [3, 4]]])}, "reads input bits . to 4"),
        ({"mapping": np.array([[[0, 1]]])}, "the counts have shape"),
        ({"counts": np.full((2, 2, 4), -1)}, "a count is negative"),
        ({"bleaching": 0}, "the lowest is 1"),
    ],
)
def test_a_model_that_contradicts_itself(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(hand_worked(), **change)


def test_any_truncated_file_gets_one_line(tmp_path: Path) -> None:
    path = tmp_path / "m.json"
    hand_worked().save(path)
    content = path.read_bytes().rstrip()
    for length in range(0, len(content), 37):
        path.write_bytes(content[:length])
        with pytest.raises(ModelFileError) as caught:
            WisardModel.load(path)
        assert "\n" not in str(caught.value)


def broken(**changes: object) -> dict[str, Any]:
    return {**hand_worked().to_json(), **changes}


@pytest.mark.parametrize(
    ("data", "line"),
    [
        ({}, r"not a wnn2hdl model: .*format None"),
        (broken(format="other"), "not a wnn2hdl model"),
        (broken(version=VERSION + 1), r"saved by a newer wnn2hdl: .*version 3.*; upgrade wnn2hdl"),
        (broken(version=1), "saved by an older wnn2hdl: .*version 1.*; train or import it again"),
        (broken(version="1"), "the model file is damaged: .*version '1'"),
        (
            broken(kind="perceptron"),
            "no such kind of model: .*'perceptron'.*; known are wisard, sparse-wisard",
        ),
        (broken(kind=["wisard"]), "no such kind of model"),
        (broken(bleaching=0), "the model file is damaged: .*at bleaching"),
        (broken(bleaching=None), "the model file is damaged: .*at bleaching"),
        (broken(extra=1), "the model file is damaged: .*at the top level"),
        (broken(classes=["a"]), "the model file is damaged: .*at classes"),
        (broken(encoder={"kind": "bits", "bits": ["X9"]}), "the model file is damaged: .*at encoder"),
        (broken(encoder={"kind": "relational", "bits": ["R>B"]}), "the model file is damaged: .*at encoder"),
        (broken(encoder={"kind": "context", "bits": [7]}), r"at encoder/bits/0: 7 is not of type 'string'\)"),
        (
            broken(encoder={"kind": "context", "bits": ["7x7(R[7:1]>=B[7:1])>=3"] * 9}),
            r"at encoder/bits: \['7x7.* … .* has non-unique elements\)",
        ),
        (broken(encoder={"kind": "relational", "bits": ["R>=R"]}), "contradicts itself: .*channel once"),
        (broken(colours=[4096]), "the model file is damaged: .*at colours"),
        (broken(colours=[1, 1]), "the model file is damaged: .*at colours"),
        (broken(counts=[[], []]), "the model file is damaged: .*at counts/"),
        (broken(rams=3), "the model contradicts itself: .*rams and address_bits say"),
        (broken(mapping=[[[0, 1], [2]]]), "the model contradicts itself"),
        (broken(mapping=[[[0, 1], [2, 9]]]), "the model contradicts itself: .*input bits . to 9"),
        (
            broken(encoder={"kind": "thermometer", "thresholds": [[2, 1]], "strict": False}),
            "contradicts itself: .*do not rise",
        ),
        (
            broken(encoder={"kind": "thermometer", "thresholds": [[float("nan")]]}),
            "NaN is not a finite number",
        ),
    ],
)
def test_a_file_that_is_no_sound_model_gets_one_line(tmp_path: Path, data: dict[str, Any], line: str) -> None:
    path = tmp_path / "m.json"
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError, match=line) as caught:
        WisardModel.load(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("ram", "reason"),
    [
        ({"addresses": [0, 0], "counts": [1, 1]}, "no address twice"),
        ({"addresses": [0], "counts": [1, 1]}, "as many counts as addresses"),
        ({"addresses": [4], "counts": [1]}, "address 4 does not fit 2 address bits"),
    ],
)
def test_a_ram_that_cannot_be_filled(tmp_path: Path, ram: dict[str, list[int]], reason: str) -> None:
    data = hand_worked().to_json()
    data["counts"][1][0] = ram
    path = tmp_path / "m.json"
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError, match=reason):
        WisardModel.load(path)


def odd_count(addresses: list[Any]) -> dict[str, Any]:
    data = hand_worked().to_json()
    data["counts"][0][0] = {"addresses": addresses, "counts": [1]}
    return data


@pytest.mark.parametrize(
    "data",
    [
        broken(address_bits=2.0),
        odd_count([1.0]),
        broken(mapping=[[[10**30, 0], [1, 2]]]),
        broken(encoder={"kind": "thermometer", "thresholds": [[10**400]], "strict": False}),
    ],
)
def test_odd_numbers_get_one_line(tmp_path: Path, data: dict[str, Any]) -> None:
    path = tmp_path / "m.json"
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError):
        WisardModel.load(path)


def test_a_model_of_thermometer_bits_survives_its_file(tmp_path: Path) -> None:
    data = broken(
        encoder={
            "kind": "thermometer",
            "thresholds": [[0.1, 0.30000000000000004], [], [1e-300, 2]],
            "strict": True,
            "input": {"bits": 16, "fraction": 12, "signed": True},
        }
    )
    model = WisardModel.from_json(data)
    model.save(tmp_path / "m.json")
    assert WisardModel.load(tmp_path / "m.json").encoder == model.encoder


@pytest.mark.parametrize("content", [b"", b"\x89PNG\r\n\x1a\n\x00", b"3", b"null"])
def test_other_files_get_one_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "m.json"
    path.write_bytes(content)
    with pytest.raises(ModelFileError, match="not a model"):
        WisardModel.load(path)


def test_a_missing_file_or_a_folder_gets_one_line(tmp_path: Path) -> None:
    with pytest.raises(ModelFileError, match=r"cannot read a model: .*No such file"):
        WisardModel.load(tmp_path / "m.json")
    with pytest.raises(ModelFileError, match=r"cannot read a model: .*it is a folder"):
        WisardModel.load(tmp_path)


def neighbourhood() -> WisardModel:
    taps = (Tap(1, 1, BitSelect(("R7", "G7")), 0b0110), Tap(0, 2, BitSelect(("B7",)), 0b10))
    return replace(hand_worked(), encoder=Neighbourhood(3, taps), mapping=np.array([[[0, 1], [1, 0]]]))


def test_a_model_of_a_neighbourhood_comes_back_from_its_file(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    neighbourhood().save(path)
    loaded = WisardModel.load(path)
    assert loaded.encoder == neighbourhood().encoder
    assert loaded.digest() == neighbourhood().digest()


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("contents", "0X6", "damaged"),
        ("contents", "1ffff", "contradicts itself"),
        ("row", 3, "contradicts itself"),
        ("row", -1, "damaged"),
        ("bits", ["R8"], "damaged"),
    ],
)
def test_a_damaged_tap_is_told(tmp_path: Path, key: str, value: Any, message: str) -> None:
    path = tmp_path / "model.json"
    data = neighbourhood().to_json()
    data["encoder"]["taps"][0][key] = value
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError, match=message):
        WisardModel.load(path)


def test_counts_are_not_allocated_before_they_are_found_too_many(tmp_path: Path) -> None:
    data = hand_worked().to_json()
    # 2,000 RAMs of 2**20 counts in less than a megabyte: 32 GB.
    rams: list[dict[str, list[int]]] = [{"addresses": [], "counts": []}] * 1000
    taps = [[[0] * 20] * 1000]
    data |= {"address_bits": 20, "rams": 1000, "mapping": taps, "counts": [rams, rams]}
    path = tmp_path / "model.json"
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError, match=r"2 discriminators of 1000 RAMs with 20 address bits take more"):
        WisardModel.load(path)


@pytest.mark.parametrize("width", [14, 32, 52, 200])
def test_a_model_of_features_is_no_table_of_pixels(width: int, tmp_path: Path) -> None:
    encoder = Thermometer((tuple(float(level) for level in range(width)),))
    replace(hand_worked(), encoder=encoder).save(tmp_path / "model.json")
    model = WisardModel.load(tmp_path / "model.json")
    with pytest.raises(InputError, match="the model does not read pixels"):
        picture_encoder(model)
    if width > 20:
        with pytest.raises(InputError, match=f"too many input bits for one truth table: {width} bits"):
            model.evaluate_all_codes()


def test_classes_of_pictures_fit_a_byte() -> None:
    model = hand_worked()
    classes = tuple(map(str, range(300)))
    many = replace(model, classes=classes, counts=np.ones((300, 2, 4), dtype=np.int64))
    with pytest.raises(InputError, match="too large for a table: 4 bits, 300 classes"):
        picture_encoder(many)
