"""The half that moves: plan text in, a moving robot and events out. Knows no language, no model, no screen.

One `Motion` serves both joints: a process of its own in real time, or the caller's thread on a virtual clock. All
methods belong to the control thread but for `halt`, which any thread may call at any moment, and `post`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Finished, Limited, Notice, Outcome, Started, Telemetry
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.execution.executor import Executor
from chatrobot.execution.lookahead import nearest_m
from chatrobot.execution.sensors import Sensors
from chatrobot.governor.governor import Governor
from chatrobot.governor.lease import LOCAL_TERM_S
from chatrobot.robots.profile import RobotProfile
from chatrobot.session.approval import Approval
from chatrobot.session.envelope import Envelope
from chatrobot.session.guard_link import GuardLink
from chatrobot.session.planner import Planned, Planner
from chatrobot.transports.transport import WireTransport
from chatrobot.wire.messages import LaserScan
from chatrobot.wire.wire import Wire

QUEUE_LIMIT = 10
FROZEN_S = 0.12
"""A gap this long between two ticks of a moving robot means that this process stood still: the plan is over."""

ZEROING_S = 2.0
"""Zeros are repeated until the robot is seen standing, or this long where nobody can see it."""

TELEMETRY_S = 0.1
ODOMETRY_WAIT_S = 2.0


@dataclass
class Job:
    """One turn's plan on its way through Motion."""

    turn: int
    lease: str
    plan_text: str
    approve: bool
    rehearse_only: bool
    epoch: int
    planned: Planned | None = None
    received_s: float = 0.0
    start: Pose = ORIGIN
    approval: Approval | None = None


@dataclass
class Totals:
    """What one run measured so far."""

    started_s: float
    start: Pose
    start_path_m: float
    counted_to_s: float = 0.0
    moving_s: float = 0.0
    paused_s: float = 0.0
    pending_pause_s: float = 0.0
    has_moved: bool = False
    limited: set[tuple[int, str]] = field(default_factory=set)


