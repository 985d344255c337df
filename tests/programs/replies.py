# ruff: noqa: E501
"""Replies as models and chat pages really give them: the words around the code, and how it is wrapped."""

from __future__ import annotations

import json

NODE = """\
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Mover(Node):
    def __init__(self):
        super().__init__('mover')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)

    def go(self):
        twist = Twist()
        twist.linear.x = 0.2
        self.publisher.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    node = Mover()
    node.go()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
"""

SETUP = """\
from setuptools import setup

setup(name='mover', entry_points={'console_scripts': ['mover = mover.mover:main']})
"""

LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([Node(package='mover', executable='mover')])
"""

_IMPORTS, _CLASS = NODE.split("\n\n\nclass", 1)
_CLASS, _MAIN = ("class" + _CLASS).split("\n\n\ndef main", 1)
_MAIN = "def main" + _MAIN


def _indented(code: str, margin: str) -> str:
    return "".join(f"{margin}{line}\n" if line else "\n" for line in code.splitlines())


# Each gives NODE, but for blank lines and quotes of another shape.
REPLIES: dict[str, str] = {
    "fence with its language": f"```python\n{NODE}```",
    "prose before and after": f"Sure! Here's a node that does it:\n\n```python\n{NODE}```\n\nRun it with `ros2 run`.",
    "language in capitals": f"```Python\n{NODE}```",
    "short name of the language": f"```py\n{NODE}```",
    "version in the language": f"```python3\n{NODE}```",
    "attribute list": f'``` {{.python .numberLines startFrom="1"}}\n{NODE}```',
    "title in the info string": f'```python title="mover.py"\n{NODE}```',
    "file name as the language": f"```mover.py\n{NODE}```",
    "no language": f"```\n{NODE}```",
    "text as the language": f"```text\n{NODE}```",
    "tildes": f"~~~python\n{NODE}~~~",
    "four ticks": f"````python\n{NODE}````",
    "indented in a list": f"1. Save this:\n\n{_indented('```python' + chr(10) + NODE + '```', '   ')}\n2. Run it.",
    "quoted": _indented(f"```python\n{NODE}```", "> ").replace("\n\n", "\n>\n"),
    "fence behind words": f"Here it is: ```python\n{NODE}```",
    "code on the fence's line": f"```python {NODE}```",
    "closing fence on the last line": f"```python\n{NODE.rstrip()}```",
    "never closed, cut off": f"Here is the program.\n```python\n{NODE}",
    "windows line ends": f"```python\n{NODE}```".replace("\n", "\r\n"),
    "byte order mark and no-break spaces": f"\ufeff```python\n{NODE.replace('    ', chr(0xA0) * 4)}```",
    "nothing but code": NODE,
    "prose, code, prose, and no fence": f"Here is the code you asked for.\n\n{NODE}\nThis node publishes once.\nGood luck!",
    "what a copy button leaves": f"python\nCopy code\n{NODE}",
    "shell commands, then the node": f"```bash\nsource /opt/ros/humble/setup.bash\n```\n\n```python\n{NODE}```",
    "the node, then how to run it": f"```python\n{NODE}```\n\n```bash\nros2 run mover mover\n```",
    "node, setup.py and launch file": f"```python\n{NODE}```\nsetup.py:\n```python\n{SETUP}```\n```python\n{LAUNCH}```",
    "setup.py first": f"```python\n{SETUP}```\nand\n```python\n{NODE}```",
    "a sketch, then the whole": f"The core is\n```python\ntwist.linear.x = 0.2\npub.publish(twist)\n```\nIn full:\n```python\n{NODE}```",
    "a draft, then a corrected one": f"```python\n{NODE.replace('0.2', '2')}```\nOops, ints. Corrected:\n```python\n{NODE}```",
    "in three pieces": f"Imports:\n```python\n{_IMPORTS}\n```\nThe class:\n```python\n{_CLASS}\n```\nMain:\n```python\n{_MAIN}```",
    "thinking aloud first": f"<think>\nMaybe ```python\nprint(1)\n``` no.\n</think>\n```python\n{NODE}```",
    "HTML": f"<p>Here:</p><pre><code class=\"language-python\">{NODE.replace('<', '&lt;').replace(chr(39), '&#39;')}</code></pre>",
    "JSON": json.dumps({"description": "Moves a little.", "code": NODE}),
    "JSON in a fence": "```json\n" + json.dumps({"code": NODE}) + "\n```",
    "JSON with a fence inside": json.dumps({"code": f"```python\n{NODE}```"}),
    "curly quotes": f"```python\n{NODE.replace(chr(39), '’')}```",
    "line numbers": "```python\n" + "".join(f"{n:3}: {line}\n" for n, line in enumerate(NODE.splitlines(), 1)) + "```",
    "Chinese around it": f"好的，下面是代码：\n\n```python\n{NODE}```\n\n运行后小车会前进。",
}  # fmt: skip

NO_PROGRAM: dict[str, str] = {
    "nothing": "",
    "prose": "I cannot write programs. From what you tell me, you import goods from China.",
    "C++": "```cpp\n#include <rclcpp/rclcpp.hpp>\nint main() {}\n```",
    "shell alone": "```bash\nros2 topic pub /cmd_vel geometry_msgs/msg/Twist '{}'\n```",
    "a line of the tutorial's form": "linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0",
}
