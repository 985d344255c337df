"""The one composition root: which robot, which world, which clock, put together into a session.

Console, web, MCP and the Python API all begin here; nothing below knows how it is put together.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from chatrobot.core.clock import VirtualClock
from chatrobot.core.errors import LinkError, UsageError
from chatrobot.core.events import Event, TruePose
from chatrobot.core.motion_budget import NOT_CHOSEN, MotionBudget
from chatrobot.dialogue.llm.camera import Camera, PassedCamera, wire_camera
from chatrobot.dialogue.llm.setup import ModelSetup, warm_up
from chatrobot.dialogue.llm.terms import ModelOptions
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.programs.authoring import Authoring
from chatrobot.dialogue.session import Session
from chatrobot.dialogue.understanding import Understanding
from chatrobot.link.in_process import InProcessLink
from chatrobot.link.processes import SIMULATED, MotionProcess, Processes
from chatrobot.models.seam import Model
from chatrobot.plan.context import RoutePlanner
from chatrobot.programs.library import Library
from chatrobot.robots.cautious import drives_on_alone, slowed
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile, profile_argument
from chatrobot.robots.open_loop import as_chosen
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import TRUTH_TOPIC, SimRobot
from chatrobot.sim.world import World, check_known, check_start
from chatrobot.wire.connect import connect_wire, is_on_this_machine, wire_address
from chatrobot.wire.messages import Odometry

OnEvent = Callable[[Event], None]
SETTLE_S = 0.5
"""A robot that has just been switched on stands still this long: its gyro's bias is measured meanwhile."""


@dataclass(frozen=True)
class Setup:
    """What a person chose on the command line or in `connect`.

    `on` is auto, sim, or a robot's wire (`wire_address`). `world`: "" is what fits, the furnished home for the
    simulated robot and nothing known for any other. `sim` holds the faults of the simulated robot (`slip=0.03,…`).
    `yes`: plans of a real robot need no approval. `programs`: who asks for a program gets one written, rehearsed and
    run; else its motion is driven as a plan. `budget` is the motion budget, as far as it is not the profile's.
    `open_loop`: drive a robot that has no odometry (`chatrobot.robots.open_loop`).
    `folder` is where places, programs and history live; None keeps
    nothing. `model` is the language model to ask, None for none, `model_options` how it is used, and `camera` takes
    pictures for it, as JPEG or PNG, in place of the robot's own camera. `processes` are those of a simulated robot in
    real time that have been started ahead; `on_ready` is called once the robot is.
    """

    on: str = "sim"
    robot: str = DEFAULT_PROFILE
    world: str = ""
    sim: str = ""
    fast: bool = False
    trace: bool = False
    yes: bool = False
    programs: bool = False
    budget: MotionBudget = NOT_CHOSEN
    open_loop: bool = False
    folder: Path | None = None
    options: Options = field(default_factory=Options)
    model: Model | None = None
    model_options: ModelOptions = field(default_factory=ModelOptions)
    camera: Callable[[], bytes | None] | None = None
    processes: Processes | None = None
    on_ready: Callable[[], None] = lambda: None


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
        WireError: nobody answers where the robot should be.
        LinkError: Motion or the simulated robot does not start.
    """
    on_wire = setup.on not in SIMULATED
    profile = load_profile(setup.robot, profile_dirs(setup.folder))
    profile = as_chosen(profile, setup.budget, open_loop=setup.open_loop)
    if not on_wire:
        profile = replace(profile, approval="stream")
    elif drives_on_alone(profile) and not is_on_this_machine(wire_address(setup.on)):
        profile = slowed(profile)  # as Motion does: what is said of speeds must be true
    setup = replace(setup, world=setup.world or default_world(setup.on, open_loop=setup.open_loop))
    world = load_world(setup.world)
    check_known(world, profile)
    FaultInjection.parse(setup.sim)
    if not on_wire:
        check_start(world, profile, f"--world {setup.world}")
    understanding = Understanding(profile, world, setup.folder)
    if not setup.fast and setup.options.interpreter != "offline":
        warm_up(setup.model)
    if on_wire:
        return _connect_wire(setup, profile, world, understanding, on_event)
    if setup.fast:
        return _connect_simulated(setup, profile, world, understanding, on_event)
    return _connect_real_time(setup, profile, world, understanding, on_event)


def default_world(on: str, *, open_loop: bool = False) -> str:
    """What is known of the surroundings where nobody says: of a robot that is not ours, or lost in them, nothing."""
    return "home" if on in SIMULATED and not open_loop else "empty"


def model_setup_of(setup: Setup, profile: RobotProfile) -> ModelSetup | None:
    """The model and how it drives this robot.

    Its steps run as they come where the profile allows that; on a base that steers like a car a plan comes whole,
    because corners can be rounded only where both legs are known.
    """
    if setup.model is None:
        return None
    streams = setup.model_options.streams and profile.approval == "stream" and profile.can_turn_on_the_spot
    return ModelSetup(
        setup.model, replace(setup.model_options, streams=streams), profile, _camera(setup, profile)
    )


def _camera(setup: Setup, profile: RobotProfile) -> Camera | None:
    """What was passed goes before what the robot has; the simulated robot has none."""
    if setup.camera is not None:
        return PassedCamera(setup.camera)
    return None if setup.on in SIMULATED else wire_camera(wire_address(setup.on), profile.wiring)


def profile_dirs(folder: Path | None) -> tuple[Path, ...]:
    """Where a person's own robot profiles live."""
    return (folder / "robots",) if folder is not None else ()


