"""Codes → sentences in the language of the question, from the phrase tables of the data folder."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache

from chatrobot.core.reason import ANGLE_PLACES, LENGTH_PLACES, Reason, Value, number
from chatrobot.language.data_files import load_table, written
from chatrobot.language.normalise import has_chinese
from chatrobot.language.typed import codes, typed
from chatrobot.plan.shown import repeated, runs, shown_plan
from chatrobot.plan.steps import Arc, Drive, Face, Go, Plan, RawTwist, Remember, Repeat, Say, Step, Turn, Wait
from chatrobot.plan.text import format_step, parse_plan

_TABLES = ("phrases", "outcomes")
_OURS = ("", "console", "base", "user_input", "service", "pupil")
"""The sources of a stop that the person who is answered speaks through."""
_SHOWN = 6
"""Steps of a plan, or groups of steps that come several times, that are spelt out in a reply; the rest is counted."""


@cache
def _phrases(language: str) -> dict[str, str]:
    tables = (load_table(language, name) for name in _TABLES)
    return {str(key): str(value) for table in tables for key, value in table.items()}


_MINUS_ZERO = re.compile(r"(?<![\w.\-])-(?=0(?:\.0+)?(?![\d.]))")
"""What is rounded to nothing has no side: no robot is -0.00 m to the left."""


class _Tidy(float):
    """A number that is shown without float noise where the phrase does not say how."""

    places = LENGTH_PLACES
    language = "en"

    def __format__(self, spec: str) -> str:
        text = super().__format__(spec) if spec not in ("", "g") else number(float(self), self.places)
        return written(text, self.language)


class _TidyAngle(_Tidy):
    places = ANGLE_PLACES


_NAMES = ("place", "obstacle")
"""The values that are names of the world's."""


class _Formatted(dict[str, Value]):
    def __init__(self, values: Mapping[str, Value], language: str) -> None:
        super().__init__(values)
        self._language = language

    def __getitem__(self, key: str) -> Value:
        value = super().__getitem__(key)
        if isinstance(value, str):
            return (
                by_language((value,), self._language)[0] if key in _NAMES else written(value, self._language)
            )
        if not isinstance(value, float):
            return value
        tidy = _TidyAngle(value) if key.endswith("_deg") else _Tidy(value)
        tidy.language = self._language
        return tidy

    def __missing__(self, key: str) -> str:
        return f"{{{key}}}"


def say(language: str, code: str, **values: Value) -> str:
    """The phrase of that code. An unknown code is printed with its values rather than hidden."""
    known = (
        table[name] for name in codes(code) for table in (_phrases(language), _phrases("en")) if name in table
    )
    template = next(known, None)
    if template is None:
        listed = ", ".join(f"{name}={_shown(value)}" for name, value in values.items())
        return f"{code} ({listed})" if listed else code
    try:
        return _MINUS_ZERO.sub("", typed(template).format_map(_Formatted(values, language)))
    except (ValueError, TypeError):
        return template


def _shown(value: Value) -> str:
    return number(value) if isinstance(value, float) else str(value)


def by_language(names: Sequence[str], language: str) -> list[str]:
    """The names of one place or thing, those in that language first; one of them may be in the language's table."""
    known = load_table(language, "names")
    ours = dict.fromkeys(known[name.casefold()] for name in names if name.casefold() in known)
    return [*ours, *sorted(names, key=lambda name: has_chinese(name) != (language == "zh"))]


def render_reason(reason: Reason, language: str) -> str:
    """A reason in words; one that knows the name of what is in the way, or a namespace, may have its own for it."""
    values: dict[str, Value] = dict(reason.values)
    if reason.code in ("stopped_by", "paused_by"):
        return _stop_cause(str(values.get("source", "")), str(values.get("why", "")), language)
    if reason.code == "emergency_stop" and values.get("source") == "pupil":
        cause = _stop_cause("", str(values.get("why", "")), language)
        return say(language, "emergency_stop_in_class", cause=cause)
    names = load_table(language, "causes")["sources"]
    for key in ("source", "to"):
        if key in values:
            values[key] = names.get(values[key], values[key])
    if "obstacle_aliases" in values:
        names_of_it = (str(values["obstacle"]), *str(values["obstacle_aliases"]).split(", "))
        values["obstacle"] = by_language(names_of_it, language)[0]
    if "obstacle" in values:
        values["the_obstacle"] = name_of(str(values["obstacle"]), language)
    special = (
        f"{reason.code}_{kind}" for key, kind in (("obstacle", "named"), ("namespace", "in")) if key in values
    )
    code = next((code for code in special if code in _phrases("en")), reason.code)
    return say(language, code, **values)


