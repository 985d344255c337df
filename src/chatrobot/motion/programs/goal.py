"""One turn's program on its way through Motion: what a `program` envelope asks for, and what its rehearsal shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from chatrobot.core.events import Event
from chatrobot.core.reason import Reason
from chatrobot.link.envelope import Envelope
from chatrobot.motion.budgets import Account
from chatrobot.motion.goal import Goal
from chatrobot.motion.planner import Planned
from chatrobot.motion.programs.rehearsal import ProgramRehearsal
from chatrobot.plan.rehearsal import RehearsedPath


@dataclass
class ProgramGoal(Goal):
    """A `Goal` whose plan is a program in the sandbox.

    `ask_findings` asks for a yes where rehearsal found something; `strict` refuses it then, so that it can be mended.
    """

    code: str = ""
    name: str = "program"
    remap: Mapping[str, str] = field(default_factory=dict)
    args: tuple[str, ...] = ()
    ask_findings: bool = False
    strict: bool = False


def goal_of(envelope: Envelope, epoch: int, now_s: float, account: Account) -> Goal:
    """Return the goal that a `plan` or a `program` envelope asks for."""
    goal = Goal.of(envelope, epoch, now_s, account)
    if envelope.word != "program":
        return goal
    payload = envelope.payload
    return ProgramGoal(
        **vars(goal),
        code=str(payload.get("code", "")),
        name=str(payload.get("name", "")) or "program",
        remap={str(name): str(to) for name, to in dict(payload.get("remap", {})).items()},
        args=tuple(payload.get("args", ())),
        ask_findings=bool(payload.get("ask_findings")),
        strict=bool(payload.get("strict")),
    )


def needs_approval(goal: Goal, planned: Planned) -> bool:
    """Tell whether what was planned waits for a yes."""
    if goal.refusal is not None or goal.rehearse_only:
        return False
    return goal.approve or (isinstance(goal, ProgramGoal) and goal.ask_findings and planned.has_findings)


@dataclass(frozen=True)
class PlannedProgram(Planned):
    """A program that has been rehearsed, as Motion takes it: like a plan.

    `strict`: what asks for a look refuses it, so that whoever wrote it can mend it.
    """

    program: ProgramRehearsal | None = None
    name: str = "program"
    strict: bool = False

    @property
    def shown(self) -> RehearsedPath | None:
        """Return what its rehearsal shows."""
        return self.program

    @property
    def ok(self) -> bool:
        """Tell whether nothing refuses it."""
        return self.refusal is None

    @property
    def refusal(self) -> Reason | None:
        """Return why it may not run. A model mends what is limited, too; a person's program is limited and told so."""
        found = self._rehearsed.refusal
        if found is None and self.strict:
            to_mend = (
                f for f in self._rehearsed.findings if f.severity == "warn" or f.reason.code == "limited"
            )
            found = next(to_mend, None)
        return found.reason if found is not None else None

    @property
    def is_endless(self) -> bool:
        """Tell whether it does not end by itself."""
        return self._rehearsed.is_endless

    @property
    def has_findings(self) -> bool:
        """Tell whether a person should look at something before it runs."""
        return any(finding.severity == "warn" for finding in self._rehearsed.findings)

    def events(self, needs_approval: bool) -> tuple[Event, ...]:
        """Return all that is told of it."""
        return (self._rehearsed.event(self.turn, self.name), self.event(needs_approval))

    @property
    def _rehearsed(self) -> ProgramRehearsal:
        assert self.program is not None
        return self.program
