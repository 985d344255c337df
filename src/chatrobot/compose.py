"""The one composition root: which robot, which world, which clock, put together into a session.

Console, nodes and the Python API all begin here; nothing below knows how it is put together.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from chatrobot.core.clock import Clock, RealClock, VirtualClock
from chatrobot.core.errors import LinkError, UsageError
from chatrobot.core.events import Event, TruePose
from chatrobot.dialogue.llm.camera import Camera, PassedCamera, wire_camera
from chatrobot.dialogue.llm.setup import ModelSetup, warm_up
from chatrobot.dialogue.llm.terms import ModelOptions
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.programs.authoring import Authoring
from chatrobot.dialogue.session import Session
from chatrobot.dialogue.understanding import Understanding
from chatrobot.governor.lease import Priority, priority_of
from chatrobot.link.in_process import InProcessLink
from chatrobot.link.motion_link import MotionLink, SecondLinks
from chatrobot.link.processes import SIMULATED, MotionProcess, Processes
from chatrobot.models.seam import Model
from chatrobot.programs.library import Library
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile, profile_argument, profile_dirs
from chatrobot.robots.open_loop import as_chosen, drives_on_alone, slowed
from chatrobot.robots.profile import NOT_CHOSEN, MotionBudget, RobotProfile
from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import TRUTH_TOPIC, SimRobot
from chatrobot.sim.world import World, check_known, check_start, frame_of
from chatrobot.wire.connect import connect_wire, is_on_this_machine, wire_address
from chatrobot.wire.messages import Odometry
from chatrobot.wire.wire import Wire

OnEvent = Callable[[Event], None]
SETTLE_S = 0.5
"""A robot that has just been switched on stands still this long: its gyro's bias is measured meanwhile."""


