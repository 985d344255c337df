"""An order to go where no place is known: the question names places, and tells of what only stands there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.language.acts import orders
from chatrobot.language.command import read_command
from chatrobot.language.compiled import Key
from chatrobot.language.conditions import is_condition
from chatrobot.language.context import Context, Thing
from chatrobot.language.gloss import MARK
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.lexicon import cut
from chatrobot.language.names import names_in
from chatrobot.language.normalise import normalise
from chatrobot.language.phrases import by_language, name_of, say
from chatrobot.language.reading import Reading
from chatrobot.language.rephrase import rephrased
from chatrobot.language.typos import edit_distance
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Go

_PLACE = "placeqqqq"
"""Stands for what is no known place: an order that goes to it names one."""
_MOST, _FAR_OFF = 5, 99


def where_to(problem: Unclear, text: str, reading: Reading) -> Interpretation | None:
    """The question where to go; None where `text` is no order to go to what nobody knows."""
    language, context = reading.language, reading.context
    is_of_a_goal = problem.code == "unknown_part" and not is_condition(problem)
    if not is_of_a_goal or not orders(normalise(text), names_in(context)):
        return None
    units, part = cut(rephrased(normalise(text), language)), cut(problem.part)
    for key, thing in _things_in(units, part, context, language):
        if _is_goal(units, key, reading):
            return _of_thing(thing, reading)
    if not _is_goal(units, part, reading):
        return None
    said = problem.part.replace(MARK, "")
    places = _places(context, language, lambda names, _: min(edit_distance(said, n, _FAR_OFF) for n in names))
    reply = f"{say(language, 'unknown_place', part=problem.part)} {say(language, 'where_to', places=places)}"
    reply = reply if places else say(language, "which_place")
    return Interpretation("unclear", reply, language, unaccounted=problem.part, code="where_to")


def _of_thing(thing: Thing, reading: Reading) -> Interpretation:
    language = reading.language
    places = _places(reading.context, language, lambda _, pose: thing.off_m(pose.x_m, pose.y_m))
    told = name_of(by_language(thing.names, language)[0], language)
    reply = say(language, "only_in_the_way", the_obstacle=told)
    if places:
        reply = f"{reply} {say(language, 'where_to', places=places)}"
    return Interpretation("unclear", reply, language, code="only_in_the_way")


def _things_in(units: Key, part: Key, context: Context, language: str) -> Iterator[tuple[Key, Thing]]:
    """The things of the map that are named where the unknown part is, the longest name first."""
    named = [(key, thing) for thing in context.things for key in thing.keys(language)]
    for key, thing in sorted(named, key=lambda each: -len(each[0])):
        if set(key) & set(part) and _at(units, key) is not None:
            yield key, thing
    heads = {id(thing): thing for key, thing in named if part and key[-len(part) :] == part}
    if len(heads) == 1:
        yield part, next(iter(heads.values()))


def _is_goal(units: Key, part: Key, reading: Reading) -> bool:
    """Whether the text goes to what stands where `part` does."""
    at = _at(units, part)
    if at is None:
        return False
    text = " ".join((*units[:at], _PLACE, *units[at + len(part) :]))
    places = {**reading.context.world_places, _PLACE: ORIGIN}
    try:
        plan = read_command(
            text, replace(reading, context=replace(reading.context, world_places=places))
        ).plan
    except Unclear:
        return False
    return plan is not None and any(isinstance(step, Go) and step.place == _PLACE for step in plan.steps)


def _at(units: Key, part: Key) -> int | None:
    """Where in the units the part stands."""
    places = range(len(units) - len(part) + 1) if part else ()
    return next((at for at in places if units[at : at + len(part)] == part), None)


def _places(context: Context, language: str, off: Callable[[list[str], Pose], float]) -> str:
    """The names of places that can be gone to, a few of them, the nearest by `off` first."""
    groups = context.place_names or tuple((name,) for name in context.world_places)
    known = [(by_language(names, language), context.world_places[names[0].casefold()]) for names in groups]
    own = context.dialogue.places.items()
    known = [*(([name], place.pose) for name, place in own if place.usable), *known]
    names = [each[0][0] for each in sorted(known, key=lambda each: off(*each))]
    more = ["…"] if len(names) > _MOST else []
    return say(language, "join").join([*names[:_MOST], *more])
