"""`python -m chatrobot.sim`: the simulated robot in real time, in a process of its own."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence

from chatrobot.core.clock import RealClock
from chatrobot.core.errors import ChatRobotError, InputError
from chatrobot.sim.control import SimControl
from chatrobot.sim.lies import SimLies
from chatrobot.sim.load import load_world
from chatrobot.sim.robot import SimRobot
from chatrobot.sim.server import SimServer
from chatrobot.wire.local import LocalHub
from chatrobot.wire.messages import TwistMessage


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
    parser.add_argument("--sim", default="", metavar="KEY=VALUE,…", help="how it lies: slip=0.03,noise=on,…")
    parser.add_argument("--socket", required=True, help="where its wire is served")
    parser.add_argument("--ready-fd", type=int, default=1, help="where it writes `ready` once it listens")
    return parser


def _serve(options: argparse.Namespace) -> None:
    from chatrobot.robots.load import load_profile

    profile = load_profile(options.profile)
    lies = SimLies.parse(options.sim)
    world = load_world(options.world)
    clock = RealClock()
    hub = LocalHub(options.socket)
    server: SimServer | None = None

    def bring_to_the_present(_: TwistMessage) -> None:
        if server is not None:
            server.catch_up()

    # Before the robot listens itself: a command must not act on time that had already passed when it came.
    hub.subscribe(profile.wiring.cmd_vel_topic, TwistMessage, bring_to_the_present)
    robot = SimRobot(profile, world, lies, wire=hub, clock=clock)
    SimControl(robot, hub)
    server = SimServer(robot, hub, clock)
    os.write(options.ready_fd, b"ready\n")
    if options.ready_fd > 2:
        os.close(options.ready_fd)
    server.run()


if __name__ == "__main__":
    sys.exit(main())
