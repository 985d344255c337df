"""The topics of the nodes (std_msgs/String and std_msgs/Bool alone, so that nothing has to be built to listen)."""

from __future__ import annotations

USER_INPUT = "user_input"
"""What a person says: text. Motion listens, too, for stop words."""

CHATGPT_NODE = "chatgpt_node"
"""Envelopes (JSON) from `base` to `control`; text of others as the tutorial has it."""

EVENTS = "chatrobot/events"
"""What happens, one JSON event a message; quiet while nothing happens."""

TELEMETRY = "chatrobot/telemetry"
"""Where the robot is and how it moves, ten times a second: the JSON event `telemetry`."""

REPLY = "chatrobot/reply"
"""Sentences for people."""

STOP = "chatrobot/stop"
"""std_msgs/Bool: true stops."""

CONTROL = "chatrobot/control"
"""Every Motion says ten times a second that it is there: {"id", "node", "host", "pid", "hears": [leases]}."""

OPERATOR = "chatrobot/operator"
"""`input` says many times a second that it is there, and what it said last (`nodes/operator.py`)."""
