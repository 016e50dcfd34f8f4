# amaranth: UnusedElaboratable=no
"""Memories, enables and resets of registers in the emitted text."""

from collections.abc import Callable
from pathlib import Path

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Part
from wnn2hdl.emit import verilog
from wnn2hdl.tools import run_icarus

Draw = Callable[[Module, "Store"], None]


class Store(Part):
    """Four words of two bits."""

    module_name = "store"
    clocked = True
    clock = "aclk"

    def __init__(self, draw: Draw) -> None:
        self.draw = draw
        super().__init__({"at": In(2), "word": In(2), "puts": In(1), "clears": In(1), "found": Out(2)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        self.draw(m, self)
        return m


def _memory(
    m: Module, store: Store, *, init: tuple[int, ...] = (), writes: int = 1, domain: str = "sync"
) -> None:
    memory = Memory(shape=2, depth=4, init=init, attrs={"ram_style": "block"})
    m.submodules.words = memory
    read = memory.read_port(domain=domain)
    m.d.comb += [read.addr.eq(store.at), store.found.eq(read.data)]
    if domain == "sync":
        m.d.comb += read.en.eq(~store.puts)
    for _ in range(writes):
        write = memory.write_port()
        m.d.comb += [write.addr.eq(store.at), write.data.eq(store.word), write.en.eq(store.puts)]


def _counter(m: Module, store: Store) -> None:
    """Counts by two conditions, from 2."""
    count = Signal(2, init=2)
    with m.If(store.puts):
        m.d.sync += count.eq(count + store.word)
    with m.If(store.clears):
        m.d.sync += count.eq(0)
    m.d.comb += store.found.eq(count)


def _lines(draw: Draw) -> list[str]:
    return [line.strip() for line in verilog(Store(draw), prefix="x_", header=[]).splitlines()]


def test_a_memory_is_an_array_with_a_statement_for_each_port() -> None:
    lines = _lines(_memory)
    assert '(* ram_style = "block" *) reg [1:0] words [0:3];' in lines
    assert (
        "initial for (words_word = 0; words_word < 4; words_word = words_word + 1) words[words_word] = 2'h0;"
        in lines
    )
    assert "always @(posedge aclk) if (puts) words[at] <= word;" in lines
    assert any(
        line.startswith("always @(posedge aclk) if (") and line.endswith("<= words[at];") for line in lines
    )


def test_enables_and_resets_are_conditions() -> None:
    lines = _lines(_counter)
    assert "initial found = 2'h2;" in lines
    assert any(
        line.startswith("always @(posedge aclk) if (clears) found <= 2'h0; else if (puts) found <= ")
        for line in lines
    )


def test_an_adder_is_as_wide_as_what_is_read_of_it() -> None:
    assert any("wire [1:0]" in line and line.endswith("= found + word;") for line in _lines(_counter))


@pytest.mark.parametrize(
    "draw",
    [
        lambda m, store: _memory(m, store, init=(1, 2)),
        lambda m, store: _memory(m, store, writes=2),
        lambda m, store: _memory(m, store, domain="comb"),
    ],
)
def test_memories_of_other_kinds_are_refused(draw: Draw) -> None:
    with pytest.raises(NotImplementedError, match="words"):
        verilog(Store(draw), prefix="x_", header=[])


@pytest.mark.simulator
def test_what_was_written_is_read_in_icarus(tmp_path: Path) -> None:
    (tmp_path / "store.v").write_text(verilog(Store(_memory), prefix="x_", header=[]))
    (tmp_path / "bench.v").write_text(
        """module bench;
    reg aclk = 0, puts = 1; reg [1:0] at, word; wire [1:0] found; integer i;
    x_store dut (.aclk(aclk), .at(at), .word(word), .puts(puts), .clears(1'b0), .found(found));
    initial begin
        for (i = 0; i < 8; i = i + 1) begin
            puts = i < 4; at = i; word = ~i;
            #1 aclk = 1; #1 aclk = 0;
            if (!puts && found !== ~at) $stop;
        end
        $display("PASS");
    end
endmodule
"""
    )
    sources = [tmp_path / "store.v", tmp_path / "bench.v"]
    assert "PASS" in run_icarus(sources, "bench", cwd=tmp_path, timeout=60).output
