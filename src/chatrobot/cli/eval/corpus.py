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
_PLAN_TEXTS = "plan text, or a list of plan texts"
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
        """Read an item.

        Raises:
            CorpusError: what is wrong with it, and what is allowed.
        """
        fields = self._mapping(data, "an item", _ITEM_KEYS)
        name, category = str(fields.get("id")), str(fields.get("category"))
        has_name = isinstance(fields.get("id"), str) and bool(name.strip())
        self._require(has_name, "id is missing or is not text", "such as en-0001")
        self._where = f"{self._path}: {name}"
        self._require(
            category in CATEGORIES, f"category is {fields.get('category')!r}", ", ".join(CATEGORIES)
        )
        turns = self._turns(fields)
        expect = self._expect(fields["expect"]) if "expect" in fields else None
        meant = self._meant(fields)
        says = expect is not None or meant is not None or turns[-1].expect is not None
        self._require(says, "expect is missing", "what must hold after the last turn: expect, plan or still")
        is_one = expect is None or meant is None
        self._require(is_one, "needs either expect or a plan", "expect; plan; still: true")
        return Item(name, category, turns, expect, meant, ask_ok=bool(fields.get("ask_ok")))

    def _meant(self, fields: Mapping[str, Any]) -> Meant | None:
        for flag in _MEANT_FLAGS:
            self._require_flag(fields, flag)
        if "plan" not in fields:
            return Meant() if fields.get("still") else None
        self._require(not fields.get("still"), "needs either a plan or still", "plan: drive 1 m; still: true")
        texts = fields["plan"] if isinstance(fields["plan"], list) else [fields["plan"]]
        self._require(bool(texts), "plan is empty", _PLAN_TEXTS)
        mirrored, closed = fields.get("mirror_ok", False), fields.get("closed_ok", False)
        return Meant(tuple(self._plan(text) for text in texts), mirrored, closed)

    def _plan(self, text: Any) -> Plan:
        self._require(isinstance(text, str), f"plan is {text!r}", _PLAN_TEXTS)
        try:
            return parse_plan(_GOTO.sub("go to", text))
        except PlanTextError as error:
            raise self._error(f"plan cannot be read: {error}", "plan text (docs/plan-language.md)") from error

    def _turns(self, fields: Mapping[str, Any]) -> tuple[Turn, ...]:
        is_one = ("say" in fields) != ("turns" in fields)
        self._require(is_one, "needs either say or turns", "say: one text; turns: a list of texts")
        entries = [fields["say"]] if "say" in fields else fields["turns"]
        is_list = isinstance(entries, list) and bool(entries)
        self._require(is_list, "turns must be a list of texts", "a text, or {say: …, expect: …}")
        return tuple(self._turn(entry) for entry in entries)

    def _turn(self, data: Any) -> Turn:
        fields = self._mapping(data, "a turn", ("say", "expect")) if isinstance(data, dict) else {"say": data}
        say = fields.get("say")
        self._require(isinstance(say, str), f"{say!r} is not text", "put it in quotes")
        return Turn(str(say), self._expect(fields["expect"]) if "expect" in fields else None)

    def _expect(self, data: Any) -> Expect:
        fields = self._mapping(data, "expect", _EXPECT_KEYS)
        self._require(bool(fields), "expect is empty", ", ".join(_EXPECT_KEYS))
        for key, allowed in (("motion", ("none",)), ("answer", ANSWERS)):
            self._require(
                fields.get(key, allowed[0]) in allowed, f"{key} is {fields.get(key)!r}", ", ".join(allowed)
            )
        self._require_flag(fields, "closed")
        signs = self._mapping(fields["sign"], "sign", ("x", "y", "yaw")) if "sign" in fields else {}
        for axis, sign in signs.items():
            self._require(str(sign) in SIGNS, f"sign.{axis} is {str(sign)!r}", 'one of "+", "-", "0"')
        return Expect(
            numbers={key: self._number(key, fields[key]) for key in _NUMBERS if key in fields},
            sign={axis: str(sign) for axis, sign in signs.items()},
            closed=fields.get("closed", False),
            no_motion="motion" in fields or "answer" in fields,
            answer=fields.get("answer"),
        )

    def _number(self, key: str, value: Any) -> float:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
        self._require(is_number, f"{key} is {value!r}", "a number")
        return float(value)

    def _mapping(self, data: Any, name: str, allowed: tuple[str, ...]) -> dict[str, Any]:
        self._require(isinstance(data, dict), f"{name} must be a mapping", ", ".join(allowed))
        for key in data:
            self._require(key in allowed, f"{name} has the unknown field {key!r}", ", ".join(allowed))
        return dict(data)

    def _require_flag(self, fields: Mapping[str, Any], flag: str) -> None:
        is_flag = isinstance(fields.get(flag, True), bool)
        self._require(is_flag, f"{flag} is {fields.get(flag)!r}", "true or false")

    def _require(self, is_right: bool, problem: str, allowed: str) -> None:
        if not is_right:
            raise self._error(problem, allowed)

    def _error(self, problem: str, allowed: str) -> CorpusError:
        return CorpusError(problem, where=self._where, allowed=allowed)
