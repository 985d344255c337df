"""Drives one plan: each tick asks for the twist that keeps the robot on its reference, and watches that it is.

The ideal end of a motion is the reference start of the next, so errors do not add up over a plan. The executor
compares odometry with where the reference was at the odometry's own stamp, so late odometry does no harm.
"""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.clock import TICK_S
from chatrobot.core.events import Event, Outcome, Progress, Remembered, Said
from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.execution.estimator import Estimate
from chatrobot.execution.reference_trajectory import ReferenceTrajectory, Tally
from chatrobot.execution.sensors import Sensors, is_seen_standing, patience_s, sensor_fault
from chatrobot.execution.tracking import (
    AT_THE_END,
    BETWEEN_STEPS,
    LATE_BY_S,
    TRIES,
    Tolerance,
    corrected,
    correction,
    must_brake,
    not_arrived,
    tracking_fault,
    unless_late,
    without_reverse,
)
from chatrobot.plan.context import Impossible
from chatrobot.plan.lowering import NotYet, Walk
from chatrobot.plan.speed_scaling import SpeedScaling
from chatrobot.plan.split import Reached
from chatrobot.plan.trajectory import CoreMotion, Emit, Pause, Segment
from chatrobot.robots.profile import RobotProfile

UNSEEN_S = 0.1
"""A robot that nobody sees is sent zeros for so long at the end of a plan: one may get lost."""

BARRED_S = 3.0
"""Somebody may walk past; after this long the way is barred and the plan ends."""

RAMP_RULES = frozenset({"", "speed", "acceleration"})
"""What the governor does to any motion: no reason to wait."""

CAUGHT_UP_SHARE = 0.9
"""A robot that was slowed has its speed again where it is sent this share of it."""


