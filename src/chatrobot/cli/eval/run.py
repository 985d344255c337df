"""Corpus items in fresh simulated sessions, each in an empty world of its own, as fast as it goes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from chatrobot.cli.eval.corpus import Item
from chatrobot.cli.eval.judge import Record, Verdict, judge
from chatrobot.compose import Setup, connect
from chatrobot.core.events import Event, Interpreted, Result, TruePose
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.trace import Measured, Sample, measure

START = Sample(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Judged:
    """One item and what became of it. `plans` is the plan text of each turn.

    `proposals` is the plan text that each turn asked about, if it did. `after_yes` is the verdict where each of these
    had been agreed to; None where that was not tried, which it is only for what was abstained.
    """

    item: Item
    verdict: Verdict
    records: tuple[Record, ...]
    plans: tuple[str, ...]
    proposals: tuple[str, ...] = ()
    after_yes: Verdict | None = None

    @property
    def measured(self) -> Measured:
        """From the start to the end of the last turn."""
        return measure([sample for record in self.records for sample in record.trace])

    @property
    def was_proposed(self) -> bool:
        """It was asked back, and a yes does the right thing."""
        return self.after_yes is not None and self.after_yes.kind == "correct"


def run_items(items: list[Item], setup: Setup) -> Iterator[Judged]:
    """Run each item, and give it as it is done. `setup` says which robot and interpreter; its folder is not touched."""
    profile = setup.profile
    for item in items:
        judged = _run_item(item, setup, profile)
        if judged.verdict.kind == "abstained" and any(judged.proposals):
            agreed = _run_item(item, setup, profile, agrees=True)
            judged = replace(judged, after_yes=agreed.verdict)
        yield judged


class _Listener:
    """Collects the true poses and the plans of one session."""

    def __init__(self) -> None:
        self.trace = [START]
        self.plans: list[str] = []

    def hear(self, event: Event) -> None:
        if isinstance(event, TruePose):
            self.trace.append(Sample(**{name: getattr(event, name) for name in Sample._fields}))
        elif isinstance(event, Interpreted):
            self.plans.append(event.plan_text)

    def take(self) -> list[Sample]:
        """Return the poses since the last call, beginning with the last one before."""
        taken, self.trace = self.trace, self.trace[-1:]
        return taken


def _run_item(item: Item, setup: Setup, profile: RobotProfile, *, agrees: bool = False) -> Judged:
    """`agrees`: a yes follows each turn that proposes something."""
    with TemporaryDirectory(prefix="chatrobot-eval-") as folder:
        listener = _Listener()
        alone = replace(setup, fast=True, trace=True, folder=Path(folder))
        connection = connect(alone, listener.hear)
        records: list[Record] = []
        proposals: list[str] = []
        for number, turn in enumerate(item.turns, 1):
            result = connection.session.do(turn.say)
            proposals.append(proposed_plan(result))
            if agrees and proposals[-1]:
                session = connection.session
                result = session.see_through(session.say_plan(proposals[-1]))
            if number == len(item.turns):
                connection.close()  # a robot that still rolls has not arrived
            records.append(Record(result.outcome, result.reply, listener.take()))
    verdict = judge(item, records, profile)
    return Judged(item, verdict, tuple(records), tuple(listener.plans), tuple(proposals))


def proposed_plan(result: Result) -> str:
    """Return the plan text that a result proposes; an empty string where it proposes none."""
    return result.proposal.plan_text if result.proposal is not None else ""
