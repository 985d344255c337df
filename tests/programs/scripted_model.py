"""A model that says what a test wrote for it, and remembers what it was asked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from chatrobot.models.seam import CallLimits, Message, Usage


class ScriptedReply:
    """A reply in two pieces."""

    def __init__(self, text: str) -> None:
        self._text = text
        self.usage: Usage | None = None

    def __iter__(self) -> Iterator[str]:
        half = len(self._text) // 2
        yield from (self._text[:half], self._text[half:])

    def cancel(self) -> None:
        self._text = ""


class ScriptedModel:
    """Gives `replies` one after the other; one more call than that fails the test."""

    name = "scripted:test"

    def __init__(self, *replies: str) -> None:
        self._replies = list(replies)
        self.asked: list[Sequence[Message]] = []

    def ask(self, messages: Sequence[Message], limits: CallLimits) -> ScriptedReply:  # noqa: ARG002
        self.asked.append(tuple(messages))
        return ScriptedReply(self._replies.pop(0))

    def forget(self) -> None:
        """It holds no conversation."""


def fenced(code: str) -> str:
    return f"Here you are.\n\n```python\n{code}```\n"


def program(body: str, *, imports: str = "") -> str:
    """A program in the style of models: `body` is the indented rest of its `run`."""
    lines = "\n".join(f"        {line}" for line in body.splitlines())
    return f"""\
import time
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
{imports}

class Mover(Node):
    def __init__(self):
        super().__init__('mover')
        self.publisher_ = self.create_publisher(Twist, '/cmd_vel', 10)

    def drive(self, x, z, seconds):
        msg = Twist()
        msg.linear.x = x
        msg.angular.z = z
        self.publisher_.publish(msg)
        time.sleep(seconds)

    def run(self):
{lines}
        self.drive(0.0, 0.0, 1.0)


def main(args=None):
    rclpy.init(args=args)
    node = Mover()
    node.run()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
"""
