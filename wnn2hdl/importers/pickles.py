"""Pickles read as data: their instructions are followed here, and only functions of ours are called.

Python's own unpickler imports and calls whatever a file names. This one knows the instructions that build
numbers, texts, tuples, lists, sets and dictionaries; for each class or function that a file names, the caller
gives a stand-in, and a file that names any other is refused.
"""

import pickletools
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

MAX_INSTRUCTIONS = 20_000_000
"""More than any model of this kind has; a longer pickle is refused before it fills the memory."""


class UnreadablePickleError(ValueError):
    """The pickle is damaged, or asks for what no model needs."""


@dataclass(frozen=True)
class StandIn:
    """What stands for a class or function that a pickle names.

    Attributes:
        name: as in the pickle, such as ``numpy.dtype``.
        make: called with the arguments in place of it.
    """

    name: str
    make: Callable[..., Any]


class Saved(ABC):
    """A stand-in for an object whose state comes after it."""

    @abstractmethod
    def set_state(self, state: object) -> None:
        """Take the state; raises UnreadablePickleError or ValueError if the object can have no such state."""


@dataclass(eq=False)
class Record(Saved):
    """An object of a class that is not there: its name, and the attributes that it was saved with."""

    name: str
    state: dict[str, Any] = field(default_factory=dict)

    def set_state(self, state: object) -> None:
        """Take the attributes, a dictionary."""
        if not isinstance(state, dict):
            raise UnreadablePickleError(f"{self.name} has no attributes by name")
        self.state = state


def record(name: str) -> StandIn:
    """A stand-in for a class whose objects are read as a `Record`."""
    return StandIn(name, lambda *_: Record(name))


Lookup = Callable[[str], StandIn | None]
"""The stand-in for a name; None if no such file may name it."""


def read_pickle(content: bytes, lookup: Lookup, persistent: Callable[[Any], Any] | None = None) -> Any:
    """The value that a pickle describes.

    Args:
        content: the pickle, of protocol 2 or later.
        lookup: what stands for the classes and functions it names.
        persistent: what an identifier of something outside the pickle stands for.

    Raises:
        UnreadablePickleError: it is damaged, or names a class, function or instruction that is not allowed.
    """
    machine = _Machine(lookup, persistent)
    try:
        for number, (instruction, argument, _) in enumerate(pickletools.genops(content)):
            if number >= MAX_INSTRUCTIONS:
                raise UnreadablePickleError("it has too many instructions")
            machine.do(instruction.name, argument)
        return machine.result()
    except UnreadablePickleError:
        raise
    except (ValueError, TypeError, IndexError, KeyError, AttributeError, OverflowError) as error:
        raise UnreadablePickleError(f"the pickle is damaged: {error}") from error


_MARK = object()

_VALUES = frozenset(
    {
        *(
            "BININT",
            "BININT1",
            "BININT2",
            "LONG1",
            "BINFLOAT",
            "BINUNICODE",
            "SHORT_BINUNICODE",
            "BINUNICODE8",
        ),
        *("BINBYTES", "SHORT_BINBYTES", "BINBYTES8", "BINSTRING", "SHORT_BINSTRING"),
    }
)
"""Instructions whose argument is the value itself."""

_CONSTANTS = {"NONE": None, "NEWTRUE": True, "NEWFALSE": False}


