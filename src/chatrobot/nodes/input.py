"""`input`: lines typed, to `user_input`. What comes back on `chatrobot/reply` is shown."""

from __future__ import annotations

import time
from collections.abc import Callable

from chatrobot.core.wiring import Wiring
from chatrobot.link.topic_link import CONTROL, OPERATOR, REPLY, STOP, USER_INPUT
from chatrobot.nodes.operator import OperatorBeat
from chatrobot.reflex import is_stop
from chatrobot.wire.connect import Connect, connect_wire, is_on_this_machine
from chatrobot.wire.messages import Flag, Text

NODE = "chatrobot_input"
_COMMANDS = {"/stop": "stop", "/estop": "emergency stop", "/release": "release the emergency stop"}
"""Those of the console that make sense here; who hears them decides."""
LISTENER_S = 3.0
BOTH_S = 1.0
"""Base and control both listen; before the first line it waits so long for the second of them."""

MEETING_S = 0.1
"""A listener that we have found may need a moment more to find us."""


class InputNode:
    """Puts what a person says on the wire. `say` may be called from any thread.

    Args:
        address: of the wire.
        show: hears every reply.

    Raises:
        WireError: nobody answers on that wire.
    """

    def __init__(
        self, address: str, wiring: Wiring, show: Callable[[str], None], connect: Connect = connect_wire
    ) -> None:
        self._wire = connect(address, wiring, NODE)
        self._has_met = False
        self._wire.advertise(USER_INPUT, Text)
        self._wire.advertise(STOP, Flag)
        self._operator = OperatorBeat(self._wire, is_on_this_machine=is_on_this_machine(address))
        self._operator.start()
        self._wire.subscribe(REPLY, Text, lambda message: show(message.data))

    def say(self, text: str) -> bool:
        """Publish a line. A stop is out at once; anything else waits a moment for somebody to listen.

        Returns:
            False where nobody listens, or only control does.
        """
        text = _COMMANDS.get(text.strip().casefold(), text)
        if is_stop(text):
            self._wire.publish(USER_INPUT, Text(text))
            return True
        if not self._has_met:
            self._wire.wait_for_listener(USER_INPUT, Text, BOTH_S, count=2)
        heard = self._wire.wait_for_listener(USER_INPUT, Text, LISTENER_S)
        if heard and not self._has_met:
            time.sleep(MEETING_S)
            self._has_met = True
        self._operator.claim(text)
        self._wire.publish(USER_INPUT, Text(text))
        return heard and not self._is_control_alone()

    def _is_control_alone(self) -> bool:
        """Whether only control listens, for stops: base understands, and hears operators as nobody else does."""
        if self._wire.wait_for_listener(OPERATOR, Text, 0.0):
            return False
        is_second = self._wire.wait_for_listener(USER_INPUT, Text, 0.0, count=2)
        control = self._wire.resolve(CONTROL)
        return not is_second and any(
            end.topic == control and end.role == "publishes" for end in self._wire.survey()
        )

    def resolved(self, topic: str) -> str:
        """Return the name of that topic on the wire."""
        return self._wire.resolve(topic)

    def stop(self) -> None:
        """Stop the robot."""
        self._wire.publish(STOP, Flag(True))

    def close(self) -> None:
        """End in order: what was said is still done."""
        self._operator.close()
        self._wire.close()
