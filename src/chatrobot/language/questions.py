"""Questions about the robot's state and abilities: what is asked, and the words that answer it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from functools import cache

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import fixed
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.data_files import load_table
from chatrobot.language.phrases import by_language, describe_plan, say
from chatrobot.plan.steps import Arc, Drive, Go, Turn
from chatrobot.robots.profile import RobotProfile

_LONGEST_COURTESY = 60
_MEASURED = frozenset({"position", "heading", "distance", "speed", "moving"})
"""Topics that odometry alone can tell of."""


@cache
def _topics(language: str) -> tuple[tuple[str, re.Pattern[str]], ...]:
    return tuple((n, re.compile(p)) for n, p in load_table(language, "questions")["topics"].items())


@cache
def _courtesies(language: str) -> tuple[tuple[str, re.Pattern[str]], ...]:
    """A phrase of the class, any number of times, with an address or an intensifier beside it."""
    table = load_table(language, "questions")["courtesies"]
    beside = str(table["beside"])
    return tuple(
        (name, re.compile(rf"(?:(?:{beside})[ ,.!~]*)*(?:(?:{said})[ ,.!~]*(?:(?:{beside})[ ,.!~]*)*)+"))
        for name, said in table.items()
        if name != "beside"
    )


@cache
def _pattern(language: str, name: str) -> re.Pattern[str]:
    return re.compile(load_table(language, "questions")[name])


def is_question(text: str, language: str) -> bool:
    """Whether a normalised text asks something (a polite request asks for nothing)."""
    return _pattern(language, "ask").search(text) is not None


def is_plain_question(text: str, language: str) -> bool:
    """Whether a question word asks for something to be told; only a full amount makes it a command."""
    return _pattern(language, "strong").search(text) is not None


def without_quiz(text: str, language: str) -> str:
    """A command without the question about it that ends it: `…, how far was that?`; else an empty string."""
    if "quiz" not in load_table(language, "questions"):
        return ""
    found = _pattern(language, "quiz").search(text)
    return text[: found.start()] if found else ""


def orders(text: str, language: str) -> bool:
    """Whether what is asked is to be acted on: `as far as …, that far you go`."""
    return (
        "orders" in load_table(language, "questions")
        and _pattern(language, "orders").search(text) is not None
    )


def courtesy_of(text: str, language: str) -> str:
    """`greeting`, `thanks`, `praise` or `parting` where a text is that and nothing else; else an empty string.

    Of several, each a sentence or a part of one, it is the last: `thanks, bye`.
    """
    said = text.strip(" ,.!?~。，！")
    if len(said) > _LONGEST_COURTESY or text.rstrip().endswith(("?", "？")):
        return ""
    kinds = [_courtesy(part, language) for part in re.split(r"[,.!，。！~]+ *", said)]
    return _courtesy(said, language) or (kinds[-1] if all(kinds) else "")


def _courtesy(said: str, language: str) -> str:
    return next((name for name, pattern in _courtesies(language) if pattern.fullmatch(said)), "")


def asks_ability(text: str, language: str) -> bool:
    """`Can you …?`: a question, unless a full command follows."""
    found = _pattern(language, "ability_ask")
    if language == "zh":
        return found.search(text) is not None and re.search(r"[?？吗]|会不会|能不能", text) is not None
    return found.search(text) is not None


def asks_what_it_can(text: str, language: str) -> bool:
    """`Can you drive backwards?`, with nothing else beside it: a fact about this robot."""
    return topic_of(text, language) in _ABILITIES


def asks_a_favour(text: str, language: str) -> bool:
    """`Could you …`: something to be done, though it is put as a question."""
    return _has("favour", text, language)


def _has(name: str, text: str, language: str) -> bool:
    """Whether that pattern is found, in a language that has it."""
    return name in load_table(language, "questions") and bool(_pattern(language, name).search(text))


def topic_of(text: str, language: str) -> str:
    """What a question is about, or an empty string."""
    return next((name for name, pattern in _topics(language) if pattern.search(text)), "")


def _where(pose: Pose, language: str) -> str:
    """`1.36 m behind`, `0.20 m ahead and 0.50 m to the left of`: how far from the start, with the sides named."""
    along_m, across_m = (fixed(abs(metres), 2) for metres in (pose.x_m, pose.y_m))
    along = ["ahead" if pose.x_m > 0.0 else "behind"] if float(along_m) else []
    across = ["across"] if float(across_m) else []
    code = "_".join(["where", *(along + across or ["started"])])
    side = say(language, "side_left" if pose.y_m > 0.0 else "side_right")
    return say(language, code, along_m=along_m, across_m=across_m, side=side)


def _turned(pose: Pose, language: str) -> str:
    yaw_deg = math.degrees(math.remainder(pose.yaw_rad, 2 * math.pi))
    degrees = fixed(yaw_deg, 0)
    if not float(degrees):
        return say(language, "not_turned")
    return say(language, "turned_to_left" if yaw_deg > 0.0 else "turned_to_right", deg=degrees.lstrip("-"))


def places_known(context: Context, language: str) -> str:
    """The places that can be gone to: the person's own, then those of the world, by its name in that language."""
    names = context.place_names or tuple((name,) for name in context.world_places)
    own = (name for name, place in context.dialogue.places.items() if place.usable)
    known = dict.fromkeys((*own, *(by_language(each, language)[0] for each in names)))
    return say(language, "join").join(known) or say(language, "no_place")


