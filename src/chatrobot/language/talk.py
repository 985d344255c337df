"""Words that name motions and order none: what is taken back, told of others, quoted, or part of talk."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from functools import cache

from chatrobot.language.acts import Read, read_acts
from chatrobot.language.beside import SURE_ASIDE, Aside, asides
from chatrobot.language.context import Context
from chatrobot.language.data_files import form, load_table
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.names import names_in
from chatrobot.language.quoting import holds_back
from chatrobot.language.rules import Rule, rules
from chatrobot.language.set_off import is_doubted
from chatrobot.language.signs import Clause, clauses_of, is_strong
from chatrobot.plan.base import Block
from chatrobot.plan.steps import RawTwist, Step

_BARE = frozenset({"NUMBER", "UNIT", "DIR", "SCALE", "FRACTION", "COUNTER"})
_ASKING = frozenset({"request", "please", "polite", "correction", "complaint"})
_OPENING = frozenset({"opening", "robot", "social", "praise", "not", "same"})
_CALLING = frozenset({"person", "please"})


def not_ordered(plain: str, language: str) -> str:
    """Why what a normalised text seems to order is not to be done, as a reason; "" where nothing says so.

    It is taken back at its end (`go ahead, no wait, don't go`), or is told of others, or was quoted, or what ends
    it is for no sensor to tell.
    """
    if form(language, "starting", "withdrawn").search(plain):
        return "taken_back"
    if form(language, "starting", "bounded").search(plain):
        return "condition"
    return "nothing_to_do" if _says(plain, language, "told") else ""


def hardly_ordered(plain: str, language: str) -> bool:
    """Whether what a normalised text seems to order may as well be a remark: `great, a quarter turn to the left`."""
    return _says(plain, language, "remarked")


def _says(plain: str, language: str, name: str) -> bool:
    return any(rule.is_in(plain) for rule in _rules(language, name))


@cache
def _rules(language: str, name: str) -> tuple[Rule, ...]:
    table = load_table(language, "talk")
    return rules(f"talk_{language}_{name}", [(rule, "") for rule in table[name]], table["parts"])


def may_be_talk(meant: Interpretation, text: str, context: Context) -> bool:
    """Whether a plan stands beside words that make it quoted, or said to somebody else, or to nobody."""
    if meant.plan is None:
        return False
    names = names_in(context)
    clauses = clauses_of(text, names)
    if len(clauses) < 2:
        return False  # there is nothing beside it
    if holds_back(clauses) or is_doubted(text, clauses, meant.language):
        return True
    if meant.corrects or context.dialogue.pending or _has_twists(meant.plan.steps):
        return False
    reads = read_acts(text, names)
    return _is_bare_beside_talk(reads) or _calls_somebody(reads)


def _is_bare_beside_talk(reads: Sequence[Read]) -> bool:
    """Whether a way alone or an amount alone stands beside talk (`left, of course`), or a whole motion before praise.

    No verb and no other word asks for it, so it may as well be part of the talk.
    """
    found = asides(reads)
    bare = [read for read in reads if not _is_told(read, found)]
    named = {sign.label for read in bare for sign in read.clause.signs if sign.moves and sign.label.isupper()}
    if not named or not named <= _BARE:
        return False
    if any(sign.label in _ASKING for read in reads for sign in read.clause.signs):
        return False
    talk = [read for read in reads if read not in bare]
    if any(sign.moves and not sign.label.isupper() for read in talk for sign in read.clause.signs):
        return False  # it points at the motion before: 一样，加二十厘米
    if talk and talk[-1] is reads[-1] and any(sign.label == "praise" for sign in reads[-1].clause.signs):
        return True
    is_whole = "DIR" in named and len(named) > 1
    return not is_whole and any(sign.label not in _OPENING for read in talk for sign in read.clause.signs)


def _calls_somebody(reads: Sequence[Read]) -> bool:
    """`Please Ben, not so fast, go back a step`: whether somebody else is called first, and the robot is not."""
    before = [read.clause for read in itertools.takewhile(lambda read: not read.clause.moves, reads)]
    if any(is_strong(clause.end) for clause in before):
        return False  # `thanks, Mum. Now go forward`
    called = any("person" in labels and labels <= _CALLING for labels in map(_labels, before))
    return called and not any("robot" in _labels(read.clause) for read in reads)


def _labels(clause: Clause) -> set[str]:
    return {sign.label for sign in clause.signs}


def _is_told(read: Read, found: Mapping[int, Aside]) -> bool:
    """Whether a clause names no motion at all, or is surely an aside without an amount."""
    if not any(sign.moves and sign.label.isupper() for sign in read.clause.signs):
        return True
    aside = found.get(read.clause.start)
    return aside is not None and aside.odds >= SURE_ASIDE and not read.clause.tells


def _has_twists(steps: Sequence[Step]) -> bool:
    return any(isinstance(s, RawTwist) or (isinstance(s, Block) and _has_twists(s.steps)) for s in steps)
