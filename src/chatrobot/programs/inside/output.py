"""What the program prints, line by line to the host."""

from __future__ import annotations

import io
from typing import Any

from chatrobot.programs.inside.link import Link


class PipeStream(io.TextIOBase):
    """Stands for `sys.stdout` or `sys.stderr`."""

    encoding = "utf-8"
    errors = "replace"

    def __init__(self, link: Link, name: str) -> None:
        self.name = name
        self._link = link
        self._line = ""
        self.buffer = _Bytes(self)

    def writable(self) -> bool:
        return True

    def write(self, text: str) -> int:
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        *lines, self._line = (self._line + text).split("\n")
        for line in lines:
            self._link.output(self.name, line)
        return len(text)

    def flush(self) -> None:
        if self._line:
            line, self._line = self._line, ""
            self._link.output(self.name, line)


class _Bytes(io.RawIOBase):
    def __init__(self, text: PipeStream) -> None:
        self._text = text

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self._text.write(bytes(data).decode(errors="replace"))
        return len(data)
