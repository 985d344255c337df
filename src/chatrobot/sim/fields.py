"""A YAML file read field by field: every mistake is told by its file, its line, what is wrong and what is allowed."""

from __future__ import annotations

import difflib
import math
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.core.errors import InputError, WorldError
from chatrobot.sim.shapes import Point

if TYPE_CHECKING:
    import yaml

MAX_COORDINATE_M = 1000.0
MAX_BYTES = 5_000_000
"""Of a file: more than that would be read for minutes."""
MAX_NAME_CHARACTERS = 80
"""As of a place in plan text."""
_FULL_WIDTH = "：，［］｛｝"
"""Of a Chinese keyboard: YAML takes them for letters."""


def read_text(path: Path, kind: type[InputError] = WorldError) -> str:
    """Return what stands in a file.

    Raises:
        InputError: of that kind; it cannot be read, or is no text.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
        if len(data) > MAX_BYTES:
            raise kind("is too large", where=str(path), allowed=f"{MAX_BYTES // 1_000_000} MB at most")
        return data.decode("utf-8-sig")
    except OSError as error:
        raise kind(f"cannot be read ({error.strerror})", where=str(path), allowed="a YAML file") from error
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise kind(
            "is no text in UTF-8", where=f"{path}, line {line}", allowed="YAML saved as UTF-8"
        ) from error


class Field:
    """A node of the file that knows its name and line; `kind` is the error that is raised for it."""

    def __init__(self, node: yaml.Node, source: str, name: str, kind: type[InputError] = WorldError) -> None:
        self._node = node
        self._error = kind
        self._kind: str = node.id  # type: ignore[attr-defined]  # "scalar", "sequence" or "mapping"
        self._source = source
        self.name = name

    @property
    def where(self) -> str:
        """The file and the line it stands in."""
        return f"{self._source}, line {self._node.start_mark.line + 1}"

    @property
    def is_mapping(self) -> bool:
        """It has fields of its own."""
        return self._kind == "mapping"

    @property
    def is_list(self) -> bool:
        """It has entries."""
        return self._kind == "sequence"

    def error(self, problem: str, allowed: str = "") -> InputError:
        """Make the error that says what is wrong here."""
        what = f"{self.name}: {problem}" if self.name else problem
        return self._error(what, where=self.where, allowed=allowed)

    def unknown(self, problem: str, allowed: tuple[str, ...]) -> InputError:
        """Make the error for a word that is none of those that are allowed."""
        return self.error(problem, f"{_meant(str(self._node.value), allowed)}allowed: {', '.join(allowed)}")

    def mapping(self, *allowed: str, required: tuple[str, ...] = ()) -> dict[str, Field]:
        """The fields of a mapping; none but the allowed ones, none missing, none twice.

        Raises:
            WorldError: says which, and what is allowed.
        """
        fields: dict[str, Field] = {}
        for key_node, value_node in self._pairs(allowed):
            key = key_node.value if isinstance(key_node.value, str) else "[…]"
            field = Field(value_node, self._source, f"{self.name}.{key}" if self.name else key, self._error)
            if key not in allowed:
                raise Field(key_node, self._source, field.name, self._error).unknown("unknown field", allowed)
            if key in fields:
                raise field.error("is given twice", "once")
            fields[key] = field
        for key in required:
            if key not in fields:
                raise self.error(f"{key} is missing", f"required: {', '.join(required)}")
        return fields

    def has(self, key: str) -> bool:
        """Return whether it is a mapping with that field."""
        return self._kind == "mapping" and any(node.value == key for node, _ in self._node.value)

    def _pairs(self, allowed: tuple[str, ...]) -> list[tuple[yaml.Node, yaml.Node]]:
        if self._kind != "mapping":
            raise self.error(
                "must be a mapping of fields", f"allowed: {', '.join(allowed)}{self._keyboard()}"
            )
        pairs: list[tuple[yaml.Node, yaml.Node]] = self._node.value
        return pairs

    def _keyboard(self) -> str:
        is_typed = self._kind == "scalar" and any(char in _FULL_WIDTH for char in self._node.value)
        return "; type : and , in half width, with a space behind" if is_typed else ""

    def items(self) -> list[Field]:
        """The entries of a list."""
        if self._kind != "sequence":
            raise self.error("must be a list", "[a, b], or a line with - for each")
        return [
            Field(node, self._source, f"{self.name}[{i}]", self._error)
            for i, node in enumerate(self._node.value)
        ]

    def filled(self) -> list[Field]:
        """The entries of a list that has some."""
        entries = self.items()
        if not entries:
            raise self.error("is empty", "one entry at least")
        return entries

    def text(self) -> str:
        """One line of text."""
        value = self._node.value
        if self._kind != "scalar" or not value.strip() or not value.isprintable():
            raise self.error("must be a line of text", "a word or two")
        return str(value.strip())

    def called(self) -> str:
        """What something is called."""
        name = self.text()
        if len(name) > MAX_NAME_CHARACTERS:
            raise self.error(f"has {len(name)} characters", f"{MAX_NAME_CHARACTERS} at most")
        return name

    def lines(self) -> str:
        """Text of one line or more."""
        value = self._node.value
        if self._kind != "scalar" or not value.strip() or not value.replace("\n", "").isprintable():
            raise self.error("must be a text", "on one line, or on several behind a |")
        return str(value.strip())

    def choice(self, *allowed: str) -> str:
        """One of some words."""
        text = self._node.value if self._kind == "scalar" else ""
        if text not in allowed:
            raise self.unknown(f"{text!r} is not possible", allowed)
        return str(text)

    def number(self, least: float = -MAX_COORDINATE_M, most: float = MAX_COORDINATE_M) -> float:
        """A number from `least` to `most`."""
        allowed = f"a number from {least:g} to {most:g}"
        if self._kind != "scalar":
            raise self.error("must be a number", allowed)
        try:
            value = float(self._node.value)
        except ValueError:
            raise self.error(f"{self._node.value!r} is not a number", allowed) from None
        if not (math.isfinite(value) and least <= value <= most):
            raise self.error(f"{self._node.value} is not possible", allowed)
        return value

    def size(self) -> float:
        """A length above zero."""
        return self.number(least=0.001)

    def point(self) -> Point:
        """Two coordinates."""
        pair = self.items()
        if len(pair) != 2:
            raise self.error(f"a point has two numbers, not {len(pair)}", "[x, y]")
        return pair[0].number(), pair[1].number()


def compose(
    text: str,
    source: str,
    kind: type[InputError] = WorldError,
    holds: str = "a world has obstacles, places and a start",
) -> Field:
    """Return the root of a YAML text; `source` is what errors call it, `holds` says what is in such a file.

    Raises:
        InputError: of that kind; it is empty, or no YAML.
    """
    import yaml  # late: an empty world needs none

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        node = yaml.compose(text, Loader=loader)
    except yaml.YAMLError as error:
        problem = getattr(error, "problem", None) or getattr(error, "reason", None) or str(error)
        where = f"{source}, line {_line_of(error, text)}"
        raise kind(f"is not YAML: {problem}", where=where, allowed=_hint(problem)) from error
    except RecursionError as error:
        raise kind("is nested too deeply", where=source) from error
    if node is None:
        raise kind("is empty", where=source, allowed=holds)
    return Field(node, source, "", kind)


def _line_of(error: yaml.YAMLError, text: str) -> int:
    """Where it went wrong: where a text begins that never ends, else where the reader stood."""
    begun, stood = getattr(error, "context_mark", None), getattr(error, "problem_mark", None)
    mark = begun if begun is not None and _NO_END in str(getattr(error, "problem", "")) else stood
    if mark is not None:
        return int(mark.line) + 1
    before = text.encode("utf-8", "replace")[: getattr(error, "position", 0)]
    return before.count(b"\n") + 1


_NO_END = "end of stream"
_HINTS = {
    "cannot start any token": "spaces to indent, no tabs; quotes around a text that begins with @, % or `",
    "tab character": "spaces to indent, no tabs",
    "mapping values": "one 'name: value' a line; quote a text that has a colon in it",
    "expected ',' or": "a comma between entries, : and , in half width, and every { and [ closed",
    _NO_END: "each quotation mark closed",
    "alias": "quotes around a text that begins with * or &",
    "another document": "one document a file: no line with ---",
    "'-' indicator": "all entries of a list indented alike",
    "control characters": "plain text: delete that character",
}
"""What most who see a problem have to change, by words of it."""


def _hint(problem: str) -> str:
    told = (hint for words, hint in _HINTS.items() if words in problem)
    return next(told, "'name: value', indented by spaces as in chatrobot world new FILE")


def _meant(key: str, allowed: tuple[str, ...]) -> str:
    if key.isdecimal():
        return "a number has a decimal point, no comma; "
    near = difflib.get_close_matches(key, allowed, n=1)
    return f"did you mean {near[0]}? " if near else ""
