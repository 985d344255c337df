"""What the interpreter makes of each text of the corpora: a line a text, kept in `ledger.txt`.

    python -m tests.language.ledger            what has changed since the file was written
    python -m tests.language.ledger --write    write it anew

test_ledger.py compares. Texts are the corpora and the German sources; sayings, and what the tests of this folder say,
are judged there. Each is said to an ideal robot. Items of `everyday/` and of sources with an even number, and sources
named `hold_*`, are held out: of these only digests are kept and counts shown.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from chatrobot.cli.eval.corpus import Item, Meant, load_corpus
from chatrobot.cli.eval.judge import misfit
from chatrobot.cli.eval.measure import ideal
from chatrobot.plan.base import Step
from chatrobot.plan.steps import Plan, Say, Wait
from chatrobot.plan.text import format_plan
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.sim.trace import Measured
from tests.language.dialogue_runner import Conversation

HERE = Path(__file__).parent
LEDGER = HERE / "ledger.txt"
PROFILE = load_profile(DEFAULT_PROFILE)
RANK = {"wrong": 0, "abstained": 1, "correct": 2, "-": 1}


@dataclass(frozen=True)
class Text:
    """One text, or the turns of a dialogue; `item` says what must happen, where that is known."""

    turns: tuple[str, ...]
    item: Item | None = None
    is_of_held_source: bool = False

    @property
    def is_held_out(self) -> bool:
        return self.is_of_held_source or (self.item is not None and self.item.number % 2 == 0)

    @property
    def key(self) -> str:
        return hashlib.sha256("\0".join(self.turns).encode()).hexdigest()[:12]


@dataclass(frozen=True)
class Line:
    """What was made of a text: its verdict where there is one, else `-`, and the outcome or the plan of each turn."""

    key: str
    verdict: str
    done: str

    def __str__(self) -> str:
        return f"{self.key} {self.verdict} {self.done}"


def texts() -> list[Text]:
    """All of them, each once."""
    found: dict[str, Text] = {}
    for text in _of_corpora():
        found.setdefault(text.key, text)
    return list(found.values())


def _of_corpora() -> Iterator[Text]:
    corpora = HERE.parent / "corpus"
    for file in sorted(corpora.glob("everyday/*.yaml")):
        yield from (Text(tuple(turn.say for turn in item.turns), item) for item in load_corpus(file))
    for file in sorted(corpora.glob("sources/*_de.yaml")):
        yield from of_corpus(file)
    for file in sorted(corpora.glob("*.yaml")):
        yield from (Text(tuple(turn.say for turn in item.turns)) for item in load_corpus(file))


def of_corpus(file: Path) -> list[Text]:
    """The texts of one file, each with what must happen."""
    is_held_out = file.stem.startswith("hold_")
    return [Text(tuple(turn.say for turn in item.turns), item, is_held_out) for item in load_corpus(file)]


def line_of(text: Text) -> Line:
    """What is made of it now."""
    talk, done, steps, declined = Conversation(), [], list[Step](), False
    for turn in text.turns:
        meant = talk.say(turn)
        if meant.plan is not None:
            steps += meant.plan.steps
            done.append(format_plan(Plan(tuple(meant.plan.steps))).replace("\n", "; "))
        else:
            done.append(meant.outcome)
            declined |= meant.outcome in ("unclear", "refused")
    said = " / ".join(done)
    if text.is_held_out:
        said = hashlib.sha256(said.encode()).hexdigest()[:12]
    return Line(text.key, _verdict(text, steps, declined=declined), said)


def _verdict(text: Text, steps: list[Step], *, declined: bool) -> str:
    meant = text.item.meant if text.item is not None else None
    if meant is None:
        return "-"
    if meant.still:
        return "wrong" if any(not isinstance(step, (Say, Wait)) for step in steps) else "correct"
    if is_meant(meant, steps):
        return "correct"
    return "abstained" if declined else "wrong"


def is_meant(meant: Meant, steps: Sequence[Step]) -> bool:
    """Whether these steps, driven perfectly, are what must happen."""
    numbers = ideal(steps, PROFILE)
    return numbers is not None and not misfit(meant, _measured(numbers), PROFILE)


def _measured(numbers: object) -> Measured:
    """An ideal drive, as if it had been measured."""
    fields = {name: getattr(numbers, name) or 0.0 for name in (
        "x", "y", "turned_deg", "rotation_deg", "path_m", "pause_s", "max_speed", "max_turn_rate"
    )}  # fmt: skip
    return Measured(**fields)


def kept() -> dict[str, Line]:
    """The lines of the file, by key."""
    lines = (line.split(" ", 2) for line in LEDGER.read_text(encoding="utf-8").splitlines())
    return {key: Line(key, verdict, done) for key, verdict, done in lines}


def changes() -> tuple[list[str], list[str]]:
    """(what is worse or nobody can judge, what is better), in words; held-out items without their text."""
    before = kept()
    worse, better = [], []
    for text in texts():
        now, was = line_of(text), before.get(text.key)
        if was is None or was == now:
            continue
        shown = "a held-out item" if text.is_held_out else f"{' / '.join(text.turns)!r}"
        told = f"{shown}: {was.verdict} {was.done} → {now.verdict} {now.done}"
        (better if RANK[now.verdict] > RANK[was.verdict] else worse).append(told)
    return worse, better


if __name__ == "__main__":
    if "--write" in sys.argv:
        LEDGER.write_text("".join(f"{line_of(text)}\n" for text in texts()), encoding="utf-8")
    else:
        worse, better = changes()
        print("\n".join(["better:", *better, "", "worse, or not judged:", *worse]))
