"""Ways of saying that are clearer said otherwise: contractions without apostrophe, Logo, polite conditions.

Plain rewriting of normalised text, by the patterns of `rephrase.toml`, before any word is looked up.
"""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import load_table
from chatrobot.language.normalise import has_chinese, normalise


@cache
def _rules(language: str) -> tuple[tuple[re.Pattern[str], str], ...]:
    table = load_table(language, "rephrase")
    return tuple((re.compile(pattern), said) for pattern, said in table.get("rules", ()))


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


def rephrased(text: str, language: str) -> str:
    """`text` (normalised) in the words that the rest of the package reads."""
    written, pattern = _contractions(language)
    text = pattern.sub(lambda found: written[found[0]], text)
    spoken, dialect = _dialect(language)
    text = dialect.sub(lambda found: spoken[found[0]], text)
    for rule, said in _rules(language):
        if rule.search(text):  # most do not match, and to prepare `said` takes longer than to see that
            text = rule.sub(said, text)
    return text


def plain_text(said: str) -> str:
    """What was `said` in an earlier turn, as this package reads it."""
    return rephrased(normalise(said), "zh" if has_chinese(said) else "en")