def _authoring(
    setup: Setup, profile: RobotProfile, world: World, understanding: Understanding
) -> Authoring | None:
    """Who writes programs and keeps them; nobody where requests for them are driven as plans."""
    if not setup.programs:
        return None
    from chatrobot.plan.route import GridRoutePlanner

    def routes() -> RoutePlanner | None:
        return None if world.is_empty else GridRoutePlanner(world, profile)

    return Authoring(
        profile,
        Library(setup.folder),
        understanding.interpret,
        model=setup.model,
        prefers_model=setup.options.interpreter == "model",
        routes=routes,
    )


# --- simulated time: one process, one thread ---


def _connect_simulated(
    setup: Setup, profile: RobotProfile, world: World, understanding: Understanding, on_event: OnEvent
) -> Connection:
    from chatrobot.motion.motion import Motion
    from chatrobot.motion.planner import Planner
    from chatrobot.motion.programs.host import ProgramHost
    from chatrobot.motion.safety.watchdog import SimulatedGuard
    from chatrobot.wire.memory import MemoryHub

    clock = VirtualClock()
    hub = MemoryHub()
    robot = SimRobot(profile, world, FaultInjection.parse(setup.sim), wire=hub.connect(), clock=clock)
    wire = hub.connect()
    guard = SimulatedGuard(clock)
    programs = ProgramHost(profile, is_in_step=True)

    def build(emit: OnEvent) -> Motion:
        planner = Planner(profile, world)
        return Motion(profile, wire, clock, planner, guard, emit, lambda job: job(), programs=programs)

    link = InProcessLink(build, wire, clock, robot.step, guard, hub.connect(), profile.wiring.cmd_vel_topic)
    link.live(SETTLE_S)
    if setup.trace:
        hub.connect().subscribe(TRUTH_TOPIC, Odometry, _tracer(on_event))
        link.step()  # the trace begins before anything moves
    authoring = _authoring(setup, profile, world, understanding)
    session = Session(link, understanding, on_event, setup.options, authoring, model_setup_of(setup, profile))

    def close() -> None:
        session.close()
        programs.close()

    return Connection(session, profile, world, close)


# --- real time: the simulated robot, Motion and the guard are processes ---


def _connect_real_time(
    setup: Setup, profile: RobotProfile, world: World, understanding: Understanding, on_event: OnEvent
) -> Connection:
    from chatrobot.link.socket_link import SocketLink
    from chatrobot.wire.local import LocalWire

    processes = setup.processes or Processes.start(
        profile_argument(setup.robot, profile_dirs(setup.folder)),
        setup.world,
        setup.sim,
        setup.budget,
        open_loop=setup.open_loop,
    )
    processes.is_taken = True
    link = SocketLink(processes.motion)
    try:
        understanding.warm()
        link.wait_until_ready()
    except LinkError:
        processes.robot.terminate()
        raise
    setup.on_ready()
    lock = threading.Lock()

    def one_at_a_time(event: Event) -> None:
        with lock:
            on_event(event)

    trace = LocalWire(processes.wire_path) if setup.trace else None
    if trace is not None:
        trace.subscribe(TRUTH_TOPIC, Odometry, _tracer(one_at_a_time))
    authoring = _authoring(setup, profile, world, understanding)
    model_setup = model_setup_of(setup, profile)
    session = Session(link, understanding, one_at_a_time, setup.options, authoring, model_setup)

    def close() -> None:
        session.close()
        if trace is not None:
            trace.close()

    return Connection(session, profile, world, close)


# --- a robot on a wire: Motion and the guard are processes ---


def _connect_wire(
    setup: Setup, profile: RobotProfile, world: World, understanding: Understanding, on_event: OnEvent
) -> Connection:
    from chatrobot.link.socket_link import SocketLink

    address = wire_address(setup.on)
    for chosen, option in ((setup.fast, "--fast"), (setup.trace, "--trace"), (setup.sim, "--sim")):
        if chosen:
            raise UsageError("only the simulated robot of --on sim can do that", where=option)
    approve = setup.options.approve or (profile.approval == "plan" and not setup.yes)
    if address.startswith(("rosbridge:", "local:")):
        connect_wire(
            address, profile.wiring, "chatrobot"
        ).close()  # Motion would wait, and could not say for what
    profile_file = profile_argument(setup.robot, profile_dirs(setup.folder))
    motion = MotionProcess.start(address, profile_file, setup.world, setup.budget, open_loop=setup.open_loop)
    link = SocketLink(motion)
    link.wait_until_ready()
    setup.on_ready()
    authoring = _authoring(setup, profile, world, understanding)
    options = replace(setup.options, approve=approve)
    session = Session(link, understanding, on_event, options, authoring, model_setup_of(setup, profile))
    return Connection(session, profile, world, session.close)


def _tracer(on_event: OnEvent) -> Callable[[Odometry], None]:
    """Truth samples as `pose` events, timed from the first."""
    began_s: list[float] = []

    def on_truth(sample: Odometry) -> None:
        began_s.append(sample.stamp_s) if not began_s else None
        on_event(TruePose(0, sample.stamp_s - began_s[0], *sample[1:]))

    return on_truth
