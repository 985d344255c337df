"""Takes goals one after the other: accepts, rehearses, has them approved, and hands them to the plan executor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

from chatrobot.core.clock import Clock
from chatrobot.core.events import Event, Finished, Notice, Outcome
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import Priority, priority_of
from chatrobot.link.envelope import Envelope
from chatrobot.link.motion_link import Approval
from chatrobot.motion.budgets import Budgets
from chatrobot.motion.goal import Goal, handed_over
from chatrobot.motion.goal_queue import GoalQueue, Inbox, OutcomeQueue
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.pausing import PausedGoal, Pausing, is_foreign, why_not_kept
from chatrobot.motion.plan_executor import PlanExecutor
from chatrobot.motion.plan_rehearsal import PlanRehearsal, Trial
from chatrobot.motion.planner import Planned, Planner, refused
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.programs.host import ProgramHost
from chatrobot.motion.safety.stop import Stops

ODOMETRY_WAIT_S = 2.0
"""A robot that has just been connected may need this long to say where it is."""


@dataclass(eq=False)
class GoalServer:
    """Prepares or drives at most one goal; the others wait in the goal queue. Belongs to the control thread."""

    _robot: GovernedRobot
    _goal_queue: GoalQueue
    _executor: PlanExecutor
    _planner: Planner
    _programs: ProgramHost
    _budgets: Budgets
    _stops: Stops
    _inbox: Inbox
    _clock: Clock
    _pausing: Pausing
    _outcomes: OutcomeQueue
    _emit: Callable[[Event], None]
    _preparing: Goal | None = field(default=None, init=False)
    _rehearsal: PlanRehearsal = field(init=False)
    _trial: Trial = field(init=False)
    why_unheard: Reason | None = field(default=None, init=False)
    """Why no odometry comes, as far as those know who look after the wire; any thread may set it."""

    def __post_init__(self) -> None:
        robot, executor, inbox = self._robot, self._executor, self._inbox
        self._rehearsal = PlanRehearsal(robot, executor, self._planner, inbox, self._emit)
        self._trial = Trial(robot, self._goal_queue, executor, self._rehearsal, inbox)

    @property
    def current(self) -> Goal | None:
        """Return what is being prepared or driven."""
        return self._preparing or self._executor.goal

    @property
    def are_done(self) -> bool:
        """True while nothing is prepared, driven, paused or queued."""
        is_any_first = self._pausing.goal or self.current or self._trial.goal
        return is_any_first is None and not self._goal_queue.goals

    @property
    def let_others_drive(self) -> bool:
        """True while nothing is done before others; what is paused is dropped for them."""
        return self.are_done or self._pausing.goal is not None

    def is_engaged(self, lease: str) -> bool:
        """Return whether something is prepared, driven, paused or queued in that lease's name."""
        return any(goal.lease == lease for goal in self._all())

    def _all(self) -> list[Goal]:
        """What moves the robot, or may: one that is prepared, driven or paused, and then the queue."""
        goals = (self.current, self._pausing.goal, *self._goal_queue.goals, self._trial.goal)
        return [goal for goal in goals if goal is not None]

    # --- accepted ---

    def accept(self, envelope: Envelope, epoch: int) -> None:
        """Take in a `plan` or a `program` that was received in that stop epoch."""
        if (mode := envelope.payload.get("mode")) == "extend":
            self._extend(envelope)
            return
        account = self._budgets.account_of(envelope.source, envelope.lease, envelope.turn)
        kind = ProgramGoal if envelope.word == "program" else Goal
        goal = kind.of(envelope, epoch, self._clock.now_s(), account)
        self._end_trial()  # what comes later stays behind it
        tries = mode == "replace" and envelope.payload.get("tries") is True
        if not (tries and self._trial.begin(goal, self._clock.now_s(), self._end_trial)):
            self._take_in(goal, mode, envelope.payload.get("instead_of"))

    def _take_in(self, goal: Goal, mode: object, place_of_turn: int | None = None) -> None:
        if self._goal_queue.is_void(goal, self._stops.count):
            self._outcomes.tell_unmoved(goal, "stopped", self._stops.last_reason)
            return
        self._pausing.drop_for(goal, mode, self._source)
        declined = self._give_way(goal)
        if declined is None and mode == "replace":
            self._replace(Reason("replaced"))
        if declined is None and place_of_turn is not None:
            changed = self._goal_queue.put_instead(goal, place_of_turn)
            self._outcomes.tell_all_unmoved(changed, "stopped", Reason("order_changed"))
            declined = None if changed else Reason("begun_meanwhile")
        elif declined is None:
            declined = self._goal_queue.add(goal)
        if declined is not None:
            self._outcomes.tell_unmoved(goal, "refused", declined)

    def _end_trial(self, planned: Planned | None = None) -> None:
        """Refuse what was tried, and let go on what is driven; else it takes its place."""
        goal = self._trial.take()
        if goal is None:
            return
        may_refuse = self._executor.goes_on and not self._goal_queue.is_void(goal, self._stops.count)
        if planned is not None and may_refuse and goal.take(planned) is not None:
            self._show(planned, goal)
            self._outcomes.tell_unmoved(goal, "refused", goal.refusal)
            return
        goal.forget_rehearsal()
        self._take_in(goal, "replace")

    def cancel(self, envelope: Envelope) -> None:
        """End one turn of a source: at once where it waits, with a controlled stop where it has begun."""
        current, why = self.current, Reason("canceled")
        about = envelope.lease, envelope.turn
        self._trial.give_up(about)
        self._outcomes.tell_all_unmoved(self._goal_queue.take_turn(*about), "stopped", why)
        if current is not None and (current.lease, current.turn) == about:
            self._end_current_gently(why)

    def void(self, envelope: Envelope, epoch: int) -> None:
        """End the turn of an envelope that a later one, a stop or another, has overtaken."""
        goal = Goal.of(envelope, epoch, self._clock.now_s())
        is_stopped = self._goal_queue.is_void(goal, self._stops.count)
        self._outcomes.tell_unmoved(
            goal, "stopped", self._stops.last_reason if is_stopped else Reason("overtaken")
        )

    def refuse(self, envelope: Envelope, epoch: int, why: Reason) -> None:
        """Refuse what a source asks for that may not ask for anything."""
        self._outcomes.tell_unmoved(Goal.of(envelope, epoch, self._clock.now_s()), "refused", why)

    def _give_way(self, goal: Goal) -> Reason | None:
        """A source of higher priority takes over at once; one of lower priority is refused, with the reason."""
        leases, current = self._robot.governor.leases, self.current
        priority = leases.priority_of(goal.lease)
        before = [*([current] if current is not None else []), *self._goal_queue.goals]
        for other in before:
            if leases.priority_of(other.lease) > priority:
                return Reason("outranked", {"source": self._source(other)})
        lower = [other for other in before if leases.priority_of(other.lease) < priority]
        if lower:
            why = handed_over(self._source(lower[0]), self._source(goal))
            self._emit(Notice(goal.turn, why))
            self._outcomes.tell_all_unmoved(self._goal_queue.take(lower), "stopped", why)
            if lower[0] is current:
                self._end_current_gently(why)
        return None

    def _source(self, goal: Goal) -> str:
        return self._robot.governor.leases.source_of(goal.lease)

    def _replace(self, why: Reason) -> None:
        """New motion takes the place of the old, after a controlled stop; what was queued is dropped."""
        self._end_queued("stopped", why)
        self._end_current_gently(why)

    def _end_current_gently(self, why: Reason) -> None:
        self._drop_prepared("stopped", why)
        self._executor.ramp_down(why)

    # --- rehearsed ---

    def begin_next(self, now_s: float) -> None:
        """Prepare the next in the queue, if nothing is prepared or driven."""
        if self._trial.is_too_long(now_s):
            self._end_trial()
        goals = self._goal_queue.goals
        if self.current is not None or not goals:
            return
        waits_behind_paused = self._pausing.goal is not None and not goals[0].rehearse_only
        if waits_behind_paused or self._is_waiting_for_odometry(goals[0], now_s):
            return
        self._preparing = goal = goals.popleft()
        goal.start = self._robot.pose
        rehearse: Callable[[], Planned] = self._rehearsal.planning(
            goal, goal.plan_text, goal.start, goal.plan_start
        )
        if isinstance(goal, ProgramGoal):
            rehearse = partial(self._programs.rehearse, goal, self._planner, self._robot.seen())
        self._inbox.fetch(rehearse, lambda planned: self._take_rehearsed(goal, planned))

    def _is_waiting_for_odometry(self, goal: Goal, now_s: float) -> bool:
        sensors = self._robot.sensors
        if not sensors.has_odometry or sensors.estimate is not None:
            return False
        if now_s - goal.received_s >= ODOMETRY_WAIT_S:
            self._goal_queue.goals.popleft()
            topic = self._robot.profile.wiring.odom_topic
            self._outcomes.tell_unmoved(
                goal, "failed", self.why_unheard or Reason("no_odometry", {"topic": topic})
            )
        return True

    def _take_rehearsed(self, goal: Goal, planned: Planned) -> None:
        if self._preparing is not goal:
            return  # stopped or replaced meanwhile; its end has been told
        refusal = goal.take(planned)
        notice = goal.account.notice(planned.is_endless)
        if refusal is None and notice is not None:
            self._emit(Notice(goal.turn, notice))
        self._show(planned, goal)
        if refusal is not None:
            self._drop_prepared("refused", refusal)
        elif goal.rehearse_only:
            self._drop_prepared("completed", None)
        elif goal.asks:
            goal.approval = Approval(self._clock.now_s(), goal.start)
        else:
            self._launch(goal)

    def _show(self, planned: Planned, goal: Goal) -> None:
        for event in planned.events(goal.asks):
            self._emit(refused(event, goal.refusal))

    def _launch(self, goal: Goal) -> None:
        self._preparing = None
        self._executor.launch(goal, lambda: self._rehearsal.next_part(goal))

    # --- rehearsed in parts, while it is driven ---

    def _extend(self, envelope: Envelope) -> None:
        """The next part of a plan that came with `more`; worth nothing once that plan has ended."""
        for goal in self._all():
            if (goal.turn, goal.lease) == (envelope.turn, envelope.lease):
                payload = envelope.payload
                goal.stream.add(str(payload.get("plan_text", "")), bool(payload.get("more")))
                self._rehearsal.next_part(goal)
                return

    def void_prepared(self, why: Reason) -> None:
        """Refuse what waits for a yes: it was about another world. What is being rehearsed is rehearsed anew."""
        goal = self._preparing
        if goal is not None and goal.approval is not None:
            self._drop_prepared("refused", why)
        elif goal is not None:
            self._preparing = None
            self._goal_queue.resume(replace(goal))  # the rehearsal of the other is nobody's now

    # --- paused ---

    def pause(self, why: Reason, now_s: float) -> None:
        """Keep what was under way when a pause stopped the robot; end what cannot be kept."""
        goal, tried = self.current, self._trial.take()
        if tried is not None:
            self._outcomes.tell_unmoved(tried, "stopped", why)
        if goal is None and self._pausing.goal is not None:
            self._pausing.hold(why)
            return  # it waits already
        measure = self._break_off(goal, why) if goal is not None else None
        if goal is None or measure is None:
            self.end_stopped(why_not_kept(goal, self._robot, why))
        else:
            self._pausing.begin(PausedGoal(goal, measure, now_s), why)

    def _break_off(self, goal: Goal, why: Reason) -> Callable[[], Finished] | None:
        """What tells how far it has come; None for what nobody could go on with."""
        if goal.rehearse_only or isinstance(goal, ProgramGoal) or is_foreign(goal, self._robot):
            return None
        if self._preparing is None:
            return self._executor.break_off(why)
        self._preparing = None
        return lambda: goal.unmoved("stopped", why, self._robot.pose)

    # --- approved ---

    def approve(self, envelope: Envelope) -> None:
        """Take a person's answer to what was rehearsed in that turn. An agent withdraws its own at most."""
        goal = self._preparing
        if goal is None or goal.approval is None or goal.turn != envelope.turn:
            return
        is_a_persons = self._robot.governor.leases.priority_of(goal.lease) >= Priority.PLAN
        is_own, yes = goal.lease == envelope.lease, bool(envelope.payload.get("yes"))
        by_person = priority_of(envelope.source) >= Priority.PLAN
        if not (is_own or (by_person and not is_a_persons)) or (yes and not by_person):
            return  # or another person was asked, about another plan that happens to have this number
        lapse = goal.approval.lapsed(self._clock.now_s(), self._robot.pose)
        if not yes or lapse is not None:
            refusal = Reason("edited_instead" if envelope.payload.get("edited") else "not_approved")
            self._drop_prepared("refused", lapse or refusal)
        else:
            goal.approval = None
            if not is_a_persons:
                goal.account.renew()  # a person has ordered it
            self._launch(goal)

    def expire_approval(self, now_s: float) -> None:
        """Refuse what has waited for a yes too long, or from where the robot is no more."""
        goal = self._preparing
        lapse = goal.approval.lapsed(now_s, self._robot.pose) if goal is not None and goal.approval else None
        if lapse is not None:
            self._drop_prepared("refused", lapse)

    # --- ended, before anything moved ---

    def end_stopped(self, why: Reason) -> None:
        """End what was driven, prepared, paused, or queued before a stop."""
        self._trial.give_up()
        self._executor.end_stopped(why)
        self._pausing.end(why)
        self._drop_prepared("stopped", why)
        self._outcomes.tell_all_unmoved(self._goal_queue.take_void(self._stops.count), "stopped", why)

    def hand_over(self, to: str) -> None:
        """End all goals, and tell it: somebody of higher priority takes command."""
        if not (goals := self._all()):
            return
        why = handed_over(self._source(goals[0]), to)
        self._emit(Notice(goals[0].turn, why))
        self._executor.end_stopped(why)
        self._end_waiting("stopped", why)

    def fail_all(self, why: Reason) -> None:
        """End all goals as failed: the way to the robot is gone for good."""
        self._executor.fail(why)
        self._end_waiting("failed", why)

    def refuse_all(self, why: Reason) -> None:
        """Refuse what is queued."""
        self._end_queued("refused", why)

    def _end_waiting(self, outcome: Outcome, why: Reason) -> None:
        self._pausing.end(why)
        self._drop_prepared(outcome, why)
        self._end_queued(outcome, why)

    def _end_queued(self, outcome: Outcome, why: Reason) -> None:
        self._trial.give_up()
        self._outcomes.tell_all_unmoved(self._goal_queue.take_all(), outcome, why)

    def _drop_prepared(self, outcome: Outcome, reason: Reason | None) -> None:
        goal, self._preparing = self._preparing, None
        if goal is not None:
            self._outcomes.tell_unmoved(goal, outcome, reason)