class _Machine:
    """The stack and the memory of a pickle."""

    def __init__(self, lookup: Lookup, persistent: Callable[[Any], Any] | None) -> None:
        self.lookup = lookup
        self.persistent = persistent
        self.stack: list[Any] = []
        self.memory: dict[int, Any] = {}
        self.ended = False

    def do(self, name: str, argument: Any) -> None:
        """Follow one instruction."""
        stack = self.stack
        if name in _VALUES:
            stack.append(argument)
        elif name in _CONSTANTS:
            stack.append(_CONSTANTS[name])
        elif name in ("MEMOIZE", "BINPUT", "LONG_BINPUT"):
            self.memory[len(self.memory) if name == "MEMOIZE" else argument] = stack[-1]
        elif name in ("BINGET", "LONG_BINGET"):
            stack.append(self.memory[argument])
        elif name in ("PROTO", "FRAME"):
            pass
        elif name == "STOP":
            self.ended = True
        else:
            handler = getattr(self, f"_{name.lower()}", None)
            if handler is None:
                raise UnreadablePickleError(f"the instruction {name} is not allowed")
            handler(argument)

    def result(self) -> Any:
        """The value left when the pickle ends."""
        if not self.ended or len(self.stack) != 1:
            raise UnreadablePickleError("the pickle ends too early")
        return self.stack[0]

    def _marked(self) -> list[Any]:
        """What was put on the stack since the last mark, which goes too."""
        at = max(index for index, value in enumerate(self.stack) if value is _MARK)
        values = self.stack[at + 1 :]
        del self.stack[at:]
        return values

    def _mark(self, _: Any) -> None:
        self.stack.append(_MARK)

    def _empty_tuple(self, _: Any) -> None:
        self.stack.append(())

    def _tuple(self, _: Any) -> None:
        self.stack.append(tuple(self._marked()))

    def _take(self, count: int) -> None:
        values = tuple(self.stack[-count:])
        if len(values) < count:
            raise UnreadablePickleError("the stack is empty")
        del self.stack[-count:]
        self.stack.append(values)

    def _tuple1(self, _: Any) -> None:
        self._take(1)

    def _tuple2(self, _: Any) -> None:
        self._take(2)

    def _tuple3(self, _: Any) -> None:
        self._take(3)

    def _empty_list(self, _: Any) -> None:
        self.stack.append([])

    def _append(self, _: Any) -> None:
        self._extend([self.stack.pop()])

    def _appends(self, _: Any) -> None:
        self._extend(self._marked())

    def _extend(self, values: list[Any]) -> None:
        target = self.stack[-1]
        if type(target) is not list:
            raise UnreadablePickleError("something is appended to what is not a list")
        target.extend(values)

    def _empty_set(self, _: Any) -> None:
        self.stack.append(set())

    def _additems(self, _: Any) -> None:
        values, target = self._marked(), self.stack[-1]
        if type(target) is not set:
            raise UnreadablePickleError("something is added to what is not a set")
        target.update(_keys(values))

    def _empty_dict(self, _: Any) -> None:
        self.stack.append({})

    def _setitem(self, _: Any) -> None:
        value, key = self.stack.pop(), self.stack.pop()
        self._update([key, value])

    def _setitems(self, _: Any) -> None:
        self._update(self._marked())

    def _update(self, pairs: list[Any]) -> None:
        target = self.stack[-1]
        if type(target) is not dict:
            raise UnreadablePickleError("an item is set in what is not a dictionary")
        target.update(zip(_keys(pairs[::2]), pairs[1::2], strict=True))

    def _global(self, argument: str) -> None:
        self.stack.append(self._stand_in(argument.replace(" ", ".", 1)))

    def _stack_global(self, _: Any) -> None:
        name, module = self.stack.pop(), self.stack.pop()
        if not isinstance(name, str) or not isinstance(module, str):
            raise UnreadablePickleError("a class has no name")
        self.stack.append(self._stand_in(f"{module}.{name}"))

    def _stand_in(self, name: str) -> StandIn:
        found = self.lookup(name)
        if found is None:
            raise UnreadablePickleError(f"it asks for {name[:80]}, which no such model needs")
        return found

    def _reduce(self, _: Any) -> None:
        arguments, function = self.stack.pop(), self.stack.pop()
        if not isinstance(function, StandIn) or not isinstance(arguments, tuple):
            raise UnreadablePickleError("it calls what is not a function")
        self.stack.append(function.make(*arguments))

    _newobj = _reduce

    def _build(self, _: Any) -> None:
        state, target = self.stack.pop(), self.stack[-1]
        if isinstance(target, Saved):
            target.set_state(state)
        elif type(target) is not dict:  # attributes beside the items of an OrderedDict are of no use
            raise UnreadablePickleError("attributes are set on what has none")

    def _binpersid(self, _: Any) -> None:
        if self.persistent is None:
            raise UnreadablePickleError("it refers to something outside of the file")
        self.stack.append(self.persistent(self.stack.pop()))


def _keys(values: list[Any]) -> list[Any]:
    # The hash of a tuple of tuples of … can take forever.
    if not all(isinstance(value, str | int | float | bool) for value in values):
        raise UnreadablePickleError("a key is neither a text nor a number")
    return values
