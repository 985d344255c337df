"""Words that name motions and order none: what is taken back, told of others, quoted, or part of talk."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from functools import cache

from chatrobot.language.acts import MAYBE_ORDER, ORDER, Read, order_log_odds, read_acts
from chatrobot.language.beside import Aside, asides, refers_alone, says_motion_alone
from chatrobot.language.context import Context, Dialogue
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.ledger import TurnRecord
from chatrobot.language.lexicon import lexicon
from chatrobot.language.names import names_in
from chatrobot.language.normalise import normalise
from chatrobot.language.quoting import holds_back
from chatrobot.language.rephrase import rephrased
from chatrobot.language.rules import Rules, form, rules
from chatrobot.language.set_off import is_doubted
from chatrobot.language.signs import Clause, Sign, clauses_of, is_strong
from chatrobot.plan.base import Block
from chatrobot.plan.steps import Drive, Plan, RawTwist, Step, Turn

_BARE = frozenset({"NUMBER", "UNIT", "DIR", "SCALE", "FRACTION", "COUNTER"})
_ASKING = frozenset({"request", "please", "polite", "correction", "complaint"})
_OPENING = frozenset({"opening", "robot", "social", "praise", "not", "same"})
_CALLING = frozenset({"person", "please", "opening"})
_POLITE = frozenset({"please", "opening", "social"})
_AMOUNT = frozenset({"NUMBER", "UNIT", "FRACTION"})
_NAMED = frozenset({"AMOUNT", "DIR", "SHAPE"})
_SUBJECTS = frozenset({"mine", "kin", "other", "thing"})
_MEANT = frozenset({"VERB", "DIR", "ROT", "SHAPE", "UNIT", "PLACE"})
"""Labels of words by which a clause could be meant for the robot, though somebody else is its subject."""
TOLD = 1.5
"""A clause with higher odds of an aside tells of something, so that a motion without an amount beside it may, too."""


def not_ordered(plain: str, language: str, plan: Plan | None, dialogue: Dialogue) -> str:
    """Why what a normalised text seems to order is not to be done, as a reason; "" where nothing says so.

    It is taken back at its end (`go ahead, no wait, don't go`), or is told of others, or was quoted, or what ends
    it is for no sensor to tell, or it only says yes to what was just done.
    """
    if plan is not None and _confirms(plain, language, plan, dialogue):
        return "nothing_to_do"
    if plan is not None and _has_twists(plan.steps) and clauses_of(plain)[0].tells_of_command:
        return "nothing_to_do"
    if form(language, "starting", "withdrawn").search(plain):
        return "taken_back"
    if form(language, "starting", "bounded").search(plain):
        return "condition"
    return "nothing_to_do" if _says(plain, language, "told") else ""


def _confirms(plain: str, language: str, plan: Plan, dialogue: Dialogue) -> bool:
    """对，左转，我打错字了: whether a yes only names the way of the motion before, and answers nothing."""
    last = dialogue.turns[-1].plan if dialogue.turns else None
    if last is None or dialogue.pending or not form(language, "talk", "confirms").fullmatch(plain.strip()):
        return False
    done, meant = last.steps[-1], plan.steps[0]
    if isinstance(done, Turn) and isinstance(meant, Turn):
        return done.left == meant.left
    return isinstance(done, Drive) and isinstance(meant, Drive) and done.direction_rad == meant.direction_rad


def hardly_ordered(plain: str, language: str) -> bool:
    """Whether what a normalised text seems to order may as well be a remark: `great, a quarter turn to the left`."""
    return _says(plain, language, "remarked")


def _says(plain: str, language: str, name: str) -> bool:
    return _rules(language, name).any_in(plain)


@cache
def _rules(language: str, name: str) -> Rules:
    table = load_table(language, "talk")
    return rules(f"talk_{language}_{name}", [(rule, "") for rule in table[name]], table["parts"])


def may_be_talk(meant: Interpretation, text: str, language: str, context: Context) -> bool:
    """Whether a plan stands beside words that make it quoted, or said to somebody else, or to nobody."""
    if meant.plan is None:
        return False
    last = context.dialogue.turns[-1] if context.dialogue.turns else None
    names = names_in(context)
    clauses = clauses_of(text, names)
    is_done = last is not None and last.plan == meant.plan and last.walk is None
    if (is_done and _says(text, language, "praised")) or _refers_past_question(text, language, context):
        return True
    if last is not None and _answers_others(clauses, last, context):
        return True
    if len(clauses) < 2:
        return False  # there is nothing beside it
    if holds_back(clauses) or is_doubted(text, clauses, meant.language):
        return True
    if meant.corrects or context.dialogue.pending or _has_twists(meant.plan.steps):
        return False
    reads = read_acts(text, names)
    if _tells_of_the_person(reads):
        return True
    return (
        _is_bare_beside_talk(reads) or calls_somebody(reads, language) or _calls_a_name(reads, text, context)
    )


def _answers_others(clauses: Sequence[Clause], last: TurnRecord, context: Context) -> bool:
    """`Two metres twenty`, after `how wide is that couch?`: a question that nobody asked the robot."""
    before = read_acts(normalise(last.text), names_in(context))
    is_question = last.text.rstrip().endswith(("?", "？")) or any(read.clause.asks for read in before)
    asked = last.outcome in ("unclear", "answered") and is_question
    signs = [sign for clause in clauses for sign in clause.signs]
    moving = {"AMOUNT" if sign.label in _AMOUNT else sign.label for sign in signs if sign.moves}
    if not asked or len(moving) != 1 or not moving <= _NAMED or any(sign.label in _ASKING for sign in signs):
        return False
    return order_log_odds(before) < MAYBE_ORDER


_WAYS = frozenset({("flag", "same_way"), ("flag", "other_way")})
"""They answer to which side."""


def _refers_past_question(text: str, language: str, context: Context) -> bool:
    """Whether a text asks for the motion before, and another order was asked back since: `do that twice`, of which?"""
    dialogue, names = context.dialogue, names_in(context)
    if not dialogue.pending or not any(turn.moved for turn in dialogue.turns):
        return False
    pending = read_acts(normalise(dialogue.pending), names)
    reads = read_acts(rephrased(text, language), names)
    signs = [sign for read in reads for sign in read.clause.signs]
    completes = any(
        sign.is_name or _WAYS & {*lexicon().words.get(tuple(sign.text.split("_")), ())} for sign in signs
    )
    told = order_log_odds(pending) >= ORDER and any(read.clause.tells for read in pending)
    is_order = (dialogue.offered is not None or told) and not refers_alone(pending)
    return is_order and not completes and refers_alone(reads)


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
    if any(_refers(sign) for read in talk for sign in read.clause.signs):
        return False  # it points at the motion before: 一样，加二十厘米
    if talk and talk[-1] is reads[-1] and any(sign.label == "praise" for sign in reads[-1].clause.signs):
        return True
    is_whole = "DIR" in named and len(named) > 1
    return not is_whole and any(sign.label not in _OPENING for read in talk for sign in read.clause.signs)


def _tells_of_the_person(reads: Sequence[Read]) -> bool:
    """我先往右挪半米，给你让路: whether each clause that names a motion is about who speaks, and hardly an order."""
    named = [read for read in reads if any(sign.moves and sign.label.isupper() for sign in read.clause.signs)]
    return all(read.clause.signs[0].label == "mine" and read.log_odds < MAYBE_ORDER for read in named)


def _refers(sign: Sign) -> bool:
    return sign.moves and not sign.label.isupper() and sign.label != "past"


def calls_somebody(reads: Sequence[Read], language: str) -> bool:
    """`Please Ben, not so fast, go back a step`: whether somebody else is called, and the robot is not.

    `Grandpa, you go back` calls nobody else: who is called is who is meant.
    """
    clauses = [read.clause for read in reads]
    pronouns = load_table(language, "talk")["pronouns"]
    if any(
        sign.label == "robot" and sign.text not in pronouns for clause in clauses for sign in clause.signs
    ):
        return False
    measured = any(clause.measures for clause in clauses)
    if any(_tells_somebody(clause, pronouns) and (clause.measures or not measured) for clause in clauses):
        return True
    begin = next((i for i, clause in enumerate(clauses) if clause.moves), len(clauses))
    before, after = clauses[:begin], clauses[begin + 1 : begin + 2]
    if any(is_strong(clause.end) for clause in before):
        return False  # `thanks, Mum. Now go forward`
    if measured or is_strong(clauses[begin : begin + 1][-1].end):
        after = []
    return any("person" in labels and labels <= _CALLING for labels in map(_labels, [*before, *after]))


def _tells_somebody(clause: Clause, pronouns: Sequence[str]) -> bool:
    """大家都退后, 奶奶您慢点儿走: whether somebody else is told to do a motion."""
    said = [sign for sign in clause.signs if sign.label not in _POLITE]
    labels = [sign.label for sign in said]
    if labels[:2] == ["person", "robot"] and said[1].text in pronouns:
        del labels[1]
    return labels[:1] == ["person"] and "VERB" in labels and not {"robot", "request", "past"} & {*labels}


def _calls_a_name(reads: Sequence[Read], text: str, context: Context) -> bool:
    """`Rex, go back`, 王子涵！后退: whether it begins with a name that nobody gave the robot, and tells no amount.

    The robot has that name once it moved for it: `Rex, go back 1 m`, or a yes to what was proposed.
    """
    clause = reads[0].clause
    name = text[clause.start : clause.stop].strip(" ,!")
    looks_like_one = any(form(code, "talk", "name").fullmatch(name) for code in LANGUAGES)
    is_strange = clause.end == "," and len(clause.signs) == 1 and (name,) not in lexicon().words
    is_name = is_strange or (clause.end in (",", "!") and looks_like_one)
    if not is_name or any(sign.label != sign.text for sign in clause.signs):
        return False
    if any(read.clause.measures for read in reads):
        return False
    turns = [*context.dialogue.turns, *context.dialogue.turns[-1:]]
    said = (turn for turn, after in itertools.pairwise(turns) if turn.moved or after.moved)
    return not any(normalise(turn.text).startswith(name) for turn in said)


def _labels(clause: Clause) -> set[str]:
    return {sign.label for sign in clause.signs}


def _is_told(read: Read, found: Mapping[int, Aside]) -> bool:
    """Whether a clause names no motion at all, tells of somebody, or is surely an aside without an amount."""
    labels = [sign.label for sign in read.clause.signs if sign.moves and sign.label.isupper()]
    if not labels or (read.clause.signs[0].label in _SUBJECTS and not _MEANT & {*labels}):
        return True
    aside = found.get(read.clause.start)
    is_aside = aside is not None and aside.odds >= TOLD
    return is_aside and not read.clause.tells and not says_motion_alone(read.clause)


def _has_twists(steps: Sequence[Step]) -> bool:
    return any(isinstance(s, RawTwist) or (isinstance(s, Block) and _has_twists(s.steps)) for s in steps)
