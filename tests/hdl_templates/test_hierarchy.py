"""Parts as submodules and as instances."""

from amaranth.hdl import Fragment

from hdl_templates.bit_match import Parameters
from hdl_templates.hierarchy import Emission


def test_an_emission_collects_each_part_once() -> None:
    emission = Emission()
    Fragment.get(Parameters(9).create(), emission)
    assert list(emission.parts) == ["match_3", "compress_3_3_to_4"]


def test_a_simulation_has_plain_submodules() -> None:
    fragment = Fragment.get(Parameters(9).create(), None)
    assert [name for _, name, _ in fragment.subfragments] == ["compare_0", "compare_1", "compare_2", "add_0"]
