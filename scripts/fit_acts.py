"""Fit the weights of the reader of acts: `python -m scripts.fit_acts [--check] [FILE…]`. Deterministic.

Examples are frames (tests/corpus/frames: what orders nothing whatever motion stands in it, and what orders) and real
sentences: the corpora, but for the even half of `everyday/` and for `sources/hold_*`, the sayings, and the tests. FILEs
are further corpora.
With --check, nothing is written: each real source is left out in turn and read by what the others taught.
"""

from __future__ import annotations

import ast
import contextlib
import itertools
import random
import re
import sys
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import numpy as np

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib
from tests.language import ledger
from tests.language.dialogue_runner import Conversation, run_item
from tests.language.test_sayings import sayings

from chatrobot.cli.eval.corpus import Item, load_corpus
from chatrobot.language import asked
from chatrobot.language.acts import SLOTS, features
from chatrobot.language.data_files import DATA, LANGUAGES
from chatrobot.language.fitted import SCALE, slot_of
from chatrobot.language.interpretation import Interpretation, Usual
from chatrobot.language.normalise import normalise
from chatrobot.language.signs import clauses_of
from chatrobot.reflex import is_stop

CORPUS = Path(__file__).parents[1] / "tests" / "corpus"
FRAMES_EACH = 16
"""So many motions are put into each frame."""
REAL_WEIGHT, FRAME_WEIGHT = 4.0, 2.3
"""What a real sentence counts, and a frame with all its motions."""
TALK_TESTS = ("test_a_report_and_a_question_move_nothing", "test_a_question_about_a_motion_orders_none")
"""Tests whose strings all order nothing."""
PENALTY = 0.6
ROUNDS, STEP = 250, 0.5


@dataclass(frozen=True)
class Example:
    """A text, whether it orders anything, what it counts, and where it comes from; `talk` is said beside the order."""

    text: str
    orders: bool
    weight: float
    source: str
    talk: tuple[str, ...] = ()


def frames(language: str) -> Iterator[Example]:
    """Each frame with some of the motions, chosen anew for each frame but alike at each run."""
    table = tomllib.loads((CORPUS / "frames" / f"{language}.toml").read_text(encoding="utf-8"))
    chance = random.Random(7)
    for orders in (False, True):
        for frame in table["orders" if orders else "still"]:
            filled = {_marked(_filled(frame, table, chance), chance) for _ in range(FRAMES_EACH)}
            for text in sorted(filled):
                talk = tuple(normalise(part) for part in re.findall(r"\[(.*?)\]", text))
                plain = text.replace("[", "").replace("]", "")
                weight = FRAME_WEIGHT / len(filled)
                yield Example(plain, orders, weight, f"frames {language}", talk)


def _filled(frame: str, table: dict[str, list[str]], chance: random.Random) -> str:
    text = frame
    while "{" in text:
        slot = text[text.index("{") + 1 : text.index("}")]
        forms = chance.choice(table["motions"]).split("|")
        chosen = {
            "v": forms[0], "ing": forms[min(1, len(forms) - 1)], "past": forms[min(2, len(forms) - 1)],
            "s": forms[-1], "n": chance.choice(table["nouns"]), "q": chance.choice(table["amounts"]),
            "d": chance.choice(table["sides"]), "p": chance.choice(table["places"]),
        }[slot]  # fmt: skip
        text = text.replace(f"{{{slot}}}", chosen, 1)
    return text


def _marked(text: str, chance: random.Random) -> str:
    """The text with another mark at its end, as people put it: a mark alone tells little."""
    if text[-1] in "?？":
        return text[:-1] if chance.random() < 0.3 else text
    return text + chance.choice(("", "", ".", "!", "…")) if text[-1].isalnum() else text


def corpus(file: Path, *, halves: bool = False) -> Iterator[Example]:
    """The items of a corpus, of `halves` only those with an odd number; of a dialogue the turns, if it goes well."""
    for item in load_corpus(file):
        if not (halves and item.number % 2 == 0):
            yield from _of_item(item, file.stem)