@dataclass(frozen=True)
class Setup:
    """What a person chose on the command line or in `connect`.

    Attributes:
        on: auto, sim, or a robot's wire (`wire_address`).
        world: "" is what fits: the furnished home for the simulated robot, nothing known for any other.
        sim: the faults of the simulated robot (`slip=0.03,…`).
        yes: plans of a real robot need no approval.
        programs: who asks for a program gets one written, rehearsed and run; else its motion is driven as a plan.
        budget: the motion budget, as far as it is not the profile's.
        open_loop: drive a robot that has no odometry (`chatrobot.robots.open_loop`).
        folder: where places, programs and history live; None keeps nothing.
        model: the language model to ask, None for none; `model_options`: how it is used.
        camera: takes pictures for it, as JPEG or PNG, in place of the robot's own camera.
        source: in whose name it speaks to Motion, which decides its priority and what it may (`governor/lease.py`).
        processes: those of a simulated robot in real time that have been started ahead.
        age_s: how long ago the page was heard from which the orders come, 0 where it is there or they come from
            elsewhere. While something moves, Motion slows (0.13 s) and stops (0.18 s) the robot by it, as by beats
            that are late. Called many times a second, from a thread of the link's.
        on_ready: called once the robot is ready.
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
    source: str = "console"
    processes: Processes | None = None
    age_s: Callable[[], float] | None = None
    on_ready: Callable[[], None] = lambda: None

    @property
    def profile(self) -> RobotProfile:
        """The robot with what a person chose for it.

        Raises:
            InputError: there is no such profile, or it cannot be driven as chosen.
        """
        loaded = load_profile(self.robot, profile_dirs(self.folder))
        return as_chosen(loaded, self.budget, open_loop=self.open_loop)


@dataclass
class Connection:
    """A session and what it stands on. Close it: a robot in motion finishes what it was told, orderly."""

    session: Session
    profile: RobotProfile
    close: Callable[[], None]
    prepared: Prepared
    link: SecondLinks
    camera: Camera | None = None  # one beside that of a model, where there is one

    @property
    def world(self) -> World:
        """Return what is known of the surroundings just now."""
        return self.session.understanding.ways.world

    def second_session(self, source: str, on_event: OnEvent, options: Options | None = None) -> Connection:
        """Return a session of an agent on the same robot, beside this one, which is a person's.

        It hears of its own turns, notices and telemetry; this one hears of its turns, too, under numbers of their own
        (`ordered` first), and `approve` answers what waits for a yes. It approves and releases nothing. What a person
        chose to approve is asked about whatever `options` say. One at a time; close it before this one.

        Raises:
            UsageError: that source is a person's.
            LinkError: there was one already, or Motion is gone.
        """
        if priority_of(source) >= Priority.PLAN:
            raise UsageError(f'a second session speaks for an agent, which "{source}" is not', where="source")
        chosen = self.prepared.setup.options
        options = options or chosen
        asks, asks_models = options.approve or chosen.approve, options.approve_models or chosen.approve_models
        options = replace(options, approve=asks, approve_models=asks_models)
        prepared = Prepared(replace(self.prepared.setup, options=options, age_s=None), self.profile)
        session = prepared.session(self.link.second(source), on_event)
        self.close = _in_turn(session.close, self.close)
        return replace(self, session=session, close=session.close, prepared=prepared)


class Prepared:
    """What is known before a robot is met: all that a session needs but the link; `listen` opens another end of the
    robot's wire, and gives the clock that its messages come by.

    Raises:
        InputError: the world is wrong, or does not fit the robot.
    """

    def __init__(self, setup: Setup, profile: RobotProfile) -> None:
        self.setup, self.profile = setup, profile
        self.world = load_world(setup.world)
        self.listen: Callable[[], tuple[Wire, Clock]]
        check_known(self.world, profile)
        frame = frame_of(self.world) if setup.on in SIMULATED else ""
        self.understanding = Understanding(profile, self.world, setup.folder, frame)

    def session(self, link: MotionLink, on_event: OnEvent) -> Session:
        """Build the session that talks over `link`."""
        setup = self.setup
        session = Session(
            link, self.understanding, on_event, setup.options, self._authoring(), self._model_setup()
        )
        if (age_s := setup.age_s) is not None:
            link.age_s = lambda: age_s() if session.is_moving and not session.is_plan_paused else 0.0
        return session

    def _authoring(self) -> Authoring | None:
        """Make what writes programs and keeps them; None where requests for them are driven as plans."""
        setup = self.setup
        if not setup.programs:
            return None
        from chatrobot.plan.route import GridRoutePlanner

        return Authoring(
            self.profile,
            Library(setup.folder),
            self.understanding.interpret,
            model=setup.model,
            prefers_model=setup.options.interpreter == "model",
            routes=lambda: None if self.world.is_empty else GridRoutePlanner(self.world, self.profile),
        )

    def _model_setup(self) -> ModelSetup | None:
        """Return the model and how it drives this robot.

        Its steps run as they come where the profile allows that; on a base that steers like a car a plan comes whole,
        because corners can be rounded only where both legs are known.
        """
        setup, profile = self.setup, self.profile
        if setup.model is None:
            return None
        streams = (
            setup.model_options.streams and profile.approval == "stream" and profile.can_turn_on_the_spot
        )
        return ModelSetup(
            setup.model, replace(setup.model_options, streams=streams), profile, _camera(setup, profile)
        )


def connect(setup: Setup, on_event: OnEvent) -> Connection:
    """Start everything and wait until the robot has been heard.

    Raises:
        InputError: a profile, world or option is wrong; the message says where and what is allowed.
        WireError: nobody answers where the robot should be.
        LinkError: Motion or the simulated robot does not start.
    """
    is_simulated = setup.on in SIMULATED
    profile = setup.profile
    if is_simulated:
        profile = replace(profile, approval="stream")
    elif drives_on_alone(profile) and not is_on_this_machine(wire_address(setup.on)):
        profile = slowed(profile)  # as Motion does: what is said of speeds must be true
    setup = replace(setup, world=setup.world or default_world(setup.on, open_loop=setup.open_loop))
    prepared = Prepared(setup, profile)
    FaultInjection.parse(setup.sim)
    if is_simulated:
        check_start(prepared.world, profile, f"--world {setup.world}")
    if not setup.fast and setup.options.interpreter != "offline":
        warm_up(setup.model)
    how = _connect_wire if not is_simulated else _connect_simulated if setup.fast else _connect_real_time
    return how(prepared, on_event)


def default_world(on: str, *, open_loop: bool = False) -> str:
    """Return the world where nobody chose one: of a robot that is not ours, or lost in it, nothing is known."""
    return "home" if on in SIMULATED and not open_loop else "empty"


def _camera(setup: Setup, profile: RobotProfile) -> Camera | None:
    """Return the camera that was passed, else the robot's; the simulated robot has none."""
    if setup.camera is not None:
        return PassedCamera(setup.camera)
    return None if setup.on in SIMULATED else wire_camera(wire_address(setup.on), profile.wiring)


# --- simulated time: one process, one thread ---


