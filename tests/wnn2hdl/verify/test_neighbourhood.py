"""The claim about a classifier of a pixel and its neighbours."""

from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import bits_to_codes
from wnn2hdl.ir.pixels import pixel_bits
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.proof import prove


def random_windows(count: int) -> NDArray[np.uint8]:
    return np.random.default_rng(0).integers(0, 256, (count, 9, 3), dtype=np.uint8)


def test_a_neighbourhood_is_its_model_on_every_window(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(5, classes=3)
    claim = circuits.specification(neighbours).claims["neighbourhood"]
    windows = random_windows(200)
    answers = bits_to_codes(claim.answers({"window": pixel_bits(windows)})["class_bits"])
    codes = [int(neighbours.encoder.codes(window.reshape(3, 3, 3))[0, 0]) for window in windows]
    assert answers.tolist() == neighbours.model.evaluate_all_codes()[codes].tolist()
    assert claim.inputs == {"window": 216}
    assert claim.outputs == {"class_bits": 2}


def test_windows_are_cared_for_by_their_code(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(5, care=0.5)
    claim = circuits.specification(neighbours).claims["neighbourhood"]
    windows = {"window": pixel_bits(random_windows(200))}
    cared = claim.cared(windows)
    assert cared.shape == (200, 1)
    assert np.array_equal(cared[:, 0], neighbours.care[neighbours.codes(windows["window"])])
    assert 0 < cared.sum() < 200


def test_the_parts_of_a_video_core_are_together_the_neighbourhood(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(5, classes=3, care=0.5)
    claims = circuits.specification(neighbours).claims
    windows = random_windows(200)
    seen = claims["taps"].answers({"rgb": pixel_bits(windows.reshape(-1, 1, 3))})["tap_bits"]
    assert claims["taps"].outputs == {"tap_bits": 5}
    encoder = neighbours.encoder
    columns = [
        seen.reshape(200, 3, 3, -1)[:, tap.row, tap.column, source]
        for tap, source in zip(encoder.taps, encoder.sources, strict=True)
    ]
    code = {"code": np.stack(columns, axis=1)}
    whole = {"window": pixel_bits(windows)}
    answers = claims["decision"].answers(code), claims["neighbourhood"].answers(whole)
    assert np.array_equal(*(answer["class_bits"] for answer in answers))
    assert np.array_equal(claims["decision"].cared(code), claims["neighbourhood"].cared(whole))
    stimulus = claims["decision"].stimulus()
    assert bits_to_codes(stimulus["code"]).tolist() == np.flatnonzero(neighbours.care).tolist()


def test_parts_are_proved_and_wrong_ones_refuted(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(5, care=0.5)
    specification = circuits.specification(neighbours)
    body = "".join(
        circuits.sum_of_products(
            f"tap_bits[{i}]",
            [f"rgb[{place}]" for place in tap.pixel.pixel_positions],
            np.flatnonzero(tap.table).tolist(),
        )
        for i, tap in enumerate(neighbours.encoder.tables)
    )
    taps = f"module taps(input [23:0] rgb, output [4:0] tap_bits);\n{body}endmodule\n"
    values = np.where(neighbours.care, neighbours.model.evaluate_all_codes() > 0, True)
    code = [f"code[{i}]" for i in range(5)]
    body = circuits.sum_of_products("class_bits", code, np.flatnonzero(values).tolist())
    decision = f"module decision(input [4:0] code, output class_bits);\n{body}endmodule\n"
    right = {"taps": taps, "decision": decision}
    found = prove(specification, {part: Circuit((text,), part) for part, text in right.items()})
    assert {part: proof.status for part, proof in found.items()} == dict.fromkeys(right, "proved")
    wrong = {"taps": taps.replace("rgb[15]", "rgb[14]"), "decision": decision.replace("|{", "~|{")}
    found = prove(specification, {part: Circuit((text,), part) for part, text in wrong.items()})
    assert {part: proof.status for part, proof in found.items()} == dict.fromkeys(wrong, "refuted")
