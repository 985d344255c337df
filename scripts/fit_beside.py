"""Fit the weights of the reader of asides: `python -m scripts.fit_beside [--check]`. Deterministic.

Examples are the frames in tests/corpus/frames/beside_*.toml, put beside the motions of the frames for acts, and the
clauses of real orders: one that can be left out of a text without changing its plan is an aside, any other is none.
With --check, nothing is written: a fifth of the frames is left out in turn and read by what the others taught.
"""

from __future__ import annotations

import random
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from unittest import mock

import numpy as np
from scripts.fit_acts import CORPUS
from tests.language.dialogue_runner import Conversation
from tests.language.test_sayings import sayings

from chatrobot.cli.eval.corpus import load_corpus
from chatrobot.language import beside
from chatrobot.language.acts import read_acts
from chatrobot.language.beside import SCALE, SLOTS, features, slot_of
from chatrobot.language.data_files import DATA, LANGUAGES
from chatrobot.language.normalise import has_chinese, normalise
from chatrobot.language.signs import clauses_of

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

EACH = 10
"""So often each frame is filled."""
PENALTY, ROUNDS, STEP = 0.06, 200, 0.5
FOLDS = 5
_SLOTS = {"t": "things", "p": "people", "a": "states", "w": "doing", "o": "other_orders", "n": "amounts",
          "b": "bodies", "l": "places",
          "q": "people_do", "y": "thing_does", "i": "i_do", "u": "you_do", "r": "present"}  # fmt: skip
_QUOTE = "{x}: {v}"


@dataclass(frozen=True)
class Example:
    """The features of a clause, whether it is an aside, what it counts, and its frame or sentence."""

    slots: tuple[int, ...]
    aside: bool
    weight: float
    frame: str


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
                text = around.format(x=said, v=chance.choice(motions))
                yield from of_text(text, normalise(said), aside, 1.0 / EACH, f"{language} {frame}")


def of_text(text: str, said: str, aside: bool, weight: float, frame: str) -> Iterator[Example]:
    """The clauses of `text` that lie within what is `said` beside an order."""
    plain = normalise(text)
    start = plain.find(said)
    clauses = clauses_of(plain)
    beside = [i for i, c in enumerate(clauses) if start <= c.start < start + len(said)]
    others = [i for i in range(len(clauses)) if i not in beside and clauses[i].moves]
    if start < 0 or not others:
        return
    for i in beside:
        if len(plain[clauses[i].start : clauses[i].stop].strip(" ,.:;!")) <= len(said) + 1:
            slots = tuple(slot_of(name) for name in features(clauses, i, others[0]))
            yield Example(slots, aside, weight, frame)


def of_corpora() -> Iterator[Example]:
    """The clauses of real orders: what can be left out of one without changing its plan is an aside."""
    files = [*CORPUS.glob("*.yaml"), *CORPUS.glob("everyday/*.yaml")]
    files += [f for f in CORPUS.glob("sources/*.yaml") if not f.stem.startswith("hold_")]
    for file in sorted(files):
        for item in load_corpus(file):
            if file.parent.name == "everyday" and item.number % 2 == 0:
                continue
            if len(item.turns) == 1 and (file.stem.endswith(LANGUAGES) or file.parent.name == "everyday"):
                yield from of_order(item.turns[0].say, file.stem)
    for saying in sayings("zh"):
        if len(saying["turns"]) == 1:
            yield from of_order(saying["turns"][0], "sayings")


def of_order(text: str, source: str) -> Iterator[Example]:
    plain = normalise(text)
    reads = read_acts(plain)
    clauses = [read.clause for read in reads]
    plan = Conversation().say(text).plan if len(clauses) > 1 else None
    if plan is None or not any(clause.moves for clause in clauses):
        return
    order = max(range(len(reads)), key=lambda i: (clauses[i].moves, reads[i].log_odds))
    for i, clause in enumerate(clauses):
        rest = f"{plain[: clause.start]} {plain[clause.stop :]}".strip(" ,;:")
        same = rest and Conversation().say(rest).plan == plan
        language = "zh" if has_chinese(text) else "en"
        if i != order and not (same and (clause.moves or clause.binds)):
            slots = tuple(slot_of(name) for name in features(clauses, i, order))
            yield Example(slots, bool(same), 1.0, f"{language} {source} {plain[clause.start : clause.stop]}")


def fit(given: list[Example]) -> np.ndarray:
    columns = np.fromiter((slot for e in given for slot in e.slots), np.int64)
    rows = np.repeat(np.arange(len(given)), [len(e.slots) for e in given])
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


def check(given: list[Example]) -> None:
    frames = sorted({e.frame for e in given})
    random.Random(3).shuffle(frames)
    found = []
    for fold in range(FOLDS):
        out = set(frames[fold::FOLDS])
        weights = fit([e for e in given if e.frame not in out])
        found += [(float(weights[list(e.slots)].sum()), e) for e in given if e.frame in out]
    for language in LANGUAGES:
        mine = [(odd, e) for odd, e in found if e.frame.startswith(language)]
        for limit in (0.0, 1.0, 2.0, 3.0, 4.0):
            asides = [odd >= limit for odd, e in mine if e.aside]
            others = [odd >= limit for odd, e in mine if not e.aside]
            print(f"{language} {limit}: asides {np.mean(asides):.3f} others {np.mean(others):.4f}")
    if "--list" in sys.argv:
        by: dict[str, list[float]] = {}
        for odd, e in found:
            by.setdefault(f"{'aside' if e.aside else 'other'} {e.frame}", []).append(odd)
        for frame, odds in sorted(by.items(), key=lambda item: np.mean(item[1])):
            print(f"   {np.mean(odds):6.2f} {frame}")


def main() -> None:
    given = [example for language in LANGUAGES for example in of_frames(language)]
    with mock.patch.object(beside, "aside_log_odds", return_value=-1.0):  # it must not teach itself
        given += of_corpora()
    print(len(given))
    if "--check" in sys.argv:
        check(given)
        return
    weights = fit(given)
    (DATA / "beside.bin").write_bytes(np.clip(np.rint(weights * SCALE), -127, 127).astype(np.int8).tobytes())


if __name__ == "__main__":
    main()