def _connect_simulated(prepared: Prepared, on_event: OnEvent) -> Connection:
    from chatrobot.motion.motion import Motion
    from chatrobot.motion.planner import Planner
    from chatrobot.motion.programs.host import ProgramHost
    from chatrobot.motion.safety.watchdog import SimulatedGuard
    from chatrobot.sim.obstacle_control import SimControl
    from chatrobot.wire.memory import MemoryHub

    setup, profile, world = prepared.setup, prepared.profile, prepared.world
    clock, hub = VirtualClock(), MemoryHub()
    robot = SimRobot(profile, world, FaultInjection.parse(setup.sim), wire=hub.connect(), clock=clock)
    SimControl(robot, hub.connect())
    wire, guard = hub.connect(), SimulatedGuard(clock)
    programs = ProgramHost(profile, is_in_step=True)

    def build(emit: OnEvent) -> Motion:
        planner = Planner(profile, world)
        return Motion(profile, wire, clock, planner, guard, emit, lambda job: job(), programs)

    link = InProcessLink(build, wire, clock, robot.step, guard, hub.connect(), profile.wiring.cmd_vel_topic)
    link.live(SETTLE_S)
    if setup.trace:
        hub.connect().subscribe(TRUTH_TOPIC, Odometry, _tracer(on_event))
        link.step()  # the trace begins before anything moves
    prepared.listen = lambda: (hub.connect(), clock)
    session = prepared.session(link, on_event)
    return Connection(session, profile, _in_turn(session.close, programs.close), prepared, link)


# --- real time: the simulated robot, Motion and the guard are processes ---


def _connect_real_time(prepared: Prepared, on_event: OnEvent) -> Connection:
    from chatrobot.link.socket_link import SocketLink
    from chatrobot.wire.local import LocalWire

    setup = prepared.setup
    profile_file = profile_argument(setup.robot, profile_dirs(setup.folder))
    processes = setup.processes or Processes.start(
        profile_file, setup.world, setup.sim, setup.budget, open_loop=setup.open_loop
    )
    processes.is_taken = True
    link = SocketLink(processes.motion, setup.source)
    try:
        prepared.understanding.warm()
        link.wait_until_ready()
    except LinkError:
        processes.robot.terminate()
        raise
    setup.on_ready()
    lock = threading.Lock()

    def one_at_a_time(event: Event) -> None:
        with lock:
            on_event(event)

    prepared.listen = lambda: (LocalWire(processes.wire_path), RealClock())
    session = prepared.session(link, one_at_a_time)
    close = session.close
    if setup.trace:
        trace, _ = prepared.listen()
        trace.subscribe(TRUTH_TOPIC, Odometry, _tracer(one_at_a_time))
        close = _in_turn(session.close, trace.close)
    camera = _camera(setup, prepared.profile)
    return Connection(session, prepared.profile, close, prepared, link, camera)


# --- a robot on a wire: Motion and the guard are processes ---


def _connect_wire(prepared: Prepared, on_event: OnEvent) -> Connection:
    from chatrobot.link.socket_link import SocketLink

    setup, profile = prepared.setup, prepared.profile
    address = wire_address(setup.on)
    for chosen, option in ((setup.fast, "--fast"), (setup.trace, "--trace"), (setup.sim, "--sim")):
        if chosen:
            raise UsageError("only the simulated robot of --on sim can do that", where=option)
    approve = setup.options.approve or (profile.approval == "plan" and not setup.yes)
    prepared.setup = replace(setup, options=replace(setup.options, approve=approve))
    profile_file = profile_argument(setup.robot, profile_dirs(setup.folder))
    with contextlib.ExitStack() as held:
        if address.startswith(("rosbridge:", "local:")):
            # Motion would wait, and could not say for what. A simulated robot leaves when the last of us has left.
            held.callback(connect_wire(address, profile.wiring, "chatrobot").close)
        (motion,) = MotionProcess.start(
            [address], profile_file, setup.world, setup.budget, open_loop=setup.open_loop
        )
        link = SocketLink(motion, setup.source)
        link.wait_until_ready()
    setup.on_ready()
    prepared.listen = lambda: (connect_wire(address, profile.wiring, "chatrobot_recorder"), RealClock())
    session, camera = prepared.session(link, on_event), _camera(setup, profile)
    return Connection(session, profile, session.close, prepared, link, camera)


def _in_turn(*closes: Callable[[], None]) -> Callable[[], None]:
    def close_all() -> None:
        for close in closes:
            close()

    return close_all


def _tracer(on_event: OnEvent) -> Callable[[Odometry], None]:
    """Truth samples as `pose` events, timed from the first."""
    began_s: list[float] = []

    def on_truth(sample: Odometry) -> None:
        began_s.append(sample.stamp_s) if not began_s else None
        on_event(TruePose(0, sample.stamp_s - began_s[0], *sample[1:]))

    return on_truth
