"""A program that has been rehearsed, as Motion takes it: like a plan, with what a program has besides."""

from __future__ import annotations

from dataclasses import dataclass

from chatrobot.core.events import Event, FindingSeen, ProgramRehearsed, Rehearsed
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.motion.planner import Planned, drawn, driving_s
from chatrobot.motion.programs.rehearsal import ProgramRehearsal
from chatrobot.plan.context import Finding
from chatrobot.programs.events import Died, Ended, Log, Raised

LOG_LINES = 50
_LIMITS = frozenset({"limited"})
"""Notes about these are what a model is to mend: a person's program is limited and told so."""


@dataclass(frozen=True)
class PlannedProgram(Planned):
    """`strict`: what asks for a look refuses it, so that whoever wrote it can mend it."""

    program: ProgramRehearsal | None = None
    name: str = "program"
    strict: bool = False

    @property
    def ok(self) -> bool:
        return self.refusal is None

    @property
    def refusal(self) -> Reason | None:
        found = self._shown.refusal or (self._to_mend if self.strict else None)
        return found.reason if found is not None else None

    @property
    def _driving_s(self) -> float:
        return driving_s(self._shown.path)

    @property
    def is_endless(self) -> bool:
        end = self._shown.end
        return isinstance(end, Ended) and end.how in ("horizon", "stuck")

    @property
    def has_findings(self) -> bool:
        return any(finding.severity == "warn" for finding in self._shown.findings)

    @property
    def duration_s(self) -> float:
        return self._shown.duration_s

    @property
    def length_m(self) -> float:
        return self._shown.length_m

    def events(self, needs_approval: bool) -> tuple[Event, ...]:
        shown = self._shown
        line, problem = shown.line, shown.traceback
        if isinstance(shown.end, Died):
            problem = shown.end.log
        told = ProgramRehearsed(
            self.turn,
            self.name,
            _ended(shown),
            round(shown.top_speed_mps, 3),
            round(shown.top_rate_radps, 3),
            shown.stopped_at_end,
            problem,
            line,
            tuple(_line(entry) for entry in shown.log[:LOG_LINES] if isinstance(entry, Log)),
        )
        return (told, self.event(needs_approval))

    def event(self, needs_approval: bool) -> Rehearsed:
        shown = self._shown
        findings = tuple(FindingSeen(self.turn, f.severity, f.reason, (), f.t_s) for f in shown.findings)
        return Rehearsed(
            self.turn,
            self.ok,
            shown.duration_s,
            shown.length_m,
            Pose(*(float(value) for value in shown.path[-1, 1:])),
            findings,
            drawn(shown.path),
            needs_approval,
            self.is_open_ended,
        )

    @property
    def _shown(self) -> ProgramRehearsal:
        assert self.program is not None
        return self.program

    @property
    def _to_mend(self) -> Finding | None:
        return next(
            (f for f in self._shown.findings if f.severity == "warn" or f.reason.code in _LIMITS), None
        )


def _ended(shown: ProgramRehearsal) -> str:
    if isinstance(shown.end, Ended):
        return shown.end.how
    return "raised" if isinstance(shown.end, Raised) else "died"


def _line(entry: Log) -> str:
    return f"[{entry.level}] [{entry.name}] {entry.text}"
