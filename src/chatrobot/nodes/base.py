"""`base`: from `user_input` to `chatgpt_node`: understands, asks Motion's node, and tells how it went."""

from __future__ import annotations

import contextlib
import gc
import json
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from chatrobot.core.errors import JointError, WireError
from chatrobot.core.events import Event, Finished, Interpreted, Notice, Result
from chatrobot.language.phrases import render_reason, say
from chatrobot.nodes.operator import Operators
from chatrobot.reflex import is_release
from chatrobot.robots.load import load_profile
from chatrobot.session.session import Options, Session
from chatrobot.session.topic_joint import TopicJoint
from chatrobot.session.topics import CHATGPT_NODE, EVENTS, OPERATOR, REPLY, STOP, USER_INPUT
from chatrobot.session.understanding import Understanding
from chatrobot.sim.load import load_world
from chatrobot.wire.connect import advertise, connect_wire, is_on_this_machine, publishers_of
from chatrobot.wire.messages import Flag, Text

NODE = "chatrobot_base"
PUMP_S = 0.1
SWITCH_INTERVAL_S = 0.0005
"""The wire's thread must get in between: what it hears may be a stop."""
LOOK_S = 1.0


@dataclass(frozen=True)
class BaseOptions:
    """`folder` is where places live; None for nowhere. The two flags are the tutorial's parameters."""

    wire: str
    profile: str
    world: str = "empty"
    folder: Path | None = None
    generate_code: bool = False
    rev_chatgpt: bool = False


class BaseNode:
    """A session whose texts come from a topic and whose Motion is another node.

    Args:
        show: hears every sentence for people, besides the topic.

    Raises:
        WireError: nobody answers on that wire.
        InputError: the profile or the world cannot be used.
    """

    def __init__(self, options: BaseOptions, show: Callable[[str], None]) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        self._options = options
        self._show = show
        profile = load_profile(options.profile)
        understanding = Understanding(profile, load_world(options.world), options.folder)
        understanding.interpret("forward 1 m")  # reads the tables now, not with the first instruction
        self._wire = connect_wire(options.wire, profile.wiring, NODE)
        self._joint = TopicJoint(self._wire, "base", is_on_this_machine=is_on_this_machine(options.wire))
        self._next_look_s = 0.0
        self._has_twin = False
        self._session = Session(self._joint, understanding, self._hear_event, Options())
        self._operators = Operators(lambda: self._session.is_idle, self._lose_operator)

    def run(self, is_leaving: Callable[[], bool]) -> None:
        """Until `is_leaving`. Understands and pumps in the calling thread.

        Raises:
            JointError: the wire is gone.
        """
        for topic in (REPLY, EVENTS):
            advertise(self._wire, topic, Text)
        self._joint.open()
        self._wire.subscribe(STOP, Flag, self._hear_stop)
        self._wire.subscribe(OPERATOR, Text, self._operators.hear_beat)
        self._operators.start()
        self._wire.subscribe(USER_INPUT, Text, self._hear)
        self._explain_parameters()
        gc.collect()
        gc.freeze()  # the words are many, and stay
        while not is_leaving():
            self._session.pump(PUMP_S)
            self._look_for_twins()
        self._session.close()
        self._wire.close()

    def stop(self, why: str) -> None:
        """Stop the robot and drop what waits; from any thread."""
        self._session.stop(why)

    # --- the wire's thread ---

    def _hear(self, message: Text) -> None:
        if message.data.strip():
            with contextlib.suppress(JointError):  # the wire is closing
                if is_release(message.data):
                    self._session.release()  # control decides, and says what it did
                else:
                    self._operators.hear_text(message.data)
                    self._session.say(message.data)

    def _lose_operator(self) -> None:
        with contextlib.suppress(JointError):
            self._session.stop("operator lost")

    def _hear_stop(self, message: Flag) -> None:
        if message.data:
            with contextlib.suppress(JointError):
                self._session.stop(STOP)

    # --- the pumping thread ---

    def _explain_parameters(self) -> None:
        language = self._session.understanding.language
        if self._options.generate_code:
            self._say(say(language, "generate_code_later"))
        if self._options.rev_chatgpt:
            self._say(say(language, "revchatgpt_gone"))

    def _look_for_twins(self) -> None:
        """Two bases would do everything twice: say so, where the wire knows names."""
        now_s = time.monotonic()
        if now_s < self._next_look_s:
            return
        self._next_look_s = now_s + LOOK_S
        has_twin = any(name.endswith(f"/{NODE}") for name in publishers_of(self._wire, CHATGPT_NODE))
        if has_twin and not self._has_twin:
            self._say(say(self._session.understanding.language, "another_base"))
        self._has_twin = has_twin

    def _hear_event(self, event: Event) -> None:
        language = self._session.understanding.language
        if isinstance(event, (Interpreted, Result)):
            self._publish(EVENTS, json.dumps(event.to_json(), separators=(",", ":"), ensure_ascii=False))
        if (isinstance(event, Interpreted) and event.plan_text) or isinstance(event, Result):
            self._say(event.reply)
        elif isinstance(event, Notice):
            self._say(event.text or render_reason(event.reason, language))
        elif isinstance(event, Finished) and event.turn == 0 and event.reason is not None:
            self._say(render_reason(event.reason, language))

    def _say(self, text: str) -> None:
        if text:
            self._show(text)
            self._publish(REPLY, text)

    def _publish(self, topic: str, text: str) -> None:
        with contextlib.suppress(WireError):  # gone: the joint tells
            self._wire.publish(topic, Text(text))