class Executor:
    """One run of one plan. `start`, then `tick` at 50 Hz until `is_done`."""

    def __init__(self, profile: RobotProfile, sensors: Sensors, emit: Callable[[Event], None]) -> None:
        self._profile = profile
        self._sensors = sensors
        self._emit = emit
        self.is_done = False
        self.reason: Reason | None = None
        self.outcome: Outcome = "completed"
        self.step = 0
        self.steps = 0
        self._reference = ReferenceTrajectory(Pose())
        self._tally = Tally()
        self._pause_until_s: float | None = None
        self._pause_s = 0.0
        self._settle_since_s: float | None = None
        self._corrections_left = TRIES
        self._has_stood = False
        """Whether it has been seen standing where the plan ends: from then on corrections wait for that each time."""
        self._timed: Twist | None = None
        self._asked = ZERO_TWIST
        self._withheld = 0.0
        """The share of the last request, 0 to 1, that was not sent: for so long the reference waits."""
        self._noted_s = 0.0
        self._first_tick = False
        self._ending: Reason | None = None
        self._barred_since_s: float | None = None
        self._begin: tuple[Pose, float] = (Pose(), 0.0)

    def start(self, turn: int, walk: Walk, duration_s: float, now_s: float) -> None:
        """Begin `walk` at its pose, the one the plan was rehearsed from; rehearsal expects `duration_s`."""
        self._turn = turn
        self._walk = walk
        self._duration_s = duration_s
        self._reference = ReferenceTrajectory(walk.pose)
        self._started_s = now_s

    def expect(self, duration_s: float) -> None:
        """Take in that the walk has become longer: `duration_s` in all."""
        self._duration_s = duration_s

    def rescale(self, scaling: SpeedScaling, now_s: float) -> None:
        """Go on at another speed, on the same path: at once, but for a motion that brakes already."""
        self._reference.rescale(scaling, now_s, self._profile.limits)
        factor = scaling.linear_factor if scaling.linear_factor != 1.0 else scaling.angular_factor
        self._duration_s += max(0.0, self._started_s + self._duration_s - now_s) * (1.0 / factor - 1.0)

    # --- what Motion reads ---

    @property
    def steps_done(self) -> int:
        """Return how many steps are finished, repeats counted each time."""
        return self.steps if self.is_done and self.reason is None else max(0, self.step - 1)

    @property
    def planned(self) -> tuple[float, float]:
        """Return metres and radians, counter-clockwise positive, of the plan up to the motion under way."""
        return self._reference.planned

    @property
    def reached(self) -> Reached | None:
        """Return how far the plan has been driven, as odometry shows it just now; None without odometry."""
        estimate = self._sensors.estimate
        return self._tally.reached(estimate.pose) if estimate is not None else None

    def progress(self, turn: int, now_s: float) -> Progress:
        """Return how far it is, by the rehearsed duration."""
        share = (now_s - self._started_s) / self._duration_s if self._duration_s > 0.0 else 1.0
        estimate = self._sensors.estimate
        pose = estimate.pose if estimate is not None else self._reference.reference
        twist = estimate.twist if estimate is not None else ZERO_TWIST
        return Progress(turn, self.step, self.steps, max(0.0, min(1.0, share)), pose, twist)

    def note(self, rule: str, reason: Reason | None, sent: Twist, now_s: float) -> None:
        """Take what the governor made of the last request.

        Where a rule slows the robot the reference waits for it, until it has its speed again; a way that stays barred
        ends the plan.
        """
        is_slowed = rule not in RAMP_RULES
        is_held_back = self._reference.segment is not None and (is_slowed or self._withheld > 0.0)
        self._withheld, self._noted_s = 0.0, now_s
        if not is_held_back:
            self._barred_since_s = None
            return
        asked = self._asked.speed_mps + abs(self._asked.wz_radps)
        share = min(1.0, (sent.speed_mps + abs(sent.wz_radps)) / asked) if asked > 0.0 else 1.0
        self._withheld = 1.0 - share if is_slowed or share < CAUGHT_UP_SHARE else 0.0
        if not (is_slowed and sent.is_zero):
            self._barred_since_s = None
        elif self._barred_since_s is None:
            self._barred_since_s = now_s
        elif now_s - self._barred_since_s > BARRED_S:
            self._end("stopped", reason)

    # --- control ---

    def ramp_down(self, reason: Reason) -> None:
        """Brake along the path, then end as `stopped`: a controlled stop."""
        self._ending = reason

    def tick(self, now_s: float) -> Twist:
        """Return the twist to ask for now, in the robot's frame."""
        fault = sensor_fault(self._sensors)
        if fault is not None:
            return self._end("failed", fault)
        if self._withheld > 0.0:
            seen = self._sensors.estimate.pose if self._sensors.estimate is not None else None
            self._reference.wait(self._withheld * (now_s - self._noted_s), now_s, seen)
            self._noted_s = now_s
        while not self.is_done:
            if self._reference.segment is not None:
                asked = self._drive(self._reference.segment, now_s)
            elif self._pause_until_s is not None:
                asked = self._pause(self._pause_until_s, now_s)
            elif self._settle_since_s is not None:
                return self._settle(now_s)
            else:
                if not self._take_next(now_s):
                    return ZERO_TWIST
                continue
            if asked is not None:
                self._asked = asked
                return asked
        return ZERO_TWIST

    def _take_next(self, now_s: float) -> bool:
        """Begin what comes next; False where that is still to come."""
        if self._ending is not None:
            self._end("stopped", self._ending)
            return True
        try:
            item = next(self._walk)
        except StopIteration:
            self._settle_since_s = now_s
            return True
        if isinstance(item, NotYet):
            return False
        if isinstance(item, Impossible):
            self._end("failed", item.reason)
        else:
            self.step, self.steps = item.number, item.total_steps
            self._reference.reference = item.start
            self._tally.begin(item)
            self._begin_motion(item.motion, now_s)
        return True

    def _begin_motion(self, motion: CoreMotion | None, now_s: float) -> None:
        if isinstance(motion, Emit):
            self._tell(motion)
            self._tally.end()
        elif isinstance(motion, Pause):
            self._pause_s = motion.duration_s
            self._pause_until_s = self._reference.free_from_s(now_s) + motion.duration_s
        elif motion is not None:
            if self._reference.scaling is not None:
                motion = self._reference.scaling.motion(motion, self._profile.limits)
            self._begin_segment(Segment(motion, self._reference.reference), now_s)
        else:
            self._tally.end()

    def _begin_segment(self, segment: Segment, now_s: float, *, is_correcting: bool = False) -> None:
        self._reference.begin(segment, now_s, is_correcting=is_correcting)
        self._first_tick = True
        estimate = self._sensors.estimate
        pose = estimate.pose if estimate is not None else segment.start
        self._begin = (pose, self._sensors.estimator.wheel_yaw_rad)

    def _drive(self, segment: Segment, now_s: float) -> Twist | None:
        t_s = now_s - self._reference.began_s
        segment = self._cut_short(segment, t_s)
        if t_s >= segment.total_s:
            return self._end_segment(segment, now_s)
        if self._first_tick and segment.motion.asked is not None:
            self._first_tick = False
            return segment.motion.asked  # beyond the limits: the governor says so, once
        self._first_tick = False
        _, twist = segment.at(t_s + TICK_S / 2.0)  # the mean over the tick it will be held for
        estimate = self._sensors.estimate
        if estimate is None:
            return twist
        reference = self._reference_at(estimate)
        fault = self._tracking_fault(segment, reference, estimate)
        if fault is not None:
            return self._end("failed", fault)
        return corrected(self._profile, segment, twist, reference.relative_to(estimate.pose))

    def _reference_at(self, estimate: Estimate) -> Pose:
        """Return where it should be when it is seen as in `estimate`, as late as it does what it is told."""
        return self._reference.at(estimate.stamp_s - self._sensors.response.lag_s)

    def _tracking_fault(self, segment: Segment, reference: Pose, estimate: Estimate) -> Reason | None:
        begin, wheel_yaw_rad = self._begin
        if self._reference.is_correcting or estimate.stamp_s < self._reference.began_s:
            return None
        if self._barred_since_s is not None:
            return None  # it was halted at once, and rolls on as far as it takes to brake
        wheel_turn_rad = self._sensors.estimator.wheel_yaw_rad - wheel_yaw_rad

        def fault(reference: Pose) -> Reason | None:
            # Measured from where the robot really began: an error it brought along is not this motion's.
            moved = reference.relative_to(segment.start)
            return tracking_fault(begin, begin.compose(moved), estimate.pose, wheel_turn_rad)

        before_s = (max(self._reference.began_s, estimate.stamp_s - late_s) for late_s in LATE_BY_S)
        return unless_late(fault, reference, map(self._reference.at, before_s))

    def _cut_short(self, segment: Segment, t_s: float) -> Segment:
        """Brake where the plan's condition holds, or where a controlled stop was asked for."""
        if self._ending is None and not must_brake(self._profile, self._sensors.scan, segment, t_s):
            return segment
        shorter = segment.stop_early(t_s)
        if shorter.total_s >= segment.total_s:
            return segment
        self._reference.change(shorter)
        return shorter

    def _end_segment(self, segment: Segment, now_s: float) -> Twist | None:
        self._reference.end()
        if not self._reference.is_correcting:
            is_cut_short = segment.ramp.hold_s < segment.motion.hold_s
            if self._ending is None or not is_cut_short:
                self._tally.end(segment.ramp.hold_s / segment.motion.hold_s)
            self._timed = segment.motion.twist if segment.motion.is_timed else None
            self._walk.ended_at(self._reference.reference)
            self._corrections_left = TRIES
            self._has_stood = False
        if self._ending is None and not self._has_stood and self._correct(BETWEEN_STEPS, now_s):
            return ZERO_TWIST
        return None

    def _pause(self, until_s: float, now_s: float) -> Twist | None:
        self._tally.wait(self._pause_s - (until_s - now_s))
        if now_s < until_s and self._ending is None:
            return ZERO_TWIST
        if now_s >= until_s:
            self._tally.end()
        self._pause_until_s = None
        return None

    def _settle(self, now_s: float) -> Twist:
        """The plan is done: see the robot stand, and drive the rest that feedback left, if it is worth it."""
        assert self._settle_since_s is not None
        waited_s = now_s - self._settle_since_s
        if self._sensors.estimate is None:
            return ZERO_TWIST if waited_s < UNSEEN_S else self._end("completed", None)
        seen = is_seen_standing(self._sensors)
        if not seen and waited_s < patience_s(self._sensors):
            return ZERO_TWIST
        if not self._reference.has_moved:
            return self._end("completed", None)
        if seen and not self._has_stood:
            self._has_stood, self._corrections_left = True, TRIES
        if seen and self._correct(AT_THE_END, now_s):
            self._settle_since_s = None
            return ZERO_TWIST
        missed = not_arrived(self._profile, self._rest(self._sensors.estimate))
        return self._end("completed" if missed is None else "failed", missed)

    def _correct(self, tolerance: Tolerance, now_s: float) -> bool:
        """Begin a small motion back to the reference if the rest is beyond `tolerance`. True if begun."""
        estimate = self._sensors.estimate
        if estimate is None or self._corrections_left == 0:
            return False
        motion = correction(self._profile, self._rest(estimate), tolerance)
        if motion is None:
            return False
        self._corrections_left -= 1
        self._begin_segment(Segment(motion, estimate.pose), now_s, is_correcting=True)
        return True

    def _rest(self, estimate: Estimate) -> Pose:
        """Return what is left to be driven, as seen from the robot."""
        rest = self._reference_at(estimate).relative_to(estimate.pose)
        if self._timed is not None:  # it was to last so long: that it went too far is told, not driven back
            rest = Pose(*without_reverse(rest, self._timed))
            rest = rest if self._timed.speed_mps > 0.0 else Pose(0.0, 0.0, rest.yaw_rad)
        return rest

    def _tell(self, motion: Emit) -> None:
        estimate = self._sensors.estimate
        if motion.kind == "remember":
            pose = estimate.pose if estimate is not None else self._reference.reference
            self._emit(Remembered(self._turn, motion.text, pose))
        else:
            self._emit(Said(self._turn, motion.text))

    def _end(self, outcome: Outcome, reason: Reason | None) -> Twist:
        self.is_done, self.outcome, self.reason = True, outcome, reason
        return ZERO_TWIST
