"""What all pages have in common: the templates they extend, and figures as people read them."""

import json
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from markupsafe import Markup

from wnn2hdl.errors import printable
from wnn2hdl.markdown import MISSING

if TYPE_CHECKING:
    from jinja2 import Environment


def environment(*packages: str) -> "Environment":
    """The templates of this package, and of others that extend them.

    Every value is escaped, and none holds control characters.
    """
    # Not at the top: commands that write no page need not wait for it.
    from jinja2 import ChoiceLoader, Environment, PackageLoader

    loader = ChoiceLoader([PackageLoader(name) for name in ("wnn2hdl.report", *packages)])
    return Environment(loader=loader, autoescape=True, finalize=_inert, trim_blocks=True, lstrip_blocks=True)


def _inert(value: Any) -> Any:
    """A value of a page: of a name with line breaks the lines stay, so that a quoted name can be copied."""
    return "\n".join(map(printable, value.split("\n"))) if type(value) is str else value


def figures_of(report: Mapping[str, Any]) -> Callable[..., Markup]:
    """A function that writes the figure at a path of a report, as an element that names the path."""

    def figure(key: str, kind: str = "count") -> Markup:
        value: Any = report
        for step in key.split("."):
            value = value[int(step)] if isinstance(value, Sequence) else value.get(step)
        return data_element(key, value, kind)

    return figure


def data_element(key: str, value: Any, kind: str) -> Markup:
    """A figure as a ``data`` element."""
    return Markup('<data data-key="{}" value="{}">{}</data>').format(
        key, json.dumps(value), form(value, kind)
    )


def form(value: Any, kind: str = "count") -> str:
    """A figure as a person reads it.

    Args:
        value: the figure; None was not measured.
        kind: ``count``, ``percent`` (of a share from 0 to 1), ``points`` (percent already), ``ps``,
            ``seconds``, ``plain_seconds`` or ``text``.
    """
    if value is None:
        return MISSING
    match kind:
        case "percent":
            return percent(value)
        case "points":
            return f"{value:.3f} %" if value else "0 %"
        case "ps":
            return f"{value:,} ps"
        case "seconds":
            return f"{value:.2f} s"
        case "plain_seconds":
            return f"{value:.2f}"
        case "text":
            return str(value)
    return f"{value:,}" if isinstance(value, int) else f"{value:,g}"


def percent(share: float) -> str:
    """A share from 0 to 1 with two decimals, or with as many as keep it from reading as 0 or 100 %."""
    digits = 2
    while 0 < share < 1 and float(f"{100 * share:.{digits}f}") in (0, 100) and digits < 12:
        digits += 1
    return f"{100 * share:.{digits}f} %"