def _of_item(item: Item, source: str) -> Iterator[Example]:
    turns = tuple(turn.say for turn in item.turns)
    if item.must_stand:
        yield from (Example(turn, False, REAL_WEIGHT, source) for turn in turns)
    elif len(turns) == 1 and (item.meant is not None or (item.expect and not item.expect.no_motion)):
        yield Example(turns[0], True, REAL_WEIGHT, source)
    elif len(turns) > 1 and ledger.line_of(ledger.Text(turns, item)).verdict in ("correct", "-"):
        yield from _of_dialogue(turns, source)


def _of_dialogue(turns: Iterable[str], source: str) -> Iterator[Example]:
    talk = Conversation()
    for turn in turns:
        meant = talk.say(turn)
        if meant.outcome in ("plan", "answered"):
            yield Example(turn, meant.plan is not None or is_set(meant), REAL_WEIGHT / 2, source)


def is_set(meant: Interpretation) -> bool:
    """Whether a speed, a word or a place is set for what comes: an order, though nothing moves."""
    return bool(meant.usual != Usual() or meant.define or meant.remember_place)


def said_in_tests() -> Iterator[Example]:
    """Sayings that are done rightly, and the strings of tests that move or must not."""
    for item in sayings("zh"):
        if run_item(item)[0] == "correct" and "answer" not in item["expect"]:
            yield from _of_dialogue(item["turns"], "sayings")
    kept = ledger.kept()
    for file in sorted((Path(__file__).parents[1] / "tests" / "language").glob("test_[b-z]*.py")):
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            is_talk = getattr(node, "name", "") in TALK_TESTS
            for text in sorted(_strings(node)):
                line = kept.get(ledger.Text((text,)).key)
                asked = line is not None and line.done in ("unclear", "refused")
                meant = Conversation().say(text)
                outcome = "plan" if is_set(meant) else meant.outcome
                if is_talk or outcome == "answered":
                    yield Example(text, False, REAL_WEIGHT / 2, "tests")
                elif outcome == "plan" and not asked:
                    yield Example(text, True, REAL_WEIGHT / 4, "tests")


def _strings(node: ast.AST) -> set[str]:
    found = (child.value for child in ast.walk(node) if isinstance(child, ast.Constant))
    return {text for text in found if isinstance(text, str) and 2 <= len(text) <= 200 and "_" not in text}


@contextlib.contextmanager
def without_reader() -> Iterator[None]:
    """What is done is known from the rest of the interpreter alone: the reader must not teach itself."""
    with mock.patch.object(asked, "is_ordered", return_value=True):
        yield


def examples(more: list[Path]) -> list[Example]:
    """All of them; stops are read before anything else."""
    found = [*frames("en"), *frames("zh"), *said_in_tests()]
    for file in sorted(CORPUS.glob("*.yaml")):
        found += corpus(file)
    for file in sorted(CORPUS.glob("everyday/*.yaml")):
        found += corpus(file, halves=True)
    for file in sorted(CORPUS.glob("sources/*.yaml")):
        if not file.stem.startswith("hold_") and file.stem.endswith(LANGUAGES):
            found += corpus(file)
    for file in more:
        found += corpus(file)
    return [example for example in found if not is_stop(example.text)]


