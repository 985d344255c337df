"""One turn's program on its way through Motion: what a `program` envelope asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from chatrobot.link.envelope import Envelope
from chatrobot.motion.budgets import Account
from chatrobot.motion.goal import Goal
from chatrobot.motion.planner import Planned


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
    """The goal that a `plan` or a `program` envelope asks for."""
    goal = Goal.of(envelope, epoch, now_s, account)
    if envelope.word != "program":
        return goal
    payload = envelope.payload
    return ProgramGoal(
        turn=goal.turn,
        lease=goal.lease,
        plan_text="",
        approve=goal.approve,
        rehearse_only=goal.rehearse_only,
        epoch=epoch,
        received_s=now_s,
        pauses=goal.pauses,
        account=account,
        code=str(payload.get("code", "")),
        name=str(payload.get("name", "")) or "program",
        remap={str(name): str(to) for name, to in dict(payload.get("remap", {})).items()},
        args=tuple(payload.get("args", ())),
        ask_findings=bool(payload.get("ask_findings")),
        strict=bool(payload.get("strict")),
    )


def needs_approval(goal: Goal, planned: Planned) -> bool:
    """Whether what was planned waits for a yes."""
    if goal.refusal is not None or goal.rehearse_only:
        return False
    return goal.approve or (isinstance(goal, ProgramGoal) and goal.ask_findings and planned.has_findings)
