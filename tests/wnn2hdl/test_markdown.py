import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.markdown import escaped, head, row, table


def test_a_table_is_its_head_and_rows() -> None:
    text = table(["part", "LUTs"], [["pixel", 3], ["delay", 0.123456], ["", None]], ["left", "right"])
    assert text.splitlines() == [
        "| part | LUTs |",
        "| --- | ---: |",
        "| pixel | 3 |",
        "| delay | 0.1235 |",
        "|  | n/a |",
    ]
    assert text.startswith(head(["part", "LUTs"], ["left", "right"]))
    assert text.endswith(row(["", None]))


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a|b", r"a\|b"),
        ("a\\|b", r"a\\\|b"),
        ("a\r\n\n# b", "a # b"),
        ("</script><b>", r"\</script\>\<b\>"),
        ("`*/`", r"\`\*/\`"),
        ("[a](b)", r"\[a\](b)"),
        ("&lt;", r"\&lt;"),
        ("scene_2023_05.tif", "scene_2023_05.tif"),
        ("_a_", r"\_a\_"),
    ],
)
def test_no_character_is_taken_for_markup(name: str, text: str) -> None:
    assert escaped(name) == text
    assert row([name]) == f"| {text} |"


@given(st.lists(st.text(), min_size=1))
def test_no_text_adds_a_row_or_a_column(cells: list[str]) -> None:
    text = row(cells)
    assert len(text.splitlines()) == 1
    unescaped = text.replace("\\\\", "").replace("\\|", "")
    assert unescaped.count("|") == len(cells) + 1