class Rows:
    """The clauses of examples as rows of slots."""

    def __init__(self, given: list[Example]) -> None:
        slots: list[list[int]] = []
        self.label, self.weight, self.of, self.moves = [], [], [], []
        for number, example in enumerate(given):
            plain = normalise(example.text)
            clauses = clauses_of(plain)
            moving = sum(clause.moves for clause in clauses)
            is_frame = example.source.startswith("frames")
            for i, clause in enumerate(clauses):
                beside = plain[clause.start : clause.stop].strip() in example.talk
                unsure = not clause.moves or (clause.talks and moving > 1 and not is_frame)
                if example.orders and moving and unsure and not beside:
                    continue  # which clause of a real sentence orders nobody has marked
                slots.append([slot_of(name, SLOTS) for name in features(clauses, i)])
                self.label.append(example.orders and not beside)
                self.weight.append(example.weight)
                self.of.append(number)
                self.moves.append(clause.moves or not moving)
        self.columns = np.fromiter(itertools.chain.from_iterable(slots), np.int64)
        self.rows = np.repeat(np.arange(len(slots)), [len(row) for row in slots])
        self.count = len(slots)
        self.y = np.array(self.label, float)
        self.w = np.array(self.weight, float)

    def odds(self, weights: np.ndarray) -> np.ndarray:
        return np.bincount(self.rows, weights[self.columns], self.count)


def fit(rows: Rows) -> np.ndarray:
    """Weights that make the labels likely, drawn to zero: by adaptive gradient steps over all rows."""
    weights, squares = np.zeros(SLOTS), np.full(SLOTS, 1e-8)
    for _ in range(ROUNDS):
        off = rows.w * (1.0 / (1.0 + np.exp(-rows.odds(weights))) - rows.y)
        slope = np.bincount(rows.columns, off[rows.rows], SLOTS) + PENALTY * weights
        squares += slope * slope
        weights -= STEP * slope / np.sqrt(squares)
    return weights


def fitted(given: list[Example]) -> np.ndarray:
    """The weights that the examples teach."""
    return fit(Rows(given))


def read(weights: np.ndarray, given: list[Example]) -> list[float]:
    """The odds that each example orders anything."""
    rows = Rows([Example(example.text, False, 1.0, "") for example in given])
    best = np.full(len(given), -60.0)
    odds = np.where(rows.moves, rows.odds(weights), -60.0)
    np.maximum.at(best, np.array(rows.of), odds)
    return list(best)


def quantised(weights: np.ndarray) -> bytes:
    """What the file of these weights holds."""
    return zlib.compress(np.clip(np.rint(weights * SCALE), -127, 127).astype(np.int8).tobytes(), 9)


def report(name: str, given: list[Example], odds: list[float]) -> None:
    """How many orders are read as talk, and how much talk as orders."""
    orders = [odd for example, odd in zip(given, odds) if example.orders]
    talk = [odd for example, odd in zip(given, odds) if not example.orders]
    lost, moved = sum(odd < 0 for odd in orders), sum(odd >= 0 for odd in talk)
    print(
        f"{name:22} orders {len(orders):5} read as talk {lost:4}   talk {len(talk):5} read as orders {moved:4}"
    )


def check(given: list[Example]) -> None:
    """Each source of real sentences, read by what the others teach; then the sum, at several thresholds."""
    unseen: list[tuple[float, bool]] = []
    for source in sorted({example.source for example in given if not example.source.startswith("frames")}):
        out = [example for example in given if example.source == source]
        odds = read(fitted([example for example in given if example.source != source]), out)
        report(source, out, odds)
        if source not in ("tests", "sayings"):
            unseen += [(odd, example.orders) for example, odd in zip(out, odds)]
        if "--list" in sys.argv:
            for example, odd in zip(out, odds):
                if (odd >= 0) != example.orders:
                    print(f"    {odd:6.1f} {'order' if example.orders else 'talk '} {example.text}")
    for threshold in (-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0):
        lost = sum(orders and odd < threshold for odd, orders in unseen)
        moved = sum(not orders and odd >= threshold for odd, orders in unseen)
        print(f"corpora at {threshold:4.1f}: {lost} orders read as talk, {moved} talk read as orders")


def main() -> None:
    with without_reader():
        given = examples([Path(name) for name in sys.argv[1:] if not name.startswith("--")])
    if "--check" in sys.argv:
        check(given)
        return
    weights = fitted(given)
    (DATA / "acts.bin").write_bytes(quantised(weights))
    report("all", given, read(weights, given))


if __name__ == "__main__":
    main()
