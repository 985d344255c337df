"""Who goes before whom. An emergency stop is above all of these: it is a latch, not a source of motion."""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum


class Priority(IntEnum):
    """Of a source of motion; the higher one drives."""

    FOREIGN = 0
    """Text from a topic that carries no envelope."""
    AGENT = 1
    """A language agent, over MCP or the like."""
    PLAN = 2
    """A person's instruction, or a program that a person started."""
    JOYSTICK = 3
    """A person with a joystick, looking at the robot."""


PRIORITIES: Mapping[str, Priority] = {
    "joystick": Priority.JOYSTICK,
    "console": Priority.PLAN,
    "program": Priority.PLAN,
    "web": Priority.PLAN,
    "base": Priority.PLAN,
    "agent": Priority.AGENT,
    "mcp": Priority.AGENT,
    "chatgpt_node": Priority.FOREIGN,
}
RELEASERS = frozenset({"console"})
"""Who may release an emergency stop unless the composition root names others: a person at the local console."""


def priority_of(source: str) -> Priority:
    """Of the source by that name; who is not listed comes last."""
    return PRIORITIES.get(source, Priority.FOREIGN)
