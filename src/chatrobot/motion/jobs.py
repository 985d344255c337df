"""What Motion was asked to do, one after the other: accepted, rehearsed, approved, and handed to the driver."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Finished, Notice, Outcome
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.governor.priority import Priority
from chatrobot.link.approval import Approval
from chatrobot.link.envelope import Envelope
from chatrobot.motion.budgets import Budgets
from chatrobot.motion.driver import Driver
from chatrobot.motion.ends import Ends
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.inbox import Inbox
from chatrobot.motion.intake import Intake
from chatrobot.motion.job import Job
from chatrobot.motion.paused import PausedJob, Pausing, is_foreign, why_not_kept
from chatrobot.motion.planner import Planned, Planner, refused
from chatrobot.motion.programs.program_box import ProgramBox
from chatrobot.motion.programs.program_job import ProgramJob, job_of, needs_approval
from chatrobot.motion.safety.stop import Stops
from chatrobot.motion.stream import Stream

ODOMETRY_WAIT_S = 2.0
"""A robot that has just been connected may need this long to say where it is."""


class Jobs:
    """At most one job is prepared or driven; the others wait in the intake. Belongs to the control thread."""

    def __init__(
        self,
        robot: GovernedRobot,
        intake: Intake,
        driver: Driver,
        planner: Planner,
        programs: ProgramBox,
        budgets: Budgets,
        stops: Stops,
        inbox: Inbox,
        clock: Clock,
        pausing: Pausing,
        ends: Ends,
        emit: Callable[[Event], None],
    ) -> None:
        self._robot = robot
        self._ends = ends
        self._budgets = budgets
        self._intake = intake
        self._driver = driver
        self._planner = planner
        self._programs = programs
        self._stops = stops
        self._inbox = inbox
        self._clock = clock
        self._emit = emit
        self._pausing = pausing
        self._preparing: Job | None = None
        self.why_unheard: Reason | None = None
        """See `Motion.why_unheard`."""

    @property
    def current(self) -> Job | None:
        """What is being prepared or driven."""
        return self._preparing or self._driver.job

    @property
    def are_done(self) -> bool:
        """Nothing is prepared, driven, paused or queued."""
        return self._pausing.job is None and self.current is None and not self._intake.jobs

    @property
    def let_others_drive(self) -> bool:
        """Nothing is done before others; what is paused is dropped for them."""
        return self.are_done or self._pausing.job is not None

    def is_engaged(self, lease: str) -> bool:
        """Something is prepared, driven, paused or queued in that lease's name."""
        return any(job.lease == lease for job in self._all())

    def _all(self) -> list[Job]:
        """What moves the robot, or may: one that is prepared, driven or paused, and then the queue."""
        first = (self.current, self._pausing.job)
        return [*(job for job in first if job is not None), *self._intake.jobs]

    # --- accepted ---

    def accept(self, envelope: Envelope, epoch: int) -> None:
        """Take in a `plan` or a `program` that was received in that stop epoch."""
        mode = envelope.payload.get("mode")
        if mode == "extend":
            self._extend(envelope)
            return
        account = self._budgets.account_of(envelope.source, envelope.lease, envelope.turn)
        job = job_of(envelope, epoch, self._clock.now_s(), account)
        if self._intake.is_void(job, self._stops.count):
            self._finish(job, "stopped", self._stops.last_reason)
            return
        self._drop_paused_for(job, mode)
        declined = self._give_way(job)
        if declined is None and mode == "replace":
            self._replace(Reason("replaced"))
        declined = declined or self._intake.add(job)
        if declined is not None:
            self._finish(job, "refused", declined)

    def void(self, envelope: Envelope, epoch: int) -> None:
        """A later word came before it, a stop or another: its turn ends here."""
        job = Job.of(envelope, epoch, self._clock.now_s())
        is_stopped = self._intake.is_void(job, self._stops.count)
        self._finish(job, "stopped", self._stops.last_reason if is_stopped else Reason("overtaken"))

    def refuse(self, envelope: Envelope, epoch: int, why: Reason) -> None:
        """Its source may not ask for anything."""
        self._finish(Job.of(envelope, epoch, self._clock.now_s()), "refused", why)

    def _give_way(self, job: Job) -> Reason | None:
        """A source of higher priority takes over at once; one of lower priority is refused, with the reason."""
        leases, current = self._robot.governor.leases, self.current
        priority = leases.priority_of(job.lease)
        before = [*([current] if current is not None else []), *self._intake.jobs]
        for other in before:
            if leases.priority_of(other.lease) > priority:
                return Reason("outranked", {"source": leases.source_of(other.lease)})
        lower = [other for other in before if leases.priority_of(other.lease) < priority]
        if lower:
            handed_over = self._handed_over(lower[0], job)
            self._emit(Notice(job.turn, handed_over))
            for waiting in self._intake.take(lower):
                self._finish(waiting, "stopped", handed_over)
            if lower[0] is current:
                self._end_current_gently(handed_over)
        return None

    def _handed_over(self, job: Job, to: Job) -> Reason:
        source_of = self._robot.governor.leases.source_of
        return Reason("handed_over", {"source": source_of(job.lease), "to": source_of(to.lease)})

    def _replace(self, why: Reason) -> None:
        """New motion takes the place of the old, after a controlled stop; what was queued is dropped."""
        for job in self._intake.take_all():
            self._finish(job, "stopped", why)
        self._end_current_gently(why)

    def _end_current_gently(self, why: Reason) -> None:
        self._drop_prepared("stopped", why)
        self._driver.ramp_down(why)

    # --- rehearsed ---

    def begin_next(self, now_s: float) -> None:
        """Prepare the next in the queue, if nothing is prepared or driven."""
        jobs = self._intake.jobs
        if self.current is not None or not jobs:
            return
        if self._pausing.job is not None and not jobs[0].rehearse_only:
            return  # it waits behind what is paused
        if self._is_waiting_for_odometry(jobs[0], now_s):
            return
        self._preparing = job = jobs.popleft()
        job.start = self._robot.pose
        rehearse: Callable[[], Planned] = self._planning(job, job.plan_text, job.start, job.plan_start)
        if isinstance(job, ProgramJob):
            rehearse = partial(self._programs.rehearse, job, self._planner, self._robot.seen())
        self._inbox.fetch(rehearse, lambda planned: self._take_rehearsed(job, planned))

    def _is_waiting_for_odometry(self, job: Job, now_s: float) -> bool:
        sensors = self._robot.sensors
        if not sensors.has_odometry or sensors.estimate is not None:
            return False
        if now_s - job.received_s >= ODOMETRY_WAIT_S:
            self._intake.jobs.popleft()
            topic = self._robot.profile.wiring.odom_topic
            self._finish(job, "failed", self.why_unheard or Reason("no_odometry", {"topic": topic}))
        return True

    def _take_rehearsed(self, job: Job, planned: Planned) -> None:
        if self._preparing is not job:
            return  # stopped or replaced meanwhile; its end has been told
        refusal = job.take(planned)
        asks = needs_approval(job, planned)
        notice = job.account.notice(planned.is_endless)
        if refusal is None and notice is not None:
            self._emit(Notice(job.turn, notice))
        for event in planned.events(asks):
            self._emit(refused(event, refusal))
        if refusal is not None:
            self._drop_prepared("refused", refusal)
        elif job.rehearse_only:
            self._drop_prepared("completed", None)
        elif asks:
            job.approval = Approval(self._clock.now_s(), job.start)
        else:
            self._launch(job)
            self._rehearse_part(job)

    def _launch(self, job: Job) -> None:
        self._preparing = None
        self._driver.launch(job)

    # --- rehearsed in parts, while it is driven ---

    def _extend(self, envelope: Envelope) -> None:
        """The next part of a plan that came with `more`; worth nothing once that plan has ended."""
        for job in self._all():
            if job.stream is not None and (job.turn, job.lease) == (envelope.turn, envelope.lease):
                job.stream.add(str(envelope.payload.get("plan_text", "")), bool(envelope.payload.get("more")))
                self._rehearse_part(job)
                return

    def _rehearse_part(self, job: Job) -> None:
        """Rehearse the next part, if the one before it has been."""
        stream = job.stream
        if not self._driver.drives(job) or stream is None or stream.walk is None:
            return
        plan_text, start = stream.take(), stream.walk.end
        if plan_text is not None:
            rehearse = self._planning(job, plan_text, start, job.plan_start or job.start)
            self._inbox.fetch(rehearse, lambda planned: self._take_part(job, stream, planned))

    def _planning(
        self, job: Job, plan_text: str, start: Pose, plan_start: Pose | None
    ) -> Callable[[], Planned]:
        """Rehearses that text of the job among what is seen now, for the background."""
        seen, left = self._robot.seen(), job.left
        return lambda: self._planner.plan(job.turn, plan_text, start, plan_start, seen, left)

    def _take_part(self, job: Job, stream: Stream, planned: Planned) -> None:
        if not self._driver.drives(job):
            return
        part = planned.part_event(stream.steps)
        refusal = stream.accept(planned)
        self._emit(refused(part, refusal))
        if refusal is None:
            self._driver.expect(stream.duration_s)
        self._rehearse_part(job)

    # --- paused ---

    def pause(self, why: Reason, now_s: float) -> None:
        """The robot has been stopped by a word that keeps what was under way; what cannot be kept has ended."""
        job = self.current
        if job is None and self._pausing.job is not None:
            return  # it waits already
        measure = self._break_off(job, why) if job is not None else None
        if job is None or measure is None:
            self.end_stopped(why_not_kept(job, self._robot) or why)
        else:
            self._pausing.begin(PausedJob(job, measure, now_s))

    def _break_off(self, job: Job, why: Reason) -> Callable[[], Finished] | None:
        """What tells how far it has come; None for what nobody could go on with."""
        if job.rehearse_only or isinstance(job, ProgramJob) or is_foreign(job, self._robot):
            return None
        if self._preparing is None:
            return self._driver.break_off(why)
        self._preparing = None
        return lambda: job.unmoved("stopped", why, self._robot.pose)

    def _drop_paused_for(self, job: Job, mode: object) -> None:
        """Another instruction takes its place, but for one of the same source that is to come after it."""
        paused = self._pausing.job
        if paused is None or job.rehearse_only:
            return
        if job.lease != paused.lease:
            self._pausing.drop(self._handed_over(paused, job))
        elif mode == "replace":
            self._pausing.drop(Reason("replaced"))

    # --- approved ---

    def approve(self, envelope: Envelope) -> None:
        """A person's answer to what was rehearsed in that turn."""
        job = self._preparing
        if job is None or job.approval is None or job.turn != envelope.turn:
            return
        is_a_persons = self._robot.governor.leases.priority_of(job.lease) >= Priority.PLAN
        if is_a_persons and job.lease != envelope.lease:
            return  # another person was asked, about another plan that happens to have this number
        yes = bool(envelope.payload.get("yes"))
        lapse = job.approval.lapsed(self._clock.now_s(), self._robot.pose)
        if not yes or lapse is not None:
            self._drop_prepared("refused", lapse or Reason("not_approved"))
        else:
            job.approval = None
            if not is_a_persons:
                job.account.renew()  # a person has ordered it
            self._launch(job)

    def expire_approval(self, now_s: float) -> None:
        """Refuse what has waited for a yes too long, or from where the robot is no more."""
        job = self._preparing
        lapse = job.approval.lapsed(now_s, self._robot.pose) if job is not None and job.approval else None
        if lapse is not None:
            self._drop_prepared("refused", lapse)

    # --- ended, before anything moved ---

    def end_stopped(self, why: Reason) -> None:
        """The robot has been stopped: end what was driven, prepared, paused, or queued before the stop."""
        self._driver.end_stopped(why)
        self._pausing.end(why)
        self._drop_prepared("stopped", why)
        for job in self._intake.take_void(self._stops.count):
            self._finish(job, "stopped", why)

    def hand_over(self, to: str) -> None:
        """Somebody of higher priority takes the wheel: what was driven, prepared or queued ends, and it is told."""
        jobs = self._all()
        if not jobs:
            return
        why = Reason(
            "handed_over", {"source": self._robot.governor.leases.source_of(jobs[0].lease), "to": to}
        )
        self._emit(Notice(jobs[0].turn, why))
        self._driver.end_stopped(why)
        self._pausing.end(why)
        self._drop_prepared("stopped", why)
        for job in self._intake.take_all():
            self._finish(job, "stopped", why)

    def fail_all(self, why: Reason) -> None:
        """The way to the robot is gone for good: all that was asked for has failed."""
        self._driver.fail(why)
        self._pausing.end(why)
        self._drop_prepared("failed", why)
        for job in self._intake.take_all():
            self._finish(job, "failed", why)

    def refuse_all(self, why: Reason) -> None:
        """Refuse what is queued."""
        for job in self._intake.take_all():
            self._finish(job, "refused", why)

    def _drop_prepared(self, outcome: Outcome, reason: Reason | None) -> None:
        job, self._preparing = self._preparing, None
        if job is not None:
            self._finish(job, outcome, reason)

    def _finish(self, job: Job, outcome: Outcome, reason: Reason | None) -> None:
        self._ends.tell(lambda: job.unmoved(outcome, reason, self._robot.pose))
