"""Orders to go to a place that a person taught, in any words: `off to the harbour with you`, 再去一趟幼儿园.

Such a clause is put in plain words, with the name in full, before any other word of it is looked up. A name may have
words for what the robot must not do (`frog pond`); and a place that a person named is where he wants it, so that what
tells why beside it needs less evidence of an aside than beside another order.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

from chatrobot.language.acts import may_be_goal, read_acts, without
from chatrobot.language.beside import MAYBE_ASIDE, Aside, asides, is_sure_aside
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.gloss import MARK
from chatrobot.language.lexicon import lexicon
from chatrobot.language.names import names_in
from chatrobot.language.normalise import has_chinese
from chatrobot.language.quoting import holds_back
from chatrobot.language.rules import form, forms
from chatrobot.language.signs import DEPENDING, Clause
from chatrobot.language.talk import calls_somebody

_ENDS = re.compile(r"[.!?;…\n]")
_LEAST_HEAD, _LEAST_BEFORE = 4, 3
"""A compound (`Piratenhafen`) is also called by its last part, which has so many letters, behind so many."""
_NOT_BESIDE = DEPENDING | {"not", "hypothetical"}


def to_taught(plain: str, language: str, context: Context) -> str:
    """A normalised text with each clause that orders to go to a taught place in plain words, and without what only
    tells why; any other text as it is."""
    written = _written(context)
    if not written:
        return plain
    code = language if language in LANGUAGES else LANGUAGES[0]
    parts, begins, before = form(code, "naming", "cut").pattern.split(plain), True, ("", "")
    ordered: list[str] = []
    for k in range(0, len(parts), 2):
        said = parts[k].strip()
        place, lead = _ordered(said, code, written, begins=begins)
        if place:
            parts[k] = _plainly(place, lead, code, "plainly")
            ordered.append(parts[k])
        elif before[0] and form(code, "naming", "stops_halfway").fullmatch(said):
            ordered[-1] = parts[k - 2] = _plainly(*before, code, "halfway")
            parts[k - 1 : k + 1] = ["", ""]
        elif form(code, "naming", "needless").fullmatch(said):
            said = parts[k] = ""
        opens = not said or bool(place) or form(code, "naming", "opens").fullmatch(said) is not None
        begins = (begins and opens) or bool(place) or bool(_ENDS.search("".join(parts[k + 1 : k + 2])))
        before = (place, lead)
    put = "".join(parts)
    if not ordered or calls_somebody(read_acts(put, names_in(context)), code):
        return plain
    return _without_reasons(plain, put, len(ordered), context)


def _written(context: Context) -> dict[str, str]:
    """How each taught place may be written, and the place."""
    found: dict[str, str] = {}
    for key, meaning in names_in(context).items():
        if meaning[0][0] == "place" and meaning[0][1] in context.dialogue.places:
            said = ("" if has_chinese("".join(key)) else " ").join(key)
            found.setdefault(said, meaning[0][1])
    return found


def _ordered(clause: str, language: str, written: Mapping[str, str], *, begins: bool) -> tuple[str, str]:
    """The place that a clause orders to go to, and what stands before the order; empty strings for none."""
    for name in ("going", "onward") if begins else ("going",):
        for pattern in forms(language, "naming", name):
            found = pattern.fullmatch(clause)
            place = _in_full(found["place"].replace(MARK, "").strip(" \"'“”「」"), written) if found else ""
            if found and place:
                return place, found["lead"]
    return "", ""


def _plainly(place: str, lead: str, language: str, way: str) -> str:
    return str(load_table(language, "naming")[way]).format(lead=lead, place=place)


def _in_full(said: str, written: Mapping[str, str]) -> str:
    """The name that `said` is, or is the head of, where it is the only one; else an empty string."""
    if said in written:
        return said
    lettered = {one.format(letter=said) for one in _letter_places()}
    meant = {kind for kind, _ in lexicon().words.get(tuple(said.split()), ())}
    is_plain = bool(said) and not meant - {"refuse", "filler", "glue"}
    heads = {
        place: name
        for name, place in written.items()
        if name in lettered or (is_plain and _is_head(said, name))
    }
    return next(iter(heads.values())) if len(heads) == 1 else ""


@cache
def _letter_places() -> tuple[str, ...]:
    return tuple(one for code in LANGUAGES for one in load_table(code, "dialogue_forms")["letter_places"])


def _is_head(said: str, name: str) -> bool:
    if has_chinese(name):
        return len(said) > 1 and name.endswith(said)
    is_part = len(said) >= _LEAST_HEAD and len(name) >= len(said) + _LEAST_BEFORE and " " not in name
    return name.endswith(f" {said}") or (is_part and name.endswith(said))


def _without_reasons(plain: str, text: str, ordered: int, context: Context) -> str:
    """`text`, in plain words, without the clauses that only tell why; `plain` where others may say how to go there."""
    reads = read_acts(text, names_in(context))
    kept = [read for read in reads if any(sign.is_name for sign in read.clause.signs)]
    beside = [read for read in reads if read not in kept]
    named = sum(sign.is_name for read in kept for sign in read.clause.signs)
    if named != ordered or holds_back([read.clause for read in reads]):
        return plain
    if any(may_be_goal(read, reads) for read in beside):
        return plain
    odds = asides(reads)
    rest = [read.clause for read in beside if not _tells_why(read.clause, odds)]
    if any(clause.moves and not clause.begins_next for clause in rest):
        return plain  # `back to the mirror, just reverse`
    return text if rest else without(text, reads, beside) or text


def _tells_why(clause: Clause, odds: Mapping[int, Aside]) -> bool:
    labels = {sign.label for sign in clause.signs}
    goes_on = clause.goes_on or clause.begins_next or clause.end == ":"
    paces = any(("pace" in dict(lexicon().words.get((sign.text,), ()))) for sign in clause.signs)
    if goes_on or paces or "contrast" in labels or clause.start not in odds:
        return False
    bears = clause.moves or labels & _NOT_BESIDE
    return is_sure_aside(clause, odds) or (not bears and odds[clause.start].odds >= MAYBE_ASIDE)
