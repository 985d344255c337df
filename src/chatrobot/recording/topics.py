"""What a recording holds: its topics, by the names that every reader finds them under, and its metadata.

The names are those of ROS, whatever the robot itself calls its topics, so that one layout shows every robot.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import LaserScan, Message, Odometry, Text, TwistMessage
from chatrobot.wire.ros_messages import RosForm, ros_form

PROFILE, SCHEMA_ENCODING, MESSAGE_ENCODING = "ros2", "ros2msg", "cdr"
"""What makes an MCAP file a bag of ROS 2."""
METADATA = "chatrobot"
"""The metadata record that says whose recording it is; `about.About` has its keys."""


class Topic(NamedTuple):
    """One topic of a recording, and the planar message that is written to it as a ROS message."""

    name: str
    kind: type[Message]

    @property
    def form(self) -> RosForm:
        """How its messages become ROS messages and are read again; `type_name` is `package/msg/Name`."""
        form: RosForm = ros_form("", self.kind, _PLAIN)
        return form


_PLAIN: Any = Wiring()

CMD_VEL = Topic("/cmd_vel", TwistMessage)
"""Every velocity that the robot was told, by whomever."""
STAMPED_VELOCITY: RosForm = ros_form(
    "cmd_vel", TwistMessage, Wiring(cmd_vel_topic="cmd_vel", cmd_vel_type="TwistStamped")
)
"""The other type that bags of others have there; we write the plain one."""
ODOM = Topic("/odom", Odometry)
SCAN = Topic("/scan", LaserScan)
GROUND_TRUTH = Topic("/ground_truth", Odometry)
"""Where the simulated robot truly is: of a simulation alone."""
USER_INPUT = Topic("/user_input", Text)
"""What a person said, word for word."""
CHATGPT_NODE = Topic("/chatgpt_node", Text)
"""The plan that was understood, or the text that a model's node sent."""
EVENTS = Topic("/chatrobot/events", Text)
"""Each event as its JSON (docs/events.md)."""

TOPICS: tuple[Topic, ...] = (CMD_VEL, ODOM, SCAN, GROUND_TRUTH, USER_INPUT, CHATGPT_NODE, EVENTS)
