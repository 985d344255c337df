"""Rehearses a program: it runs in the sandbox on virtual time, and what it would do is looked at before a wheel turns.

with warm_server() as server:       # chatrobot.programs.sandboxed; start it once, keep it
    rehearsal = rehearse_program(server, source, profile, world, start)
    rehearsal.ok, rehearsal.path, rehearsal.findings, rehearsal.stopped_at_end, rehearsal.cmd_vel
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from chatrobot.core.events import ProgramRehearsed
from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.reason import Reason, Value
from chatrobot.governor.space_rules import fence_rules
from chatrobot.motion.programs.clocks import SteppedProgram
from chatrobot.motion.programs.rehearsal_environment import RehearsalEnvironment
from chatrobot.motion.remembered_obstacles import RememberedObstacles, with_seen
from chatrobot.plan.context import Finding, Severity
from chatrobot.plan.fenced_path import outside_m, way_out
from chatrobot.plan.known_world import Contact, Floats, obstacle_values
from chatrobot.plan.rehearsal import MARGIN_M, RehearsedPath, limited_reason
from chatrobot.plan.swept_path import first_contact
from chatrobot.programs.events import (
    ENDS,
    Beat,
    Died,
    Ended,
    Log,
    Output,
    ProgramEvent,
    Raised,
    TopicNoticed,
    TwistAsked,
)
from chatrobot.programs.pipe import ProgramSettings, robot_topics
from chatrobot.programs.sandboxed import SandboxedProgram
from chatrobot.robots.profile import RobotProfile
from chatrobot.sandbox.limits import SandboxLimits
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.sim.world import EMPTY_WORLD, World

HORIZON_S = 60.0
WALL_LIMIT_S = 10.0
LIMITS = SandboxLimits(cpu_s=10)
LOG_LINES = 50
"""Of what it logs, in the event."""
_HARMLESS = ("box_tried_files", "box_tried_memory", "box_tried_threads")
"""Honest programs try these, and some can do without."""
_TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_SENSOR_TYPES = (
    "nav_msgs/msg/Odometry",
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/Imu",
    "turtlesim/msg/Pose",
)


@dataclass(frozen=True, eq=False)
class ProgramRehearsal(RehearsedPath):
    """The rehearsal of a program; `path` goes on to where the robot stands after the program's end.

    `did` is what it did, with the time since its start; its end comes last. `wall_s` is how long the rehearsal took.
    """

    did: tuple[tuple[float, ProgramEvent], ...]
    wall_s: float

    @property
    def end(self) -> Ended | Raised | Died:
        """Return its last event."""
        end = self.did[-1][1]
        assert isinstance(end, ENDS)
        return end

    @property
    def cmd_vel(self) -> list[tuple[float, Twist]]:
        """Return what it published for the robot: (seconds since its start, velocity)."""
        return [(t_s, event.twist) for t_s, event in self.did if isinstance(event, TwistAsked)]

    @property
    def log(self) -> list[Log | Output]:
        """Return what it logged and printed."""
        return [event for _, event in self.did if isinstance(event, (Log, Output))]

    @property
    def topics(self) -> list[TopicNoticed]:
        """Return what it publishes on and listens to."""
        return [event for _, event in self.did if isinstance(event, TopicNoticed)]

    @property
    def duration_s(self) -> float:
        """Return how long it took by the program's clock."""
        if not isinstance(self.end, Died):
            return self.end.t_s
        return self.cmd_vel[-1][0] if self.cmd_vel else 0.0

    @property
    def top_speed_mps(self) -> float:
        """Return the highest speed that the robot really reached."""
        steps = self._steps
        return float((np.hypot(steps[:, 1], steps[:, 2]) / steps[:, 0]).max(initial=0.0))

    @property
    def top_rate_radps(self) -> float:
        """Return the highest rate of turn that the robot really reached."""
        steps = self._steps
        return float((np.abs(steps[:, 3]) / steps[:, 0]).max(initial=0.0))

    @property
    def _steps(self) -> Floats:
        """The steps from row to row of the path, where these are not too near to divide by."""
        steps: Floats = np.diff(self.path, axis=0)
        return steps[steps[:, 0] > 1e-3]

    @property
    def stopped_at_end(self) -> bool:
        """Tell whether the last velocity it asked for was zero, if it asked for any."""
        return not self.cmd_vel or self.cmd_vel[-1][1].is_zero

    @property
    def moves(self) -> bool:
        """Tell whether it ever asked for a velocity."""
        return any(not twist.is_zero for _, twist in self.cmd_vel)

    @property
    def is_endless(self) -> bool:
        """Tell whether it was still running, or waiting, when its rehearsal ended."""
        return self.ended in ("horizon", "stuck")

    @property
    def ended(self) -> str:
        """Return how, as `ProgramRehearsed` has it."""
        return self.end.how if isinstance(self.end, Ended) else type(self.end).__name__.lower()

    @property
    def problem(self) -> str:
        """Return the traceback of a program that raised, or the last words of one that died."""
        return self.end.traceback if isinstance(self.end, Raised) else getattr(self.end, "log", "")

    @property
    def line(self) -> int:
        """Return the line of the program where it raised; 0 elsewhere."""
        return self.end.line if isinstance(self.end, Raised) else 0

    def event(self, turn: int, name: str) -> ProgramRehearsed:
        """Return what is told of it, besides what is told of every rehearsal."""
        return ProgramRehearsed(
            turn,
            name,
            self.ended,
            round(self.top_speed_mps, 3),
            round(self.top_rate_radps, 3),
            self.stopped_at_end,
            self.problem,
            self.line,
            tuple(f"[{e.level}] [{e.name}] {e.text}" for e in self.log[:LOG_LINES] if isinstance(e, Log)),
        )


