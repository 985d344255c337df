"""Questions about places: where one is, how far, on which side, which is nearest or farthest. None of them moves."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import NamedTuple

from chatrobot.core.geometry import Pose
from chatrobot.core.reason import fixed
from chatrobot.language.context import Context
from chatrobot.language.data_files import load_table
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import by_language, say
from chatrobot.language.points import word_of
from chatrobot.language.questions import places_known, places_told, topic_of, unknown_pose
from chatrobot.language.rules import Rules, rules
from chatrobot.language.seen import SECTORS, what_is_seen
from chatrobot.language.typos import edit_distance
from chatrobot.language.unclear import Unclear

_HERE_M, _AT_M = 0.25, 0.05
_ON_SIDE_RAD, _TOWARDS_RAD = math.radians(67.5), math.radians(35.0)
"""A place so near is no other one, or is here; one so far off a side is not on it, or not driven to."""
_SIDES_DEG = {"ahead": 0.0, "left": 90.0, "behind": 180.0, "right": -90.0}
_FAR_OFF = 99
_SHOWN = 60
_MOST_NAMED, _MOST_BESIDE = 5, 3
_OF_ALL = ("nearest", "farthest")
"""Questions that name no place."""


class _Place(NamedTuple):
    name: str
    pose: Pose


@cache
def _rules(language: str) -> Rules:
    table = load_table(language, "places_asked")
    name = rf"(?:{table['article']})*(?P<place>.+?)"
    whole = "(?:{before})*(?:{said})(?:{after})*"
    asked = (
        (whole.format(before=table["before"], said=said.replace("PLACE", name), after=table["after"]), kind)
        for kind, said in table["asked"]
    )
    return rules(f"places_asked_{language}", asked, {})


def answer_about_places(plain: str, language: LanguageCode, context: Context) -> Interpretation | None:
    """The answer to a normalised text that asks about places and nothing else; None for any other text."""
    said = plain.strip(" ?!.。,~")
    for rule in _rules(language).that_may_match(said):
        found = rule.fullmatch(said)
        if found is None:
            continue
        kind, named = rule.said, found.groupdict()
        side = named.get("side") or named.get("side2") or ""
        if kind == "sight":
            return Interpretation(
                "answered", what_is_seen(_side_of(side, language), language, context), language
            )
        place = named.get("place") or (_spoken_of(language, context) if kind == "it" else "")
        reply = _reply(kind, place, side, language, context)
        if reply:
            return Interpretation("answered", reply, language)
    return None


def _reply(kind: str, named: str, side: str, language: LanguageCode, context: Context) -> str:
    if kind == "places":
        return places_told(context, language)
    known = _known(context, language)
    place = known.get(_plain(named))
    if kind == "it" and place is None:
        return say(language, "which_place_asked", places=places_known(context, language))
    if kind not in _OF_ALL and place is None:
        return _unknown(named, list(known), language, context) if _may_be_a_place(named, language) else ""
    unheard = unknown_pose(context)
    if unheard:
        return say(language, unheard)
    if kind in _OF_ALL:
        # Places that are reached by no way that is known come after those that are.
        order = sorted(
            {place.name: place for place in known.values()}.values(), key=lambda p: _far(p, context)
        )
        order = [other for other in order if _straight_m(other, context) > _HERE_M]
        at = 0 if kind == "nearest" else -1
        return say(language, f"place_{kind}", text=_told(order[at], language, context)) if order else ""
    assert place is not None
    if kind == "near":
        return _beside(place, list(known.values()), language)
    told = _told(place, language, context)
    if not side:
        return told
    return say(language, "place_yes" if _is_on(place, side, language, context) else "place_no", text=told)


def _beside(place: _Place, known: list[_Place], language: str) -> str:
    """`Nearest to the sofa: table (1.20 m), door (2.00 m).`"""
    off_m = {
        other.name: math.hypot(other.pose.x_m - place.pose.x_m, other.pose.y_m - place.pose.y_m)
        for other in known
        if other.name != place.name
    }
    near = sorted(off_m, key=lambda name: off_m[name])[:_MOST_BESIDE]
    if not near:
        return say(language, "answer_places", places=place.name)
    told = say(language, "join").join(f"{name} ({fixed(off_m[name], 2)} m)" for name in near)
    return say(language, "place_beside", place=place.name, places=told)


def place_here(language: LanguageCode, context: Context) -> str:
    """`I am at the kitchen.`, where the robot stands at a place that has a name; else an empty string."""
    places = [
        place for place in _known(context, language).values() if place.pose != context.dialogue.start_pose
    ]
    here = min(places, key=lambda place: _straight_m(place, context), default=None)
    if here is None or _straight_m(here, context) > _HERE_M or unknown_pose(context):
        return ""
    return say(language, "answer_place_here", place=here.name)


def _spoken_of(language: str, context: Context) -> str:
    """The place that was named last: it is meant by `it`; an empty string where none was."""
    known = sorted(_known(context, language), key=len, reverse=True)
    for turn in reversed(context.dialogue.turns):
        for name in known:
            if re.search(rf"(?<![a-z]){re.escape(name)}(?![a-z])", _plain(turn.text)):
                return name
    return ""


def with_spoken_place(plain: str, language: str, context: Context) -> str:
    """`Take me there`, after a turn about one place: with its name. Any other text as it is."""
    found = re.search(load_table(language, "places_asked").get("there", "(?!)"), plain)
    place = _last_spoken_of(language, context) if found is not None else ""
    return f"{found['before']}go to the {place}{found['after']}" if found is not None and place else plain


def by_distance_to_place(plain: str, language: str, context: Context) -> str:
    """`50 cm closer to the sofa`, `until you are 1 m from the sofa`, of a known place, as a way to it.

    Any other text as it is: of what is no place, or lies where the robot drives, a sensor sees how far it is.

    Raises:
        Unclear: it is to be backed up to, or told in another way, and lies elsewhere.
    """
    listed = load_table(language, "places_asked").get("by_distance", ())
    known = _known(context, language) if listed else {}
    names = "|".join(re.escape(name) for name in sorted(known, key=len, reverse=True) if name)
    for pattern, said, side in listed:
        found = re.search(pattern.replace("PLACE", f"(?:{names})"), plain) if names else None
        if found is None or (side and _is_towards(known[found["place"]], side, context)):
            continue
        if not said:
            raise Unclear("unclear_motion", plain[:_SHOWN], is_final=True)
        plain = f"{plain[: found.start()]}{found.expand(said)}{plain[found.end() :]}"
    return plain


def _is_towards(place: _Place, side: str, context: Context) -> bool:
    off = math.remainder(_bearing_rad(place, context) - math.radians(_SIDES_DEG[side]), 2 * math.pi)
    return abs(off) < _TOWARDS_RAD


def _last_spoken_of(language: str, context: Context) -> str:
    """The one place that the turns since the last motion named last; an empty string for none, or several."""
    known, start = _known(context, language), load_table(language, "places_asked")["start"]
    for turn in reversed(context.dialogue.turns):
        said = _plain(turn.text)
        named = [name for name in known if re.search(rf"(?<![a-z]){re.escape(name)}(?![a-z])", said)]
        if named or turn.plan is not None:
            name = max(named, key=len, default="")
            return "" if len({known[n].name for n in named}) > 1 else "start" if name in start else name
    return ""


def _plain(name: str) -> str:
    return normalise(word_of(name)).casefold().strip()


def _may_be_a_place(named: str, language: str) -> bool:
    """Whether it may be a name: no pronoun, no sentence of its own, and nothing that another answer is about."""
    is_none = re.search(load_table(language, "places_asked")["no_place"], named) is not None
    return bool(named) and not is_none and not topic_of(named, language)


def _known(context: Context, language: str) -> dict[str, _Place]:
    """Every name that may be said: of the start, of the places of the world, of those the person named."""
    start = load_table(language, "places_asked")["start"]
    called = by_language(start[:1], language)[0]
    found = {name: _Place(called, context.dialogue.start_pose) for name in start}
    groups = context.place_names or tuple((name,) for name in context.world_places)
    for names in groups:
        shown = by_language(names, language)[0]
        found |= {_plain(name): _Place(shown, context.world_places[name.casefold()]) for name in names}
    own = {name: place for name, place in context.dialogue.places.items() if place.usable}
    return found | {_plain(name): _Place(name, place.pose) for name, place in own.items()}


def _unknown(named: str, known: list[str], language: str, context: Context) -> str:
    earlier = {_plain(name): name for name, place in context.dialogue.places.items() if not place.usable}
    if _plain(named) in earlier:
        return say(language, "place_unusable", part=earlier[_plain(named)])
    reply = say(language, "no_such_place", part=named)
    off = {name: edit_distance(_plain(named), name, _FAR_OFF) for name in known}
    near = [name for name in sorted(off, key=lambda name: off[name]) if off[name] * 2 < len(name)]
    if near:
        places = _known(context, language)
        shown = list(dict.fromkeys(places[name].name for name in near))[:_MOST_NAMED]
        return f"{reply} {say(language, 'places_near', places=say(language, 'join').join(shown))}"
    return f"{reply} {places_told(context, language)}"


def _straight_m(place: _Place, context: Context) -> float:
    here = context.state.pose
    return math.hypot(place.pose.x_m - here.x_m, place.pose.y_m - here.y_m)


def _far(place: _Place, context: Context) -> tuple[bool, float]:
    way_m = context.way_m(place.pose)
    return (way_m is None and context.has_ways, _straight_m(place, context) if way_m is None else way_m)


def _bearing_rad(place: _Place, context: Context) -> float:
    seen = place.pose.relative_to(context.state.pose)
    return math.atan2(seen.y_m, seen.x_m)


def _is_on(place: _Place, side: str, language: str, context: Context) -> bool:
    asked = _SIDES_DEG[_side_of(side, language)]
    off = math.remainder(_bearing_rad(place, context) - math.radians(asked), 2 * math.pi)
    return abs(off) < _ON_SIDE_RAD and _straight_m(place, context) > _HERE_M


def _side_of(said: str, language: str) -> str:
    sides = load_table(language, "places_asked")["sides"]
    return next((name for name, pattern in sides.items() if re.fullmatch(pattern, said)), "")


def _told(place: _Place, language: str, context: Context) -> str:
    """`The kitchen is ahead to the left, 3.20 m by the way I would drive.`"""
    if _straight_m(place, context) <= _AT_M:
        return say(language, "place_here", place=place.name)
    sector = SECTORS[round(math.degrees(_bearing_rad(place, context)) / 45.0) % 8]
    way_m = context.way_m(place.pose)
    code = "place_by_way" if way_m is not None else "place_no_way" if context.has_ways else "place_straight"
    metres = fixed(_straight_m(place, context) if way_m is None else way_m, 2)
    return say(language, code, place=place.name, side=say(language, f"sector_{sector}"), distance_m=metres)