def places_told(context: Context, language: str) -> str:
    """The same in a sentence, and which names are left of an earlier session."""
    told = say(language, "answer_places", places=places_known(context, language))
    own = context.dialogue.places.items()
    earlier = [n for n, place in own if not place.usable and n.casefold() not in context.world_places]
    if not earlier:
        return told
    return f"{told} {say(language, 'answer_places_earlier', places=say(language, 'join').join(earlier))}"


def unknown_pose(context: Context) -> str:
    """The code of the phrase that says why nobody knows where the robot is; an empty string where it is known."""
    state = context.state
    return "" if state.has_said_so else "answer_unheard" if state.is_measured else "answer_unmeasured"


def answer(topic: str, language: str, context: Context, profile: RobotProfile) -> str:
    """The answer in words; says so where something is not known."""
    if topic in _MEASURED and unknown_pose(context):
        return say(language, unknown_pose(context))
    if topic == "places":
        return places_told(context, language)
    if topic in _OF_TURNS:
        return _told_of(topic, language, context.dialogue)
    if topic == "last" and not context.dialogue.turns:
        return say(language, "answer_nothing_done")
    values = _values(language, context, profile)
    if topic == "past_speed" and "last_speed_mps" not in values:
        topic = "past_rate" if "last_rate_degps" in values else "speed"
    known = {"battery": "percent", "obstacle": "distance_m", "duration": "duration_s", "sight": "range_m"}
    if topic in known and known[topic] not in values:
        return say(language, f"answer_{topic}_unknown")
    if topic == "contact":
        seen = say(
            language, f"answer_obstacle{'_unknown' if context.state.obstacle_m is None else ''}", **values
        )
        return say(language, "answer_contact", seen=seen)
    if topic == "moving":
        topic = "moving" if context.state.moving else "standing"
    if topic in _ABILITIES:
        return say(language, f"answer_{topic}{'' if _ABILITIES[topic](profile) else '_not'}")
    return say(language, f"answer_{topic}", **values)


_ABILITIES: Mapping[str, Callable[[RobotProfile], bool]] = {
    "reverse": lambda _: True,
    "sideways": lambda profile: profile.can_go_sideways,
    "on_the_spot": lambda profile: profile.limits.min_turning_radius_m == 0.0,
    "camera": lambda profile: profile.wiring.camera_topic is not None,
}
"""What one kind of robot can do, or has, and another not."""


def _values(language: str, context: Context, profile: RobotProfile) -> dict[str, float | int | str]:
    """What is known, by the names that the phrases have for it."""
    state, last = context.state, context.dialogue.last_motion
    pose = state.pose.relative_to(context.dialogue.start_pose)
    (low_x_m, high_x_m), (low_y_m, high_y_m) = ((min(of), max(of)) for of in zip(*profile.footprint))
    told: dict[str, float | int | str | None] = {
        "where": _where(pose, language),
        "turned": _turned(pose, language),
        "speed_mps": math.hypot(state.twist.vx_mps, state.twist.vy_mps),
        "path_m": state.path_m,
        "max_speed_mps": profile.limits.max_speed_mps,
        "max_rate_radps": profile.limits.max_rate_radps,
        "default_speed_mps": context.dialogue.usual.speed_mps or profile.defaults.speed_mps,
        "title": profile.title,
        "last": context.dialogue.turns[-1].text if context.dialogue.turns else None,
        "percent": state.battery_percent,
        "distance_m": state.obstacle_m,
        "duration_s": last.duration_s if last is not None else None,
        **_last_speeds(context, profile),
        "length_m": high_x_m - low_x_m,
        "width_m": high_y_m - low_y_m,
        "most_m": profile.safety.budget.distance_m,
        "most_s": profile.safety.budget.time_s,
        "range_m": profile.lidar.max_range_m if profile.lidar is not None else None,
    }
    return {name: value for name, value in told.items() if value is not None}


def _last_speeds(context: Context, profile: RobotProfile) -> dict[str, float]:
    """The fastest that the last motion was to go and to turn, where it did."""
    last, usual = context.dialogue.last_motion, context.dialogue.usual
    steps = last.plan.steps if last is not None and last.plan is not None else ()
    drives = [step for step in steps if isinstance(step, (Drive, Arc, Go))]
    turns = [step for step in steps if isinstance(step, Turn)]
    told: dict[str, float] = {}
    if drives:
        told["last_speed_mps"] = max(
            s.speed_mps or usual.speed_mps or profile.defaults.speed_mps for s in drives
        )
    if turns:
        rate_radps = max(s.rate_radps or usual.rate_radps or profile.defaults.rate_radps for s in turns)
        told["last_rate_degps"] = round(math.degrees(rate_radps), 1)
    return told


_OF_TURNS = {"why": -1, "done": -1, "done_before": -2, "done_first": 0, "understood": -1}
"""What is told of one turn, and of which."""


def _told_of(topic: str, language: str, dialogue: Dialogue) -> str:
    """How the last turn was understood or ended, or what the last, the last but one, or the first motion did."""
    asked = topic in ("why", "understood")
    turns = [
        turn for turn in dialogue.turns if (turn.outcome != "answered" if asked else turn.plan and turn.told)
    ]
    at = _OF_TURNS[topic]
    if not -len(turns) <= at < len(turns):
        return say(language, "answer_nothing_done")
    turn = turns[at]
    if topic == "understood" and turn.plan is not None:
        return say(language, "answer_understood", last=turn.text, text=describe_plan(turn.plan, language))
    return say(language, "answer_done", last=turn.text, told=turn.told)
