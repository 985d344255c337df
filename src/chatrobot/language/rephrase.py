"""Ways of saying that are clearer said otherwise: contractions without apostrophe, Logo, polite conditions.

Plain rewriting of normalised text, by the patterns of `rephrase.toml`, before any word is looked up.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache, lru_cache

from chatrobot.language.data_files import load_table
from chatrobot.language.normalise import has_chinese, normalise
from chatrobot.language.rules import Rules, rules


@cache
def _rules(language: str, name: str = "rules") -> Rules:
    table = load_table(language, "rephrase")
    return rules(f"rephrase_{language}_{name}", table.get(name, ()), table.get("parts", {}))


@cache
def _contractions(language: str) -> tuple[dict[str, str], re.Pattern[str]]:
    written = dict(load_table(language, "rephrase").get("contractions", {}))
    return written, re.compile(rf"\b(?:{'|'.join(map(re.escape, written)) or '$^'})\b")


@cache
def _dialect(language: str) -> tuple[dict[str, str], re.Pattern[str]]:
    """Words of a language without spaces, the longest first."""
    written = dict(load_table(language, "rephrase").get("dialect", {}))
    longest_first = sorted(written, key=len, reverse=True)
    return written, re.compile("|".join(map(re.escape, longest_first)) or "(?!)")


_ITEM = re.compile(r"\s*\(?(\d{1,2})(?:[、:)] ?|[.,](?: |(?=[^\d\s])))")
_INLINE = re.compile(r"(?:^|(?<=\s))\(?(\d{1,2})(?:[.:]| ?\))(?: ?(?=[a-z])| (?=\d))")
_BEFORE_LIST = re.compile(r"(?:^|[:：])\s*$")
_LETTERED = re.compile(r"(?:^|(?<=\s))\(?([a-h])\) ?(?=[a-z\d])")
_LETTERS = "abcdefgh"
_NUMBERED = re.compile(r"(?:^|(?<=[\n;。:!.]))\s*(\d{1,2})[、:] ?(?=[^\d\s])")


def without_numbers(text: str) -> str:
    """A numbered list without its numbers: they must run from 1 on, or they are amounts."""
    heading, lines = _heading_and_lines(text)
    items = [_ITEM.match(line) for line in lines]
    if len(items) > 1 and [int(item[1]) if item else 0 for item in items] == [*range(1, len(items) + 1)]:
        return "\n".join([*heading, *(_ITEM.sub("; ", line, count=1) for line in lines)])
    first = _INLINE.search(text)
    if first and _BEFORE_LIST.search(text[: first.start()]) and _run_on(_INLINE.findall(text)):
        return text[: first.start()] + _INLINE.sub(
            "; ", text[first.end() :]
        )  # `Do this: 1) go 1 m 2) turn left`
    letters = _LETTERED.findall(text)
    if len(letters) > 1 and "".join(letters) == _LETTERS[: len(letters)]:
        return _LETTERED.sub("; ", text)
    return _NUMBERED.sub("; ", text) if _run_on(_NUMBERED.findall(text)) else text


def _run_on(numbers: list[str]) -> bool:
    return len(numbers) > 1 and [int(number) for number in numbers] == [*range(1, len(numbers) + 1)]


def is_item(line: str) -> bool:
    """Whether a line is a point of a list."""
    return bool(_ITEM.match(line)) or line.lstrip().startswith(("-", "*", "•"))


def _heading_and_lines(text: str) -> tuple[list[str], list[str]]:
    lines = [line for line in text.split("\n") if line.strip()]
    headed = bool(lines) and lines[0].rstrip().endswith(":")
    return lines[:headed], lines[headed:]


def _without_heading(text: str, language: str) -> str:
    """`Here is the plan:` and a list under it: nothing is to be done by the heading itself."""
    heading, lines = _heading_and_lines(text)
    listed = bool(heading) and all(is_item(line) for line in lines)
    if listed and len(lines) > 1 and _heading(language).fullmatch(heading[0].strip()):
        return "\n".join(lines)
    return text


@cache
def _heading(language: str) -> re.Pattern[str]:
    return re.compile(load_table(language, "rephrase")["heading"])


@cache
def _wishes(language: str) -> tuple[re.Pattern[str], dict[str, str], re.Pattern[str]]:
    """What opens a wish; the verbs in it, in the past tense, and how they are read."""
    table = load_table(language, "rephrase").get("wish", {})
    pasts = {past: verb for verb, past in table.get("pasts", {}).items()}
    return (
        re.compile(table.get("opening", "(?!)")),
        pasts,
        re.compile(rf"\b(?:{'|'.join(pasts) or '(?!)'})\b"),
    )


def _of_wishes(text: str, language: str) -> str:
    """`It would be great if you turned left`: the order that it is."""
    opening, pasts, pattern = _wishes(language)
    found = opening.search(text)
    if found is None:
        return text
    return text[: found.start()] + pattern.sub(lambda past: pasts[past[0]], text[found.end() :])


@lru_cache(maxsize=256)
def rephrased(text: str, language: str) -> str:
    """`text` (normalised) in the words that the rest of the package reads."""
    return _rules(language).applied(_spelled_out(text, language))


def rewritings(text: str, language: str) -> Iterator[tuple[int, str, str]]:
    """Each rule that changes `text` (normalised), by its number in the file; what it matches, and the text after it."""
    text = _spelled_out(text, language)
    for number, rule in enumerate(_rules(language), 1):
        before, text = text, rule.applied(text)
        found = rule.pattern.search(before) if text != before else None
        if found is not None:
            yield number, found[0], text


def in_full(text: str, language: str) -> str:
    """`text` (normalised) with words in full that people type short: `ur on my foot`, `fwd 1 m k`."""
    text = _rules(language, "short").applied(text)
    written, pattern = _contractions(language)
    return pattern.sub(lambda found: written[found[0]], text)


def in_full_after(text: str, language: str) -> str:
    """`text` as `in_full` reads it where something was done before it: 走满三米 is what is missing to them."""
    return _rules(language, "after").applied(text)


def _spelled_out(text: str, language: str) -> str:
    text = _of_wishes(text, language)
    text = without_numbers(_without_heading(text, language))
    written, pattern = _contractions(language)
    text = pattern.sub(lambda found: written[found[0]], text)
    spoken, dialect = _dialect(language)
    return dialect.sub(lambda found: spoken[found[0]], text)


def with_breaks(text: str, language: str) -> str:
    """`text` (normalised) with the commas that dictation leaves out: 转三圈我看看 is 转三圈, 我看看."""
    if re.search(load_table(language, "rephrase").get("unbroken", ""), text):
        return text
    return _rules(language, "breaks").applied(text)


def plain_text(said: str) -> str:
    """What was `said` in an earlier turn, as this package reads it."""
    language = "zh" if has_chinese(said) else "en"
    return rephrased(in_full(normalise(said), language), language)
