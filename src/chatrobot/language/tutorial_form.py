"""Raw velocities: the tutorial's line (`linear.x = 1,linear.y = 0,…`, one second) and other notations."""

from __future__ import annotations

import math
import re
from functools import lru_cache

from chatrobot.language.compiled import Key
from chatrobot.language.data_files import LANGUAGES, expand, load_table
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.numbers import is_kind
from chatrobot.language.quantities import read_quantities
from chatrobot.language.tokens import Atom, tokenise
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import RawTwist
from chatrobot.plan.text import NUMBER, ImpossibleTwistError, read_tutorial_line, twist_from

_BLOCK = re.compile(r"['\"]?(linear|angular)['\"]?\s*:\s*\{([^{}]*)\}")
_ENTRY = re.compile(rf"['\"]?([xyz])['\"]?\s*:\s*({NUMBER})")
_ROS_CLI = re.compile(
    r"ros2 topic pub|rostopic pub|--once|--rate \d+|-r \d+|-1\b|/?cmd_vel\b|geometry_msgs(?:/msg)?(?:/twist)?"
)
_AXES = ("vx", "vy", "wz")
_NAMES = {
    "vx": "vx", "vy": "vy", "wz": "wz", "x": "vx", "y": "vy", "theta": "wz", "yaw": "wz", "v": "vx", "w": "wz",
    "omega": "wz", "phi": "wz", "psi": "wz", "z": "wz",
}  # fmt: skip
_LIST = rf"{NUMBER}(?: ?, ?{NUMBER})*"
_TUPLE = re.compile(
    rf"[(\[]((?:vx|vy|wz|v|w|omega)(?: ?, ?(?:vx|vy|wz|v|w|omega))+)[)\]] ?(?:=|:|to|is) ?[(\[] ?({_LIST}) ?[)\]]"
)
_CALL = re.compile(rf"\b(linear|angular) ?[=:] ?(?:vector3)? ?[(\[] ?({_LIST}) ?[)\]]")
_DOT = re.compile(r"\b(x|y|theta|yaw|phi|psi)[ -]?dot\b ?(?:is|=|of|equals)? ?")
_DOTTED = re.compile(rf"\b(linear|angular) ?\. ?([xyz]) ?[=:]? ?(?={NUMBER})")
_TOPIC = re.compile(rf"\bcmd[ _]?vel\b[ :,]*(?=(?:v?x|v?y|w?z|w|theta|yaw) ?[=:]? ?{NUMBER})")
_SINGLE = re.compile(rf"\b(x|y|z|theta|yaw) ?[=:] ?(?={NUMBER})")
_VALUE_FIRST = re.compile(rf"({NUMBER}) ?m/s (?:in |along )?([xy])\b")
_NAME_FIRST = re.compile(rf"(?:yaw rate|yaw|angular|wz|omega) ?[=:]? ?(?={NUMBER})")
_LETTERS = re.compile(rf"\bv ?= ?{NUMBER}.*\bw ?= ?{NUMBER}|\bw ?= ?{NUMBER}.*\bv ?= ?{NUMBER}")


def read_twists(text: str) -> list[RawTwist]:
    """The raw velocities that `text` (normalised) is, one after the other; none where it is something else.

    Each line of the tutorial's form is one. Lines that could as well be the axes of a single one are not read so.

    Raises:
        Unclear: see `read_twist`.
    """
    lines = [line for line in text.split("\n") if line.strip()]
    if len(lines) > 1:
        read = [_tutorial_line(line) for line in lines]
        told = [set(_DOTTED.findall(line)) for line in lines]
        if all(told[0] & axes for axes in told[1:]):
            twists = [twist for twist in read if twist is not None]
            if len(twists) == len(lines):
                return twists
    twist = read_twist(text)
    return [] if twist is None else [twist]


def read_twist(text: str) -> RawTwist | None:
    """The raw velocity that `text` (normalised) is, or None where it is something else.

    Raises:
        Unclear: for a raw velocity that cannot be: not finite, out of the plane, or without a duration.
    """
    twist = _tutorial_line(text)
    if twist is not None:
        return twist
    marked = any(mark in text for mark in _marks())
    text = _ROS_CLI.sub(" ", _plainer(_with_axes(text)))
    blocks = _BLOCK.findall(text)
    if blocks:
        return _blocks(text, blocks)
    if not marked and not any(mark in text for mark in _marks()):
        return None
    return _spoken(text)


def _tutorial_line(line: str) -> RawTwist | None:
    try:
        return read_tutorial_line(line)
    except ImpossibleTwistError as error:
        raise _unclear(error) from error


def _with_axes(text: str) -> str:
    """Axes written apart from their velocity: `cmd_vel x=0.5 z=0`, `linear.x 0.2`, `0.1 m/s x`."""
    if _TOPIC.search(text):
        text = _SINGLE.sub(lambda m: f" {_NAMES[m[1]]} ", _TOPIC.sub("twist ", text))
    if _NAME_FIRST.search(text):  # all of them name first
        text = _VALUE_FIRST.sub(r" v\2 \1 ", text)
    return _DOTTED.sub(lambda m: f"{m[1]} {m[2]} ", text)