class Motion:
    """See the module.

    Args:
        planner: makes `Planned` from plan text: parsed, lowered, rehearsed.
        background: runs a function off the control thread, then posts; a simulation runs it at once.
        emit: takes events; called on the control thread only.
    """

    def __init__(
        self,
        profile: RobotProfile,
        wire: Wire,
        clock: Clock,
        planner: Planner,
        guard: GuardLink,
        emit: Callable[[Event], None],
        background: Callable[[Callable[[], None]], None],
    ) -> None:
        self._profile = profile
        self._clock = clock
        self._planner = planner
        self._guard = guard
        self._emit = emit
        self._background = background
        self._epoch = StopEpoch()
        self._seen_epoch = 0
        self._stop_reason = Reason("stopped")
        self._transport = WireTransport(wire, profile.wiring, self._epoch)
        self._governor = Governor(profile, self._epoch)
        self._sensors = Sensors(profile, clock)
        self._looked_at: LaserScan | None = None
        self._inbox: deque[Callable[[], None]] = deque()
        self._jobs: deque[Job] = deque()
        self._current: Job | None = None
        self._executor: Executor | None = None
        self._totals: Totals | None = None
        self._zeroing_since_s: float | None = None
        self._last_tick_s: float | None = None
        self._next_telemetry_s = 0.0
        self._sequences: dict[tuple[str, bool], int] = {}
        self._leaving: set[str] = set()
        self._void_turns: dict[str, int] = {}
        """By lease, the last turn that a stop has made void: a plan of such a turn may still be on its way."""

    # --- from any thread -------------------------------------------------------------------------------------

    def halt(self, why: Reason) -> None:
        """Stop now: the zero is out before this returns. What runs and what is queued ends as `stopped`."""
        self._stop_reason = why
        self._transport.halt()

    def post(self, action: Callable[[], None]) -> None:
        """Have `action` done on the control thread with the next tick."""
        self._inbox.append(action)

    def receive(self, envelope: Envelope) -> None:
        """Take in an envelope. A stop is out before this returns; the rest is done with the next tick."""
        if envelope.word == "emergency_stop":
            self._governor.latch(envelope.source, str(envelope.payload.get("why", "")))
        if envelope.word in ("stop", "emergency_stop"):
            why = str(envelope.payload.get("why", ""))
            self._void_turns[envelope.lease] = envelope.turn
            self.halt(Reason("stopped_by", {"source": envelope.source, "why": why}))
        # What was said before a stop must not run after it, however late it is handled.
        epoch = self._epoch.value
        self.post(lambda: self._handle(envelope, epoch))

    def lose(self, lease: str) -> None:
        """The source behind `lease` is gone without a goodbye: a loss, and it stops. From any thread."""
        self.halt(Reason("source_lost", {"source": self._governor.leases.source_of(lease)}))
        self._governor.leases.end(lease)
        self._leaving.add(lease)

    # --- control thread --------------------------------------------------------------------------------------

    def start(self, wire: Wire) -> None:
        """Listen to the robot and shake hands with the guard."""
        self._sensors.attach(wire)
        self._guard.handshake()

    @property
    def is_busy(self) -> bool:
        """True while anything is moving, queued, being rehearsed, awaited or zeroed."""
        unbooked_stop = self._seen_epoch != self._epoch.value
        return bool(
            self._current or self._jobs or self._inbox or unbooked_stop or self._zeroing_since_s is not None
        )

    @property
    def has_left(self) -> bool:
        """Every source has gone, and all is done."""
        return bool(self._leaving) and not self.is_busy

    @property
    def sensors(self) -> Sensors:
        return self._sensors

    def _handle(self, envelope: Envelope, epoch: int) -> None:
        """One envelope, received in that stop epoch. Stops have been heard already; here they are only booked."""
        kind = (
            envelope.lease,
            envelope.word == "beat",
        )  # a beat comes from another thread: it may overtake a plan
        if envelope.sequence <= self._sequences.get(kind, -1):
            if envelope.word == "plan":  # overtaken by a later word, most likely a stop: its turn ends here
                self._finish_unstarted(self._job(envelope, epoch), "stopped", self._stop_reason)
            return
        self._sequences[kind] = envelope.sequence
        now_s = self._clock.now_s()
        self._governor.leases.beat(envelope.lease, now_s)
        if envelope.word == "hello":
            term_s = min(float(envelope.payload.get("term_s", LOCAL_TERM_S)), 1.0)
            self._governor.leases.open(envelope.lease, envelope.source, term_s, now_s)
        elif envelope.word == "plan":
            self._accept(envelope, epoch)
        elif envelope.word == "approve":
            self._approve(envelope.turn, bool(envelope.payload.get("yes")))
        elif envelope.word == "release":
            self._governor.release()
        elif envelope.word == "goodbye":
            self._governor.leases.entrust(envelope.lease)
            self._leaving.add(envelope.lease)

    def tick(self) -> None:
        """One period of the control loop."""
        now_s = self._clock.now_s()
        self._notice_freeze(now_s)
        self._last_tick_s = now_s
        self._guard.beat()
        self._look()
        self._book_stop()
        while self._inbox:
            self._inbox.popleft()()
        self._book_stop()
        self._run(now_s)
        self._keep_zeroing(now_s)
        self._begin_next(now_s)
        self._tell(now_s)

    def _look(self) -> None:
        """Show the governor what the lidar has seen since the last tick."""
        scan = self._sensors.scan
        if scan is None or scan is self._looked_at:
            return
        self._looked_at = scan
        pose = self._sensors.estimator.pose_at(scan.stamp_s)
        if pose is not None:
            self._governor.take_scan(scan, pose)

    # --- plans -----------------------------------------------------------------------------------------------

    def _job(self, envelope: Envelope, epoch: int) -> Job:
        payload = envelope.payload
        return Job(
            turn=envelope.turn,
            lease=envelope.lease,
            plan_text=str(payload.get("plan_text", "")),
            approve=bool(payload.get("approve")),
            rehearse_only=bool(payload.get("rehearse_only")),
            epoch=epoch,
            received_s=self._clock.now_s(),
        )

    def _accept(self, envelope: Envelope, epoch: int) -> None:
        job = self._job(envelope, epoch)
        if envelope.payload.get("mode") == "replace":
            self._replace()
        if epoch != self._epoch.value or job.turn <= self._void_turns.get(job.lease, 0):
            self._finish_unstarted(job, "stopped", self._stop_reason)
            return
        if len(self._jobs) >= QUEUE_LIMIT:
            self._finish_unstarted(job, "refused", Reason("queue_full", {"limit": QUEUE_LIMIT}))
            return
        self._jobs.append(job)
        self._begin_next(self._clock.now_s())

    def _replace(self) -> None:
        """New motion takes the place of the old, after a controlled stop; what was queued is dropped."""
        for job in self._jobs:
            self._finish_unstarted(job, "stopped", Reason("replaced"))
        self._jobs.clear()
        if self._executor is not None:
            self._executor.ramp_down(Reason("replaced"))
        elif self._current is not None:
            job, self._current = self._current, None
            self._finish_unstarted(job, "stopped", Reason("replaced"))

    def _begin_next(self, now_s: float) -> None:
        if self._current is not None or not self._jobs or self._zeroing_since_s is not None:
            return
        job = self._jobs[0]
        if self._is_waiting_for_odometry(job, now_s):
            return
        self._jobs.popleft()
        self._current = job
        estimate = self._sensors.estimate
        job.start = estimate.pose if estimate is not None else ORIGIN

        def plan() -> None:
            planned = self._planner.plan(job.turn, job.plan_text, job.start)
            self.post(lambda: self._on_planned(job, planned))

        self._background(plan)

    def _is_waiting_for_odometry(self, job: Job, now_s: float) -> bool:
        """A robot that has just been connected may need a moment to say where it is."""
        if not self._sensors.has_odometry or self._sensors.estimate is not None:
            return False
        if now_s - job.received_s < ODOMETRY_WAIT_S:
            return True
        self._jobs.popleft()
        self._finish_unstarted(
            job, "failed", Reason("no_odometry", {"topic": self._profile.wiring.odom_topic})
        )
        return True

    def _on_planned(self, job: Job, planned: Planned) -> None:
        if self._current is not job:
            return  # stopped or replaced meanwhile; its end has been told
        job.planned = planned
        needs_approval = job.approve and planned.ok and not job.rehearse_only
        self._emit(planned.event(needs_approval))
        if job.rehearse_only:
            self._current = None
            outcome: Outcome = "completed" if planned.ok else "refused"
            self._finish_unstarted(job, outcome, planned.refusal)
        elif not planned.ok:
            self._current = None
            self._finish_unstarted(job, "refused", planned.refusal)
        elif needs_approval:
            job.approval = Approval(self._clock.now_s(), job.start)
        else:
            self._launch(job)

    def _approve(self, turn: int, yes: bool) -> None:
        job = self._current
        if job is None or job.approval is None or job.turn != turn:
            return
        approval, job.approval = job.approval, None
        estimate = self._sensors.estimate
        lapse = approval.lapsed(self._clock.now_s(), estimate.pose if estimate is not None else job.start)
        if not yes or lapse is not None:
            self._current = None
            self._finish_unstarted(job, "refused", lapse or Reason("not_approved"))
            return
        self._launch(job)

    def _launch(self, job: Job) -> None:
        now_s = self._clock.now_s()
        blocker = self._blocker(job, now_s)
        if blocker is not None:
            self._current = None
            self._finish_unstarted(job, "refused", blocker)
            return
        assert job.planned is not None
        estimate = self._sensors.estimate
        self._executor = Executor(self._profile, self._sensors, self._emit)
        self._executor.start(job.turn, job.planned.walk(), job.planned.duration_s, now_s)
        self._totals = Totals(now_s, job.start, estimate.path_m if estimate is not None else 0.0, now_s)
        self._emit(Started(job.turn, job.start))
        self._run(now_s)

    def _blocker(self, job: Job, now_s: float) -> Reason | None:
        """Why nothing may move just now."""
        if self._governor.latched is not None:
            return self._governor.latched
        if not self._guard.is_alive():
            return Reason("guard_lost")
        if not self._governor.leases.is_valid(job.lease, now_s):
            return Reason("lease_lapsed", {"source": self._governor.leases.source_of(job.lease)})
        return None

    # --- a running plan --------------------------------------------------------------------------------------

    def _run(self, now_s: float) -> None:
        job, executor = self._current, self._executor
        if job is None or executor is None:
            self._expire_approval(now_s)
            return
        blocker = self._blocker(job, now_s)
        if blocker is None and self._sensors.bumped:
            blocker = Reason("bumped")
        if blocker is not None:
            self.halt(blocker)
            self._book_stop()
            return
        asked = executor.tick(now_s)
        if executor.is_done:
            self._end_run("completed" if executor.reason is None else executor.outcome, executor.reason)
            return
        estimate = self._sensors.estimate
        verdict = self._governor.govern(
            asked, job.lease, now_s, estimate.pose if estimate is not None else None
        )
        self._transport.send(verdict.sent)
        executor.note(verdict.rule, verdict.reason, verdict.sent.twist, now_s)
        self._count(verdict.sent.twist.is_zero, now_s)
        if verdict.action == "limited" and verdict.rule != "acceleration" and self._totals is not None:
            key = (executor.step, verdict.rule)
            if key not in self._totals.limited:
                self._totals.limited.add(key)
                self._emit(Limited(job.turn, verdict.rule, asked, verdict.sent.twist, verdict.reason))

    def _count(self, standing: bool, now_s: float) -> None:
        """Time in motion, and time standing between two motions: the last pause counts once motion follows."""
        totals = self._totals
        if totals is None:
            return
        elapsed_s, totals.counted_to_s = now_s - totals.counted_to_s, now_s
        if not standing:
            totals.has_moved = True
            totals.moving_s += elapsed_s
            totals.paused_s += totals.pending_pause_s
            totals.pending_pause_s = 0.0
        elif totals.has_moved:
            totals.pending_pause_s += elapsed_s

    def _end_run(self, outcome: Outcome, reason: Reason | None) -> None:
        job, executor, totals = self._current, self._executor, self._totals
        assert job is not None
        assert executor is not None
        assert totals is not None
        self._current = self._executor = self._totals = None
        if outcome != "completed":
            self.halt(reason or Reason("stopped"))
            self._seen_epoch = self._epoch.value
            self._zeroing_since_s = self._clock.now_s()
        estimate = self._sensors.estimate
        pose = estimate.pose if estimate is not None else totals.start
        self._emit(
            Finished(
                job.turn,
                outcome,
                reason,
                start=totals.start,
                pose=pose,
                turned_rad=pose.yaw_rad - totals.start.yaw_rad,
                path_m=(estimate.path_m - totals.start_path_m) if estimate is not None else 0.0,
                duration_s=totals.moving_s,
                paused_s=totals.paused_s,
                planned_m=executor.planned_m,
                planned_turn_rad=executor.planned_turn_rad,
                steps_done=executor.steps_done,
                steps=executor.steps,
                measured=self._sensors.has_odometry,
            )
        )

    def _finish_unstarted(self, job: Job, outcome: Outcome, reason: Reason | None) -> None:
        estimate = self._sensors.estimate
        pose = estimate.pose if estimate is not None else ORIGIN
        self._emit(
            Finished(
                job.turn,
                outcome,
                reason,
                start=pose,
                pose=pose,
                turned_rad=0.0,
                path_m=0.0,
                duration_s=0.0,
                paused_s=0.0,
            )
        )

    def _expire_approval(self, now_s: float) -> None:
        job = self._current
        if job is None or job.approval is None:
            return
        estimate = self._sensors.estimate
        lapse = job.approval.lapsed(now_s, estimate.pose if estimate is not None else job.start)
        if lapse is not None:
            self._current = None
            self._finish_unstarted(job, "refused", lapse)

    # --- stopping --------------------------------------------------------------------------------------------

    def _book_stop(self) -> None:
        """A stop has gone out, from whatever thread: end what ran and what waited, then see the robot stand."""
        if self._seen_epoch == self._epoch.value:
            return
        self._seen_epoch = self._epoch.value
        self._zeroing_since_s = self._clock.now_s()
        why = self._stop_reason
        if self._executor is not None:
            self._end_run("failed" if why.code in _FAILURES else "stopped", why)
        elif self._current is not None:
            job, self._current = self._current, None
            self._finish_unstarted(job, "stopped", why)
        self._drop_stopped_jobs(why)

    def _drop_stopped_jobs(self, why: Reason) -> None:
        """What was said before the stop is dropped; what was said after it stays."""
        for job in [job for job in self._jobs if job.epoch != self._epoch.value]:
            self._jobs.remove(job)
            self._finish_unstarted(job, "stopped", why)

    def _keep_zeroing(self, now_s: float) -> None:
        since_s = self._zeroing_since_s
        if since_s is None:
            return
        estimate = self._sensors.estimate
        seen_standing = (
            estimate is not None
            and estimate.is_standing
            and estimate.stamp_s > since_s
            and self._sensors.odometry_age_s() < ODOMETRY_FRESH_S
        )
        if seen_standing or now_s - since_s > ZEROING_S:
            self._zeroing_since_s = None
            return
        self._transport.send(self._governor.govern(ZERO_TWIST, "", now_s).sent)

    def _notice_freeze(self, now_s: float) -> None:
        """This process was frozen, or the guard thinks so: what moved is over; shake hands anew."""
        gap_s = now_s - self._last_tick_s if self._last_tick_s is not None else 0.0
        tripped = self._guard.was_tripped()
        if self._executor is not None and (gap_s > FROZEN_S or tripped):
            self.halt(Reason("motion_froze", {"gap_s": round(gap_s, 2)}))
        if tripped or gap_s > FROZEN_S:
            self._guard.handshake()

    # --- telling ---------------------------------------------------------------------------------------------

    def _tell(self, now_s: float) -> None:
        job, executor = self._current, self._executor
        if now_s < self._next_telemetry_s:
            return
        self._next_telemetry_s = now_s + TELEMETRY_S
        estimate = self._sensors.estimate
        if estimate is None:
            return
        if job is not None and executor is not None:
            self._emit(executor.progress(job.turn, now_s))
        scan = self._sensors.scan
        self._emit(
            Telemetry(
                job.turn if job is not None else 0,
                estimate.pose,
                estimate.twist,
                estimate.path_m,
                self._sensors.battery_percent,
                nearest_m(scan) if scan is not None else None,
                executor is not None,
            )
        )


ODOMETRY_FRESH_S = 0.3
_FAILURES = frozenset({"guard_lost", "bumped", "motion_froze"})


def notice(code: str, **values: Any) -> Notice:
    """A notice that belongs to no turn."""
    return Notice(0, Reason(code, values))
