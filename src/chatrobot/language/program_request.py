"""Requests for a program: what it is to do, and how it is to be; and programs that are asked for by name.

The tutorial's two requests are read as they stand, with their numbers; any other one leaves a sentence that the
interpreter reads like every other.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

from chatrobot.core.reason import Reason
from chatrobot.language.data_files import REPLY_LANGUAGES, load_table
from chatrobot.language.normalise import normalise
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import RawTwist, Repeat, Step
from chatrobot.reflex import is_stop


class Patterns(dict[str, re.Pattern[str]]):
    """Patterns by name, each compiled at the first look."""

    def __init__(self, sources: dict[str, str]) -> None:
        super().__init__()
        self.sources = sources

    def __missing__(self, name: str) -> re.Pattern[str]:
        self[name] = re.compile(self.sources[name], re.S | re.I)
        return self[name]


DEFAULT_REST_S = 1.0
LONGEST_REST_S = 60.0
_CORNER_DEG = 90.0
_CORNER_SLACK_DEG = 3.0
_NAME_WORDS = 4
_NAME_CHARS = 30
_NEVER_LAST = frozenset({"a", "an", "the", "to", "of", "in", "like", "my"})


@dataclass(frozen=True)
class ProgramRequest:
    """What somebody wants written.

    `body` is the motion in the person's words, without those around it; `steps` the same where it was told in the
    tutorial's numbers. `promises` are what the request says and its numbers do not give.
    """

    text: str
    body: str
    name: str
    steps: tuple[Step, ...] = ()
    topic: str = ""
    uses_sleep: bool = False
    rest_s: float = DEFAULT_REST_S
    promises: tuple[Reason, ...] = ()


@dataclass(frozen=True)
class _Tables:
    """The tables of one language, compiled."""

    patterns: Patterns
    wording: Patterns
    names: Patterns
    plain: dict[str, str]


@lru_cache(maxsize=1)
def _tables() -> tuple[_Tables, ...]:
    loaded = [load_table(language, "programs") for language in REPLY_LANGUAGES]
    return tuple(
        _Tables(Patterns(t["patterns"]), Patterns(t["wording"]), Patterns(t["names"]), dict(t["plain"]))
        for t in loaded
    )


def read_program_request(text: str) -> list[Step] | None:
    """The steps that a request for a program describes; None where `text` asks for no program.

    Raises:
        Unclear: for a program whose motion is not told in the tutorial's numbers.
    """
    text = " ".join(text.split())
    for tables in _tables():
        if tables.patterns["request"].search(text):
            steps = _motion(text, tables.patterns)
            if steps is None:
                raise Unclear("program")
            return steps
    return None


def read_request(text: str, *, is_asked_for: bool = False) -> ProgramRequest | None:
    """What program `text` asks for; None where it asks for none. `is_asked_for`: it was said otherwise that it does."""
    plain = " ".join(normalise(text).split())
    found = next((t for t in _tables() if t.patterns["request"].search(plain)), None)
    if found is None and not is_asked_for:
        return None
    tables = found or _tables()[0]
    whole, plain = plain, tables.wording["named"].sub("", plain, count=1)
    steps = _motion(plain, tables.patterns) or []
    body = _body(plain, tables) if found is not None else plain
    rest = tables.wording["rest"].search(plain)
    topic = tables.wording["topic"].search(text)
    return ProgramRequest(
        text=text,
        body=body,
        name=_name(text, whole, body, tables),
        steps=tuple(steps),
        topic=topic[1] if topic else "",
        uses_sleep=bool(tables.wording["sleep"].search(plain)),
        rest_s=min(float(rest[1]), LONGEST_REST_S) if rest else DEFAULT_REST_S,
        promises=_promises(steps, plain, tables.patterns),
    )


def read_program_name(text: str, names: Iterable[str]) -> str | None:
    """Which of the kept programs `text` asks to run ("do the square dance again"); None where it asks for none."""
    known = {_key(name): name for name in names}
    return next((known[said] for said, _ in _asked_to_run(text) if said in known), None)


def read_changed_program(text: str, names: Iterable[str]) -> str | None:
    """Which of the kept programs `text` asks to run otherwise than it is: `run the triangle twice`; else None."""
    known = sorted(names, key=len, reverse=True)
    for said, tables in _asked_to_run(text):
        for name in known:
            tail = said.removeprefix(_key(name)).strip()
            if said.startswith(_key(name)) and tables.wording["changed"].match(tail):
                return name
    return None


def _asked_to_run(text: str) -> Iterator[tuple[str, _Tables]]:
    """What `text` may ask to run, with the tables that read it so."""
    plain = " ".join(normalise(text).split())
    for tables in _tables():
        for pattern in ("again", "again_weak"):
            found = tables.wording[pattern].match(plain)
            if found is not None:
                yield _key(found["name"]), tables


def asks_about_programs(text: str) -> str:
    """`kept` for `which programs do you have?`, `managed` for `delete the program dash`; else an empty string."""
    plain = " ".join(normalise(text).split())
    asked = (
        kind for tables in _tables() for kind in ("managed", "kept") if tables.wording[kind].search(plain)
    )
    return next(asked, "")


def may_be_called(name: str) -> bool:
    """Tell whether a program of that name could be run by it: a stop is a stop, whatever else is called so."""
    return not is_stop(name) and read_program_name(f"run {name}", [name]) is not None


def _key(name: str) -> str:
    return " ".join(re.sub(r"[^\w ]+", " ", normalise(name).replace("_", " ")).split())


def _motion(text: str, patterns: Patterns) -> list[Step] | None:
    """The motion as the tutorial tells it, in numbers."""
    square = patterns["square"].search(text)
    if square:
        found = [patterns[name].search(text) for name in ("linear", "drive_time", "angular", "turn_time")]
        if all(found):
            speed, drive_s, rate, turn_s = (float(m[1]) for m in found if m)
            return [Repeat(4, (RawTwist(speed, 0.0, 0.0, drive_s), RawTwist(0.0, 0.0, rate, turn_s)))]
    rotation = patterns["rotation"].search(text)
    if rotation and not square:
        return [RawTwist(0.0, 0.0, float(rotation[1]), float(rotation[2]))]
    return None


def _promises(steps: list[Step], text: str, patterns: Patterns) -> tuple[Reason, ...]:
    """1.0 rad/s for 2 s is 115 degrees: no corner of a square. Done as told, and said."""
    if not steps or not patterns["square"].search(text) or not isinstance(steps[0], Repeat):
        return ()
    turn = steps[0].steps[-1]
    assert isinstance(turn, RawTwist)
    turned_deg = math.degrees(abs(turn.wz_radps) * turn.duration_s)
    if abs(turned_deg - _CORNER_DEG) <= _CORNER_SLACK_DEG:
        return ()
    right_s = math.radians(_CORNER_DEG) / abs(turn.wz_radps)
    values = {
        "rate_radps": abs(turn.wz_radps),
        "time_s": turn.duration_s,
        "turned_deg": turned_deg,
        "corner_deg": _CORNER_DEG,
        "right_s": right_s,
    }
    return (Reason("promise_corner", values),)


def _body(plain: str, tables: _Tables) -> str:
    """The motion's own words: what asks for a program and what says how it is to look are left out."""
    rest = plain
    for _ in range(2):  # "code for a ROS 2 node that …" names it twice
        found = tables.wording["lead"].match(rest)
        if found is None:
            break
        rest = rest[found.end() :]
    sentences = [part for part in re.split(r"(?<=[.;!?])\s+(?:\d+ ?[.,、)] ?)?|(?<=[。；])", rest) if part]
    kept = [part for part in sentences if not tables.wording["aside"].search(part)]
    words = " ".join(kept).strip(" ,.;:，。；：")
    for third, order in tables.plain.items():
        words = re.sub(rf"\b{third}\b", order, words)
    return re.sub(r"\b(?:called|named) [\"“'][^\"”']*[\"”'] ?", "", words)


def _name(text: str, plain: str, body: str, tables: _Tables) -> str:
    named = tables.wording["named"].search(text)
    if named:
        return str(next(filter(None, named.groups()))).strip()
    for name in tables.names.sources:
        if tables.names[name].search(plain):
            return name
    first = re.split(r"\d|\b(?:and|then|until|for|at)\b|[,.;:!?]", body, maxsplit=1)[0]
    words = re.findall(r"[^\W\d_]+", first)[:_NAME_WORDS]
    while words and words[-1] in _NEVER_LAST:
        words.pop()
    name = " ".join(words)[:_NAME_CHARS].strip()
    return name if name and may_be_called(name) else "program"
