"""What stands between two streams with back-pressure: a pipeline without a halt, or a register."""

from dataclasses import dataclass

from amaranth.hdl import Module, Mux, Signal, Value

CHAIN = 16
"""Choices inside one another, at most: Amaranth's simulator writes Python, which nests 100 levels."""


@dataclass(frozen=True)
class Head:
    """The end of a queue that is read.

    Attributes:
        valid: whether there is a word.
        word: the word, from a register.
    """

    valid: Signal
    word: Signal


def named(m: Module, name: str, value: Value) -> Signal:
    """A signal that is the value."""
    signal = Signal(value.shape(), name=name)
    m.d.comb += signal.eq(value)
    return signal


def registered(m: Module, name: str, *, valid: Value, word: Value, ready: Value, taken: Value) -> Head:
    """Hold one word of a stream in a register; one passes in each cycle in which it is taken.

    Args:
        m: the module under construction.
        name: what the names of the registers begin with.
        valid: whether a word is offered.
        word: the word.
        ready: driven here: whether it is taken. It follows ``taken`` without a register, so this must depend
            on registers alone.
        taken: whether the head is taken in this cycle, if there is one.
    """
    head = Head(Signal(name=f"{name}_head_valid"), Signal(len(word), name=f"{name}_head", reset_less=True))
    moves = Signal(name=f"{name}_head_moves")
    m.d.comb += [moves.eq(~head.valid | taken), ready.eq(moves)]
    with m.If(moves):
        m.d.sync += [head.valid.eq(valid), head.word.eq(word)]
    return head


def queued(
    m: Module,
    name: str,
    *,
    valid: Value,
    word: Value,
    latency: int,
    ready: Value,
    taken: Value,
) -> Head:
    """Queue the words that come out of a pipeline, so that the stream in front of it can be held back.

    The pipeline runs freely: what is in it when its reader stops has a place in the queue. ``ready`` depends
    on registers only, and a word passes in each cycle as long as the reader takes one in each.

    Registers of words keep their contents at a reset. `amaranth.lib.fifo` would keep the words in a memory;
    so short a queue costs less as a shift register (measured with Yosys 0.70: see the tests).

    Args:
        m: the module under construction.
        name: what the names of the registers begin with.
        valid: whether a beat of the stream is offered.
        word: what comes out of the pipeline, ``latency`` cycles after the beat that it belongs to.
        latency: cycles of the pipeline; 0 where ``word`` is a function of the beat.
        ready: driven here: whether the beat is taken.
        taken: whether the head is taken in this cycle, if there is one.

    Returns:
        The head.
    """
    places = latency + 1
    head = Head(Signal(name=f"{name}_head_valid"), Signal(len(word), name=f"{name}_head", reset_less=True))
    moves = Signal(name=f"{name}_head_moves")
    m.d.comb += moves.eq(~head.valid | taken)

    # Whether another beat has a place: of its own, since a pipeline before the queue moves by it.
    room = Signal(name=f"{name}_room", init=1)
    accepted = Signal(name=f"{name}_accepted")
    m.d.comb += [ready.eq(room), accepted.eq(valid & room)]
    arrives: Value = accepted
    for cycle in range(1, latency + 1):
        later = Signal(name=f"{name}_arrives_{cycle}")
        m.d.sync += later.eq(arrives)
        arrives = later

    stored = Signal(range(places + 1), name=f"{name}_stored") if latency else ~room
    any_stored = stored.any()
    leaves = Signal(name=f"{name}_leaves")
    stores = Signal(name=f"{name}_stores")
    m.d.comb += [
        leaves.eq(moves & (any_stored | arrives)),
        stores.eq(arrives & ~(moves & ~any_stored)),
    ]
    if latency:
        # Beats that were accepted and are not at the head yet.
        waiting = Signal(range(places + 1), name=f"{name}_waiting")
        waits = Signal(range(places + 1), name=f"{name}_waits")
        m.d.comb += waits.eq(waiting + accepted - leaves)
        m.d.sync += [
            waiting.eq(waits),
            room.eq(waits != places),
            stored.eq(stored + stores - (moves & any_stored)),
        ]
    else:
        m.d.sync += room.eq(moves | (room & ~valid))
    words = [Signal(len(word), name=f"{name}_stored_{place}", reset_less=True) for place in range(places)]
    with m.If(stores):
        m.d.sync += [later.eq(earlier) for earlier, later in zip([word, *words], words, strict=False)]
    oldest: Value = words[0]
    for place, later in enumerate(words[1:], start=1):
        if place % CHAIN == 0:
            oldest = named(m, f"{name}_oldest_{place}", oldest)
        oldest = Mux(stored == place + 1, later, oldest)
    with m.If(moves):
        m.d.sync += [head.valid.eq(any_stored | arrives), head.word.eq(Mux(any_stored, oldest, word))]
    return head
