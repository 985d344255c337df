"""The sandbox as Motion uses it: one warm server, programs rehearsed in it and started from it."""

from __future__ import annotations

from chatrobot.core.errors import SandboxError
from chatrobot.core.reason import Reason
from chatrobot.motion.planner import Planned, Planner
from chatrobot.motion.programs.clocks import LiveProgram, RealTimeProgram, SensorMailbox, SteppedProgram
from chatrobot.motion.programs.goal import PlannedProgram, ProgramGoal
from chatrobot.motion.programs.rehearsal import HORIZON_S, ProgramRehearsal, rehearse_program
from chatrobot.motion.remembered_obstacles import RememberedObstacles
from chatrobot.programs.events import Died
from chatrobot.programs.pipe import LATEST_S, ProgramSettings, robot_topics
from chatrobot.programs.sandboxed import SandboxedProgram, warm_server
from chatrobot.robots.profile import MAX_TIME_S, RobotProfile
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.wire.wire import Wire

QUICK_S = 0.2
"""What was rehearsed up to the horizon in less is rehearsed on: it may end by itself, only later."""


class ProgramHost:
    """The sandbox of programs, for Motion. Its server starts with the first program, and anew where it has died.

    Args:
        is_in_step: programs run on the virtual clock of a simulation, not in real time.
        server: the warm server, where robots have one in common.
    """

    def __init__(self, profile: RobotProfile, *, is_in_step: bool, server: WarmServer | None = None) -> None:
        self._profile = profile
        self._is_in_step = is_in_step
        self._server = server or warm_server()
        self._sensors = SensorMailbox()

    def attach(self, wire: Wire) -> None:
        """Hear the robot's sensors, for programs that listen to them."""
        self._sensors.attach(wire, self._profile.wiring)

    def rehearse(self, goal: ProgramGoal, planner: Planner, seen: RememberedObstacles | None) -> Planned:
        """Run it on virtual time, among what is known and what the lidar has seen, from where the goal starts."""
        try:
            self.warm()
            rehearsal = self._rehearse(goal, planner, seen, HORIZON_S)
            if rehearsal.ended == "horizon" and rehearsal.wall_s < QUICK_S:
                longer = self._rehearse(goal, planner, seen, MAX_TIME_S)
                rehearsal = rehearsal if longer.is_endless or isinstance(longer.end, Died) else longer
        except SandboxError as error:
            return Planned(goal.turn, None, error.reason)
        return PlannedProgram(goal.turn, None, program=rehearsal, name=goal.name, strict=goal.strict)

    def _rehearse(
        self, goal: ProgramGoal, planner: Planner, seen: RememberedObstacles | None, horizon_s: float
    ) -> ProgramRehearsal:
        return rehearse_program(
            self._server,
            goal.code,
            self._profile,
            planner.world,
            goal.start,
            name=_file_name(goal.name),
            horizon_s=horizon_s,
            remaps=goal.remap,
            args=goal.args,
            seen=seen,
        )

    def launch(self, goal: ProgramGoal) -> LiveProgram | Reason:
        """Start it; return why where it cannot be."""
        settings = ProgramSettings(
            goal.code,
            name=_file_name(goal.name),
            mode="virtual" if self._is_in_step else "live",
            topics=robot_topics(self._profile.wiring),
            odom_type=self._profile.wiring.odom_type,
            remaps=goal.remap,
            args=goal.args,
            horizon_s=LATEST_S,
        )
        program = SandboxedProgram(self._server, settings)
        self._sensors.forget()
        try:
            self.warm()
            program.start()
        except SandboxError as error:
            return error.reason
        return (SteppedProgram if self._is_in_step else RealTimeProgram)(program, self._sensors)

    def close(self) -> None:
        """End the server and whatever still runs in it."""
        self._server.close()

    def warm(self) -> None:
        """Start the server, where it does not run. Raises SandboxError."""
        self._server.start_if_needed()


def _file_name(name: str) -> str:
    """Return what tracebacks call the program."""
    return name.replace(" ", "_") or "program"
