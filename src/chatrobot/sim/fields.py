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
_FULL_WIDTH = "：，［］｛｝"
"""Of a Chinese keyboard: YAML takes them for letters."""


def read_text(path: Path, kind: type[InputError] = WorldError) -> str:
    """Return what stands in a file.

    Raises:
        InputError: of that kind; it cannot be read, or is no text.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise kind(f"cannot be read ({error.strerror})", where=str(path)) from error
    except UnicodeDecodeError as error:
        raise kind("cannot be read", where=str(path), allowed="YAML in UTF-8") from error


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

    def mapping(self, *allowed: str, required: tuple[str, ...] = ()) -> dict[str, Field]:
        """The fields of a mapping; none but the allowed ones, none missing, none twice.

        Raises:
            WorldError: says which, and what is allowed.
        """
        fields: dict[str, Field] = {}
        for key_node, value_node in self._pairs(allowed):
            key = str(key_node.value)
            field = Field(value_node, self._source, f"{self.name}.{key}" if self.name else key, self._error)
            if key not in allowed:
                near = difflib.get_close_matches(key, allowed, n=1)
                meant = f"did you mean {near[0]}? " if near else ""
                raise Field(key_node, self._source, field.name, self._error).error(
                    "unknown field", f"{meant}allowed: {', '.join(allowed)}"
                )
            if key in fields:
                raise field.error("is given twice")
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

    def text(self) -> str:
        """One line of text."""
        value = self._node.value
        if self._kind != "scalar" or not value.strip() or not value.isprintable():
            raise self.error("must be a line of text", "a word or two")
        return str(value.strip())

    def lines(self) -> str:
        """Text of one line or more."""
        value = self._node.value
        if self._kind != "scalar" or not value.strip() or not value.replace("\n", "").isprintable():
            raise self.error("must be a text", "on one line, or on several behind a |")
        return str(value.strip())

    def choice(self, *allowed: str) -> str:
        """One of some words."""
        text = self.text()
        if text not in allowed:
            raise self.error(f"{text!r} is not possible", f"allowed: {', '.join(allowed)}")
        return text

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
        mark = getattr(error, "problem_mark", None)
        where = f"{source}, line {mark.line + 1}" if mark else source
        problem = getattr(error, "problem", None) or str(error)
        raise kind(f"is not YAML: {problem}", where=where, allowed=_hint(problem)) from error
    except RecursionError as error:
        raise kind("is nested too deeply", where=source) from error
    if node is None:
        raise kind("is empty", where=source, allowed=holds)
    return Field(node, source, "", kind)


def _hint(problem: str) -> str:
    """What most who see that problem have to change."""
    if "cannot start any token" in problem:
        return "spaces to indent, no tabs; quotes around a text that begins with @, % or `"
    if "mapping values" in problem:
        return "one 'name: value' a line; quote a text that has a colon in it"
    if "expected ',' or" in problem:
        return "a comma between entries, and every { and [ closed"
    return "'name: value', indented by spaces as in chatrobot world new FILE"
