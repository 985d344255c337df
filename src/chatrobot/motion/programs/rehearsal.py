"""Rehearses a program: it runs in the sandbox on virtual time, and what it would do is looked at before a wheel turns.

with warm_server() as server:       # chatrobot.programs.sandboxed; start it once, keep it
    rehearsal = rehearse_program(server, source, profile, world, start)
    rehearsal.ok, rehearsal.path, rehearsal.findings, rehearsal.stopped_at_end, rehearsal.cmd_vel
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.motion.programs.rehearsal_environment import RehearsalEnvironment, limited_reason
from chatrobot.motion.remembered_obstacles import RememberedObstacles, with_seen
from chatrobot.plan.context import Finding, Severity
from chatrobot.plan.known_world import Contact, Floats
from chatrobot.plan.rehearsal import MARGIN_M
from chatrobot.plan.swept_path import area_clearance, first_contact
from chatrobot.programs.events import Died, Ended, Log, Output, Raised, TopicNoticed, raised_reason
from chatrobot.programs.lock_step import Played, play
from chatrobot.programs.sandboxed import Launcher, SandboxedProgram
from chatrobot.programs.settings import ProgramSettings, robot_topics
from chatrobot.robots.profile import RobotProfile
from chatrobot.sandbox.limits import SandboxLimits
from chatrobot.sim.world import EMPTY_WORLD, World

HORIZON_S = 60.0
WALL_LIMIT_S = 10.0
LIMITS = SandboxLimits(cpu_s=10)
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
class ProgramRehearsal:
    """What a program would do.

    `path` is [n, 4] of t_s, x_m, y_m, yaw_rad in the odom frame, up to where the robot stands after the program's
    end. `cmd_vel` is what it published: (seconds since its start, velocity). `stopped_at_end` is false where the last
    velocity it asked for was not zero. `turned_rad` is net, `top_…` what the robot really reached.
    """

    path: Floats
    duration_s: float
    length_m: float
    turned_rad: float
    top_speed_mps: float
    top_rate_radps: float
    findings: tuple[Finding, ...]
    stopped_at_end: bool
    cmd_vel: tuple[tuple[float, Twist], ...]
    log: tuple[Log | Output, ...]
    topics: tuple[TopicNoticed, ...]
    end: Ended | Raised | Died
    wall_s: float

    @property
    def ok(self) -> bool:
        """Nothing was found that refuses it."""
        return self.refusal is None

    @property
    def refusal(self) -> Finding | None:
        return next((finding for finding in self.findings if finding.severity == "refuse"), None)

    @property
    def traceback(self) -> str:
        return self.end.traceback if isinstance(self.end, Raised) else ""

    @property
    def line(self) -> int:
        """Of the program, where it raised; 0 elsewhere."""
        return self.end.line if isinstance(self.end, Raised) else 0


def rehearse_program(
    server: Launcher,
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
    """Rehearse `source` from `start` (odom frame), at most to `horizon_s` of its own time. Raises SandboxError.

    `seen` is what the lidar has seen: the program sees it, too.
    """
    settings = ProgramSettings(
        source,
        name=name,
        topics=robot_topics(profile.wiring),
        remaps=remaps or {},
        args=args,
        horizon_s=horizon_s,
    )
    area = world.allowed_area.points if world.allowed_area is not None else None
    environment = RehearsalEnvironment(
        profile, with_seen(world, seen.clear_of(start)) if seen is not None else world, start
    )
    played = play(SandboxedProgram(server, settings, LIMITS), environment, wall_limit_s)
    environment.finish()
    path = np.array(environment.path)
    findings = [
        *_about_the_end(played, horizon_s),
        *_about_motion(played, environment),
        *_about_topics(played, settings),
    ]
    findings += _about_the_way(path, profile, world, area, seen)
    steps = np.diff(path, axis=0)
    long_enough = steps[steps[:, 0] > 1e-3]
    speeds = np.hypot(long_enough[:, 1], long_enough[:, 2]) / long_enough[:, 0]
    rates = np.abs(long_enough[:, 3]) / long_enough[:, 0]
    return ProgramRehearsal(
        path=path,
        duration_s=played.duration_s,
        length_m=float(np.hypot(steps[:, 1], steps[:, 2]).sum()),
        turned_rad=float(path[-1, 3] - path[0, 3]),
        top_speed_mps=float(speeds.max(initial=0.0)),
        top_rate_radps=float(rates.max(initial=0.0)),
        findings=tuple(sorted(findings, key=lambda finding: finding.t_s)),
        stopped_at_end=_stopped(played),
        cmd_vel=tuple(played.cmd_vel),
        log=tuple(played.log),
        topics=tuple(played.topics),
        end=played.end,
        wall_s=played.wall_s,
    )


def _stopped(played: Played) -> bool:
    return not played.cmd_vel or played.cmd_vel[-1][1].is_zero


def _has_driven_and_stopped(played: Played) -> bool:
    """What it did with the robot was done: the last velocity it asked for was a zero behind others."""
    return _stopped(played) and any(not twist.is_zero for _, twist in played.cmd_vel)


def _found(severity: Severity, reason_code: str, t_s: float = 0.0, **values: float | int | str) -> Finding:
    return Finding(severity, Reason(reason_code, values), t_s=t_s)


def _about_the_end(played: Played, horizon_s: float) -> Iterator[Finding]:
    end = played.end
    if isinstance(end, Died):
        yield Finding("refuse", end.reason, t_s=played.duration_s)
    elif isinstance(end, Raised) and _has_driven_and_stopped(played):
        yield Finding("warn", Reason("program_raised_at_end", raised_reason(end).values), t_s=end.t_s)
    elif isinstance(end, Raised):
        yield Finding("refuse", raised_reason(end), t_s=end.t_s)
    elif end.how == "horizon":
        yield _found("note", "program_endless", end.t_s, horizon_s=horizon_s)
    elif end.how == "stuck":
        yield _found("warn", "program_waits_for_ever", end.t_s, horizon_s=horizon_s)
    elif end.exit_code != 0:
        yield _found("warn", "program_exit_code", end.t_s, exit_code=end.exit_code)
    for attempt in played.attempts:
        yield Finding("warn" if attempt.code in _HARMLESS else "refuse", attempt, t_s=played.duration_s)


def _about_motion(played: Played, environment: RehearsalEnvironment) -> Iterator[Finding]:
    for t_s, verdict in environment.limited.values():
        if not verdict.asked.is_finite:
            yield _found("refuse", "program_not_finite", t_s)
        else:
            yield Finding("note", limited_reason(verdict), t_s=t_s)
    if not played.is_planar:
        yield _found("note", "program_not_planar")
    if all(twist.is_zero for _, twist in played.cmd_vel):
        yield _found("warn", "program_moves_nothing")
    elif not _stopped(played) and not (isinstance(played.end, Ended) and played.end.how == "horizon"):
        yield _found("warn", "program_never_stops", played.duration_s)


def _about_topics(played: Played, settings: ProgramSettings) -> Iterator[Finding]:
    ours = set(settings.topics.values())
    for noticed in dict.fromkeys((topic.direction, topic.topic, topic.type_name) for topic in played.topics):
        direction, topic, type_name = noticed
        if topic in ours:
            continue
        if direction == "publishes" and type_name in _TWISTS:
            yield _found("warn", "program_other_topic", topic=topic, robot_topic=settings.topics["cmd_vel"])
        elif direction == "listens" and type_name in _SENSOR_TYPES:
            yield _found("warn", "program_topic_silent", topic=topic)


def _about_the_way(
    path: Floats, profile: RobotProfile, world: World, area: Any, seen: RememberedObstacles | None
) -> Iterator[Finding]:
    poses, footprint = path[:, 1:], profile.footprint
    if not world.is_empty:
        known = first_contact(poses, footprint, world.clearance_m, MARGIN_M)
        if known is not None:
            name = world.obstacle_name_at(known.x_m, known.y_m)
            yield _contact(
                "would_collide", path, known, margin_m=MARGIN_M, **({"obstacle": name} if name else {})
            )
    unknown = seen.first_contact(poses) if seen is not None else None
    if unknown is not None:
        yield _contact("would_collide", path, unknown, margin_m=MARGIN_M)
    if area is not None:
        left = first_contact(poses, footprint, area_clearance(area), 0.0, core_stays_clear=False)
        if left is not None:
            yield _contact("leaves_area", path, left)


def _contact(code: str, path: Floats, contact: Contact, **about: float | str) -> Finding:
    row = path[contact.row]
    driven_m = float(np.hypot(*np.diff(path[: contact.row + 1, 1:3], axis=0).T).sum())
    values: dict[str, float | int | str] = {"distance_m": driven_m, "total_m": driven_m, **about}
    pose = Pose(*(float(value) for value in row[1:]))
    return Finding("refuse", Reason(code, values), t_s=float(row[0]), where=pose)
