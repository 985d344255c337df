"""The half that moves: plan text in, a moving robot and events out. Knows no language, no model, no screen.

One `Motion` serves both links: a process of its own in real time, or the caller's thread on a virtual clock. All
methods belong to the control thread but for `halt`, `receive` and `lose`, which any thread may call at any moment, and
`post`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Looked, Notice
from chatrobot.core.governed import StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import Sensors
from chatrobot.governor.governor import Governor
from chatrobot.governor.lease import RELEASERS
from chatrobot.link.envelope import Envelope
from chatrobot.motion.budgets import Budgets, open_loop_notice
from chatrobot.motion.clients import Clients
from chatrobot.motion.goal_queue import GoalQueue, Inbox, OutcomeQueue
from chatrobot.motion.goal_server import GoalServer
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.obstacles import Obstacles
from chatrobot.motion.pausing import Pausing
from chatrobot.motion.plan_executor import PlanExecutor
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.relayed_velocities import RelayedVelocities
from chatrobot.motion.safety.stop import KEEPING, PAUSED, StopConfirmation, Stops, WireTransport
from chatrobot.motion.safety.watchdog import GuardLink, Interlock, StallDetector
from chatrobot.motion.telemetry import LimitPublisher, ScanPublisher, TelemetryPublisher, sectors_m
from chatrobot.plan.speed_scaling import SpeedScaling
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.wire import Wire


class Motion:
    """Takes in envelopes, and does with each tick what is due; others do the work. See the module.

    Args:
        planner: makes `Planned` from plan text: parsed, lowered, rehearsed.
        background: runs a function off the control thread; a simulation runs it at once.
        programs: where programs are rehearsed and run.
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
        programs: ProgramHost,
        releasers: Collection[str] = RELEASERS,
    ) -> None:
        self._profile = profile
        self._clock = clock
        self._guard = guard
        self._emit = emit
        self._programs = programs
        epoch = StopEpoch()
        transport = WireTransport(wire, profile.wiring, epoch)
        self._governor = Governor(profile, epoch, planner.allowed_area, releasers)
        self.sensors = Sensors(profile, clock)
        self._robot = robot = GovernedRobot(profile, self.sensors, self._governor, transport)
        self.stop_confirmation = StopConfirmation(self.sensors, robot.send_zero, self._notice)
        self._stops = Stops(epoch, transport, self.stop_confirmation, clock)
        self.interlock = Interlock(self._governor, guard)
        self._goal_queue = GoalQueue()
        self._clients = Clients(
            self._governor.leases, lambda lease: self.goals.is_engaged(lease), self._goal_queue.forget
        )
        self._inbox = Inbox(background)
        self._outcomes = outcomes = OutcomeQueue(robot, emit)
        stops, inbox, queue = self._stops, self._inbox, self._goal_queue
        self._executor = PlanExecutor(robot, self.interlock, stops, programs, inbox, clock, outcomes, emit)
        self._pausing = pausing = Pausing(robot, queue, self.interlock, stops, clock, outcomes, emit)
        self._budgets = Budgets(profile.safety.budget)
        self.goals = GoalServer(
            robot, queue, self._executor, planner, programs, self._budgets, stops, inbox, clock, pausing, outcomes, emit
        )  # fmt: skip
        self._obstacles = Obstacles(robot, planner, self.goals, self._executor, stops, inbox, wire, emit)
        self._relayed = RelayedVelocities(
            robot, self._clients, self.goals, pausing, stops, self.stop_confirmation, self.interlock, clock,
            self._notice, LimitPublisher(emit).note,
        )  # fmt: skip
        self._stall_detector = StallDetector(clock, guard, self.halt)
        self._telemetry = TelemetryPublisher(profile, self.sensors, self._executor.progress, emit)
        self._scans = ScanPublisher(profile.lidar, self.sensors, self._governor.leases, emit)
        self._emergency: Envelope | None = None

    # --- from any thread -------------------------------------------------------------------------------------

    def halt(self, why: Reason) -> None:
        """Stop now: the zero is out before this returns. What runs and what is queued ends as `stopped`."""
        self._stops.halt(why)

    def thaw(self) -> None:
        """Void what drove before this process was stopped by a signal (SIGSTOP). For a signal handler."""
        why = self._stall_detector.thaw(self._clock.now_s())
        if why is not None:
            self._stops.void(why)

    def post(self, action: Callable[[], None]) -> None:
        """Have `action` done on the control thread with the next tick."""
        self._inbox.post(action)

    def receive(self, envelope: Envelope, said_in_epoch: int | None = None) -> None:
        """Take in an envelope. A stop is out before this returns; the rest is done with the next tick.

        Args:
            said_in_epoch: what `stops` was when it was said, where that was before it came here.
        """
        if envelope.word == "emergency_stop":
            self._emergency = envelope
            self._governor.latch(envelope.source, str(envelope.payload.get("why", "")))
        if envelope.word in ("stop", "emergency_stop"):
            self._heed_stop(envelope)
        # What was said before a stop must not run after it, however late it is handled.
        epoch = self._stops.count if said_in_epoch is None else said_in_epoch
        emergency = self._emergency
        came_s = self._clock.now_s()
        self.post(lambda: self._handle(envelope, epoch, emergency, came_s))

    def _heed_stop(self, envelope: Envelope) -> None:
        keeps = envelope.word == "stop" and envelope.payload.get("keep") is True
        if keeps:
            self._goal_queue.pause(envelope.lease)
        else:
            self._goal_queue.void_turn(envelope.lease, envelope.turn)
        about = {"source": envelope.source, "why": str(envelope.payload.get("why", ""))}
        self.halt(Reason(PAUSED if keeps else "stopped_by", about))

    def lose(self, lease: str) -> None:
        """Stop: the source behind `lease` is gone without a goodbye."""
        self.halt(self._lost(lease))
        self._clients.lose(lease)

    def lose_second(self, lease: str) -> None:
        """End what is done for the source behind `lease`, which is gone without a goodbye; others go on."""
        self._clients.lose(lease)

        def end() -> None:
            if self.goals.is_engaged(lease):  # then nothing of anybody who goes before it drives or waits
                self.halt(self._lost(lease))

        self.post(end)

    def _lost(self, lease: str) -> Reason:
        return Reason("source_lost", {"source": self._governor.leases.source_of(lease)})

    # --- control thread --------------------------------------------------------------------------------------

    def start(self, wire: Wire) -> None:
        """Listen to the robot and shake hands with the guard."""
        self.sensors.attach(wire)
        self._programs.attach(wire)
        self._relayed.listen(wire)
        self._guard.handshake()
        if (open_loop := open_loop_notice(self._profile)) is not None:
            self._notice(open_loop)

    @property
    def is_busy(self) -> bool:
        """True while anything is moving, queued, being rehearsed, awaited or zeroed."""
        is_zeroed = self.stop_confirmation.is_active and self.stop_confirmation.disobeyed is None
        is_ending = is_zeroed or not self._outcomes.are_told
        return not self.goals.are_done or bool(self._inbox) or self._stops.is_unbooked or is_ending

    @property
    def has_work(self) -> bool:
        """True while something is driven, prepared or queued. From any thread."""
        return not self.goals.are_done

    @property
    def stops(self) -> int:
        """Return a number that changes with every stop: what was asked before it does not count any more."""
        return self._stops.count

    @property
    def latched(self) -> Reason | None:
        """Return the emergency stop that has not been released."""
        return self._governor.latched

    def see_it_stand(self) -> None:
        """Send zeros until the robot stands: nobody knows what it has heard last."""
        self.stop_confirmation.begin(self._clock.now_s())

    def give_up(self, why: Reason) -> None:
        """End as failed all that was asked for: the wire is closed for good."""
        self.goals.fail_all(why)

    def leave(self) -> None:
        """Say goodbye to the guard, so that it sends no zeros; not where the robot is out of sight and may move."""
        if not (self.stop_confirmation.has_lost_sight and self._robot.may_move):
            self._guard.goodbye()

    def tick(self) -> None:
        """Do one period of the control loop."""
        now_s = self._clock.now_s()
        late_s = self._stall_detector.tick(
            now_s,
            is_driven=self._executor.is_driving or self._relayed.are_driving,
            is_engaged=self.goals.current is not None,
        )
        self._governor.leases.note_held_up(late_s)
        self._robot.look()
        self._book_stop()
        while (action := self._inbox.take()) is not None:
            action()
            self._book_stop()
        now_s = self._clock.now_s()  # an action may have sent the first velocity of a motion meanwhile
        self._relayed.tick_sticks(now_s)
        self._executor.tick(now_s)
        self._book_stop()
        self.goals.expire_approval(now_s)
        if not self._executor.is_driving:
            self.stop_confirmation.tick(now_s)
            if self.stop_confirmation.is_at_rest:
                self._robot.may_move = False
        if not self.stop_confirmation.is_watched:
            self._outcomes.tell_all()
        self._pausing.watch(now_s, is_standing=not self.stop_confirmation.is_watched)
        self._relayed.tick_programs(now_s)
        self._begin_next(now_s)
        # Late: it wakes the guard, which may take this processor.
        self._stall_detector.beat(self._clock.now_s())
        self._telemetry.tick(now_s)
        self._scans.tick(now_s)

    def _book_stop(self) -> None:
        """A stop has gone out, from whatever thread: end what ran and what waited, then see the robot stand."""
        why = self._stops.book()
        if why is None:
            return
        if why.code in KEEPING:
            self.goals.pause(why, self._clock.now_s())
        else:
            self.goals.end_stopped(why)
        self._relayed.stop()

    def _begin_next(self, now_s: float) -> None:
        if self.stop_confirmation.disobeyed is not None:
            self.goals.refuse_all(self.stop_confirmation.disobeyed)
        if not (self.stop_confirmation.is_active or self._relayed.is_program_driving):
            self.goals.begin_next(now_s)

    def _notice(self, reason: Reason) -> None:
        self._emit(Notice(0, reason))

    # --- what was said ---------------------------------------------------------------------------------------

    def _handle(self, envelope: Envelope, epoch: int, emergency: Envelope | None, came_s: float) -> None:
        """One envelope, received at `came_s` in that stop epoch, after that emergency stop.

        Stops have been heard already; here they are only booked.
        """
        now_s = self._clock.now_s()
        self._clients.note(envelope.lease, now_s)
        if self._goal_queue.is_old(envelope):
            if envelope.word in ("plan", "program"):
                self.goals.void(envelope, epoch)
            return
        self._clients.hear(envelope, came_s)
        if envelope.word in ("plan", "program"):
            self._accept(envelope, epoch)
            self._begin_next(now_s)
        elif envelope.word == "look":
            self._emit(Looked(envelope.turn, sectors_m(self._profile, self.sensors.scan)))
        elif envelope.word == "watch":
            self._scans.watch(envelope.lease, on=envelope.payload.get("scans") is True)
        elif envelope.word == "steer":
            self._relayed.steer(envelope, came_s)
        elif envelope.word == "resume":
            self._pausing.resume(envelope)
            self._begin_next(now_s)
        elif envelope.word == "rescale":
            scaling = SpeedScaling(**envelope.payload)
            self._executor.rescale(envelope, scaling)
            self._pausing.rescale(envelope, scaling)
        elif envelope.word == "approve":
            self.goals.approve(envelope)
        elif envelope.word == "cancel":
            self.goals.cancel(envelope)
        elif envelope.word == "release":
            self._release(envelope, emergency)
        elif envelope.word == "limit":
            for reason in self._budgets.change(envelope.source, envelope.payload):
                self._emit(Notice(envelope.turn, reason))
        elif envelope.word == "obstacle":
            self._obstacles.change(envelope)
        elif envelope.word == "goodbye":
            self._clients.leave(envelope.lease)
            self._relayed.leave(envelope.lease)
            self._pausing.drop(Reason("source_left", {"source": envelope.source}), envelope.lease)

    def _accept(self, envelope: Envelope, epoch: int) -> None:
        refusal = self._clients.refusal(envelope)
        if refusal is not None:
            self.goals.refuse(envelope, epoch, refusal)
        elif self._relayed.stick:  # what waited would set out by itself once the person lets go
            self.goals.refuse(envelope, epoch, Reason("outranked", {"source": self._relayed.stick}))
        else:
            self.goals.accept(envelope, epoch)

    def _release(self, envelope: Envelope, emergency: Envelope | None) -> None:
        """Release what was set when the release was said; an emergency stop that came after it holds."""
        if self._emergency is not emergency:
            return
        who = {"source": envelope.source}
        code = "released" if self.latched is not None else "none_to_release"
        released = self._governor.release(envelope.source)
        newer = self._emergency
        if newer is not None and newer is not emergency:  # it came in between, and may have seen the old one
            self._governor.latch(newer.source, str(newer.payload.get("why", "")))
        elif not released:
            self._emit(Notice(envelope.turn, Reason("release_refused", who)))
        else:
            self._emit(Notice(envelope.turn, Reason(code, who)))
