"""Puts a text of a language whose words the reader does not know into English words, word by word.

The reader's rules care little for the order of words, so a gloss is enough: `data/<code>/gloss.toml` has the words, the
verbs with their forms and what parts from them, and rules for what two languages order differently. What no word of it
covers keeps its letters and gets a mark, so that it is never taken for a misspelt English word.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from chatrobot.language.gloss_tables import UNIT, VERB, Key, Tables, folded, tables
from chatrobot.language.lexicon import lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.typos import is_slip

MARK = "qx"
"""Ends a word that no gloss covers, so that it is near no English word; no word ends in it."""
_BREAK = re.compile(r"((?:[,!?;:…\n()\"“”„«»—–]|\.(?!\d))+)")
_WORD = re.compile(r"[^\W\d_]+")
_MARKED = re.compile(rf"([\w~]+)\{VERB}")
_CHANGED = re.compile(r"([aou])e(?![aeou])")
_LEAST_STEM, _LEAST_MENDED = 4, 5
_NEGATIVE, _MINUS = re.compile(r"(?<![\w.,])-\.?\d"), re.compile(r"(?<![\w.,])- (?=\.?\d)")
_SPACES = re.compile(r"[ \t]+")
_SENTENCE = re.compile(r"(?<=[.!?;\n])(?!\d)")
_BEFORE_MARK = re.compile(r" +([,.!?;:…])")


@dataclass(frozen=True)
class Gloss:
    """A text in English words; `said` maps words of it to how they were written."""

    text: str
    said: Mapping[str, str]

    def as_said(self, words: str) -> str:
        """Part of the gloss as it was written, as far as that is known."""
        whole = self.said.get(words) if len(words) > 1 else words  # point A is no `einen`
        if whole:
            return whole
        for phrase in sorted((said for said in self.said if " " in said), key=len, reverse=True):
            words = re.sub(rf"\b{re.escape(phrase)}\b", lambda found: self.said[found[0]], words)
        return re.sub(r"[^\W\d_]+", lambda found: self.said.get(found[0], found[0]), words)

    def as_kept(self, text: str) -> str:
        """A text with the words that no gloss covers as they were written."""
        return re.sub(
            rf"[^\W\d_]+{MARK}", lambda found: self.said.get(found[0], found[0].removesuffix(MARK)), text
        )


def gloss(text: str, language: str, names: Collection[Key] = ()) -> Gloss:
    """`text` in English words. `names` are words of this dialogue and stay as they are, as does a word it teaches."""
    using = tables(language)
    written = {folded(word, language): word for word in _WORD.findall(text)}
    written |= {using.dialect[word]: said for word, said in written.items() if word in using.dialect}
    spoken = written_plainly(text, language)
    taught = {
        tuple(said.split()) for found in using.taught.finditer(spoken) for said in found.groups() if said
    }
    names = {name for name in (*names, *taught) if name}  # none of a name that is all marks
    plain = using.before.applied(spoken)
    folded_names = {tuple(folded(unit, language) for unit in name): name for name in names}
    folded_names |= {
        (said,): name for key, name in folded_names.items() if len(key) == 1 for said in _ordered(key[0])
    }
    found = list(_words(UNIT.findall(plain), using, folded_names))
    said = {
        english.replace(VERB, "").strip(): " ".join(written.get(unit, unit) for unit in key)
        for key, english in reversed(
            found
        )  # of words that mean the same the first: it is the one that is taught
        if english
    }
    out = _in_order(_tidy(" ".join(english for _, english in found)), using)
    out = _MINUS.sub("-", out) if _NEGATIVE.search(plain) else out
    for name in names:  # `Station zwei` is `station 2`
        marked = " ".join(f"{re.escape(unit)}(?:{MARK})?" for unit in name)
        out = re.sub(rf"\b{marked}(?!\w)", " ".join(name), out)
    return Gloss(out, said)


def written_plainly(text: str, language: str) -> str:
    """`text` without letters of its own, and without words that are only written as they are spoken."""
    dialect = tables(language).dialect
    return _WORD.sub(lambda word: dialect.get(word[0], word[0]), folded(normalise(text), language))


def _ordered(word: str) -> Iterator[str]:
    """Yield a taught verb as it is in an order: “wackel” and “wackle”, of “wackeln”."""
    if word.endswith("n") and len(word) > _LEAST_STEM:
        yield word[:-1]
        yield word[:-1].removesuffix("e")
        yield (
            f"{word[:-3]}{word[-2]}e" if word.endswith(("eln", "ern")) else f"{word[:-1].removesuffix('e')}e"
        )


def _in_order(words: str, using: Tables) -> str:
    """English words in the order that the reader expects."""
    ruled = "".join(using.rules.applied(part.lstrip()) + " " for part in _SENTENCE.split(words))
    clauses = [clause for part in _BREAK.split(ruled) for clause in using.joint.split(part)]
    opened = "".join(_verb_first(clause, using) for clause in clauses).replace(VERB, "")
    return _tidy(using.after.applied(_tidy(opened).replace("~", " "))).strip(" ,")


def _tidy(text: str) -> str:
    return _BEFORE_MARK.sub(r"\1", _SPACES.sub(" ", text))


def _words(units: list[str], using: Tables, names: Mapping[Key, Key]) -> Iterator[tuple[Key, str]]:
    """What stands there, cut into words and phrases, each with its English words."""
    at, named = 0, max(map(len, names), default=0)
    while at < len(units):
        for length in range(max(using.longest.get(units[at], 1), named), 0, -1):
            key = tuple(units[at : at + length])
            if key in names or key in using.words:
                yield key, " ".join(names[key]) if key in names else using.words[key]
                break
        else:
            key = (units[at],)
            near = _inflected(units[at], using)
            if near:
                yield key, using.words[near,]
                at += 1
                continue
            kept = f"{units[at]}{MARK}" if units[at].isalpha() and len(units[at]) > 1 else units[at]
            yield key, _number(units[at], using) or kept
        at += len(key)


def _inflected(word: str, using: Tables) -> str:
    """The word that `word` is with another ending, or one slip of the finger away; an empty string for none."""
    for ending in using.endings:
        stem = word.removesuffix(ending)
        if stem != word and len(stem) >= _LEAST_STEM and (stem,) in using.words:
            return stem
    stem = using.diminutive.sub("", word)
    if stem != word and len(stem) >= _LEAST_STEM:
        whole = next((noun for noun in (_CHANGED.sub(r"\1", stem), stem) if (noun,) in using.words), "")
        if whole:
            return whole
    if len(word) < _LEAST_MENDED or (word,) in lexicon().words:
        return ""
    slips = [meant for meant in using.mended if is_slip(word, meant)]
    return slips[0] if len(slips) == 1 else ""


def _number(word: str, using: Tables) -> str:
    """A number that is written as one word, with what may follow in the same word; an empty string for none."""
    found = using.number.fullmatch(word)
    if found is None or not any(found.groups()):
        return ""
    parts = found.groupdict()
    value = sum(using.values[parts[name]] for name in ("one", "ten", "teen", "last") if parts[name])
    for name, unit in (("hundreds", 100), ("thousands", 1000)):
        if parts[name]:
            value += unit * using.values.get(parts[name].removesuffix(parts[f"{name}_word"]), 1)
    return (
        using.suffixes[parts["suffix"]].format(n=value, half=value + 0.5) if parts["suffix"] else str(value)
    )


def _verb_first(clause: str, using: Tables) -> str:
    """A clause whose verb stood last, with the verb behind the words that open a clause, or behind `can`, `must`."""
    found = list(_MARKED.finditer(clause))
    opened = using.openers.match(clause)
    start = opened.end() if opened else 0
    if len(found) != 1 or found[0].start() <= start:
        return clause
    verb = found[0]
    modal = using.modals.search(clause, start, verb.start())
    start = modal.end() if modal else start
    to = "to " if clause[: verb.start()].endswith(" to ") else ""
    between = clause[start : verb.start() - len(to)]
    return f"{clause[:start].rstrip()} {to}{verb[1]} {between.strip()} {clause[verb.end() :].strip()} "
