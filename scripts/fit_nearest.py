"""Fit the weights of the nearest reading: `python -m scripts.fit_nearest [--check]`. Deterministic; some 15 minutes.

Examples are the items of the corpus that the rules do not read, each without every part that may be left out, judged
by the plan that the item must give. Two choices are fitted: which part to leave out (`omissions.bin`), and which of
the plans that are read is meant, if any (`nearest.bin`). Both are softmax choices in which all that is right counts.
With --check, nothing is written: the writers are left out in turn, and read by what the others taught.
"""

from __future__ import annotations

import contextlib
import random
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing import Pool
from unittest import mock

import numpy as np
from scripts.fit_acts import CORPUS, quantised
from tests.language import ledger
from tests.language.dialogue_runner import Conversation

from chatrobot.cli.eval.corpus import Item, load_corpus
from chatrobot.language import fitted
from chatrobot.language.acts import read_acts
from chatrobot.language.data_files import DATA
from chatrobot.language.fitted import SLOTS
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.language.names import names_in
from chatrobot.language.nearest import candidates, choice_slots, nearest, text_slots
from chatrobot.language.normalise import normalise
from chatrobot.language.omissions import omissions
from chatrobot.language.reading import Reading
from chatrobot.language.signs import Names
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import Step
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan

RANK_PENALTY, CHOICE_PENALTY, ROUNDS, STEP = 1.0, 3.0, 120, 0.3
LEAST_SEEN, PARTS = 3, 8
"""A feature has a weight if so many parts have it; the writers are left out in so many groups."""


@dataclass
class Said:
    """A turn that the rules do not read. `before`: the steps of the turns before it.

    `seen`: what each rest of it is read as; `right`: whether a plan, as text, is what the item wants.
    """

    source: str
    item: Item
    text: str
    problem: Unclear
    reading: Reading
    before: list[Step]
    seen: dict[str, Interpretation | Unclear] = field(default_factory=dict)
    right: dict[str, bool] = field(default_factory=dict)

    @property
    def names(self) -> Names:
        """The names of its dialogue."""
        return names_in(self.reading.context)

    def read(self, rest: str) -> Interpretation:
        """What the text means without a part. Raises Unclear as the interpreter does."""
        if rest not in self.seen:
            try:
                robot = OfflineInterpreter(self.reading.profile)
                self.seen[rest] = robot.read_order(rest, self.reading)
            except Unclear as problem:
                self.seen[rest] = problem
        found = self.seen[rest]
        if isinstance(found, Unclear):
            raise found
        return found

    def is_right(self, plan: Plan) -> bool:
        """Whether the plan is what the item wants."""
        key = format_plan(plan)
        if key not in self.right and self.item.meant is not None:
            steps = [*self.before, *plan.steps]
            self.right[key] = not self.item.must_stand and ledger.is_meant(self.item.meant, steps)
        return self.right[key]


@dataclass(frozen=True)
class Choice:
    """Features of what may be chosen, whether each is right, and those of choosing none, where one may."""

    slots: list[tuple[int, ...]]
    right: list[bool]
    none: tuple[int, ...] = ()


def items() -> Iterator[tuple[str, Item]]:
    """The items to learn from, each with the writer's file; what is held out is not among them."""
    for file in sorted(CORPUS.glob("everyday/*.yaml")):
        yield from ((file.stem, item) for item in load_corpus(file) if item.number % 2)
    for file in sorted([*CORPUS.glob("sources/*.yaml"), *CORPUS.glob("sources/unfitted/*.yaml")]):
        if not file.stem.startswith("hold_"):
            yield from ((file.stem, item) for item in load_corpus(file))


def said_of(given: tuple[str, Item]) -> Said | None:
    """The last turn of an item, with each rest of it read, where the rules do not read it but what came before."""
    source, item = given
    if item.meant is None:
        return None
    talk, before = Conversation(), list[Step]()
    for turn in item.turns[:-1]:
        meant = talk.say(turn.say)
        if meant.outcome in ("unclear", "refused"):
            return None
        before += meant.plan.steps if meant.plan is not None else ()
    asked: list[tuple[str, Unclear, Reading]] = []

    def listen(_: OfflineInterpreter, problem: Unclear, text: str, reading: Reading) -> None:
        asked.append((normalise(text), problem, reading))

    with mock.patch.object(OfflineInterpreter, "_likeliest", listen):
        meant = talk.interpreter.interpret(item.turns[-1].say, talk.context)
    if not asked or meant.plan is not None:
        return None
    text, problem, reading = asked[0]
    said = Said(source, item, text, problem, reading, before)
    _read_all(said)
    return said


def _read_all(said: Said) -> None:
    for one in omissions(said.text, said.problem, said.names):
        with contextlib.suppress(Unclear):
            meant = said.read(one.rest)
            if meant.plan is not None:
                said.is_right(meant.plan)


