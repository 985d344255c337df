"""Makes the MCP server of a robot: tools with their hints, resources, and a prompt that teaches the plan language."""

from __future__ import annotations

import contextlib
from typing import Any

from mcp.server.mcpserver import MCPServer
from mcp_types import ToolAnnotations

from chatrobot import __version__
from chatrobot.core.event import strict_json
from chatrobot.dialogue.llm.prompt import robot_line, step_lines
from chatrobot.mcp_server.robot import AgentRobot, RobotGoneError
from chatrobot.mcp_server.surroundings import map_of, motion_told, robot_told
from chatrobot.mcp_server.told import pose_told
from chatrobot.mcp_server.tools import Tools, strict_tool
from chatrobot.robots.profile import RobotProfile

_INSTRUCTIONS = """\
You drive a wheeled robot ({title}, {kind}). {robot}
Say what to do with instruct, in plain words or as a plan; look with observe; rehearse first where you are not sure.
Each call returns once the motion has ended, with what was measured: never tell a person that something was done that a
result does not show. A person's word has priority: if a person stopped the robot, do not move it again unless they ask.
"""
_PLAN_LANGUAGE = """\
The plan language, for instruct(plan=…) and rehearse(plan=…): one step a line.
{steps}
Units: m, s, deg, rad, m/s, deg/s. x is ahead of where the robot started, y to the left of it; left turns are positive;
directions are the robot's own. Leave out speeds unless they matter.
Example, a square of half a metre:
repeat 4
  drive 0.5 m
  turn left 90 deg
end
{robot}{task}"""

_DESCRIPTIONS = {
    "instruct": """\
Move the robot: say what to do in plain English, Chinese or German (`text`), or give exact steps (`plan`, one a line:
`drive 1 m`, `turn left 90 deg`, `go to 2 0.5`; prompt plan_language has all). Rehearsed first, kept within limits;
returns once it has ended, with what was measured. Questions ("where are you?"), "undo", "continue", and "yes" to a
question work, too. Cancel the call to stop. Send ways of over a minute in parts: clients give up.""",
    "rehearse": """\
Check what instruct would do, without moving: the plan, its length, time and end, and what is wrong with it.""",
    "observe": """\
See now: pose (metres ahead and left of the start, degrees left), motion, free way around by lidar, things near by name,
the last events, a camera picture if there is one.""",
    "stop": "Stop the robot at once, and drop what waits. Always allowed.",
    "places": 'List the named places that instruct can go to. To add one: instruct("remember this place as dock").',
    "programs": """\
Kept ROS 2 (rclpy) programs, run in a sandbox under the same limits. write: `text` is a whole Python program, or words
for a motion it is to do; it is rehearsed and kept, not run.""",
}
"""What an agent's model reads, and pays for, with every request: 1,000 tokens at most, with their schemas."""

_READS = ToolAnnotations(read_only_hint=True, destructive_hint=False, open_world_hint=False)
_MOVES = ToolAnnotations(
    read_only_hint=False, destructive_hint=True, idempotent_hint=False, open_world_hint=True
)
_STOPS = ToolAnnotations(
    read_only_hint=False, destructive_hint=False, idempotent_hint=True, open_world_hint=True
)


def build_server(
    robot: AgentRobot, profile: RobotProfile, *, is_simulated: bool, tools: Tools | None = None
) -> MCPServer[Any]:
    """Make the server, with tools of its own where none are given. `AgentRobot.start` meets the robot."""
    kind = "simulated" if is_simulated else "real: mind people and things"
    tools = tools or Tools(robot)
    server: MCPServer[Any] = MCPServer(
        "chatrobot",
        title="ChatRobot",
        version=__version__,
        instructions=_INSTRUCTIONS.format(title=profile.title, kind=kind, robot=robot_line(profile)),
        tools=[
            strict_tool(function, _DESCRIPTIONS[function.__name__].replace("\n", " "), hints)
            for function, hints in (
                (tools.instruct, _MOVES),
                (tools.rehearse, _READS),
                (tools.observe, _READS),
                (tools.stop, _STOPS),
                (tools.places, _READS),
                (tools.programs, _MOVES),
            )
        ],
        log_level="WARNING",
    )
    _add_resources(server, robot)
    _add_prompt(server, profile)
    return server


def _add_resources(server: MCPServer[Any], robot: AgentRobot) -> None:
    record = robot.record

    @server.resource(
        "chatrobot://state",
        name="state",
        description="Which robot it is, where, how it moves, and the last events.",
        mime_type="application/json",
    )
    async def state() -> str:
        with contextlib.suppress(RobotGoneError):  # then it tells that, too
            await robot.ready()
        return strict_json(_state_of(robot))

    @server.resource(
        "chatrobot://map",
        name="map",
        description="The known world: obstacles by name, places, the allowed area, the robot.",
        mime_type="application/json",
    )
    async def world_map() -> str:
        connection = await robot.ready()
        return strict_json(
            map_of(connection, record.telemetry.pose if record.telemetry is not None else None)
        )

    @server.resource(
        "chatrobot://last",
        name="last",
        description="The last result, and the measured way of the last motion, five poses a second.",
        mime_type="application/json",
    )
    def last() -> str:
        result = record.last
        told = result.to_json() if result is not None else {}
        if result is not None and result.pose is not None:
            told["ended_at"] = pose_told(result.pose)
        return strict_json({"result": told or None, "way": record.way(), "edited_by_person": record.edit})


def _state_of(robot: AgentRobot) -> dict[str, Any]:
    connection, record = robot.connection, robot.record
    return {
        "robot": robot_told(connection, is_shared=robot.is_shared) if connection else None,
        **motion_told(record.telemetry, record.heard_at_s),
        "connected": connection is not None,
        "paused": connection is not None and connection.session.is_paused,
        "happened": record.happened(),
    }


def _add_prompt(server: MCPServer[Any], profile: RobotProfile) -> None:
    @server.prompt(
        name="plan_language", description="The plan language in a few lines, and a task to do with it."
    )
    def plan_language(task: str = "") -> str:
        return _PLAN_LANGUAGE.format(
            steps=step_lines(profile), robot=robot_line(profile), task=f"\n\nThe task: {task}" if task else ""
        )
