"""Corpus files: what people say and what must then happen, read and checked. Format: tests/corpus/FORMAT.md."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from chatrobot.core.errors import CorpusError, PlanTextError
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import parse_plan

CATEGORIES = (
    "primitive", "metric", "speed", "time", "sequence", "repeat", "shape", "arc", "dialogue", "stop", "clarify",
    "refuse", "info", "twist", "complex", "still",
)  # fmt: skip
Answer = Literal["clarify", "refuse", "info"]
ANSWERS = ("clarify", "refuse", "info")
SIGNS = ("+", "-", "0")
_NUMBERS = (
    "x", "y", "yaw_deg", "turned_deg", "path_m", "duration_s", "pause_s", "max_speed", "max_turn_rate",
    "stays_within_m",
)  # fmt: skip
_EXPECT_KEYS = (*_NUMBERS, "sign", "closed", "motion", "answer")
_MEANT_FLAGS = ("still", "mirror_ok", "closed_ok", "ask_ok")
_ITEM_KEYS = ("id", "category", "say", "turns", "expect", "note", "plan", *_MEANT_FLAGS)
_GOTO = re.compile(r"^\s*goto\b", re.MULTILINE)


@dataclass(frozen=True)
class Expect:
    """What must hold. `numbers` by the names of the format (metres, degrees, seconds, m/s, rad/s)."""

    numbers: Mapping[str, float] = field(default_factory=dict)
    sign: Mapping[str, str] = field(default_factory=dict)
    closed: bool = False
    no_motion: bool = False
    answer: Answer | None = None


@dataclass(frozen=True)
class Meant:
    """What must happen as plans: any of `plans` is right; with `still` there is none, and nothing may move."""

    plans: tuple[Plan, ...] = ()
    mirror_ok: bool = False
    closed_ok: bool = False

    @property
    def still(self) -> bool:
        """Nothing may move, in no turn."""
        return not self.plans


@dataclass(frozen=True)
class Turn:
    """One utterance; `expect` where it is judged by itself."""

    say: str
    expect: Expect | None = None


@dataclass(frozen=True)
class Item:
    """One entry of a corpus. `expect` is judged after the last turn; None where only the turns' own count.

    `meant` is the other form, judged over all turns. `ask_ok`: to ask back is as good.
    """

    id: str
    category: str
    turns: tuple[Turn, ...]
    expect: Expect | None = None
    meant: Meant | None = None
    ask_ok: bool = False

    @property
    def number(self) -> int:
        """The running number at the end of the id; 0 where there is none."""
        digits = re.search(r"(\d+)$", self.id)
        return int(digits.group()) if digits else 0

    @property
    def must_stand(self) -> bool:
        """Nothing may move in any of its turns."""
        return self.meant is not None and self.meant.still


def load_corpus(path: Path) -> list[Item]:
    """All items of a file.

    Raises:
        CorpusError: names the file, the item, what is wrong and what is allowed.
    """
    import yaml

    try:
        data = yaml.load(path.read_bytes(), getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except OSError as error:
        raise CorpusError("cannot be read", where=str(path), allowed=error.strerror or "") from error
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
        raise CorpusError(f"is not YAML: {error}", where=str(path)) from error
    if not isinstance(data, list) or not data:
        raise CorpusError(
            "must be a list of items", where=str(path), allowed="- id: …, category: …, say: …, expect: …"
        )
    items = [_Reader(f"{path}: item {number}", str(path)).item(entry) for number, entry in enumerate(data, 1)]
    seen: set[str] = set()
    for item in items:
        if item.id in seen:
            raise CorpusError("this id is used twice", where=f"{path}: {item.id}")
        seen.add(item.id)
    return items


class _Reader:
    """Reads one item, and knows what to call it in errors."""

    def __init__(self, where: str, path: str) -> None:
        self._where = where
        self._path = path

    def item(self, data: Any) -> Item:
        fields = self._mapping(data, "an item", _ITEM_KEYS)
        name = fields.get("id")
        if not isinstance(name, str) or not name.strip():
            raise self._error("id is missing or is not text", "such as en-0001")
        self._where = f"{self._path}: {name}"
        if fields.get("category") not in CATEGORIES:
            raise self._error(f"category is {fields.get('category')!r}", ", ".join(CATEGORIES))
        turns = self._turns(fields)
        expect = self._expect(fields["expect"]) if "expect" in fields else None
        meant = self._meant(fields)
        if expect is None and meant is None and turns[-1].expect is None:
            raise self._error(
                "expect is missing", "what must hold after the last turn: expect, plan or still"
            )
        if expect is not None and meant is not None:
            raise self._error("needs either expect or a plan", "expect; plan; still: true")
        return Item(name, fields["category"], turns, expect, meant, ask_ok=bool(fields.get("ask_ok")))

    def _meant(self, fields: Mapping[str, Any]) -> Meant | None:
        for flag in _MEANT_FLAGS:
            if not isinstance(fields.get(flag, True), bool):
                raise self._error(f"{flag} is {fields[flag]!r}", "true or false")
        if "plan" not in fields:
            return Meant() if fields.get("still") else None
        if fields.get("still"):
            raise self._error("needs either a plan or still", "plan: drive 1 m; still: true")
        texts = fields["plan"] if isinstance(fields["plan"], list) else [fields["plan"]]
        if not texts:
            raise self._error("plan is empty", "plan text, or a list of plan texts")
        mirrored, closed = fields.get("mirror_ok", False), fields.get("closed_ok", False)
        return Meant(tuple(self._plan(text) for text in texts), mirrored, closed)

    def _plan(self, text: Any) -> Plan:
        if not isinstance(text, str):
            raise self._error(f"plan is {text!r}", "plan text, or a list of plan texts")
        try:
            return parse_plan(_GOTO.sub("go to", text))
        except PlanTextError as error:
            raise self._error(f"plan cannot be read: {error}", "plan text (docs/plan-language.md)") from error

    def _turns(self, fields: Mapping[str, Any]) -> tuple[Turn, ...]:
        if ("say" in fields) == ("turns" in fields):
            raise self._error("needs either say or turns", "say: one text; turns: a list of texts")
        entries = [fields["say"]] if "say" in fields else fields["turns"]
        if not isinstance(entries, list) or not entries:
            raise self._error("turns must be a list of texts", "a text, or {say: …, expect: …}")
        return tuple(self._turn(entry) for entry in entries)

    def _turn(self, data: Any) -> Turn:
        fields = self._mapping(data, "a turn", ("say", "expect")) if isinstance(data, dict) else {"say": data}
        say = fields.get("say")
        if not isinstance(say, str):
            raise self._error(f"{say!r} is not text", "put it in quotes")
        return Turn(say, self._expect(fields["expect"]) if "expect" in fields else None)

    def _expect(self, data: Any) -> Expect:
        fields = self._mapping(data, "expect", _EXPECT_KEYS)
        if not fields:
            raise self._error("expect is empty", ", ".join(_EXPECT_KEYS))
        self._check_word(fields, "motion", ("none",))
        self._check_word(fields, "answer", ANSWERS)
        if not isinstance(fields.get("closed", True), bool):
            raise self._error(f"closed is {fields['closed']!r}", "true or false")
        return Expect(
            numbers={key: self._number(key, fields[key]) for key in _NUMBERS if key in fields},
            sign=self._signs(fields["sign"]) if "sign" in fields else {},
            closed=fields.get("closed", False),
            no_motion="motion" in fields or "answer" in fields,
            answer=fields.get("answer"),
        )

    def _signs(self, data: Any) -> dict[str, str]:
        signs = {axis: str(sign) for axis, sign in self._mapping(data, "sign", ("x", "y", "yaw")).items()}
        for axis, sign in signs.items():
            if sign not in SIGNS:
                raise self._error(f"sign.{axis} is {sign!r}", 'one of "+", "-", "0"')
        return signs

    def _number(self, key: str, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise self._error(f"{key} is {value!r}", "a number")
        return float(value)

    def _check_word(self, fields: Mapping[str, Any], key: str, allowed: tuple[str, ...]) -> None:
        if key in fields and fields[key] not in allowed:
            raise self._error(f"{key} is {fields[key]!r}", ", ".join(allowed))

    def _mapping(self, data: Any, name: str, allowed: tuple[str, ...]) -> dict[str, Any]:
        if not isinstance(data, dict):
            raise self._error(f"{name} must be a mapping", ", ".join(allowed))
        for key in data:
            if key not in allowed:
                raise self._error(f"{name} has the unknown field {key!r}", ", ".join(allowed))
        return data

    def _error(self, problem: str, allowed: str) -> CorpusError:
        return CorpusError(problem, where=self._where, allowed=allowed)
