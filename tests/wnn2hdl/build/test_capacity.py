import pytest

from wnn2hdl.build.capacity import require_capacity
from wnn2hdl.errors import InputError
from wnn2hdl.synth import XC7Z020


def test_what_the_device_has_may_be_taken() -> None:
    require_capacity(XC7Z020.luts)


def test_a_circuit_that_cannot_fit_is_refused_with_the_estimate() -> None:
    with pytest.raises(InputError) as error:
        require_capacity(XC7Z020.luts + 1)
    assert error.value.exit_status == 2
    assert str(error.value) == (
        "the circuit is estimated to take more LUTs than the device has: about 53,201 of the 53,200 of an "
        "xc7z020clg484; use a smaller model, or allow more with --max-luts 53201"
    )


def test_the_user_may_allow_a_larger_one() -> None:
    require_capacity(300_000, 300_000)
    with pytest.raises(InputError, match="about 300,001"):
        require_capacity(300_001, 300_000)


def test_fewer_allowed_luts_are_a_matter_of_the_count_not_of_the_estimate() -> None:
    require_capacity(100, 50)