def _plainer(text: str) -> str:
    """Other notations in that of the blocks and the spoken form: tuples, single letters, dots for derivatives."""
    tuple_form = _TUPLE.search(text)
    if tuple_form:
        names = [_NAMES[name] for name in re.findall(r"[a-z]+", tuple_form[1])]
        values = re.findall(NUMBER, tuple_form[2])
        if len(names) == len(values):
            said = " ".join(f"{name} {value}" for name, value in zip(names, values))
            return f"{text[: tuple_form.start()]} {said} {text[tuple_form.end() :]}"
    text = _CALL.sub(
        lambda m: f"{m[1]}: {{{', '.join(f'{a}: {v}' for a, v in zip('xyz', re.findall(NUMBER, m[2])))}}}",
        text,
    )
    text = re.sub(r"\btwist ?\((.*)\)", r"\1", text)
    text = _DOT.sub(lambda m: _NAMES[m[1]] + " ", text)
    if _LETTERS.search(text):
        text = re.sub(r"\bt ?= ?", "for ", re.sub(r"\bw ?= ?", "wz ", re.sub(r"\bv ?= ?", "vx ", text)))
    return text


def _twist(values: dict[str, float], seconds: float) -> RawTwist:
    if not 0.0 < seconds < math.inf:
        raise Unclear("bad_number", f"{seconds:g} s")
    try:
        return twist_from(values, seconds)
    except ImpossibleTwistError as error:
        raise _unclear(error) from error


def _unclear(error: ImpossibleTwistError) -> Unclear:
    return Unclear(error.code, refused=error.code == "not_planar")


def _blocks(text: str, blocks: list[tuple[str, str]]) -> RawTwist:
    values = {f"{g}.{axis}": float(v) for g, body in blocks for axis, v in _ENTRY.findall(body)}
    rest = _BLOCK.sub(" ", text)
    entries = sum(len(_ENTRY.findall(body)) for _, body in blocks)
    if not entries or any(_ENTRY.sub("", body).strip(" ,") for _, body in blocks):
        raise Unclear("unknown_part", text[:60])
    seconds, unknown = _rest(rest)
    if unknown:
        raise Unclear("unknown_part", unknown)
    if seconds is None:
        raise Unclear("how_long", text[:60])
    return _twist(values, seconds)


def _rest(text: str) -> tuple[float | None, str]:
    """The duration in what is left beside the velocities, and the first word that nothing explains."""
    atoms = read_quantities(tokenise(re.sub(r"[{}'\"_:=/]", " ", text), lexicon(), _axis_words()))
    seconds = None
    for atom in atoms:
        if atom.kind == "q" and atom.value in ("time", "number"):
            seconds = atom.number
        elif not (atom.kind in ("glue", "filler", "sep", "num", "conn") or atom.kind == "axis"):
            return seconds, atom.text
    return seconds, ""


@lru_cache(maxsize=1)
def _axis_words() -> dict[Key, tuple[tuple[str, str], ...]]:
    words: dict[Key, tuple[tuple[str, str], ...]] = {}
    for language in LANGUAGES:
        for value, listed in load_table(language, "axes")["axis"].items():
            for pattern in listed:
                for written in expand(pattern):
                    words.setdefault(cut(written), (("axis", value),))
    return words


@lru_cache(maxsize=1)
def _marks() -> frozenset[str]:
    """What makes it worth trying: words that only an engineer says."""
    return frozenset({
        "linear", "angular", "vx", "vy", "wz", "cmd_vel", "twist", " in x", " in y", "yaw rate", "yawrate",
        "x velocity", "y velocity", "omega", "x方向", "线速度", "角速度", "x 方向", "转速", "y方向",
        "y 方向", "x=", "vth", "w=", "w =", "ω",
    })  # fmt: skip


def _spoken(text: str) -> RawTwist | None:
    atoms = read_quantities(tokenise(re.sub(r"[=_:{}]", " ", text), lexicon(), _axis_words()))
    axes = [a for a in atoms if a.kind == "axis" and a.value in (*_AXES, "none")]
    if not axes or any(
        a.kind in ("dir", "verb", "rot", "shape", "role", "flag") and a.value not in ("halt", "go")
        for a in atoms
    ):
        return None
    if not any(a.kind == "q" and a.value in ("number", "speed", "rate") for a in atoms):
        return None
    pairs, seconds = _paired(atoms)
    if pairs is None:
        return None
    if seconds is None:
        raise Unclear("how_long", text[:60])
    names = {"vx": "linear.x", "vy": "linear.y", "wz": "angular.z", "none": "linear.z"}
    return _twist({names[axis]: value for axis, value in pairs.items()}, seconds)


def _paired(atoms: list[Atom]) -> tuple[dict[str, float] | None, float | None]:
    """Velocities by axis, whichever of name and number comes first, and the duration."""
    marks = [a for a in atoms if a.kind == "q" or (a.kind == "axis" and a.value in (*_AXES, "none"))]
    name_first = bool(marks) and marks[0].kind == "axis"
    pairs: dict[str, float] = {}
    seconds: float | None = None
    axis, value = "", None
    hold = False
    for i, atom in enumerate(atoms):
        if atom.kind == "axis":
            hold = atom.value == "duration" or (hold and atom.value == "send")
            if atom.value in (*_AXES, "none"):
                if name_first and axis and axis != atom.value:
                    return None, None  # 线速度z: neither the one nor the other
                if name_first:
                    axis = atom.value
                elif value is not None:
                    pairs[atom.value], value = value, None
                else:
                    return None, None
        elif (atom.kind == "q" and atom.value == "time") or (
            atom.kind == "q" and hold and atom.value == "number"
        ):
            seconds = atom.number
        elif atom.kind == "q" and atom.value in ("number", "speed", "rate"):
            if name_first and axis and axis not in pairs:
                pairs[axis], axis = atom.number, ""
            elif not name_first and value is None:
                value = atom.number
            else:
                return None, None
        elif is_kind(atoms, i, "unknown") or atom.kind == "q" or atom.kind == "refuse":
            return None, None
    return (pairs or None) if value is None else None, seconds
