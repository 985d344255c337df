"""The half that moves: plan text in, a moving robot and events out. Knows no language, no model, no screen.

One `Motion` serves both joints: a process of its own in real time, or the caller's thread on a virtual clock. All
methods belong to the control thread but for `halt`, which any thread may call at any moment, and `post`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Looked, Notice, Outcome, Started, Telemetry
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST, Pose
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.core.wiring import RELAY_TOPIC
from chatrobot.execution.lookahead import nearest_m
from chatrobot.execution.sensors import Sensors
from chatrobot.governor.governor import Governor
from chatrobot.governor.lease import LOCAL_TERM_S
from chatrobot.governor.priority import RELEASERS, Priority, priority_of
from chatrobot.robots.profile import RobotProfile
from chatrobot.session.approval import Approval
from chatrobot.session.envelope import Envelope, seconds
from chatrobot.session.governed_motion import sensed_by
from chatrobot.session.guard_link import GuardLink
from chatrobot.session.intake import Intake
from chatrobot.session.job import Job
from chatrobot.session.planner import Planned, Planner
from chatrobot.session.program_box import NoBox, ProgramBox
from chatrobot.session.program_job import ProgramJob, job_of, needs_approval
from chatrobot.session.program_run import LiveProgram, ProgramRun
from chatrobot.session.relay import Relay
from chatrobot.session.run import Run
from chatrobot.session.sectors import sectors_m
from chatrobot.session.stream import Stream
from chatrobot.session.zeroing import Zeroing
from chatrobot.transports.transport import WireTransport
from chatrobot.wire.messages import LaserScan, TwistMessage
from chatrobot.wire.wire import Wire

FROZEN_S = 0.12
"""A gap this long between two ticks of a moving robot means that this process stood still: the plan is over."""

LONGEST_TERM_S = 1.0
TELEMETRY_S = 0.1
ODOMETRY_WAIT_S = 2.0
_FAILURES = frozenset({"guard_lost", "bumped", "motion_froze", "wire_gone"})


class Motion:
    """See the module.

    Args:
        planner: makes `Planned` from plan text: parsed, lowered, rehearsed.
        background: runs a function off the control thread, then posts; a simulation runs it at once.
        programs: where programs are rehearsed and run; None refuses them.
        emit: takes events; called on the control thread only.
        releasers: the sources that may release an emergency stop.
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
        releasers: Collection[str] = RELEASERS,
        programs: ProgramBox | None = None,
    ) -> None:
        self._profile = profile
        self._clock = clock
        self._planner = planner
        self._guard = guard
        self._emit = emit
        self._background = background
        self._programs = programs or NoBox()
        self._epoch = StopEpoch()
        self._seen_epoch = 0
        self._stop_reason = Reason("stopped")
        self._asked_stop = self._booked_stop = object()
        self._emergency: Envelope | None = None
        self._transport = WireTransport(wire, profile.wiring, self._epoch)
        self._governor = Governor(profile, self._epoch, planner.allowed_area, releasers)
        self._sensors = Sensors(profile, clock)
        self._looked_at: LaserScan | None = None
        self._inbox: deque[Callable[[], None]] = deque()
        self._intake = Intake()
        self._current: Job | None = None
        self._run: Run | ProgramRun | None = None
        self.zeroing = Zeroing(self._sensors, self._send_zero, lambda reason: emit(Notice(0, reason)))
        self._relay = Relay(
            clock,
            self._governor,
            self._transport,
            self._sensors,
            lambda: self.zeroing.begin(clock.now_s()),
            lambda reason: emit(Notice(0, reason)),
        )
        self._last_tick_s: float | None = None
        self._suspended_s = clock.suspended_s()
        self._next_telemetry_s = 0.0
        self._leaving: set[str] = set()
        self.obstruction: Reason | None = None
        """Why nothing may move for now, by those who look after the wire; any thread may set it."""

    # --- from any thread -------------------------------------------------------------------------------------

    def halt(self, why: Reason) -> None:
        """Stop now: the zero is out before this returns. What runs and what is queued ends as `stopped`."""
        self._stop_reason = why
        self._asked_stop = object()
        self._transport.halt()

    def post(self, action: Callable[[], None]) -> None:
        """Have `action` done on the control thread with the next tick."""
        self._inbox.append(action)

    def receive(self, envelope: Envelope, said_in: int | None = None) -> None:
        """Take in an envelope. A stop is out before this returns; the rest is done with the next tick.

        Args:
            said_in: what `stops` was when it was said, where that was before it came here.
        """
        if envelope.word == "emergency_stop":
            self._emergency = envelope
            self._governor.latch(envelope.source, str(envelope.payload.get("why", "")))
        if envelope.word in ("stop", "emergency_stop"):
            why = str(envelope.payload.get("why", ""))
            self._intake.void_turn(envelope.lease, envelope.turn)
            self.halt(Reason("stopped_by", {"source": envelope.source, "why": why}))
        # What was said before a stop must not run after it, however late it is handled.
        epoch = self._epoch.value if said_in is None else said_in
        emergency = self._emergency
        self.post(lambda: self._handle(envelope, epoch, emergency))

    def lose(self, lease: str) -> None:
        """The source behind `lease` is gone without a goodbye: a loss, and it stops. From any thread."""
        self.halt(Reason("source_lost", {"source": self._governor.leases.source_of(lease)}))
        self._governor.leases.end(lease)
        self._leaving.add(lease)

    # --- control thread --------------------------------------------------------------------------------------

    def start(self, wire: Wire) -> None:
        """Listen to the robot and shake hands with the guard."""
        self._sensors.attach(wire)
        self._programs.attach(wire)
        wire.subscribe(RELAY_TOPIC, TwistMessage, self._relay.hear)
        self._guard.handshake()

    @property
    def is_busy(self) -> bool:
        """True while anything is moving, queued, being rehearsed, awaited or zeroed."""
        return bool(
            self._current
            or self._intake.jobs
            or self._inbox
            or self._is_stopped
            or (self.zeroing.is_active and self.zeroing.disobeyed is None)
        )

    @property
    def stops(self) -> int:
        """Changes with every stop: what was asked before it does not count any more."""
        return self._epoch.value

    @property
    def latched(self) -> Reason | None:
        """The emergency stop that has not been released."""
        return self._governor.latched

    @property
    def has_left(self) -> bool:
        """Every source has gone, and all is done."""
        return bool(self._leaving) and not self.is_busy

    @property
    def sensors(self) -> Sensors:
        return self._sensors

    def _handle(self, envelope: Envelope, epoch: int, emergency: Envelope | None) -> None:
        """One envelope, received in that stop epoch, after that emergency stop.

        Stops have been heard already; here they are only booked.
        """
        if self._intake.is_old(envelope):
            if envelope.word in (
                "plan",
                "program",
            ):  # overtaken by a later word, most likely a stop: its turn ends here
                self._finish_unmoved(
                    Job.of(envelope, epoch, self._clock.now_s()), "stopped", self._stop_reason
                )
            return
        now_s = self._clock.now_s()
        self._governor.leases.beat(envelope.lease, now_s)
        if (envelope.word == "hello" or self._opens_lease(envelope)) and envelope.lease not in self._leaving:
            term_s = min(seconds(envelope.payload.get("term_s"), LOCAL_TERM_S), LONGEST_TERM_S)
            self._governor.leases.open(envelope.lease, envelope.source, term_s, now_s)
        if envelope.word in ("plan", "program"):
            self._accept(envelope, epoch)
        elif envelope.word == "look":
            self._emit(Looked(envelope.turn, sectors_m(self._profile, self._sensors.scan)))
        elif envelope.word == "approve":
            if priority_of(envelope.source) >= Priority.PLAN:  # a person's word, not an agent's
                self._approve(envelope, bool(envelope.payload.get("yes")))
        elif envelope.word == "release":
            self._release(envelope, emergency)
        elif envelope.word == "goodbye":
            self._governor.leases.entrust(envelope.lease)
            self._leaving.add(envelope.lease)

    def _release(self, envelope: Envelope, emergency: Envelope | None) -> None:
        """Release what was set when the release was said; an emergency stop that came after it holds."""
        if self._emergency is not emergency:
            return
        who = {"source": envelope.source}
        released = self._governor.release(envelope.source)
        newer = self._emergency
        if (
            newer is not None and newer is not emergency
        ):  # it came in between, and may have seen the old one set
            self._governor.latch(newer.source, str(newer.payload.get("why", "")))
        elif not released:
            self._emit(Notice(envelope.turn, Reason("release_refused", who)))
        elif envelope.source != "console":  # the person there sees it
            self._emit(Notice(envelope.turn, Reason("released", who)))

    def _opens_lease(self, envelope: Envelope) -> bool:
        """A source that was there before us, and names its term with what it says."""
        return "term_s" in envelope.payload and not self._governor.leases.is_known(envelope.lease)

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
        self._drive(now_s)
        if self._run is None:
            self.zeroing.tick(now_s)
        self._relay.tick(now_s, self._is_free)
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

    def _accept(self, envelope: Envelope, epoch: int) -> None:
        if envelope.payload.get("mode") == "extend":
            self._extend(envelope)
            return
        job = job_of(envelope, epoch, self._clock.now_s())
        declined = self._decline_who_left(envelope) or self._give_way(job)
        if declined is None and envelope.payload.get("mode") == "replace":
            self._replace(Reason("replaced"))
        declined = declined or self._intake.add(job, self._epoch.value)
        if declined is not None:
            outcome: Outcome = "stopped" if declined.code == "stopped" else "refused"
            self._finish_unmoved(job, outcome, declined)
            return
        self._begin_next(self._clock.now_s())

    def _decline_who_left(self, envelope: Envelope) -> Reason | None:
        """After a goodbye no beat is waited for: what is said later could never lapse."""
        has_left = envelope.lease in self._leaving
        return Reason("lease_lapsed", {"source": envelope.source}) if has_left else None

    def _give_way(self, job: Job) -> Reason | None:
        """A source of higher priority takes over at once; one of lower priority is refused, with the reason."""
        leases = self._governor.leases
        priority = leases.priority_of(job.lease)
        before = [other for other in (self._current, *self._intake.jobs) if other is not None]
        for other in before:
            if leases.priority_of(other.lease) > priority:
                return Reason("outranked", {"source": leases.source_of(other.lease)})
        lower = [other for other in before if leases.priority_of(other.lease) < priority]
        if lower:
            names = {"source": leases.source_of(lower[0].lease), "to": leases.source_of(job.lease)}
            handed_over = Reason("handed_over", names)
            self._emit(Notice(job.turn, handed_over))
            for waiting in self._intake.take(lower):
                self._finish_unmoved(waiting, "stopped", handed_over)
            if self._current in lower:
                self._end_current_gently(handed_over)
        return None

    def _replace(self, why: Reason) -> None:
        """New motion takes the place of the old, after a controlled stop; what was queued is dropped."""
        for job in self._intake.take_all():
            self._finish_unmoved(job, "stopped", why)
        self._end_current_gently(why)

    def _end_current_gently(self, why: Reason) -> None:
        if self._run is not None:
            self._run.ramp_down(why)
        elif self._current is not None:
            self._finish_current("stopped", why)

    def _begin_next(self, now_s: float) -> None:
        jobs = self._intake.jobs
        if self.zeroing.disobeyed is not None:
            for job in self._intake.take_all():
                self._finish_unmoved(job, "refused", self.zeroing.disobeyed)
        if self._current is not None or not jobs or self.zeroing.is_active or self._relay.is_driving:
            return
        job = jobs[0]
        if self._is_waiting_for_odometry(job, now_s):
            return
        jobs.popleft()
        self._current = job
        job.start = self._pose()

        def plan() -> None:
            if isinstance(job, ProgramJob):
                planned = self._programs.rehearse(job, self._planner)
            else:
                planned = self._planner.plan(job.turn, job.plan_text, job.start)
            self.post(lambda: self._on_planned(job, planned))

        self._background(plan)

    def _is_waiting_for_odometry(self, job: Job, now_s: float) -> bool:
        """A robot that has just been connected may need a moment to say where it is."""
        if not self._sensors.has_odometry or self._sensors.estimate is not None:
            return False
        if now_s - job.received_s < ODOMETRY_WAIT_S:
            return True
        self._intake.jobs.popleft()
        self._finish_unmoved(job, "failed", Reason("no_odometry", {"topic": self._profile.wiring.odom_topic}))
        return True

    def _on_planned(self, job: Job, planned: Planned) -> None:
        if self._current is not job:
            return  # stopped or replaced meanwhile; its end has been told
        refusal = job.take(planned)
        asks = needs_approval(job, planned)
        for event in planned.events(asks):
            self._emit(event)
        if refusal is not None:
            self._finish_current("refused", refusal)
        elif job.rehearse_only:
            self._finish_current("completed", None)
        elif asks:
            job.approval = Approval(self._clock.now_s(), job.start)
        else:
            self._launch(job)
            self._plan_part(job)

    def _extend(self, envelope: Envelope) -> None:
        """The next part of a plan that came with `more`; worth nothing once that plan has ended."""
        jobs = [self._current, *self._intake.jobs] if self._current is not None else self._intake.jobs
        for job in jobs:
            if job.stream is not None and (job.turn, job.lease) == (envelope.turn, envelope.lease):
                job.stream.add(str(envelope.payload.get("plan_text", "")), bool(envelope.payload.get("more")))
                self._plan_part(job)
                return

    def _plan_part(self, job: Job) -> None:
        """Rehearse the next part, if the one before it has been."""
        stream = job.stream
        if self._run is None or self._run.job is not job or stream is None or stream.walk is None:
            return
        text, start = stream.take(), stream.walk.end
        if text is None:
            return
        plan_text = text

        def plan() -> None:
            planned = self._planner.plan(job.turn, plan_text, start, job.start)
            self.post(lambda: self._on_part(job, stream, planned))

        self._background(plan)

    def _on_part(self, job: Job, stream: Stream, planned: Planned) -> None:
        if not isinstance(self._run, Run) or self._run.job is not job:
            return
        self._emit(planned.part_event(stream.steps))
        if stream.accept(planned) is None:
            self._run.executor.expect(stream.duration_s)
        self._plan_part(job)

    def _approve(self, envelope: Envelope, yes: bool) -> None:
        job = self._current
        if job is None or job.approval is None or job.turn != envelope.turn:
            return
        is_theirs = self._governor.leases.priority_of(job.lease) >= Priority.PLAN
        if is_theirs and job.lease != envelope.lease:
            return  # another person was asked, about another plan that happens to have this number
        approval, job.approval = job.approval, None
        lapse = approval.lapsed(self._clock.now_s(), self._pose())
        if not yes or lapse is not None:
            self._finish_current("refused", lapse or Reason("not_approved"))
        else:
            self._launch(job)

    def _launch(self, job: Job) -> None:
        now_s = self._clock.now_s()
        blocker = self._blocker(job, now_s)
        blocker = blocker or self._governor.begin(job.lease, now_s, sensed_by(self._sensors)).refusal
        if blocker is not None:
            self._finish_current("refused", blocker)
        elif self._is_stopped:
            return  # a moment ago, from another thread: the wheel was taken after it, and the job ends as stopped
        elif isinstance(job, ProgramJob):
            self._launch_program(job)
        else:
            self._launch_plan(job, now_s)

    def _launch_plan(self, job: Job, now_s: float) -> None:
        self._run = Run(job, self._profile, self._sensors, self._governor, self._transport, self._emit, now_s)
        self._emit(Started(job.turn, job.start))
        self._drive(now_s)

    def _launch_program(self, job: ProgramJob) -> None:
        """Start it in its box, off this thread; it runs from the moment it is there."""

        def launch() -> None:
            program = self._programs.launch(job)
            self.post(lambda: self._on_launched(job, program))

        self._background(launch)

    def _on_launched(self, job: ProgramJob, program: LiveProgram | Reason) -> None:
        if self._current is not job or isinstance(program, Reason):
            if not isinstance(program, Reason):
                program.close()  # stopped meanwhile
            elif self._current is job:
                self._finish_current("refused", program)
            return
        now_s = self._clock.now_s()
        self._run = ProgramRun(
            job, program, self._profile, self._sensors, self._governor, self._transport, self._emit, now_s
        )
        self._emit(Started(job.turn, job.start))
        self._drive(now_s)

    def _blocker(self, job: Job, now_s: float) -> Reason | None:
        """Why it may not move just now."""
        barrier = self._barrier()
        if barrier is None and not self._governor.leases.is_valid(job.lease, now_s):
            return Reason("lease_lapsed", {"source": self._governor.leases.source_of(job.lease)})
        return barrier

    def _barrier(self) -> Reason | None:
        """Why nothing may move just now."""
        if self._governor.latched is not None:
            return self._governor.latched
        if self.obstruction is not None:
            return self.obstruction
        return None if self._guard.is_alive() else Reason("guard_lost")

    def _is_free(self) -> bool:
        """Nothing of ours drives, waits or stops the robot, and nothing keeps it from moving."""
        is_taken = self._current or self._intake.jobs or self.zeroing.is_active or self._sensors.bumped
        return not is_taken and not self._is_stopped and self._barrier() is None

    @property
    def _is_stopped(self) -> bool:
        """A stop has gone out that is not booked yet."""
        return self._seen_epoch != self._epoch.value

    # --- a running plan --------------------------------------------------------------------------------------

    def _drive(self, now_s: float) -> None:
        run = self._run
        if run is None:
            self._expire_approval(now_s)
            return
        blocker = self._blocker(run.job, now_s)
        if blocker is None and self._sensors.bumped:
            blocker = Reason("bumped")
        if blocker is not None:
            self.halt(blocker)
            self._book_stop()
            return
        run.tick(now_s)
        if run.is_done:
            self._end_run(run.outcome, run.reason)

    def _end_run(self, outcome: Outcome, reason: Reason | None) -> None:
        run = self._run
        assert run is not None
        self._current = self._run = None
        run.close()
        self._governor.end(run.job.lease)
        if outcome == "completed" and self.zeroing.is_seen_moving:  # told to stand, and waited for
            outcome, reason = "failed", self.zeroing.disobedience
        if outcome != "completed":
            self._transport.halt()
            epoch = self._epoch.value
            if self._asked_stop is self._booked_stop:  # else somebody's stop came at this very moment
                self._seen_epoch = epoch
            self.zeroing.begin(self._clock.now_s())
        stream = run.job.stream
        if outcome == "completed" and stream is not None and stream.refusal is not None:
            outcome, reason = "refused", stream.refusal  # what came before it has been done
        self._emit(run.finished(outcome, reason))

    def _finish_current(self, outcome: Outcome, reason: Reason | None) -> None:
        """End the current job, which has not begun to move."""
        job, self._current = self._current, None
        assert job is not None
        self._governor.end(job.lease)  # it may have taken the wheel already: a program that is being launched
        self._finish_unmoved(job, outcome, reason)

    def _finish_unmoved(self, job: Job, outcome: Outcome, reason: Reason | None) -> None:
        self._emit(job.unmoved(outcome, reason, self._pose()))

    def _expire_approval(self, now_s: float) -> None:
        job = self._current
        if job is None or job.approval is None:
            return
        lapse = job.approval.lapsed(now_s, self._pose())
        if lapse is not None:
            self._finish_current("refused", lapse)

    def _pose(self) -> Pose:
        """Where the robot is, as far as it is known."""
        estimate = self._sensors.estimate
        return estimate.pose if estimate is not None else ORIGIN

    # --- stopping --------------------------------------------------------------------------------------------

    def _book_stop(self) -> None:
        """A stop has gone out, from whatever thread: end what ran and what waited, then see the robot stand."""
        if not self._is_stopped:
            return
        self._booked_stop = self._asked_stop
        self._seen_epoch = self._epoch.value
        self.zeroing.begin(self._clock.now_s())
        why = self._stop_reason
        if self._run is not None:
            self._end_run("failed" if why.code in _FAILURES else "stopped", why)
        elif self._current is not None:
            self._finish_current("stopped", why)
        for job in self._intake.take_void(self._epoch.value):
            self._finish_unmoved(job, "stopped", why)

    def see_it_stand(self) -> None:
        """Send zeros until it does: nobody knows what it has heard last."""
        self.zeroing.begin(self._clock.now_s())

    def _send_zero(self, now_s: float) -> None:
        self._transport.send(self._governor.govern(ZERO_TWIST, "", now_s).sent)

    def _notice_freeze(self, now_s: float) -> None:
        """This process was frozen, or the guard thinks so: what moved is over; shake hands anew.

        What slept through a suspended machine is over too, a plan that waits for a yes included.
        """
        suspended_s, self._suspended_s = (
            self._clock.suspended_s() - self._suspended_s,
            self._clock.suspended_s(),
        )
        gap_s = suspended_s + (now_s - self._last_tick_s if self._last_tick_s is not None else 0.0)
        tripped = self._guard.was_tripped()
        slept = suspended_s > FROZEN_S and self._current is not None
        is_driven = self._run is not None or self._relay.is_driving
        if slept or (is_driven and (gap_s > FROZEN_S or tripped)):
            self.halt(Reason("motion_froze", {"gap_s": round(gap_s, 2)}))
        if tripped or gap_s > FROZEN_S:
            self._guard.handshake()

    # --- the end ---------------------------------------------------------------------------------------------

    def give_up(self, why: Reason) -> None:
        """The wire is closed for good, and with it the way to the robot: all that was asked for ends as failed."""
        run, current = self._run, self._current
        self._run = self._current = None
        if run is not None:
            run.close()
            self._emit(run.finished("failed", why))
        elif current is not None:
            self._finish_unmoved(current, "failed", why)
        for job in self._intake.take_all():
            self._finish_unmoved(job, "failed", why)

    def leave(self) -> None:
        """Goodbye to the guard; where the robot is out of sight no word is said, so that it goes on sending zeros."""
        if not self.zeroing.has_lost_sight:
            self._guard.goodbye()

    # --- telling ---------------------------------------------------------------------------------------------

    def _tell(self, now_s: float) -> None:
        if now_s < self._next_telemetry_s:
            return
        self._next_telemetry_s = now_s + TELEMETRY_S
        estimate, scan, run = self._sensors.estimate, self._sensors.scan, self._run
        if estimate is None:
            return
        if run is not None:
            self._emit(run.progress(now_s))
        self._emit(
            Telemetry(
                run.job.turn if run is not None else 0,
                estimate.pose,
                estimate.twist,
                estimate.path_m,
                self._sensors.battery_percent,
                nearest_m(scan) if scan is not None else None,
                run is not None,
            )
        )