def rehearse_program(
    server: WarmServer,
    source: str,
    profile: RobotProfile,
    world: World = EMPTY_WORLD,
    start: Pose = ORIGIN,
    *,
    name: str = "program",
    horizon_s: float = HORIZON_S,
    remaps: Mapping[str, str] | None = None,
    args: tuple[str, ...] = (),
    wall_limit_s: float = WALL_LIMIT_S,
    seen: RememberedObstacles | None = None,
) -> ProgramRehearsal:
    """Rehearse `source` from `start` (odom frame), at most to `horizon_s` of its own time.

    Args:
        wall_limit_s: a program that takes longer here is ended, as too busy.
        seen: what the lidar has seen: the program sees it, too.

    Raises:
        SandboxError: it cannot be launched.
    """
    settings = ProgramSettings(
        source,
        name=name,
        topics=robot_topics(profile.wiring),
        remaps=remaps or {},
        args=args,
        horizon_s=horizon_s,
    )
    around = with_seen(world, seen.clear_of(start)) if seen is not None else world
    environment = RehearsalEnvironment(profile, around, start)
    began_s = time.monotonic()
    did, tried = _play(SandboxedProgram(server, settings, LIMITS), environment, wall_limit_s)
    wall_s = time.monotonic() - began_s
    environment.finish()
    path = np.array(environment.path)
    length_m = float(np.hypot(*np.diff(path[:, 1:3], axis=0).T).sum())
    shown = ProgramRehearsal(path, length_m, (), tuple(did), wall_s)
    findings = [
        *_about_the_end(shown, horizon_s),
        *(_found("warn" if wall.code in _HARMLESS else "refuse", wall, shown.duration_s) for wall in tried),
        *_about_motion(shown, environment),
        *_about_topics(shown, settings.topics),
        *_about_the_way(path, profile, world, seen),
    ]
    return replace(shown, findings=tuple(sorted(findings, key=lambda finding: finding.t_s)))


def _play(
    program: SandboxedProgram, environment: RehearsalEnvironment, wall_limit_s: float
) -> tuple[list[tuple[float, ProgramEvent]], Sequence[Reason]]:
    """Have the program and its simulated robot live to its end: what it did, and what the sandbox did not let it do."""
    clocked = SteppedProgram(program, environment.sensors, limit_s=wall_limit_s, in_all=True)
    did: list[tuple[float, ProgramEvent]] = []
    program.start()
    try:
        while True:
            for event in clocked.poll_until(environment.now_s):
                if isinstance(event, TwistAsked):
                    environment.ask(event.twist)
                if not isinstance(event, Beat):
                    did.append((environment.now_s, event))
            if did and isinstance(did[-1][1], ENDS):
                break
            environment.advance(clocked.next_s)
        report = program.exit_report() if program.end is not None else None
    finally:
        program.close()
    return did, report.findings if report is not None else ()


