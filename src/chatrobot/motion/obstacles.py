"""Obstacles that a person puts into a simulation, or takes away, while it runs: simulation and rehearsal know them.

What waits for a yes is void then. What runs is checked against what has come: where its way is not free any more, it
is broken off, and rehearsed anew from where the robot stands.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from chatrobot.core.events import Event, Notice
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.governor.lease import Priority, priority_of
from chatrobot.link.envelope import Envelope
from chatrobot.motion.goal_queue import Inbox
from chatrobot.motion.goal_server import GoalServer
from chatrobot.motion.governed_robot import GovernedRobot
from chatrobot.motion.plan_executor import PlanExecutor
from chatrobot.motion.planner import Planner
from chatrobot.motion.programs.goal import ProgramGoal
from chatrobot.motion.safety.stop import WAY_CHANGED, Stops
from chatrobot.plan.known_world import Contact, Floats
from chatrobot.plan.rehearsal import MARGIN_M
from chatrobot.plan.swept_path import first_contact
from chatrobot.sim.obstacle_control import CONTROL_TOPIC, read_request
from chatrobot.sim.shapes import Shape
from chatrobot.sim.world import Obstacle, World
from chatrobot.wire.messages import Text
from chatrobot.wire.wire import Wire

MOST = 50
NEAR_M = 5.0
"""So far beyond all that the world holds something may stand."""


@dataclass(eq=False)
class Obstacles:
    """Keeps what was put there. Belongs to the control thread."""

    _robot: GovernedRobot
    _planner: Planner
    _goals: GoalServer
    _executor: PlanExecutor
    _stops: Stops
    _inbox: Inbox
    _wire: Wire
    _emit: Callable[[Event], None]
    _added: dict[str, Obstacle] = field(default_factory=dict, init=False)

    def change(self, envelope: Envelope) -> None:
        """Do what an `obstacle` envelope says, or tell why not."""
        if priority_of(envelope.source) < Priority.PLAN:
            self._tell(envelope, Reason("obstacle_by_person"))
            return
        try:
            name, shape = read_request(envelope.payload)
        except (ValueError, TypeError, KeyError) as error:
            self._tell(envelope, Reason("obstacle_unclear", {"problem": str(error)}))
            return
        refusal = self._refusal(name, shape)
        if refusal is not None:
            self._tell(envelope, refusal)
            return
        if shape is None:
            del self._added[name]
        else:
            self._added[name] = Obstacle(name, shape)
        self._planner.add(tuple(self._added.values()))
        self._wire.publish(CONTROL_TOPIC, Text(json.dumps(envelope.payload)))
        self._emit(ObstacleChanged(envelope.turn, name, shape.outline() if shape is not None else ()))
        self._tell(
            envelope, Reason("obstacle_added" if shape is not None else "obstacle_removed", {"name": name})
        )
        self._goals.void_prepared(Reason("approval_world_changed"))
        if shape is not None:
            self._check_way(name, shape)

    def _refusal(self, name: str, shape: Shape | None) -> Reason | None:
        if shape is None:
            return None if name in self._added else self._unknown(name)
        if name not in self._added and len(self._added) >= MOST:
            return Reason("obstacles_too_many", {"limit": MOST})
        bounds, (x_m, y_m) = self._planner.world.bounds, shape.outline()[0]
        if bounds is not None and not bounds.holds(x_m, y_m, NEAR_M):  # a world of nothing has no end
            return Reason("obstacle_far", {"name": name, "most_m": NEAR_M})
        here = np.array([self._robot.pose])
        is_on_robot = _contact(name, shape, here, self._robot, margin_m=0.0) is not None
        return Reason("obstacle_on_robot", {"name": name}) if is_on_robot else None

    def _unknown(self, name: str) -> Reason:
        if not self._added:
            return Reason("no_obstacle_put")
        return Reason("obstacle_unknown", {"name": name, "names": ", ".join(self._added)})

    def _check_way(self, name: str, shape: Shape) -> None:
        """Look, off the control thread, whether what runs comes too near to it."""
        goal = self._executor.goal
        if goal is None or not goal.stream.paths:
            return
        poses = _from_here(np.concatenate(goal.stream.paths)[:, 1:], self._robot.pose)
        code = "program_way_changed" if isinstance(goal, ProgramGoal) else WAY_CHANGED
        why = Reason(code, {"name": name})

        def take(found: Contact | None) -> None:
            if found is not None and self._executor.goal is goal:
                self._emit(Notice(goal.turn, why))
                self._stops.halt(why)

        self._inbox.fetch(lambda: _contact(name, shape, poses, self._robot, MARGIN_M), take)

    def _tell(self, envelope: Envelope, reason: Reason) -> None:
        self._emit(Notice(envelope.turn, reason))


def _contact(name: str, shape: Shape, poses: Floats, robot: GovernedRobot, margin_m: float) -> Contact | None:
    alone = World(name, (Obstacle(name, shape),))
    return first_contact(poses, robot.profile.footprint, alone.clearance_m, margin_m)


def _from_here(poses: Floats, pose: Pose) -> Floats:
    """The rest of the way, from the first of its poses that is as near as any to where the robot is."""
    away_m = np.hypot(poses[:, 0] - pose.x_m, poses[:, 1] - pose.y_m)
    rest: Floats = poses[int(np.argmax(away_m <= away_m.min() + 0.02)) :]
    return rest
