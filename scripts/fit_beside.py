"""Fit the weights of the reader of asides: `python -m scripts.fit_beside [--check]`. Deterministic.

Examples are what people wrote, in tests/corpus/asides: clauses to be said beside an order (`<language>_<writer>.tsv`:
kind, place, clause), and clauses of whole texts (`texts.tsv`: kind, text, clause as it is read), by the plan that the
text must give. Besides them the frames in tests/corpus/frames/beside_*.toml, put beside the motions of the frames for
acts. The words that many of the writers use are written down with the weights.
With --check, nothing is written: each file is left out in turn and read by what the others taught.
"""

from __future__ import annotations

import random
import re
import sys
import zlib
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scripts.fit_acts import CORPUS, quantised

from chatrobot.core.geometry import ORIGIN
from chatrobot.language import aside_features
from chatrobot.language.aside_features import COMMON_WORDS, features
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.data_files import DATA, LANGUAGES
from chatrobot.language.fitted import SLOTS, slot_of
from chatrobot.language.glossed import in_known_words
from chatrobot.language.normalise import normalise
from chatrobot.language.set_off import has_amount
from chatrobot.language.signs import Clause, clauses_of

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ASIDES = CORPUS / "asides"
EACH, OF_FRAMES = 10, 0.4
"""So often each frame is filled; what all of its fillings weigh together."""
PENALTY, ROUNDS, STEP = 0.8, 200, 0.5
LEAST_SEEN = 3
"""A feature has a weight if so many clauses of people have it."""
OF_TEXTS = 1.0
"""What a clause of a whole text counts: the rules were made with these at hand, so their words tell less of others."""
LEAST_WRITERS, WRITERS_A_FILE = 12, 40
"""A common word is used by so many, where a file counts as that many writers."""
_SLOTS = {"t": "things", "p": "people", "a": "states", "w": "doing", "o": "other_orders", "n": "amounts",
          "b": "bodies", "l": "places",
          "q": "people_do", "y": "thing_does", "i": "i_do", "u": "you_do", "r": "present"}  # fmt: skip
_QUOTE = "{x}: {v}"
_ORDERS = {
    "en": ("Go forward one metre", "Turn left 90 degrees", "Back half a metre", "Slide right 30 cm",
           "Drive a square with sides of 50 cm"),
    "zh": ("前进一米", "左转九十度", "往后退半米", "往右平移三十厘米", "走一个边长半米的正方形"),
    "de": ("Fahr einen Meter vor", "Dreh dich um 90 Grad nach links", "Einen halben Meter zurück",
           "30 cm nach rechts rutschen", "Fahr ein Quadrat mit 50 cm Seitenlänge"),
}  # fmt: skip
_PLACES = {"<,": "{x}{c}{v}", "<.": "{x} {v}", ">,": "{v}{c}{x}", ">.": "{v}{s}{x}", ",,": "{v}{c}{x}{c}{w}"}
_NOWHERE = Context(Dialogue(), RobotState(ORIGIN, path_m=0.0, battery_percent=None))


@dataclass(frozen=True)
class Example:
    """Clause `at` of `clauses` beside the order in clause `order`; whether it is an aside, what it counts, its file."""

    clauses: Sequence[Clause]
    at: int
    order: int
    aside: bool
    weight: float
    source: str

    @property
    def slots(self) -> tuple[int, ...]:
        """Where the weights of its features are kept."""
        return tuple({slot_of(name) for name in features(self.clauses, self.at, self.order)})


def filled(frame: str, table: dict[str, list[str]], chance: random.Random) -> str:
    return re.sub(r"\{(\w)\}", lambda slot: chance.choice(table[_SLOTS[slot[1]]]), frame)


def of_frames(language: str) -> Iterator[Example]:
    """Each frame filled some times, before and after motions."""
    table = tomllib.loads((CORPUS / "frames" / f"beside_{language}.toml").read_text(encoding="utf-8"))
    acts = tomllib.loads((CORPUS / "frames" / f"{language}.toml").read_text(encoding="utf-8"))
    motions = [motion.split("|")[0] for motion in acts["motions"]]
    chance = random.Random(11)
    for aside in (True, False):
        for frame in table["asides" if aside else "bearing"]:
            for _ in range(EACH):
                said = filled(frame, table, chance)
                around = chance.choice([*table["before"], *table["after"]])
                if not aside and chance.random() < 0.15:
                    around = _QUOTE
                text = normalise(around.format(x=said, v=chance.choice(motions)))
                yield from of_text(text, normalise(said), aside, OF_FRAMES / EACH, "frames")


