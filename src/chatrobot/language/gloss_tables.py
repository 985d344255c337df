"""The words, verbs and rules by which a text is put into English words: `data/<code>/gloss.toml`, ready for use."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from chatrobot.language.compiled import compiled
from chatrobot.language.data_files import expand, in_full, load_table
from chatrobot.language.rules import Rules, rules

VERB = "^"
"""Follows a verb that may stand last in its clause, and is to open it."""
UNIT = re.compile(r"\d+(?:\.\d+)?|[^\W\d_]+(?:'[a-z]+)?|\n|[^\s\w]+?|\S")
_WRITTEN_OUT = ("words", "verbs", "names", "prefixes", "inverted")
"""The parts of the file that become single words and phrases."""
_ADJECTIVE = re.compile(r"^([a-z]\w*?)(?:er|es|e)(?= )")
"""The first word of a place's name where it begins with a small letter: its ending changes."""

Key = tuple[str, ...]


@dataclass(frozen=True)
class Tables:
    """The gloss of one language."""

    words: Mapping[Key, str]
    dialect: Mapping[str, str]
    longest: Mapping[str, int]
    before: Rules
    rules: Rules
    after: Rules
    openers: re.Pattern[str]
    modals: re.Pattern[str]
    taught: re.Pattern[str]
    joint: re.Pattern[str]
    number: re.Pattern[str]
    values: Mapping[str, int]
    suffixes: Mapping[str, str]
    endings: tuple[str, ...]
    diminutive: re.Pattern[str]
    mended: tuple[str, ...]


@cache
def tables(language: str) -> Tables:
    """The gloss of that language, read once."""
    words, rest, _ = _compiled(language)
    longest: dict[str, int] = {}
    for key in words:
        longest[key[0]] = max(longest.get(key[0], 0), len(key))
    numbers = rest["numbers"]
    listed = {name: _any_of(numbers[name]) for name in ("ones", "teens", "tens", "suffixes")}
    before, ruled, after = (
        rules(f"gloss_{language}_{name}", rest[name], rest["parts"]) for name in ("before", "rules", "after")
    )
    return Tables(
        words=words,
        dialect={written: plain for plain, listed in rest["dialect"].items() for written in listed},
        longest=longest,
        before=before,
        rules=ruled,
        after=after,
        openers=re.compile(rf"\s*(?:(?:{_any_of(map(re.escape, rest['openers']))})\b[ ]*)*"),
        modals=re.compile(rest["modals"]),
        taught=re.compile(in_full(rest["taught"], rest["parts"])),
        joint=re.compile(rf"(?<= )(?=(?:{'|'.join(rest['joints'])})\b)"),
        number=re.compile(numbers["pattern"].format(**listed)),
        values={**numbers["ones"], **numbers["teens"], **numbers["tens"]},
        suffixes=numbers["suffixes"],
        endings=tuple(rest["endings"]),
        diminutive=re.compile(rest["diminutive"]),
        mended=tuple(rest["mended"]),
    )


def words_of(language: str) -> frozenset[str]:
    """Every single word that tells that a text is in that language, as it is folded: names of people do not."""
    words, _, names = _compiled(language)
    known = {unit for key, word in words.items() if (word,) != key for unit in key if unit.isalpha()}
    using = tables(language)
    return frozenset(known | set(using.values) | set(using.dialect)) - names


def shared_words(language: str) -> frozenset[str]:
    """Every single word that is the same in English, such as “ok”: it tells no language."""
    return frozenset(key[0] for key, word in _compiled(language)[0].items() if (word,) == key)


def letters_of(language: str) -> frozenset[str]:
    """The letters that are folded."""
    return frozenset(map(chr, _folds(language)))


def folded(text: str, language: str) -> str:
    """A text as the words of that language are looked up: in lower case, without letters of its own."""
    return text.lower().translate(_folds(language))


@cache
def _folds(language: str) -> dict[int, str]:
    return {ord(letter): by for letter, by in _compiled(language)[1]["folds"].items()}


def _any_of(words: Iterable[str]) -> str:
    return "|".join(sorted(words, key=len, reverse=True))


@cache
def _compiled(language: str) -> tuple[dict[Key, str], dict[str, Any], frozenset[str]]:
    return compiled(
        f"gloss-{language}", lambda: _parts(load_table(language, "gloss"), load_table(language, "names"))
    )


def _parts(
    table: Mapping[str, Any], places: Mapping[str, str]
) -> tuple[dict[Key, str], dict[str, Any], frozenset[str]]:
    """What each word or phrase becomes, the listed and the forms of the verbs; the rest as it stands; names."""
    folds = {ord(letter): by for letter, by in table["folds"].items()}
    words: dict[Key, str] = {}

    def add(written: str, english: str) -> None:
        words.setdefault(tuple(UNIT.findall(written.lower().translate(folds))), english)

    for english, name in places.items():
        for written in expand(_ADJECTIVE.sub(r"\1{e,en,er,es,em}", name)):
            add(written, english)
    for listed in (*table["words"].values(), table["names"]):
        for english, patterns in listed.items():
            for written in itertools.chain.from_iterable(map(expand, patterns)):
                add(written, english.rstrip("_"))
    for row in table["verbs"]:
        for written, english in _forms(row, table):
            add(written, english)
    names = frozenset(unit for listed in table["names"].values() for name in listed for unit in name.split())
    return words, {name: part for name, part in table.items() if name not in _WRITTEN_OUT}, names


def _forms(row: list[str], table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The forms of one verb, alone and with each prefix that parts from it."""
    english, order, infinitive, second, third, past, done = row
    base, does, did, driven = english.split(" ")
    to = table["infinitive"]
    for prefix, adverb in {"": "", **table["prefixes"]}.items():
        for written in filter(None, expand(infinitive)):
            yield f"{prefix}{written}", f"{base}{VERB} {adverb}"
            yield f"{prefix}{to}{written}" if prefix else f"{to} {written}", f"to {base}{VERB} {adverb}"
            for person, said in table["inverted"].items():
                yield f"{prefix}{written} {person}", said.format(base=base)
        for forms, said in ((second, f"{base}{VERB}"), (third, does), (past, did), (done, driven)):
            yield from ((f"{prefix}{written}", f"{said} {adverb}") for written in expand(forms) if written)
    yield from ((written, base) for written in expand(order) if written)
