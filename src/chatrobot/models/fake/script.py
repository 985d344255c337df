"""Reads the script of a fake model, in YAML (docs/models.md describes it for users)."""

from __future__ import annotations

import math
import re
import threading
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from chatrobot.core.errors import InputError

_TOKEN = re.compile(r"\s*\S{1,4}|\s+")
_HUGE_PIECE = "na " * 1365
"""4 kB: what a huge reply is made of."""
_COUNTS = frozenset({"times", "cut_off_after", "hang_after", "prompt_tokens", "cached_tokens"})
_AMOUNTS = frozenset({"tokens_per_s", "first_piece_s", "huge_mb", "retry_after_s"})
_TEXTS = frozenset(
    {"refusal", "finish", "raw", "content_type", "message", "code", "body", "name", "arguments"}
)
_TOP = ("model", "models", "keys", "tokens_per_s", "first_piece_s", "replies", "otherwise")


class ScriptError(InputError):
    """Raised for a script that cannot be used."""


@dataclass(frozen=True)
class HttpError:
    """Answer that is an error. `body` replaces the provider's usual form."""

    status: int = 500
    message: str = "the script says so"
    code: str = ""
    retry_after_s: float | None = None
    body: str | None = None


@dataclass(frozen=True)
class ToolCall:
    """Call of a tool that nobody offered."""

    name: str
    arguments: str = "{}"


@dataclass(frozen=True)
class Answer:
    """Answer to one call. Counts are in tokens (about four characters), times in seconds."""

    text: str = ""
    match: re.Pattern[str] | None = None
    times: int | None = None
    tokens_per_s: float = 0.0
    first_piece_s: float = 0.0
    error: HttpError | None = None
    cut_off_after: int | None = None
    hang_after: int | None = None
    refusal: str = ""
    tool_calls: tuple[ToolCall, ...] = ()
    huge_mb: float = 0.0
    finish: str = "stop"
    raw: str | None = None
    content_type: str = "text/event-stream"
    prompt_tokens: int | None = None
    cached_tokens: int = 0
    uncounted: bool = False

    def tokens(self, said: str) -> list[str]:
        """Return the reply to what was said, piece by piece; joined it is the text to the letter."""
        text = self.text
        found = self.match.search(said) if self.match is not None else None
        for index, group in enumerate(found.groups() if found else (), start=1):
            text = text.replace(f"{{{index}}}", group or "")
        return _TOKEN.findall(text) + [_HUGE_PIECE] * int(self.huge_mb * 1e6 / len(_HUGE_PIECE))

    @property
    def reason(self) -> str:
        """Return why it ends, in OpenAI's words."""
        if self.refusal:
            return "content_filter"
        return "tool_calls" if self.tool_calls else self.finish


@dataclass
class Script:
    """Answers in order; locked, as calls may come at the same time."""

    answers: tuple[Answer, ...]
    models: tuple[str, ...] = ("fake",)
    keys: tuple[str, ...] = ()
    otherwise: Answer = field(
        default_factory=lambda: Answer(
            error=HttpError(500, "the script has no answer for this", "script_ended")
        )
    )
    _served: dict[int, int] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def answer(self, said: str) -> Answer:
        """Return the first answer that fits and is not used up."""
        with self._lock:
            for index, answer in enumerate(self.answers):
                limit = answer.times if answer.times is not None else None if answer.match else 1
                if limit is not None and self._served.get(index, 0) >= limit:
                    continue
                if answer.match is None or answer.match.search(said):
                    self._served[index] = self._served.get(index, 0) + 1
                    return answer
            return self.otherwise


def load_script(path: Path) -> Script:
    """Read a script.

    Raises:
        ScriptError: the file, what is wrong in it and what is allowed.
    """
    import yaml

    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ScriptError(error.strerror or "cannot be read", where=str(path)) from None
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        raise ScriptError(" ".join(str(error).split()), where=str(path), allowed="a YAML file") from None
    return read_script(data, where=str(path))


def read_script(data: Any, where: str = "script") -> Script:
    """Read a script from what YAML gave.

    Raises:
        ScriptError: what is wrong in it and what is allowed.
    """
    given = _mapping({"replies": data} if isinstance(data, list) else data, _TOP, where)
    usual: dict[str, Any] = {key: given[key] for key in ("tokens_per_s", "first_piece_s") if key in given}
    rows = given.get("replies", [])
    if not isinstance(rows, list):
        raise ScriptError("replies is no list", where=where, allowed="replies: [{text: …}, …]")
    answers = (_answer(row, usual, f"{where}: reply {number}") for number, row in enumerate(rows, start=1))
    models = _names_in(given, "models", where) or (str(given.get("model", "fake")),)
    if not isinstance(given.get("model", ""), str):
        raise ScriptError("model is no text", where=where, allowed="model: NAME, or models: [NAME, …]")
    script = Script(tuple(answers), models, _names_in(given, "keys", where))
    if "otherwise" in given:
        script.otherwise = _answer(given["otherwise"], usual, f"{where}: otherwise")
    return script


def _answer(row: Any, usual: dict[str, Any], where: str) -> Answer:
    row = _mapping({"text": row} if isinstance(row, str) else row, _names(Answer), where)
    values: dict[str, Any] = {**usual, **row, "text": str(row.get("text", ""))}
    try:
        if "match" in values:
            values["match"] = re.compile(str(values["match"]), re.IGNORECASE)
        if "error" in values:
            error = _checked(_mapping(values["error"], _names(HttpError), f"{where}: error"))
            values["error"] = HttpError(**error)
        if "tool_calls" in values:
            values["tool_calls"] = tuple(ToolCall(**_checked(call)) for call in values["tool_calls"])
        return Answer(**_checked(values))
    except re.error as error:
        raise ScriptError(f"match is no regular expression: {error}", where=where) from None
    except (TypeError, ValueError) as error:
        raise ScriptError(str(error), where=where) from None


def _checked(values: dict[str, Any]) -> dict[str, Any]:
    """Return the values, which are of their kinds.

    Raises:
        ValueError: one is not; it says what is allowed.
    """
    for name, value in values.items():
        if value is None:
            continue
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool) and 0 <= value < math.inf
        if name in _COUNTS and not (is_number and isinstance(value, int)):
            raise ValueError(f"{name}: {value!r} is no count (a whole number, 0 or more)")
        if name in _AMOUNTS and not is_number:
            raise ValueError(f"{name}: {value!r} is no amount (a number, 0 or more)")
        if name in _TEXTS and not isinstance(value, str):
            raise ValueError(f"{name}: {value!r} is no text")
        if name == "status" and not (is_number and 100 <= value <= 599):
            raise ValueError(f"status: {value!r} is no status of HTTP (100 to 599)")
    return values


def _names_in(given: dict[str, Any], key: str, where: str) -> tuple[str, ...]:
    names = given.get(key) or []
    if not isinstance(names, list) or not all(isinstance(name, (str, int)) for name in names):
        raise ScriptError(f"{key} is no list of texts", where=where, allowed=f"{key}: [TEXT, …]")
    return tuple(map(str, names))


def _names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(entry.name for entry in fields(kind))


def _mapping(row: Any, names: tuple[str, ...], where: str) -> dict[str, Any]:
    """Return the row, which has no key but those.

    Raises:
        ScriptError: it is no such mapping.
    """
    if not isinstance(row, dict):
        raise ScriptError("no mapping", where=where, allowed=", ".join(names))
    for key in row:
        if key not in names:
            raise ScriptError(f"unknown: {key}", where=where, allowed=", ".join(names))
    return row
