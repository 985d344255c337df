"""The stop words of all languages. `data/<code>.toml` lists them; `data/<code>.json` is the same, which loads at once.

A file that is missing or broken disables no other: a stop in one language never depends on another's words.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field, fields
from pathlib import Path

DATA = Path(__file__).parent / "data"

_Lists = tuple[str, ...]


@dataclass(frozen=True)
class StopWords:
    """The words of one language, or of several. The comments in `data/en.toml` tell what each list is for.

    A verb of `split_verbs` is a stop as it stands, and with each of `inside` at its bar: `halt | an`, "halt sofort an".
    `fold` maps a character to what it is read as, `sounds` a Chinese character to its syllable in pinyin.
    """

    stop: _Lists = ()
    emergency: _Lists = ()
    pause: _Lists = ()
    pause_filler: _Lists = ()
    filler: _Lists = ()
    release: _Lists = ()
    release_filler: _Lists = ()
    cancelled: _Lists = ()
    taken_back: _Lists = ()
    stretched: _Lists = ()
    not_stretched: _Lists = ()
    other_words: _Lists = ()
    not_leading: _Lists = ()
    nouns_after: _Lists = ()
    times_after: _Lists = ()
    duration_words: _Lists = ()
    duration_but: _Lists = ()
    forbids: _Lists = ()
    forbidden: _Lists = ()
    split_verbs: _Lists = ()
    inside: _Lists = ()
    real_words: _Lists = ()
    fold: dict[str, str] = field(default_factory=dict)
    sounds: dict[str, str] = field(default_factory=dict)


LISTS = tuple(item.name for item in fields(StopWords) if item.name not in ("real_words", "fold", "sounds"))


def parse(table: object) -> StopWords:
    """The words of one file.

    Raises:
        ValueError: a key is unknown, or a value is not of its type.
    """
    if not isinstance(table, dict):
        raise ValueError("the file is not a table")
    for name, value in table.items():
        _check(name, value)
    lists = {name: tuple(table.get(name, ())) for name in LISTS}
    lists["stop"] += tuple(
        verb.replace(" | ", f" {word} ") for verb in lists["split_verbs"] for word in ("", *lists["inside"])
    )
    sounds = table.get("sounds", {})
    return StopWords(
        **lists,
        real_words=tuple(table.get("real_words", "").split()),
        fold={group[0]: group[1:] for group in table.get("fold", "").split()},
        sounds={character: syllable for syllable, group in sounds.items() for character in group},
    )


def _check(name: str, value: object) -> None:
    if name in LISTS:
        is_right = isinstance(value, list) and all(isinstance(item, str) and item.strip() for item in value)
    elif name in ("real_words", "fold"):
        is_right = isinstance(value, str)
    elif name == "sounds":
        is_right = isinstance(value, dict) and all(isinstance(item, str) for item in value.values())
    else:
        raise ValueError(f"'{name}' is not a list of stop words")
    if not is_right:
        raise ValueError(f"'{name}' is not what the other languages have under that name")


def load(directory: Path = DATA) -> dict[str, StopWords]:
    """The words by language code. A broken file is logged and left out."""
    found = {}
    for path in sorted(directory.glob("*.json")):
        try:
            found[path.stem] = parse(json.loads(path.read_text(encoding="utf-8")))
        except (OSError, ValueError) as error:
            import logging  # only then: every process that hears stops loads this module

            logging.getLogger(__name__).error("The stop words in %s cannot be used: %s", path, error)
    return found


def together(languages: dict[str, StopWords]) -> StopWords:
    """The words of all languages, which are always active together."""
    lists = {
        name: tuple(word for words in languages.values() for word in getattr(words, name))
        for name in (*LISTS, "real_words")
    }
    return StopWords(
        **lists,
        fold={a: b for words in languages.values() for a, b in words.fold.items()},
        sounds={a: b for words in languages.values() for a, b in words.sounds.items()},
    )


BY_LANGUAGE = load()
ALL = together(BY_LANGUAGE)