def part_choice(said: Said) -> Choice | None:
    """Which part of a text to leave out; None where no part is the right one."""
    slots, right = [], []
    for one in omissions(said.text, said.problem, said.names):
        meant = said.seen[one.rest]
        slots.append(one.slots)
        right.append(
            isinstance(meant, Interpretation) and meant.plan is not None and said.is_right(meant.plan)
        )
    return Choice(slots, right) if any(right) else None


def plan_choice(said: Said) -> Choice | None:
    """Which plan is meant, if any; None where none is read."""
    found = candidates(said.text, said.problem, said.reading, said.read)
    if not found:
        return None
    right = [said.is_right(one.meant.plan) for one in found if one.meant.plan is not None]
    none = text_slots(read_acts(said.text, said.names), said.problem)
    return Choice(choice_slots(found, said.names), right, none)


def fit(choices: Sequence[Choice], penalty: float) -> np.ndarray:
    """Weights under which what is right is chosen: the likelihood of any of it, by gradient steps of their own size."""
    rows = [slots for choice in choices for slots in (*choice.slots, choice.none)]
    columns = np.fromiter((slot for row in rows for slot in row), np.int64)
    lines = np.repeat(np.arange(len(rows)), [len(row) for row in rows])
    of = np.repeat(np.arange(len(choices)), [len(choice.slots) + 1 for choice in choices])
    is_open = np.array([bool(row) for row in rows])
    right = np.array([r for c in choices for r in (*c.right, bool(c.none) and not any(c.right))], float)
    seen = np.bincount(columns, minlength=SLOTS) >= LEAST_SEEN
    weights, squares = np.zeros(SLOTS), np.full(SLOTS, 1e-6)
    for _ in range(ROUNDS):
        shares = _shares(np.bincount(lines, weights[columns], len(rows)), of, is_open)
        wanted = shares * right
        wanted /= np.bincount(of, wanted)[of]
        slope = np.bincount(columns, (wanted - shares)[lines], SLOTS) - penalty * weights
        slope *= seen
        squares += slope * slope
        weights += STEP * slope / np.sqrt(squares)
    return weights


def _shares(odds: np.ndarray, of: np.ndarray, is_open: np.ndarray) -> np.ndarray:
    """The probability of each row within its choice; zero where a choice has no such row."""
    odds = np.where(is_open, odds, -np.inf)
    top = np.full(of[-1] + 1, -np.inf)
    np.maximum.at(top, of, odds)
    raised = np.exp(odds - top[of])
    shares: np.ndarray = raised / np.bincount(of, raised)[of]
    return shares


def learnt(given: Sequence[Said]) -> tuple[bytes, bytes]:
    """The weights of both choices, as bytes; those of the first are in use from then on."""
    ranked = quantised(fit([choice for said in given if (choice := part_choice(said))], RANK_PENALTY))
    use("omissions", ranked)
    plans = [choice for said in given if (choice := plan_choice(said))]
    return ranked, quantised(fit(plans, CHOICE_PENALTY))


def use(name: str, content: bytes) -> None:
    """Take these weights from now on."""
    (DATA / f"{name}.bin").write_bytes(content)
    fitted.weights.cache_clear()


def check(given: Sequence[Said]) -> None:
    """Print how often the likeliest plan of a left-out writer is right, by its probability."""
    sources = sorted({said.source for said in given})
    random.Random(3).shuffle(sources)
    found: list[tuple[float, bool, bool]] = []
    for part in range(PARTS):
        left_out = set(sources[part::PARTS])
        use("nearest", learnt([said for said in given if said.source not in left_out])[1])
        for said in given:
            best = (
                nearest(said.text, said.problem, said.reading, said.read) if said.source in left_out else None
            )
            if best is not None and best.meant.plan is not None:
                found.append((best.probability, said.is_right(best.meant.plan), said.item.must_stand))
    orders = sum(not said.item.must_stand for said in given)
    print(f"{orders} orders, {len(given) - orders} that order nothing")
    for least in (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95):
        kinds = Counter((right, still) for odds, right, still in found if odds >= least)
        print(
            f"{least}: right {kinds[True, False]} wrong {kinds[False, False]} of nothing {kinds[False, True]}"
        )


def main() -> None:
    kept = {name: (DATA / f"{name}.bin").read_bytes() for name in ("omissions", "nearest")}
    use("omissions", quantised(np.zeros(SLOTS)))  # what is learned does not depend on what was
    with Pool() as pool:
        read = pool.imap(said_of, list(items()), chunksize=16)
        given = [said for said in read if said is not None]
    if "--check" in sys.argv:
        try:
            check(given)
        finally:
            for name, content in kept.items():
                use(name, content)
        return
    use("nearest", learnt(given)[1])


if __name__ == "__main__":
    main()
