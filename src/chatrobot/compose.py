"""The one composition root: which robot, which world, which clock, put together into a session.

Console, web, MCP and the Python API all begin here; nothing below knows how it is put together.
"""

from __future__ import annotations

import subprocess
import sys
import threading
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.core.clock import VirtualClock
from chatrobot.core.errors import JointError, UsageError
from chatrobot.core.events import Event, TruePose
from chatrobot.robots.load import DEFAULT_PROFILE, list_profiles, load_profile
from chatrobot.robots.profile import RobotProfile
from chatrobot.session.joint import SimulatedJoint
from chatrobot.session.session import Options, Session
from chatrobot.session.understanding import Understanding
from chatrobot.sim.lies import SimLies
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import TRUTH_TOPIC, SimRobot
from chatrobot.sim.world import World
from chatrobot.wire.messages import Odometry

if TYPE_CHECKING:
    from chatrobot.session.socket_joint import SocketJoint

OnEvent = Callable[[Event], None]
SETTLE_S = 0.5
"""A robot that has just been switched on stands still this long: its gyro's bias is measured meanwhile."""


@dataclass(frozen=True)
class Setup:
    """What a person chose on the command line or in `connect`.

    `sim` holds the lies of the simulated robot (`slip=0.03,…`). `folder` is where places, programs and history
    live; None keeps nothing.
    """

    on: str = "sim"
    robot: str = DEFAULT_PROFILE
    world: str = "home"
    sim: str = ""
    fast: bool = False
    trace: bool = False
    folder: Path | None = None
    options: Options = field(default_factory=Options)


@dataclass
class Connection:
    """A session and what it stands on. Close it: a robot in motion finishes what it was told, orderly."""

    session: Session
    profile: RobotProfile
    world: World
    close: Callable[[], None]


def connect(setup: Setup, on_event: OnEvent) -> Connection:
    """Start everything and wait until the robot has been heard.

    Raises:
        InputError: a profile, world or option is wrong; the message says where and what is allowed.
        JointError: Motion or the simulated robot does not start.
    """
    if setup.on not in ("auto", "sim"):
        raise UsageError(
            f"this version cannot drive a robot over {setup.on!r} yet",
            where="--on",
            allowed="sim; ROS 2, DDS and rosbridge are being built",
        )
    profile = replace(load_profile(setup.robot, _profile_dirs(setup)), approval="stream")
    world = load_world(setup.world)
    SimLies.parse(setup.sim)
    understanding = Understanding(profile, world, setup.folder)
    if setup.fast:
        return _connect_simulated(setup, profile, world, understanding, on_event)
    return _connect_real_time(setup, profile, world, understanding, on_event)


def _profile_argument(setup: Setup) -> str:
    """What other processes find the profile by: a user's own by its file, for they know no config folder."""
    for entry in list_profiles(_profile_dirs(setup)):
        if entry.name == setup.robot and entry.origin == "user":
            return str(entry.file)
    return setup.robot


def _profile_dirs(setup: Setup) -> tuple[Path, ...]:
    return (setup.folder / "robots",) if setup.folder is not None else ()


# --- simulated time: one process, one thread ---


def _connect_simulated(
    setup: Setup, profile: RobotProfile, world: World, understanding: Understanding, on_event: OnEvent
) -> Connection:
    from chatrobot.session.guard_link import SimulatedGuard
    from chatrobot.session.motion import Motion
    from chatrobot.session.planner import Planner
    from chatrobot.wire.memory import MemoryHub

    clock = VirtualClock()
    hub = MemoryHub()
    robot = SimRobot(profile, world, SimLies.parse(setup.sim), wire=hub.connect(), clock=clock)
    robot.step(SETTLE_S)
    clock.advance(SETTLE_S)
    if setup.trace:
        hub.connect().subscribe(TRUTH_TOPIC, Odometry, _tracer(on_event))
    wire = hub.connect()
    guard = SimulatedGuard(clock)

    def build(emit: OnEvent) -> Motion:
        planner = Planner(profile, world)
        return Motion(profile, wire, clock, planner, guard, emit, lambda job: job())

    joint = SimulatedJoint(build, wire, clock, robot.step, guard, hub.connect(), profile.wiring.cmd_vel_topic)
    joint.next_event(SETTLE_S)
    session = Session(joint, understanding, on_event, setup.options)
    return Connection(session, profile, world, session.close)


# --- real time: the simulated robot, Motion and the guard are processes ---


def _connect_real_time(
    setup: Setup, profile: RobotProfile, world: World, understanding: Understanding, on_event: OnEvent
) -> Connection:
    from chatrobot.session.socket_joint import SocketJoint
    from chatrobot.wire.local import LocalWire
    from chatrobot.wire.runtime_dir import runtime_dir

    wire_path = runtime_dir() / f"sim-{uuid.uuid4().hex[:12]}.wire"
    profile_argument = _profile_argument(setup)
    robot = spawn_simulated_robot(setup, profile_argument, wire_path)
    joint: SocketJoint | None = None
    try:
        joint = SocketJoint(str(wire_path), profile_argument, setup.world)
        joint.wait_until_ready()
    except JointError:
        robot.terminate()
        raise
    lock = threading.Lock()

    def one_at_a_time(event: Event) -> None:
        with lock:
            on_event(event)

    trace = LocalWire(wire_path) if setup.trace else None
    if trace is not None:
        trace.subscribe(TRUTH_TOPIC, Odometry, _tracer(one_at_a_time))
    session = Session(joint, understanding, one_at_a_time, setup.options)

    def close() -> None:
        session.close()
        if trace is not None:
            trace.close()

    return Connection(session, profile, world, close)


def spawn_simulated_robot(setup: Setup, profile: str, wire_path: Path) -> subprocess.Popen[bytes]:
    """In a session of its own: Ctrl-C at the console must not kill the robot before it stands."""
    return subprocess.Popen(
        [
            *(sys.executable, "-m", "chatrobot.sim", "--socket", str(wire_path)),
            *("--profile", profile, "--world", setup.world, "--sim", setup.sim),
        ],
        start_new_session=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )


def _tracer(on_event: OnEvent) -> Callable[[Odometry], None]:
    """Truth samples as `pose` events, timed from the first."""
    began_s: list[float] = []

    def on_truth(sample: Odometry) -> None:
        began_s.append(sample.stamp_s) if not began_s else None
        on_event(TruePose(0, sample.stamp_s - began_s[0], *sample[1:]))

    return on_truth
