"""Keeps the words that a person has taught, with the plan of each, for later sessions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from chatrobot.core.errors import PlanTextError
from chatrobot.core.reason import Reason
from chatrobot.dialogue.robot_file import Entry, RobotFile
from chatrobot.plan.base import expanded
from chatrobot.plan.steps import Go, Plan
from chatrobot.plan.text import format_plan, parse_plan

_CODES = ("words_not_kept", "words_unreadable")


class Words:
    """The taught words of one robot. A word whose plan goes to a point of odometry means nothing in another session.

    Args: as for `Places`.
    """

    def __init__(self, folder: Path | None, robot: str, epoch: str) -> None:
        self._file = RobotFile(folder, "words", _CODES, robot, self._plan)
        self._epoch = epoch

    def all(self) -> dict[str, Plan]:
        """Return the plan of every word that can be used in this session."""
        usable = {n: e for n, e in self._file.entries.items() if e.get("epoch", self._epoch) == self._epoch}
        return {name: self._plan(name, entry) for name, entry in usable.items()}

    def learn(self, define: Mapping[str, Plan], renamed: Mapping[str, str]) -> dict[str, Plan]:
        """Take in new words, and new names of words, empty where one is forgotten; return all that can be used."""
        before = dict(self._file.entries)
        entries = {renamed.get(name, name): entry for name, entry in before.items()}
        entries.pop("", None)
        self._file.entries = {**entries, **{name: self._entry(plan) for name, plan in define.items()}}
        if self._file.entries != before:
            self._file.keep()
        return self.all()

    def take_unkept(self) -> Reason | None:
        """Return why words are known for this session only; once, None where they are kept."""
        return self._file.take_unkept()

    def _entry(self, plan: Plan) -> Entry:
        is_bound = any(isinstance(step, Go) and step.frame == "odom" for step in expanded(plan.steps))
        return {"plan": format_plan(plan)} | ({"epoch": self._epoch} if is_bound else {})

    @staticmethod
    def _plan(_name: str, entry: Entry) -> Plan:
        """The plan of an entry. Raises a ValueError or KeyError where it has none."""
        try:
            return parse_plan(str(entry["plan"]))
        except PlanTextError as error:
            raise ValueError(str(error)) from error
