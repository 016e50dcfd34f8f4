"""The straightforward Verilog that networks are compared with is the model, too."""

import pytest

from benchmarks.plain import TOP, plain_verilog
from tests.small_networks import lut_network, wisard
from tests.small_sums import sum_network
from wnn2hdl.verify.equivalence import Circuit, find_differences
from wnn2hdl.verify.specify import specify


@pytest.mark.slow
def test_straightforward_verilog_equals_the_reference() -> None:
    pairs = []
    for model in (lut_network(3, layers=(8, 6)), wisard(3), wisard(4, ties="first"), sum_network(3)):
        specification = specify(model, None, {})
        claim = specification.claims["network"]
        reference = Circuit((specification.reference,), claim.module)
        pairs.append((Circuit((plain_verilog(model),), TOP), reference))
    assert find_differences(pairs, timeout=300) == [None] * len(pairs)
