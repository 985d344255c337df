"""The order within a text that was dictated without marks: `hmm too close to my chair come back one`.

Where nothing else reads a text, what stands before and behind the order is looked at as if a mark set it off. Both must
be talk that holds nothing of an order, and what is left must be one by itself; it is only ever proposed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from chatrobot.language.acts import ORDER, order_log_odds, read_acts
from chatrobot.language.data_files import relation_words
from chatrobot.language.interpretation import Interpretation, LanguageCode
from chatrobot.language.likeliest import proposed
from chatrobot.language.signs import BINDING, Names, Sign, clauses_of
from chatrobot.language.unclear import Unclear

_MOST_SIGNS, _MOST_TRIED = 26, 10
_BEGINS = frozenset({"VERB", "FLAG", "MULTIPLE", "TIMES", "other", "same", "opening", "please", "request"})
"""Labels of the first word of an order."""
_CLOSES = frozenset({"praise", "social", "robot", "person", "verdict", "mine", "kin", "for"})
"""Labels of the first word of talk behind an order: all else may go on with it."""
_BEARING = (BINDING - {"please"}) | {"report", "later", "sees", "supposed", *'"“”「」『』'}
"""Labels of words that may bear on the order, wherever they stand."""
_TELLING = frozenset({"earlier", "did", "past"})
"""Labels of words that may tell of another motion than the one that is ordered."""
_STUMBLED = frozenset({"unknown_part", "unclear_motion", "nothing_to_do"})
"""Why a text was not read, where it may have talk in it."""
_NOW = "now"
"""What parts what is told of before from what is ordered: `that made me dizzy now the other way round`."""
_SUBJECTS = frozenset({"mine", "kin", "other", "person", "to", "can"})
"""Labels of words that do what the verb right behind them says: `we go back`."""
_TALK, _SURE_TALK = ORDER, -1.5
"""What is left out has lower odds of an order: the first where all of the text orders something, else the second."""

Reader = Callable[[str], Interpretation]


@dataclass(frozen=True)
class _Said:
    """A text, its words, and those that begin a clause."""

    plain: str
    names: Names
    signs: Sequence[Sign]
    opening: frozenset[int]

    def between(self, begin: int, end: int) -> str:
        """The text from one word to before another."""
        starts = [*(sign.start for sign in self.signs), len(self.plain)]
        return self.plain[starts[begin] : starts[end]].strip(" ,;:")

    def odds(self, begin: int, end: int) -> float:
        return order_log_odds(read_acts(self.between(begin, end), self.names))


def set_apart(
    plain: str, names: Names, language: LanguageCode, problem: Unclear, read: Reader
) -> Interpretation | None:
    """The order in a normalised text, proposed, where `read` raised `problem`; None where none stands apart in it."""
    clauses = clauses_of(plain, names)
    signs = [sign for clause in clauses for sign in clause.signs]
    if (
        problem.refused
        or problem.code not in _STUMBLED
        or not 1 < len(signs) <= _MOST_SIGNS
        or not any(sign.moves for sign in signs)
    ):
        return None
    said = _Said(plain, names, signs, frozenset(clause.signs[0].start for clause in clauses))
    for (begin, end), _ in zip(_parts(said), range(_MOST_TRIED)):
        part = said.between(begin, end)
        if order_log_odds(read_acts(part, names)) < ORDER:
            continue
        try:
            found = read(part)
        except Unclear:
            continue
        if found.plan is not None:
            left_out = max(said.between(0, begin), said.between(end, len(signs)), key=len)
            return proposed(found, language, (left_out,))
    return None


def _parts(said: _Said) -> Iterator[tuple[int, int]]:
    """Where what may be the order begins and ends, all else being talk: the longest first."""
    count = len(said.signs)
    limit = _TALK if said.odds(0, count) >= ORDER else _SURE_TALK
    begins = [
        i
        for i in range(count)
        if _is_before_now(said, i) or (_may_begin(said, i) and _is_talk(said, 0, i, limit))
    ]
    ends = [j for j in range(count, 0, -1) if _may_end(said, j) and _is_talk(said, j, count, limit)]
    parts = ((i, j) for i in begins for j in ends if i < j and 0 < i + count - j < count)
    return iter(sorted(parts, key=lambda part: part[0] - part[1]))


def _may_begin(said: _Said, at: int) -> bool:
    """Whether an order may begin there: behind no mark, no subject of it, and no half phrase."""
    if at == 0:
        return True
    before, sign = said.signs[at - 1], said.signs[at]
    if sign.label not in _BEGINS or sign.start in said.opening:
        return False
    if before.text in relation_words("words") | relation_words("articles"):
        return False
    named = before.label == "thing" or (at > 1 and said.signs[at - 2].text in relation_words("articles"))
    if named and sign.label == "FLAG":
        return False  # `the turn again`
    return before.label not in _SUBJECTS or sign.label != "VERB"


def _may_end(said: _Said, at: int) -> bool:
    if at == len(said.signs):
        return True
    last, sign = said.signs[at - 1], said.signs[at]
    is_whole = last.moves or last.label in ("opening", "please")
    return is_whole and sign.label in _CLOSES and sign.start not in said.opening


def _is_before_now(said: _Said, at: int) -> bool:
    """Whether `now` stands there, and nothing before it orders anything, or bears on what does."""
    signs = said.signs[:at]
    if not signs or said.signs[at].text != _NOW or said.signs[at].start in said.opening:
        return False
    bearing = _BEARING - {"question"}
    return not any(sign.label in bearing or (sign.moves and sign.label.isupper()) for sign in signs)


def _is_talk(said: _Said, begin: int, end: int, limit: float) -> bool:
    """Whether nothing of it is part of an order, or bears on one."""
    if begin == end:
        return True
    bearing = relation_words("words") | relation_words("moved")
    labels = _BEARING if begin else _BEARING | _TELLING
    for sign in said.signs[begin:end]:
        if sign.label in labels or (sign.moves and sign.label.isupper()):
            return False
        if any(word in bearing for word in sign.text.split("_")):
            return False
    return said.odds(begin, end) < limit