def _found(severity: Severity, reason: Reason | str, t_s: float = 0.0, **values: Value) -> Finding:
    return Finding(severity, Reason(reason, values) if isinstance(reason, str) else reason, t_s=t_s)


def _about_the_end(shown: ProgramRehearsal, horizon_s: float) -> Iterator[Finding]:
    end, over_s = shown.end, shown.duration_s
    if isinstance(end, Died):
        yield _found("refuse", end.reason, over_s)
    elif (
        isinstance(end, Raised) and shown.moves and shown.stopped_at_end
    ):  # what it did with the robot was done
        yield _found("warn", Reason("program_raised_at_end", end.as_reason.values), over_s)
    elif isinstance(end, Raised):
        yield _found("refuse", end.as_reason, over_s)
    elif end.how == "horizon":
        yield _found("note", "program_endless", over_s, horizon_s=horizon_s)
    elif end.how == "stuck":
        yield _found("warn", "program_waits_for_ever", over_s, horizon_s=horizon_s)
    elif end.exit_code != 0:
        yield _found("warn", "program_exit_code", over_s, exit_code=end.exit_code)


def _about_motion(shown: ProgramRehearsal, environment: RehearsalEnvironment) -> Iterator[Finding]:
    for t_s, verdict in environment.limited.values():
        if verdict.asked.is_finite:
            reason = verdict.reason or limited_reason(verdict.asked, verdict.allowed)
            yield _found("note", reason, t_s)
        else:
            yield _found("refuse", "program_not_finite", t_s)
    if any(isinstance(event, TwistAsked) and not event.planar for _, event in shown.did):
        yield _found("note", "program_not_planar")
    if not shown.moves:
        yield _found("warn", "program_moves_nothing")
    elif not shown.stopped_at_end and shown.ended != "horizon":
        yield _found("warn", "program_never_stops", shown.duration_s)


def _about_topics(shown: ProgramRehearsal, robots: Mapping[str, str]) -> Iterator[Finding]:
    noticed = dict.fromkeys((topic.direction, topic.topic, topic.type_name) for topic in shown.topics)
    for direction, topic, type_name in noticed:
        if topic in robots.values():
            continue
        if direction == "publishes" and type_name in _TWISTS:
            yield _found("warn", "program_other_topic", topic=topic, robot_topic=robots["cmd_vel"])
        elif direction == "listens" and type_name in _SENSOR_TYPES:
            yield _found("warn", "program_topic_silent", topic=topic)


def _about_the_way(
    path: Floats, profile: RobotProfile, world: World, seen: RememberedObstacles | None
) -> Iterator[Finding]:
    poses, footprint = path[:, 1:], profile.footprint
    if not world.is_empty:
        known = first_contact(poses, footprint, world.clearance_m, MARGIN_M)
        if known is not None:
            about = obstacle_values(world.obstacle_names_at(known.x_m, known.y_m))
            yield _contact("would_collide", path, known, margin_m=MARGIN_M, **about)
    unknown = seen.first_contact(poses) if seen is not None else None
    if unknown is not None:
        yield _contact("would_collide", path, unknown, margin_m=MARGIN_M)
    yield from _about_fences(path, profile, world)


def _about_fences(path: Floats, profile: RobotProfile, world: World) -> Iterator[Finding]:
    """At the profile's own fence the governor of the rehearsal has stopped the program, as it will."""
    start, footprint = Pose(*path[0, 1:].tolist()), profile.footprint
    area = world.allowed_area.points if world.allowed_area is not None else None
    fences = [fence for fence in (area, profile.safety.fence) if fence is not None]
    out_m = max((outside_m(start, footprint, fence) for fence in fences), default=0.0)
    left = None
    if area is not None:
        left = way_out(path, footprint, area, fence_rules(profile))
    if left is not None and left.is_outside:
        yield _contact("outside_area", path, left.contact, outside_m=out_m)
        return
    if out_m > 0.0:
        yield _found("note", "stands_outside", outside_m=out_m)
    if left is not None:
        yield _contact("leaves_area", path, left.contact)


def _contact(code: str, path: Floats, contact: Contact, **about: Value) -> Finding:
    row = path[contact.row]
    driven_m = float(np.hypot(*np.diff(path[: contact.row + 1, 1:3], axis=0).T).sum())
    reason = Reason(code, {"distance_m": driven_m, "total_m": driven_m, **about})
    return Finding("refuse", reason, t_s=float(row[0]))
