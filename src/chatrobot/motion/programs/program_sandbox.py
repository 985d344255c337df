"""Where Motion has programs rehearsed and run: in the sandbox, or nowhere.

All methods but `attach` are called from Motion's background thread, where nothing that moves waits for them.
"""

from __future__ import annotations

from typing import Protocol

from chatrobot.core.reason import Reason
from chatrobot.motion.planner import Planned, Planner
from chatrobot.motion.programs.execution import LiveProgram
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.remembered_obstacles import RememberedObstacles
from chatrobot.wire.wire import Wire


class ProgramSandbox(Protocol):
    """What Motion needs of it."""

    def attach(self, wire: Wire) -> None:
        """Hear the robot's sensors, for programs that listen to them."""
        ...

    def rehearse(self, goal: ProgramGoal, planner: Planner, seen: RememberedObstacles | None) -> Planned:
        """Run it on virtual time, among what is known and what the lidar has seen, from where the goal starts."""
        ...

    def launch(self, goal: ProgramGoal) -> LiveProgram | Reason:
        """Start it; why it cannot be."""
        ...


class NoSandbox:
    """Nowhere: every program is refused."""

    def attach(self, wire: Wire) -> None:
        """There is nothing to hear for."""

    def rehearse(self, goal: ProgramGoal, planner: Planner, seen: RememberedObstacles | None) -> Planned:  # noqa: ARG002
        return Planned(goal.turn, None, Reason("no_programs_here"))

    def launch(self, goal: ProgramGoal) -> LiveProgram | Reason:  # noqa: ARG002
        return Reason("no_programs_here")
