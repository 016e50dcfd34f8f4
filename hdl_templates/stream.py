"""A pipeline without a halt between two streams with back-pressure."""

from dataclasses import dataclass

from amaranth.hdl import Array, Module, Mux, Signal, Value


@dataclass(frozen=True)
class Head:
    """The end of a queue that is read.

    Attributes:
        valid: whether there is a word.
        word: the word, from a register.
    """

    valid: Signal
    word: Signal


def queued(
    m: Module,
    valid: Value,
    word: Value,
    *,
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
        valid: whether a beat of the stream is offered.
        word: what comes out of the pipeline, ``latency`` cycles after the beat that it belongs to.
        latency: cycles of the pipeline; 0 where ``word`` is a function of the beat.
        ready: driven here: whether the beat is taken.
        taken: whether the head is taken in this cycle, if there is one.

    Returns:
        The head.
    """
    places = latency + 1
    head = Head(Signal(name="head_valid"), Signal(len(word), name="head", reset_less=True))
    moves = Signal(name="head_moves")
    m.d.comb += moves.eq(~head.valid | taken)

    accepted = Signal(name="accepted")
    # Beats that were accepted and are not at the head yet.
    waiting = Signal(range(places + 1), name="waiting")
    m.d.comb += [ready.eq(waiting != places), accepted.eq(valid & ready)]
    arrives: Value = accepted
    for cycle in range(1, latency + 1):
        later = Signal(name=f"arrives_{cycle}")
        m.d.sync += later.eq(arrives)
        arrives = later

    stored = Signal(range(places + 1), name="stored") if latency else waiting
    any_stored = stored.any()
    leaves = Signal(name="leaves")
    stores = Signal(name="stores")
    m.d.comb += [
        leaves.eq(moves & (any_stored | arrives)),
        stores.eq(arrives & ~(moves & ~any_stored)),
    ]
    m.d.sync += waiting.eq(waiting + accepted - leaves)
    if latency:
        m.d.sync += stored.eq(stored + stores - (moves & any_stored))
    words = [Signal(len(word), name=f"stored_{place}", reset_less=True) for place in range(places)]
    with m.If(stores):
        m.d.sync += [later.eq(earlier) for earlier, later in zip([word, *words], words, strict=False)]
    oldest = Array(words)[(stored - 1)[: len(stored)]] if latency else words[0]
    with m.If(moves):
        m.d.sync += [head.valid.eq(any_stored | arrives), head.word.eq(Mux(any_stored, oldest, word))]
    return head
