"""`python -m chatrobot.sim`: the simulated robot in real time, in a process of its own; those of a class in one."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import ChatRobotError, InputError, UsageError
from chatrobot.core.process import wake_promptly
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.fault_injection import FaultInjection
from chatrobot.sim.load import load_world
from chatrobot.sim.network_wire import MarshalledWire, TransformPublisher
from chatrobot.sim.obstacle_control import SimControl
from chatrobot.sim.robot import TICK_S, SimRobot
from chatrobot.sim.server import SimServer, Simulation
from chatrobot.sim.world import World, check_start
from chatrobot.wire.local import LocalHub
from chatrobot.wire.messages import TwistMessage
from chatrobot.wire.wire import Wire

NODE = "chatrobot_sim"
TURNS = 5
"""Many robots measure in so many turns: not all at once, and not each by itself, for each turn is a waking."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit code 0 after an orderly end, 2 where the options are wrong, 1 where it could not start."""
    options = _parser().parse_args(arguments)
    try:
        _serve(options)
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    except (ChatRobotError, OSError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m chatrobot.sim", description=__doc__)
    parser.add_argument("--profile", required=True, help="a robot profile, by name or path")
    parser.add_argument("--world", default="home", help="empty, home or a world file")
    parser.add_argument(
        "--sim", default="", metavar="KEY=VALUE,…", help="injected faults: slip=0.03,noise=on,…"
    )
    parser.add_argument(
        "--on",
        default="local",
        help="local (the default), dds or ros, dds://DOMAIN/NAMESPACE or rosbridge:ws://HOST:9090",
    )
    parser.add_argument("--ros-args", nargs=argparse.REMAINDER, default=[], help="with --on ros; the last")
    parser.add_argument(
        "--socket",
        action="append",
        default=[],
        help="where its wire is served; with --on local alone; once for each robot, none of which meets another",
    )
    parser.add_argument("--ready-fd", type=int, default=1, help="where it writes `ready` once it listens")
    return parser


def _serve(options: argparse.Namespace) -> None:
    from chatrobot.robots.load import load_profile

    profile = load_profile(options.profile)
    faults = FaultInjection.parse(options.sim)
    world = load_world(options.world)
    check_start(world, profile, f"--world {options.world}")
    wake_promptly()
    wires = _open_wires(options, profile)
    servers = [
        _server(profile, world, faults, wire, place % TURNS * TICK_S / TURNS)
        for place, wire in enumerate(wires)
    ]
    os.write(options.ready_fd, b"ready\n")
    if options.ready_fd > 2:
        os.close(options.ready_fd)
    Simulation(servers, RealClock()).run()


def _server(
    profile: RobotProfile,
    world: World,
    faults: FaultInjection,
    wire: LocalHub | MarshalledWire,
    later_s: float,
) -> SimServer:
    clock = RealClock()
    server: SimServer | None = None

    def bring_to_its_time(_: TwistMessage) -> None:
        if server is not None:
            server.catch_up(wire.age_s)

    # Before the robot listens itself: a command acts from when it came, on no time before and on all after that.
    wire.subscribe(profile.wiring.cmd_vel_topic, TwistMessage, bring_to_its_time)
    robot = SimRobot(profile, world, faults, wire=wire, clock=clock)
    robot.skip(later_s)
    SimControl(robot, wire)
    server = SimServer(robot, wire, clock)
    return server


def _open_wires(options: argparse.Namespace, profile: RobotProfile) -> Sequence[LocalHub | MarshalledWire]:
    if options.on == "local":
        if not options.socket:
            raise UsageError("a simulated robot on a local wire needs --socket", where="--socket")
        try:
            return [LocalHub(path) for path in options.socket]
        except OSError as error:
            problem = f"no wire can be served there ({error.strerror or error})"
            allowed = "--socket PATH: a new file in a folder that is there"
            raise UsageError(problem, where=", ".join(options.socket), allowed=allowed) from error
    address = f"{options.on}:" if options.on in ("dds", "ros") else options.on
    if not address.startswith(("dds:", "ros:", "rosbridge:")):
        raise UsageError(
            f"{options.on!r} is not a robot address",
            where="--on",
            allowed="local, dds, ros or rosbridge:ws://HOST:9090",
        )
    from chatrobot.wire.connect import connect_wire
    from chatrobot.wire.ros import connect_ros

    if address.startswith("ros:"):
        on_ros = connect_ros(address, profile.wiring, NODE, options.ros_args)
        way = f"{on_ros.resolve(profile.wiring.cmd_vel_topic)} → {on_ros.resolve(profile.wiring.odom_topic)}"
        on_ros.node.log("info", f"the simulated {profile.name} drives: {way}")
        wire: Wire = on_ros
    else:
        wire = connect_wire(address, profile.wiring, NODE)
    return [MarshalledWire(wire, TransformPublisher(wire, profile).after)]


if __name__ == "__main__":
    sys.exit(main())
