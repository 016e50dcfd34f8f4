# amaranth: UnusedElaboratable=no
"""Winner-takes-all."""

from typing import Literal

import numpy as np
import pytest
from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from hdl_templates.hierarchy import Part
from hdl_templates.winner import draw_winner
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.verify.simulation import simulate

Tie = Literal["first", "last"]


class Winner(Part):
    """The index of the largest of several words."""

    module_name = "winner"

    def __init__(self, *, widths: tuple[int, ...], tie: Tie) -> None:
        self.tie = tie
        self.words = [f"word{i}" for i in range(len(widths))]
        ports = {name: In(width) for name, width in zip(self.words, widths, strict=True)}
        super().__init__(ports | {"index": Out((len(widths) - 1).bit_length())})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        words = [getattr(self, name) for name in self.words]
        m.d.comb += self.index.eq(draw_winner(m, words, tie=self.tie, name="winner"))
        return m


@pytest.mark.parametrize("tie", ["first", "last"])
@pytest.mark.parametrize("widths", [(1, 1), (2, 1, 3), (2, 2, 2, 2), (1, 3, 2, 1, 3)])
def test_the_largest_word_wins_and_the_rule_decides_ties(widths: tuple[int, ...], tie: Tie) -> None:
    codes = np.arange(1 << sum(widths))
    words = [codes >> sum(widths[:i]) & ((1 << width) - 1) for i, width in enumerate(widths)]
    largest = np.max(words, axis=0)
    order = range(len(words)) if tie == "first" else reversed(range(len(words)))
    winner = np.select([words[i] == largest for i in order], list(range(len(words))))
    if tie == "last":
        winner = len(words) - 1 - winner
    inputs = {f"word{i}": codes_to_bits(words[i], width) for i, width in enumerate(widths)}
    index = codes_to_bits(winner, (len(words) - 1).bit_length())
    simulate(Winner(widths=widths, tie=tie), inputs, {"index": index})


def test_a_simulator_takes_many_words() -> None:
    """Nested expressions would be of a size that is exponential in the levels of the tree."""
    assert Simulator(Winner(widths=(8,) * 100, tie="first"))