def of_clauses(file: Path) -> Iterator[Example]:
    """Each clause of a writer beside an order."""
    language = file.stem[:2]
    chance = random.Random(5)
    comma, stop = ("，", "。") if language == "zh" else (", ", ". ")
    for line in file.read_text(encoding="utf-8").splitlines():
        kind, place, said = line.split("\t")
        order, other = chance.choice(_ORDERS[language]), chance.choice(_ORDERS[language])
        text = _PLACES[place].format(x=said, v=order, w=other, c=comma, s=stop)
        yield from of_text(as_read(text), as_read(said).strip(" ,.:;!"), kind == "aside", 1.0, file.stem)


def of_texts(file: Path) -> Iterator[Example]:
    """Each clause of whole texts; those of one that orders nothing count as one together."""
    rows = [line.replace("\\n", "\n").split("\t") for line in file.read_text(encoding="utf-8").splitlines()]
    still = Counter(text for kind, text, _ in rows if kind == "still")
    for kind, text, said in rows:
        yield from of_text(as_read(text), said, kind == "aside", OF_TEXTS / still.get(text, 1), file.stem)


def as_read(text: str) -> str:
    return normalise(in_known_words(text, _NOWHERE)[1])


def of_text(plain: str, said: str, aside: bool, weight: float, source: str) -> Iterator[Example]:
    """The clauses of `plain` that lie within what is `said` beside an order."""
    start = plain.find(said)
    clauses = clauses_of(plain)
    beside = [i for i, c in enumerate(clauses) if start <= c.start < start + len(said)]
    others = [i for i in range(len(clauses)) if i not in beside and clauses[i].moves]
    order = max(others, key=lambda i: has_amount(clauses[i]), default=-1)
    if start < 0 or order < 0:
        return
    for i in beside:
        if len(plain[clauses[i].start : clauses[i].stop].strip(" ,.:;!")) <= len(said) + 1:
            yield Example(clauses, i, order, aside, weight, source)


def common_words(given: Sequence[Example]) -> list[str]:
    """The words that many of the writers use."""
    users: dict[str, set[str]] = defaultdict(set)
    for e in given:
        if e.source != "frames":
            said = e.clauses[e.at]
            writer = f"{e.source} {zlib.crc32(repr(said).encode()) % WRITERS_A_FILE}"
            for sign in said.signs:
                users[sign.text].add(writer)
    return sorted(word for word, by in users.items() if len(by) >= LEAST_WRITERS)


def fit(given: Sequence[Example], slots: Sequence[tuple[int, ...]]) -> np.ndarray:
    slots = seen_often(given, slots)
    columns = np.fromiter((slot for of_one in slots for slot in of_one), np.int64)
    rows = np.repeat(np.arange(len(given)), [len(of_one) for of_one in slots])
    y = np.array([e.aside for e in given], float)
    w = np.array([e.weight for e in given], float)
    weights, squares = np.zeros(SLOTS), np.full(SLOTS, 1e-8)
    for _ in range(ROUNDS):
        odds = np.bincount(rows, weights[columns], len(given))
        off = w * (1.0 / (1.0 + np.exp(-odds)) - y)
        slope = np.bincount(columns, off[rows], SLOTS) + PENALTY * weights
        squares += slope * slope
        weights -= STEP * slope / np.sqrt(squares)
    return weights


def seen_often(given: Sequence[Example], slots: Sequence[tuple[int, ...]]) -> list[tuple[int, ...]]:
    """The slots of each example without those that hardly any clause of people has."""
    seen = Counter(slot for e, of_one in zip(given, slots) if e.source != "frames" for slot in of_one)
    return [tuple(slot for slot in of_one if seen[slot] >= LEAST_SEEN) for of_one in slots]


def check(given: list[Example], slots: list[tuple[int, ...]]) -> None:
    for source in sorted({e.source for e in given} - {"frames"}):
        kept = [i for i, e in enumerate(given) if e.source != source]
        weights = fit([given[i] for i in kept], [slots[i] for i in kept])
        found = [
            (float(weights[list(slots[i])].sum()), e.aside) for i, e in enumerate(given) if e.source == source
        ]
        for limit in (0.0, 1.0, 2.0, 3.0, 4.0):
            asides = [odds >= limit for odds, aside in found if aside]
            others = [odds >= limit for odds, aside in found if not aside]
            print(f"{source} {limit}: asides {np.mean(asides):.3f} others {np.mean(others):.4f}")


def main() -> None:
    given = [example for language in LANGUAGES for example in of_frames(language)]
    given += [e for file in sorted(ASIDES.glob("??_*.tsv")) for e in of_clauses(file)]
    given += of_texts(ASIDES / "texts.tsv")
    print(f"{len(given)} examples")
    if "--check" not in sys.argv:
        COMMON_WORDS.write_text("\n".join(common_words(given)) + "\n", encoding="utf-8")
        aside_features.common_words.cache_clear()
    slots = [example.slots for example in given]
    if "--check" in sys.argv:
        check(given, slots)
        return
    weights = fit(given, slots)
    (DATA / "beside.bin").write_bytes(quantised(weights))


if __name__ == "__main__":
    main()
