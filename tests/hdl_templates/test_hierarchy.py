# amaranth: UnusedElaboratable=no
"""Parts as submodules and as instances."""

from amaranth.hdl import Fragment, Module
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Emission, Part, place
from hdl_templates.matcher import draw_match


class Matcher(Part):
    """Counts the places in which nine bits agree.

    It is combinational.
    """

    module_name = "matcher"

    def __init__(self) -> None:
        super().__init__({"bits": In(9), "reference_bits": In(9), "match_count": Out(4)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        count = draw_match(m, self.bits, self.reference_bits, name="match", platform=platform)
        m.d.comb += self.match_count.eq(count)
        return m


class Delay(Part):
    """One register."""

    module_name = "delay"
    clocked = True

    def __init__(self) -> None:
        super().__init__({"data": In(1), "late": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.d.sync += self.late.eq(self.data)
        return m


def test_an_emission_collects_each_part_once_and_names_it_with_the_prefix() -> None:
    emission = Emission("aerial_")
    Fragment.get(Matcher(), emission)
    assert list(emission.parts) == ["aerial_match_3", "aerial_compress_3_3_to_4"]
    assert emission.module(Matcher()) == "aerial_matcher"


def test_a_simulation_has_plain_submodules() -> None:
    fragment = Fragment.get(Matcher(), None)
    names = ["match_compare_0", "match_compare_1", "match_compare_2", "match_add_0"]
    assert [name for _, name, _ in fragment.subfragments] == names


def test_clocked_parts_are_connected_to_the_clock() -> None:
    m = Module()
    place(m, "one", Delay(), Emission())
    ((instance, name, _),) = Fragment.get(m, None).subfragments
    assert (name, instance.type, sorted(instance.ports)) == ("one", "delay", ["clk", "data", "late"])


def test_the_summary_of_a_part_is_the_first_line_of_its_docstring() -> None:
    assert Matcher().summary == "Counts the places in which nine bits agree."
