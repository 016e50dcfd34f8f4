"""Files to which something happened: in their structure, in their text or in their bytes."""

import contextlib
import json
import random
import re
from collections.abc import Iterator
from typing import Any

INTERESTING: tuple[Any, ...] = (
    *(None, True, False, 0, 1, -1, 2, 63, 64, 65, 255, 256, 1 << 20, 1 << 31, 1 << 32, 1 << 63, 1 << 64),
    *(10**30, -(10**30), 0.5, -0.0, 1e-300, 1e308, float("nan"), float("inf")),
    *(
        "",
        " ",
        "0",
        "-1",
        "x" * 5000,
        "\0",
        "\ud800",
        "\n",
        "../../etc/passwd",
        "/dev/zero",
        "*/",
        "</script>",
    ),
    *("=1+1", "a|b", "\u202e", "\U0001f332", [], {}, [[]], [0] * 1000, {"": 0}),
)
"""Values that programs mistake."""

TOKENS = (
    *(
        b"",
        b"0",
        b"-1",
        b"00",
        b"1e999",
        b"NaN",
        b"9" * 400,
        b"9" * 5000,
        b"inf",
        b'"',
        b"'",
        b",",
        b";",
        b"\n",
    ),
    *(
        b"\r",
        b"\0",
        b"\xff",
        b"\xef\xbb\xbf",
        b"[",
        b"]",
        b"{",
        b"}",
        b"[" * 100_000,
        b"true",
        b"1_000",
        b"0x10",
    ),
    *(b"\xed\xa0\x80", b"x" * 200_000, b"=", b"#", b"1979-05-27", b"\\", b"/", b"-0", b".", b"1.", b"'''"),
)
"""Pieces of text that parsers mistake."""

_TOKEN = re.compile(rb"\w+|\s+|[^\w\s]")


def damaged(content: bytes, chance: random.Random) -> bytes:
    """A file that something happened to: in its structure, in its text, or in its bytes."""
    steps = [_bytes, _tokens]
    with contextlib.suppress(ValueError):
        json.loads(content)
        steps += [_structure] * 4
    for _ in range(chance.choice((1, 1, 1, 2, 5))):
        content = chance.choice(steps)(content, chance)
    return content


def _bytes(content: bytes, chance: random.Random) -> bytes:
    start, end = sorted(chance.randrange(len(content) + 1) for _ in range(2))
    end = min(end, start + chance.choice((1, 4, 64, 1 << 20)))
    flipped = bytes(byte ^ 1 << chance.randrange(8) for byte in content[start:end])
    rest = content[end:]
    return content[:start] + chance.choice(
        (flipped + rest, rest, b"", content[start:end] * 2 + rest, chance.randbytes(9) + content[start:])
    )


def _tokens(content: bytes, chance: random.Random) -> bytes:
    tokens = _TOKEN.findall(content[: 1 << 20]) or [b""]
    place = chance.randrange(len(tokens))
    match chance.randrange(4):
        case 0:
            tokens[place] = chance.choice(TOKENS)
        case 1:
            tokens[place] *= 2
        case 2:
            other = chance.randrange(len(tokens))
            tokens[place], tokens[other] = tokens[other], tokens[place]
        case _:
            tokens.insert(place, chance.choice(TOKENS))
    return b"".join(tokens)


def _structure(content: bytes, chance: random.Random) -> bytes:
    try:
        data = json.loads(content)
    except (ValueError, RecursionError):
        return _tokens(content, chance)
    places = [*_places(data)]
    if not places:
        return json.dumps(chance.choice(INTERESTING)).encode()
    holder, key = chance.choice(places)
    match chance.randrange(5):
        case 0:
            del holder[key]
        case 1 if isinstance(holder, list):
            holder.insert(key, holder[key])
        case 1:
            holder[str(chance.choice(INTERESTING))] = holder.pop(key)
        case 2:
            other, place = chance.choice(places)
            with contextlib.suppress(KeyError, IndexError):
                holder[key], other[place] = other[place], holder[key]
        case _:
            holder[key] = chance.choice(INTERESTING)
    try:
        return json.dumps(data).encode()
    except (ValueError, RecursionError):
        return content  # a value was put into itself


def _places(data: Any) -> Iterator[tuple[Any, Any]]:
    """Every place in a JSON value, but of long lists a few."""
    if isinstance(data, dict):
        keys: list[Any] = [*data]
    elif isinstance(data, list):
        keys = [*range(len(data))][:: max(1, len(data) // 20)]
    else:
        return
    for key in keys:
        yield data, key
        yield from _places(data[key])
