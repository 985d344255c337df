"""Corpus items in fresh simulated sessions, each in an empty world of its own, as fast as it goes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from chatrobot.cli.eval.corpus import Item
from chatrobot.cli.eval.judge import Record, Verdict, judge
from chatrobot.cli.eval.measure import Measured, Sample, measure
from chatrobot.compose import Setup, connect
from chatrobot.core.events import Event, Interpreted, TruePose

START = Sample(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Judged:
    """One item and what became of it. `plans` is the plan text of each turn."""

    item: Item
    verdict: Verdict
    records: tuple[Record, ...]
    plans: tuple[str, ...]

    @property
    def measured(self) -> Measured:
        """From the start to the end of the last turn."""
        return measure([sample for record in self.records for sample in record.trace])


def run_items(items: list[Item], setup: Setup) -> Iterator[Judged]:
    """Each item as it is done. `setup` says which robot and interpreter; its folder is not touched."""
    for item in items:
        with TemporaryDirectory(prefix="chatrobot-eval-") as folder:
            yield _run_item(item, replace(setup, fast=True, trace=True, folder=Path(folder)))


class _Listener:
    """Collects the true poses and the plans of one session."""

    def __init__(self) -> None:
        self.trace = [START]
        self.plans: list[str] = []

    def hear(self, event: Event) -> None:
        if isinstance(event, TruePose):
            self.trace.append(
                Sample(
                    event.t_s, event.x_m, event.y_m, event.yaw_rad, event.vx_mps, event.vy_mps, event.wz_radps
                )
            )
        elif isinstance(event, Interpreted):
            self.plans.append(event.plan_text)

    def take(self) -> list[Sample]:
        """The poses since the last call, beginning with the last one before."""
        taken, self.trace = self.trace, self.trace[-1:]
        return taken


def _run_item(item: Item, setup: Setup) -> Judged:
    listener = _Listener()
    connection = connect(setup, listener.hear)
    records = []
    for number, turn in enumerate(item.turns, 1):
        result = connection.session.do(turn.say)
        if number == len(item.turns):
            connection.close()  # a robot that still rolls has not arrived
        records.append(Record(result.outcome, result.reply, listener.take()))
    return Judged(item, judge(item, records), tuple(records), tuple(listener.plans))
