"""Points by their coordinates: `go to (1, 1)`, `x=1 y=2`, `to the coordinates x 1.5, y minus 1, heading 90 degrees`."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from functools import lru_cache, partial

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Place
from chatrobot.language.data_files import REPLY_LANGUAGES, load_table

_NUMBER = r"([-+−]?\d*\.?\d+) ?m?"
_WRITTEN = re.compile(rf"\({_NUMBER}, {_NUMBER}(?:, {_NUMBER})?\)")
_AT_ORIGIN_M, _AT_ORIGIN_RAD = 0.05, math.radians(3.0)
_LETTERS = str.maketrans("0123456789.-+,e", "abcdefghijkmpqu", "() ")
_TWIST = re.compile(r"linear|angular|twist|\bz ?[=:]", re.IGNORECASE)


@dataclass(frozen=True)
class _Words:
    """How a language leads to a point, goes on behind it, says the heading that a place has, and tells the frame.

    `equals` and `minus` are words for those signs; `origin` only says that it is where the robot stands; `along` is a
    heading by an axis, `degrees` the same by an angle.
    """

    lead: re.Pattern[str]
    heading: re.Pattern[str]
    its_heading: str
    axes: re.Pattern[str]
    equals: str
    minus: str
    origin: re.Pattern[str]
    along: re.Pattern[str]
    degrees: str


def with_points(text: str, context: Context) -> tuple[str, Context]:
    """A text in which each point, metres in the odom frame, is a place of this text alone, in one word.

    That x points ahead and y to the left is the frame that is meant anyway (REP 103), as long as the robot stands
    where that began; any other is not read.
    """
    if _TWIST.search(text) or not _point().search(text):
        return text, context
    for words in _words() if _is_at_origin(context.state.pose) else ():
        text = words.axes.sub(lambda told: "" if told.end() == len(told.string) else told["mark"], text)
        text = words.along.sub(partial(_by_degrees, words.degrees), words.origin.sub("", text))
    places: dict[str, Place] = {}
    out, at = "", 0
    for found in _point().finditer(text):
        x_m, y_m = (_number(number) for number in found.groups() if number is not None)
        lead, (heading_deg, end, its_heading) = _lead(text[at : found.start()]), _heading(text, found.end())
        name = f"({x_m:g}, {y_m:g}, {heading_deg:g})" if its_heading else f"({x_m:g}, {y_m:g})"
        places[name] = Place(Pose(x_m, y_m, math.radians(heading_deg)))
        out += f"{lead} {word_of(name)} {its_heading}"
        at = end
    dialogue = replace(context.dialogue, places={**context.dialogue.places, **places})
    return out + text[at:], replace(context, dialogue=dialogue)


def _by_degrees(written: str, found: re.Match[str]) -> str:
    """A heading along an axis, by degrees: `facing along minus y`."""
    is_back = bool(found["back"])
    return written.format(
        degrees={("x", False): 0, ("y", False): 90, ("x", True): 180}.get((found["axis"], is_back), -90)
    )


def _is_at_origin(pose: Pose) -> bool:
    return math.hypot(pose.x_m, pose.y_m) < _AT_ORIGIN_M and abs(pose.yaw_rad) < _AT_ORIGIN_RAD


def naming_points(said: str, context: Context) -> str:
    """What is told, with the points as they are written."""
    for name in context.dialogue.places:
        said = said.replace(word_of(name), name) if _WRITTEN.fullmatch(name) else said
    return said


def word_of(name: str) -> str:
    """The name of a place as it is looked up in a text: that of a point is one word of letters."""
    return "xy" + name.translate(_LETTERS) if _WRITTEN.fullmatch(name) else name


def _number(written: str) -> float:
    for sign in ("−", *(words.minus for words in _words())):
        written = written.replace(sign, "-")
    return float(written.replace(" ", "").replace(",", "."))


def _lead(text: str) -> str:
    """The text without a word like `coordinates` at its end."""
    for words in _words():
        text = words.lead.sub("", text)
    return text


def _heading(text: str, at: int) -> tuple[float, int, str]:
    """The heading, degrees, that is told behind a point, where that and a unit end, and the words for it."""
    behind = [(words, found) for words in _words() if (found := words.heading.match(text, at)) is not None]
    words, found = max(behind, key=lambda each: each[1].end())
    if found["deg"] is None:
        return 0.0, found.end(), ""
    return _number(found["deg"]), found.end(), words.its_heading


@lru_cache(maxsize=1)
def _words() -> tuple[_Words, ...]:
    tables = (load_table(code, "relations")["points"] for code in REPLY_LANGUAGES)
    return tuple(
        _Words(
            re.compile(table["lead"], re.IGNORECASE),
            re.compile(table["heading"], re.IGNORECASE),
            table["its_heading"],
            re.compile(table["axes"], re.IGNORECASE),
            table["equals"],
            table["minus"],
            re.compile(table.get("origin", "(?!)"), re.IGNORECASE),
            re.compile(table.get("along", "(?!)"), re.IGNORECASE),
            table.get("degrees", ""),
        )
        for table in tables
    )


@lru_cache(maxsize=1)
def _point() -> re.Pattern[str]:
    """Both coordinates of a point: in brackets, or each behind its letter."""
    equals, minus = ("|".join(getattr(words, name) for words in _words()) for name in ("equals", "minus"))
    named = rf"((?:[-+−] ?|(?:{minus}) ?)?\d*[.,]?\d+)(?: ?m(?:et(?:er|re)s?)?\b)?"
    between = r"[ ,，、]*(?:(?<=[ ,，])[a-z]{1,3} )?"
    return re.compile(
        rf"[(（] ?{_NUMBER} ?[,，] ?{_NUMBER} ?[)）]"
        rf"|(?<![a-z])x ?(?:=|{equals}) ?{named}{between}y ?(?:=|{equals}) ?{named}(?!\d|[.,]\d)"
        rf"|(?<![a-z\d])x {named}[ ,，]+(?:[a-z]{{1,3}} )?y {named}(?!\d|[.,]\d)",
        re.IGNORECASE,
    )
