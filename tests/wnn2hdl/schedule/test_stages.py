"""Schedules as JSON."""

import json
from typing import Any

import pytest

from tests.wnn2hdl.schedule.conftest import chain
from wnn2hdl.schedule import Stages, for_stages


def test_a_schedule_comes_back_as_it_was_saved() -> None:
    stages = for_stages(chain(4), 2)
    assert Stages.from_json(json.loads(json.dumps(stages.to_json()))) == stages


@pytest.mark.parametrize(
    "data",
    [
        None,
        {},
        {"stages": {"chain": {"parity": {"t0": -1}}}, "latencies": {"chain": 1}, "period_ps": 1},
        {"stages": {"chain": {"parity": {"t0": 0.5}}}, "latencies": {"chain": 1}, "period_ps": 1},
        {"stages": [], "latencies": {}, "period_ps": 1},
        {"stages": {}, "latencies": {"chain": True}, "period_ps": 1},
    ],
)
def test_anything_else_is_refused(data: Any) -> None:
    with pytest.raises((ValueError, KeyError, TypeError, AttributeError)):
        Stages.from_json(data)
