"""How far long work is: a callback that every long job calls, and a loop that calls it."""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

Progress = Callable[[str, int, int], None]
"""``progress(step, done, total)``: what is being done and how much of it is finished."""

Item = TypeVar("Item")


def reported(items: Iterable[Item], step: str, total: int, progress: Progress) -> Iterator[Item]:
    """Yield items one by one; report before the first one and whenever one is finished.

    Args:
        items: what is worked through.
        step: what is being done.
        total: how many items there are; nothing is reported if it is 0.
        progress: the callback.
    """
    if total:
        progress(step, 0, total)
    for done, item in enumerate(items, start=1):
        yield item
        progress(step, done, total)