def name_of(thing: str, language: str) -> str:
    """The name of a thing in a sentence; one with a number takes no article."""
    code = "the_numbered" if any(map(str.isdigit, thing)) else "the_obstacle"
    return say(language, code, obstacle=thing)


def _stop_cause(source: str, why: str, language: str) -> str:
    """Who stopped the robot: `why` is what a person said, or one of the causes in the table."""
    causes = load_table(language, "causes")
    name, is_ours = causes["sources"].get(source, source), source in _OURS
    if why in causes["stops"]:
        cause = str(causes["stops"][why])
        tells_who = is_ours or source == "agent"  # its causes name it
        return cause if tells_who else say(language, "stopped_at", source=name, cause=cause)
    if not why:
        return say(language, "stopped_by" if source else "stopped", source=name)
    return say(language, "stopped_said" if is_ours else "stopped_said_by", source=name, why=why)


def describe_plan(plan: Plan, language: str) -> str:
    """One short line: what is going to happen."""
    return describe_steps(plan.steps, language)


def describe_text(plan_text: str, language: str) -> str:
    """Plan text in a few words."""
    return describe_steps(parse_plan(plan_text).steps, language)


def describe_steps(steps: Iterable[Step], language: str) -> str:
    """The steps in short words, the first few of them."""
    join = say(language, "join")
    groups = list(runs([_step(step, language) for step in steps]))
    text = join.join(repeated(count, group, join) for count, group in groups[:_SHOWN])
    more = sum(count * len(group) for count, group in groups[_SHOWN:])
    return say(language, "and_more", text=text, count=more) if more else text


def _way(direction_rad: float) -> str:
    names = ("forward", "forward_left", "left", "back_left", "back", "back_right", "right", "forward_right")
    return f"way_{names[round(direction_rad / (math.pi / 4)) % 8]}"


def _drive(step: Drive, spoken: Callable[..., str]) -> str:
    way = spoken(_way(step.direction_rad))
    if step.distance_m is not None:
        return spoken("step_drive", way=way, m=number(step.distance_m))
    if step.duration_s is not None:
        return spoken("step_drive_time", way=way, s=number(step.duration_s))
    return spoken("step_drive_until", way=way, m=number(step.until.distance_m) if step.until else "")


def _go(step: Go, spoken: Callable[..., str]) -> str:
    code = "the_start" if step.frame == "start" else "the_point"
    point = spoken(code, x=number(step.x_m, 2), y=number(step.y_m, 2))
    if step.place and step.yaw_rad is not None:
        deg = number(math.degrees(step.yaw_rad), ANGLE_PLACES)
        return spoken("step_go_facing", place=step.place, deg=deg)
    return spoken("step_go", place=spoken("the_place", place=step.place) if step.place else point)


def _step(step: Step, language: str) -> str:
    speed_mps, rate_radps = getattr(step, "speed_mps", None), getattr(step, "rate_radps", None)
    text = _step_at_any_speed(step, language)
    if speed_mps is not None:
        return text + say(language, "step_speed", mps=number(speed_mps))
    if rate_radps is not None:
        return text + say(language, "step_rate", dps=number(math.degrees(rate_radps), ANGLE_PLACES))
    return text


def _step_at_any_speed(step: Step, language: str) -> str:
    def spoken(code: str, **values: Value) -> str:
        return say(language, code, **values)

    if isinstance(step, Drive):
        return _drive(step, spoken)
    if isinstance(step, Turn):
        side = spoken("way_left" if step.left else "way_right")
        if step.angle_rad is not None:
            return spoken("step_turn", side=side, deg=number(math.degrees(step.angle_rad), ANGLE_PLACES))
        return spoken("step_turn_time", side=side, s=number(step.duration_s or 0.0))
    if isinstance(step, Arc):
        side = spoken("way_left" if step.left else "way_right")
        deg = number(math.degrees(step.angle_rad), ANGLE_PLACES)
        return spoken("step_arc", side=side, m=number(step.radius_m), deg=deg)
    if isinstance(step, RawTwist):
        vx, vy, wz = number(step.vx_mps), number(step.vy_mps), number(step.wz_radps)
        return spoken("step_twist", vx=vx, vy=vy, wz=wz, s=number(step.duration_s))
    if isinstance(step, Go):
        return _go(step, spoken)
    if isinstance(step, Face):
        return spoken("step_face", deg=number(math.degrees(step.yaw_rad), ANGLE_PLACES))
    if isinstance(step, Wait):
        return spoken("step_wait", s=number(step.duration_s))
    if isinstance(step, Say):
        return step.text
    if isinstance(step, Remember):
        return spoken("step_remember", place=step.place)
    if isinstance(step, Repeat):
        return repeated(
            step.count, [describe_steps((each,), language) for each in step.steps], say(language, "join")
        )
    return shown_plan(format_step(step))  # somebody else's primitive
