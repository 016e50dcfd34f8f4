"""Warnings of libraries, muted or recorded while several threads run.

Python's filters belong to the whole process. A thread that ends a `warnings.catch_warnings` brings back the
filters that it found, and with them another thread's; so one thread at a time changes them, and only here.
"""

import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

_ONE_THREAD = threading.RLock()


@contextmanager
def muted(category: type[Warning] = Warning, *, message: str = "") -> Iterator[None]:
    """Without the warnings of a category whose text begins as the regular expression ``message`` says.

    No other thread mutes or records meanwhile, so what takes long belongs outside.
    """
    with _ONE_THREAD, warnings.catch_warnings():
        warnings.filterwarnings("ignore", message, category)
        yield


@contextmanager
def recorded() -> Iterator[list[warnings.WarningMessage]]:
    """A list to which every warning is added instead of being shown."""
    with _ONE_THREAD, warnings.catch_warnings(record=True, action="always") as noted:
        yield noted
