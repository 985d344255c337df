"""`chatrobot eval FILE…`: run a corpus, each item in a fresh simulated session, and say what was understood."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from chatrobot.cli.choices import setup_from
from chatrobot.cli.eval.corpus import Item, load_corpus
from chatrobot.cli.eval.judge import Record, Verdict, judge
from chatrobot.cli.eval.measure import Measured, Sample, has_moved, measure
from chatrobot.cli.eval.report import item_json, misses, table, totals_json
from chatrobot.cli.json_lines import json_line
from chatrobot.compose import Connection, Setup, connect, profile_dirs
from chatrobot.core.events import Event, Interpreted, Result, TruePose
from chatrobot.dialogue.options import Options
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import RobotProfile

_REPORTED_EVERY_S = 0.2


def run(args: argparse.Namespace) -> int:
    """0 where the files are valid, whatever the verdicts.

    Raises:
        CorpusError: a file is not.
    """
    setup = setup_from(args, options=Options(), world="empty", named_model=True)
    items = [item for file in args.files for item in load_corpus(Path(file)) if _is_chosen(item, args.only)]
    began_s = time.monotonic()
    judged: list[Judged] = []
    with _Progress(len(items), began_s) as progress:
        for one in run_items(items, setup):
            judged.append(one)
            if args.json:
                progress.clear()
                print(json_line(item_json(one)), end="", flush=True)
            progress.show(len(judged))
    if args.json:
        print(json_line(totals_json(judged)), end="")
        return 0
    print(table(judged), end="")
    if args.misses:
        print(misses(judged), end="")
    print(f"\n{len(items)} items in {time.monotonic() - began_s:.1f} s")
    return 0


def _is_chosen(item: Item, only: str | None) -> bool:
    return only is None or item.number % 2 == (only == "odd")


class _Progress:
    """How many items are done, on one line of the terminal that errors go to; nothing where they go elsewhere.

    The line is there while it is entered.
    """

    def __init__(self, total: int, began_s: float) -> None:
        self._total = total
        self._began_s = self._shown_s = began_s
        self._is_shown = sys.stderr.isatty()

    def __enter__(self) -> _Progress:
        self._write(f"0 of {self._total}")
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()

    def show(self, done: int) -> None:
        now_s = time.monotonic()
        if now_s - self._shown_s >= _REPORTED_EVERY_S:
            self._shown_s = now_s
            left_s = (now_s - self._began_s) / done * (self._total - done)
            self._write(f"{done} of {self._total}, {left_s:.0f} s to go ")

    def clear(self) -> None:
        self._write("")

    def _write(self, text: str) -> None:
        if self._is_shown:
            print(f"\r{text}\033[K", end="", file=sys.stderr, flush=True)


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
    def has_moved(self) -> bool:
        """Whether the robot moved in any turn."""
        return has_moved([sample for record in self.records for sample in record.trace])

    @property
    def was_proposed(self) -> bool:
        """It was asked back, and a yes does the right thing."""
        return self.after_yes is not None and self.after_yes.kind == "correct"


def run_items(items: list[Item], setup: Setup) -> Iterator[Judged]:
    """Each item as it is done. `setup` says which robot and interpreter; its folder is not touched."""
    profile = load_profile(setup.robot, profile_dirs(setup.folder))
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
                result = _agreed(connection, proposals[-1])
            if number == len(item.turns):
                connection.close()  # a robot that still rolls has not arrived
            records.append(Record(result.outcome, result.reply, listener.take()))
    verdict = judge(item, records, profile)
    return Judged(item, verdict, tuple(records), tuple(listener.plans), tuple(proposals))


def proposed_plan(result: Result) -> str:
    """The plan text that a result proposes; an empty string where it proposes none."""
    proposal = getattr(result, "proposal", None)
    if isinstance(proposal, dict):
        return str(proposal.get("plan_text", ""))
    return str(getattr(proposal, "plan_text", ""))


def _agreed(connection: Connection, plan_text: str) -> Result:
    """The result of driving what was proposed, as a yes does."""
    session = connection.session
    turn = session.say_plan(plan_text)
    while turn not in session.results:
        session.pump(0.1)
    return session.results[turn]
