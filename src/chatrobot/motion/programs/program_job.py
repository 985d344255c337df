"""One turn's program on its way through Motion: what a `program` envelope asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from chatrobot.link.envelope import Envelope
from chatrobot.motion.budgets import Account
from chatrobot.motion.job import Job
from chatrobot.motion.planner import Planned


@dataclass
class ProgramJob(Job):
    """A `Job` whose plan is a program in the box.

    `ask_findings` asks for a yes where rehearsal found something; `strict` refuses it then, so that it can be mended.
    """

    code: str = ""
    name: str = "program"
    remap: Mapping[str, str] = field(default_factory=dict)
    args: tuple[str, ...] = ()
    ask_findings: bool = False
    strict: bool = False


def job_of(envelope: Envelope, epoch: int, now_s: float, account: Account) -> Job:
    """The job that a `plan` or a `program` envelope asks for."""
    job = Job.of(envelope, epoch, now_s, account)
    if envelope.word != "program":
        return job
    payload = envelope.payload
    return ProgramJob(
        turn=job.turn,
        lease=job.lease,
        plan_text="",
        approve=job.approve,
        rehearse_only=job.rehearse_only,
        epoch=epoch,
        received_s=now_s,
        pauses=job.pauses,
        account=account,
        code=str(payload.get("code", "")),
        name=str(payload.get("name", "")) or "program",
        remap={str(name): str(to) for name, to in dict(payload.get("remap", {})).items()},
        args=tuple(payload.get("args", ())),
        ask_findings=bool(payload.get("ask_findings")),
        strict=bool(payload.get("strict")),
    )


def needs_approval(job: Job, planned: Planned) -> bool:
    """Whether what was planned waits for a yes."""
    if job.refusal is not None or job.rehearse_only:
        return False
    return job.approve or (isinstance(job, ProgramJob) and job.ask_findings and planned.has_findings)
