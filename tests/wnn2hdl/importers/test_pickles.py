import os
import pickle
import subprocess
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.importers.pickles import Record, StandIn, UnreadablePickleError, read_pickle, record

plain = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text() | st.binary(),
    lambda inner: (
        st.lists(inner)
        | st.lists(inner).map(tuple)
        | st.dictionaries(st.text() | st.integers(), inner)
        | st.sets(st.text())
    ),
    max_leaves=20,
)


def nothing(_: str) -> StandIn | None:
    """No class or function is known."""
    return None


@given(plain, st.sampled_from([4, 5]))
def test_plain_values_are_what_python_reads(value: Any, protocol: int) -> None:
    content = pickle.dumps(value, protocol)
    assert read_pickle(content, nothing) == pickle.loads(content) == value


class Evil:
    """Runs a command when Python unpickles it."""

    def __init__(self, function: Any, *arguments: Any) -> None:
        self.function, self.arguments = function, arguments

    def __reduce__(self) -> Any:
        return self.function, self.arguments


@pytest.mark.parametrize("function", [os.system, eval, exec, subprocess.run, getattr])
@pytest.mark.parametrize("protocol", [2, 4])
def test_a_malicious_pickle_is_refused_and_nothing_is_run(
    tmp_path: Path, function: Any, protocol: int
) -> None:
    evidence = tmp_path / "evidence"
    content = pickle.dumps(Evil(function, f"open({str(evidence)!r}, 'w')"), protocol)
    with pytest.raises(UnreadablePickleError, match=r"it asks for .*, which no such model needs"):
        read_pickle(content, nothing)
    assert not evidence.exists()


def test_classes_are_stand_ins_and_objects_records(named_classes: Any) -> None:
    made = named_classes("wisard.Thing")["wisard.Thing"]()
    made.__dict__.update(size=3, inner=[made.__class__()])
    content = pickle.dumps(made, 4)
    found = read_pickle(content, lambda name: record(name) if name == "wisard.Thing" else None)
    assert isinstance(found, Record)
    assert (found.name, found.state["size"]) == ("wisard.Thing", 3)
    assert isinstance(found.state["inner"][0], Record)


def test_only_a_stand_in_is_called() -> None:
    calls: list[Any] = []
    content = pickle.dumps(Evil(print, "a", 1), 4)
    assert read_pickle(content, lambda name: StandIn(name, lambda *given: calls.append(given))) is None
    assert calls == [("a", 1)]


def test_attributes_cannot_be_set_on_a_stand_in() -> None:
    content = b"\x80\x04cwisard\nThing\n}X\x04\x00\x00\x00makeNsb."
    with pytest.raises(UnreadablePickleError, match="set on what has none"):
        read_pickle(content, record)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\x80\x04",
        b"\x80\x04K\x01",  # no end
        b"\x80\x04.",  # nothing on the stack
        b"\x80\x04K\x01K\x02.",  # two values
        b"\x80\x04h\x07.",  # nothing remembered there
        b"\x80\x04t.",  # a tuple without a mark
        b"\x80\x04K\x01a.",  # appended to a number
        b"\x80\x04]K\x01R.",  # a list called
        b"\x80\x04]Q.",  # something outside of the file
        b"\x80\x04(K\x01l.",  # an instruction that no model needs
        b"\x80\x04I1\n.",
        b"\x80\x04}))s.",  # a tuple as a key
        b"\x80\x04\x8e\xff\xff\xff\xff\xff\xff\xff\x7f.",  # bytes of a size that there is not
    ],
)
def test_a_damaged_pickle_gets_one_error(content: bytes) -> None:
    with pytest.raises(UnreadablePickleError):
        read_pickle(content, nothing)


@given(plain, st.data())
def test_any_changed_byte_gives_a_value_or_one_error(value: Any, data: st.DataObject) -> None:
    content = bytearray(pickle.dumps(value, 4))
    content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    with suppress(UnreadablePickleError):
        read_pickle(bytes(content), nothing)
