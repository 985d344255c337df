"""`The rug is 2.4 m long, do a quarter of that`; `the door is 4 m ahead, stop 1 m short of it`: a way told by a thing.

A text tells how long a thing is, or how far ahead, and its order counts the thing, wants a share of it, or leads up to
it. The order is put with the length that comes of it, in the person's own language, before anything else is read. The
wordings are `data/<code>/things.toml`.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.data_files import in_full as with_parts
from chatrobot.language.gloss import gloss, written_plainly
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.quantities import read_quantities
from chatrobot.language.rephrase import in_full, rephrased
from chatrobot.language.rules import form, forms
from chatrobot.language.tokens import tokenise
from chatrobot.language.unclear import Unclear

_GAP = "\t"
"""Stands where a gap was told: no text has it."""
MARK = re.compile(r"[;!?:，。；！？\n]|(?<!\d)[,.]|[,.](?!\d)")
_STOP = re.compile(r"[;!?\n。；！？]|\.(?!\d)")
_PASSED = frozenset({"glue", "num", "filler"})
_NOUNS = frozenset({"filler", "glue", "verb"})
"""What else a word may mean whose length is told: `my stride is 70 cm`."""
_FACTORS = frozenset({"number", "times", "fold", "scale", "percent", "count", "turns"})
_LEAST_M = 0.01


class Put(NamedTuple):
    """A text with its way told in metres; not sure, where only the order tells that the thing is ahead."""

    text: str
    is_sure: bool


@dataclass(frozen=True)
class _Told:
    """What a text tells of a thing: its length, or with a `way` its distance that way; `said` is the measure."""

    text: str
    thing: str
    metres: float
    said: str
    side: str = ""
    is_far: bool = False
    way: str = ""


def by_things(text: str, language: str, known: Collection[str] = ()) -> Put | None:
    """The text with the way that comes of what it tells of a thing; None where none is told or wanted.

    `known` are the names of places: one of them is no thing.
    """
    if not form(language, "things", "mentions").search(text.lower()):
        return None
    plain = in_full(normalise(text), language) if language in LANGUAGES else written_plainly(text, language)
    found = list(_told(plain, language))
    if not found:
        return None
    rest, told = found[-1][0], [one for _, one in found]
    if any(one.thing in known for one in told):
        return None
    put = _led(rest, told, language) or _counted(rest, told, language)
    return None if put is None else Put(" ".join(put.text.split()).lstrip(",.; "), put.is_sure)


def check_counted(plain: str, language: str) -> None:
    """`My car is 4 m long, go forward`: a length that no order counts; `the box is 40 cm wide, drive 2 m` draws none.

    Raises:
        Unclear: naming what is told.
    """
    code = language if language in LANGUAGES else LANGUAGES[0]
    unread = next(filter(None, (one.search(plain) for one in forms(code, "things", "unread"))), None)
    if unread is not None:
        raise Unclear("unknown_part", unread[0])
    for rest, one in _told(plain, code):
        head = one.thing.split(" ")[-1]
        named = [(head,), (head.removesuffix("s"),), tuple(head)]
        kinds = {kind for name in named for kind, _ in lexicon().words.get(name, ())}
        if "shape" in kinds and (head in rest or not _search("measured", "", rest, code)):
            continue
        if not one.is_far and kinds <= {*_NOUNS, "shape"} and _search("owned", "", one.text, code):
            raise Unclear("unknown_part", one.text)


def _told(rest: str, language: str) -> Iterator[tuple[str, _Told]]:
    """Each thing whose measure is told, and the text without that."""
    far: list[_Told] = []
    for name in ("far", "farther", "long"):
        for pattern in forms(language, "things", name):
            while (found := pattern.search(rest)) is not None:
                groups = _groups(found)
                metres = _amount(groups["told"], language)
                before = far[-1].metres if far and name == "farther" else 0.0
                if metres is None or (name == "farther" and not before):
                    break
                one = _Told(
                    found[0].strip(" ,.;:"),
                    groups.get("named", "").strip(),
                    before + metres,
                    groups["told"],
                    next((side for side in ("long", "wide") if groups.get(side)), ""),
                    is_far=name != "long",
                    way="back"
                    if groups.get("behind")
                    else "forward"
                    if groups.get("ahead") or before
                    else "",
                )
                rest = f"{rest[: found.start()]}{groups.get('keep', '')} {rest[found.end() :]}".strip()
                begun = _search("begun", "", rest, language) if name == "long" else None
                if begun is not None:  # it lies ahead, and its end is what can be reached
                    rest = f"{rest[: begun.start()]} {rest[begun.end() :]}".strip()
                    one = replace(one, is_far=True, way="forward")
                far += [one] if one.is_far else []
                yield rest, one


def _led(rest: str, told: list[_Told], language: str) -> Put | None:
    """What leads up to the thing, or to a gap before it."""
    for one in (one for one in reversed(told) if one.is_far):
        gap = _search("gap", one.thing, rest, language)
        gap_m = _amount(_groups(gap)["short"], language, one.said) if gap is not None else 0.0
        if gap_m is None or gap_m > one.metres - _LEAST_M:
            continue
        said = f"{rest[: gap.start()]}{_GAP}{rest[gap.end() :]}" if gap is not None else rest
        reach = _search("reach", one.thing, said, language)
        if reach is None and gap is not None:
            reach = _search("up_to_gap", one.thing, said, language)
        if reach is None and (gap is None or not _groups(gap).get("own")):
            continue
        if _is_barred(said, reach or re.search(_GAP, said), language):
            return None
        groups = _groups(reach) if reach is not None else {}
        way = one.way or "forward"
        if groups.get("middle"):
            gap_m = one.metres / 2
        if groups.get("backs"):
            way = "" if one.way == "forward" else "back"
        if not way or (way == "back" and one.way != way):
            return None
        order = _table(language)["stopped" if reach is None else "reached"][way]
        words = {name: groups.get(name, "") for name in ("how", "kept", "last")}
        order = f" {' '.join(order.format(m=_metres(one.metres - gap_m), **words).split())}"
        if reach is None:
            said = said.replace(_GAP, order)
        else:
            before, after = said[: reach.start()], said[reach.end() :]
            if _search("still", "", f"{before} {after}", language):
                return None
            said = f"{before}{order}{after}".replace(_GAP, "")
        is_solid = gap is None and _search("solid", "", one.thing, language) is not None
        return Put(said, is_sure=not is_solid and bool(one.way or groups.get("ahead")))
    return None


def _counted(rest: str, told: list[_Told], language: str) -> Put | None:
    """How often the thing is wanted, or what share of it; a pronoun may mean it where no other length is told."""
    used: set[str] = set()
    if _search("apart", "", rest, language):
        return None
    is_alone = len(told) == 1 and not _search("measured", "", rest, language)
    for name in ("counted", "shared", "shared_by_pronoun"):
        for one in told:
            if name == "shared_by_pronoun" and not is_alone:
                continue
            at = 0
            for _ in range(4):
                found = _search(name, one.thing, rest, language, at, first=True)
                if found is None:
                    break
                if _is_barred(rest, found, language) or not _is_ordered(rest, found, language):
                    return None
                groups = _groups(found)
                sides = [side for side in ("long", "wide") if groups.get(side)]
                factor = _factor(groups, language)
                if factor is None or (sides and one.side and sides[0] != one.side):
                    return None
                length = _table(language)["metres"].format(m=_metres(factor * one.metres))
                length = f"{groups.get('kept', '')} {length}".lstrip()
                rest = f"{rest[: found.start()]}{length}{rest[found.end() :]}"
                at = found.start() + len(length)
                used.add(one.thing)
        if used and name != "counted":
            break
    return Put(rest, is_sure=True) if used and len(used) == len({one.thing for one in told}) else None


def _is_ordered(text: str, found: re.Match[str], language: str) -> bool:
    """Whether its sentence names a motion: `we need four tiles` counts them for something else."""
    begins = max((mark.end() for mark in _STOP.finditer(text, 0, found.start())), default=0)
    after = _STOP.search(text, found.end())
    said = f"{text[begins : found.start()]} {text[found.end() : after.start() if after else len(text)]}"
    return _search("ordered", "", said, language) is not None


def _is_barred(text: str, found: re.Match[str] | None, language: str) -> bool:
    """Whether the clause that it stands in denies, asks, depends on something or tells of before."""
    start, stop = found.span() if found is not None else (0, len(text))
    begins = max((mark.end() for mark in MARK.finditer(text, 0, start)), default=0)
    return _search("barred", "", text[begins:stop], language) is not None


def _factor(groups: Mapping[str, str], language: str) -> float | None:
    half = 0.5 if groups.get("half") else 0.0
    said = groups.get("count") or groups.get("part")
    if not said:
        return 0.5 if groups.get("middle") else 1.0 + half
    words = _atoms(said, language)
    if words and all(atom.kind == "num" for atom in words):
        return 1.0 + half  # an article
    atoms = [atom for atom in words if atom.kind == "q"]
    fits = len(atoms) == 1 and atoms[0].value in _FACTORS and 0 < atoms[0].number <= 1000
    return atoms[0].number + half if fits else None


def _groups(found: re.Match[str]) -> dict[str, str]:
    """What its groups hold; a name with a mark behind it is the same, elsewhere in the pattern."""
    return {name.rstrip("_"): said for name, said in found.groupdict().items() if said}


def _amount(said: str, language: str, like: str = "") -> float | None:
    """The length in metres that these words are, in the unit of `like` where they have none."""
    atoms = _atoms(said, language)
    if like and [atom.value for atom in atoms if atom.kind == "q"] == ["number"]:
        unit = re.findall(with_parts("<unit>", _table(language)["parts"]), like)
        atoms = _atoms(f"{said} {unit[-1]}", language) if unit else atoms
    lengths = [atom.number for atom in atoms if (atom.kind, atom.value) == ("q", "length")]
    others = [atom for atom in atoms if atom.kind not in ("q", *_PASSED)]
    return lengths[0] if len(lengths) == sum(atom.kind == "q" for atom in atoms) == 1 and not others else None


@lru_cache(maxsize=64)
def _atoms(said: str, language: str) -> list[Any]:
    code = language if language in LANGUAGES else LANGUAGES[0]
    plain = said if language in LANGUAGES else gloss(said, language).text
    return read_quantities(tokenise(rephrased(in_full(normalise(plain), code), code), lexicon(), {}))


def _metres(value: float) -> str:
    return f"{round(value, 4):g}"


def _table(language: str) -> dict[str, Any]:
    return load_table(language, "things")


def _search(
    name: str, thing: str, text: str, language: str, at: int = 0, *, first: bool = False
) -> re.Match[str] | None:
    patterns = (re.compile(source) for source in _sources(name, thing, language))
    found = filter(None, (pattern.search(text, at) for pattern in patterns))
    return min(found, key=lambda one: one.start(), default=None) if first else next(found, None)


@lru_cache(maxsize=128)
def _sources(name: str, thing: str, language: str) -> list[str]:
    """The patterns of that name, with the thing as a text may name it again put in."""
    table = _table(language)
    head = thing
    for pattern, put in table["head"]:
        head = re.sub(pattern, put, head)
    is_named = thing and not re.fullmatch(table["pronoun"], thing)
    named = table["named"].replace("HEAD", head) if is_named else table["any"]
    parts = {**table["parts"], "thing": with_parts(named, table["parts"])}
    return [with_parts(pattern, parts) for pattern in table[name]]
