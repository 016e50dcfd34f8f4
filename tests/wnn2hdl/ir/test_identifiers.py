"""Names of modules and ports."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.ir.identifiers import RESERVED, name_from, require_name, require_unreserved


def test_the_words_of_all_three_languages_are_reserved() -> None:
    assert {"always", "logic", "checker"} <= RESERVED
    assert {"entity", "downto", "signal"} <= RESERVED
    assert {"namespace", "alignas", "register"} <= RESERVED
    assert all(word == word.lower() for word in RESERVED)


@pytest.mark.parametrize("name", ["aerial", "forest_2", "R7", "a" * 60])
def test_names_stay_as_they_are(name: str) -> None:
    assert require_name(name) == name


@pytest.mark.parametrize("name", ["", "2nd", "_x", "x_", "a__b", "a-b", "a b", "über", "a\n", "a" * 61])
def test_what_is_no_identifier_is_refused(name: str) -> None:
    with pytest.raises(InputError, match="not a name that Verilog modules can begin with"):
        require_name(name)


@pytest.mark.parametrize("name", ["module", "Entity", "SIGNAL", "class"])
def test_whole_names_are_no_reserved_words_in_any_case(name: str) -> None:
    assert require_name(name) == name
    with pytest.raises(InputError, match=f"called like a reserved word: {name}; choose another --name"):
        require_unreserved(name)


def test_what_begins_with_a_reserved_word_is_another_word() -> None:
    require_unreserved("module_block")
    with pytest.raises(InputError):
        require_unreserved("first_match")


def test_a_name_is_made_of_any_text() -> None:
    assert name_from("build/my model (2).json") == "build_my_model_2_json"
    assert name_from("2024") == "wnn_2024"
    assert name_from("…") == "wnn"


@given(st.text())
def test_what_is_made_of_any_text_is_a_name(text: str) -> None:
    assert require_name(name_from(text))
