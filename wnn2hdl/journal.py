"""Records in a file that only grows, so that what a killed process had finished is kept."""

import json
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

from wnn2hdl.errors import InputError


class Journal:
    """The finished parts of long work.

    The file's first line is the identity as JSON. A record follows another: a line with the CRC-32 of its
    content in hexadecimal and its length in bytes, the content, and the end of a line. What a killed process
    left half-written at the end is not a record, nor is anything after a damaged one. A file of another
    identity holds no records.

    Opening only reads; the first `append` makes the file and cuts off what is not sound. So
    any process may read, and the one that holds the folder (`wnn2hdl.files.output_folder`) may append.

    Args:
        path: the file.
        identity: a JSON object of everything that decides the records.

    Raises:
        InputError: the file is there and cannot be read.
    """

    def __init__(self, path: Path, identity: Mapping[str, Any]) -> None:
        self._path = path
        self._head = json.dumps(identity, sort_keys=True).encode() + b"\n"
        self._end = 0
        self._reader: BinaryIO | None = None
        self._writer: BinaryIO | None = None
        try:
            self._reader = path.open("rb")
            self._end = self._sound_end(self._reader)
        except FileNotFoundError:
            pass
        except OSError as error:
            raise InputError("cannot read the journal", value=f"{path} ({error.strerror})") from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for stream in (self._reader, self._writer):
            if stream is not None:
                stream.close()

    def __iter__(self) -> Iterator[tuple[int, bytes]]:
        """Place and content of each record, in the order in which they were appended."""
        place = len(self._head)
        while place < self._end:
            content, following = self._record(place)
            yield place, content
            place = following

    def append(self, content: bytes) -> int:
        """Add a record.

        Returns:
            its place, for `read`.

        Raises:
            InputError: the file cannot be written, or the disk is full; the record is then not there.
        """
        try:
            if self._writer is None:
                self._writer = self._open_writer()
            place, block = self._end, _framed(content)
            self._put(self._writer, place, block)
        except OSError as error:
            raise InputError(
                "cannot write",
                value=f"{self._path} ({error.strerror})",
                hint="choose a folder you may write to, with room in it; what is finished is kept",
            ) from error
        self._end = place + len(block)
        return place

    def read(self, place: int) -> bytes:
        """The content of the record at a place."""
        return self._record(place)[0]

    def _record(self, place: int) -> tuple[bytes, int]:
        """The content of the record at a place, and the place after it."""
        if self._reader is None:
            self._reader = self._path.open("rb")
        self._reader.seek(place)
        _, length = self._reader.readline().split()
        content = self._reader.read(int(length))
        # The end of a line closes the record.
        return content, self._reader.tell() + 1

    def _sound_end(self, stream: BinaryIO) -> int:
        """Where the sound part of the file ends; 0 if it has another identity."""
        if stream.read(len(self._head)) != self._head:
            return 0
        end = len(self._head)
        while _next(stream) is not None:
            end = stream.tell()
        return end

    def _open_writer(self) -> BinaryIO:
        self._path.touch()
        # Unbuffered: what is appended is in the file's hands when `append` returns.
        stream = self._path.open("r+b", buffering=0)
        try:
            if self._end == 0:
                self._put(stream, 0, self._head)
                self._end = len(self._head)
            stream.truncate(self._end)
        except BaseException:
            stream.close()
            raise
        return stream

    @staticmethod
    def _put(stream: BinaryIO, place: int, block: bytes) -> None:
        stream.seek(place)
        while block:
            block = block[stream.write(block) :]


def _framed(content: bytes) -> bytes:
    return b"%08x %d\n%b\n" % (zlib.crc32(content), len(content), content)


def _next(stream: BinaryIO) -> bytes | None:
    """The content of the next record; None if there is no sound one."""
    # A sound head is short: a damaged file may have no other line.
    head = stream.readline(32).split()
    if len(head) != 2 or not head[1].isdigit():
        return None
    content = stream.read(int(head[1]))
    sound = len(content) == int(head[1]) and head[0] == b"%08x" % zlib.crc32(content)
    return content if sound and stream.read(1) == b"\n" else None
