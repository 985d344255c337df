"""`base`: from `user_input` to `chatgpt_node`: understands, asks Motion's node, and tells how it went."""

from __future__ import annotations

import contextlib
import gc
import json
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from chatrobot.compose import Prepared, Setup
from chatrobot.core import events
from chatrobot.core.errors import LinkError, WireError
from chatrobot.core.events import Event
from chatrobot.dialogue.llm.setup import explain_server_held, warm_up
from chatrobot.dialogue.programs.draft import body, headline
from chatrobot.dialogue.question import Question
from chatrobot.language.consent import read_consent
from chatrobot.language.phrases import render_reason, say
from chatrobot.link.motion_link import LAPSES_AFTER_S
from chatrobot.link.topic_link import CHATGPT_NODE, EVENTS, OPERATOR, REPLY, STOP, USER_INPUT, TopicLink
from chatrobot.nodes.log import Severity, Write
from chatrobot.nodes.operator import Operators
from chatrobot.nodes.told import severity_of
from chatrobot.reflex import is_release
from chatrobot.wire.connect import Connect, connect_wire, is_on_this_machine, wire_address
from chatrobot.wire.messages import Flag, Text

if TYPE_CHECKING:
    from chatrobot.nodes.ros_interfaces import Diagnosis, RosInterfaces

NODE = "chatrobot_base"
PUMP_S = 0.1
SWITCH_INTERVAL_S = 0.0005
"""The wire's thread must get in between: what it hears may be a stop."""
LOOK_S = 1.0
Approval = Literal["profile", "all", "none"]
_SEVERITY_OF_RESULTS: Mapping[str, Severity] = {"refused": "warn", "unclear": "warn", "failed": "error"}


class BaseNode:
    """A session whose texts come from a topic and whose Motion is another node.

    Args:
        setup: what was chosen; `on` is the wire, `programs` the tutorial's parameter generate_code.
        show: hears every sentence for people, besides the topic, and how severe it is; it must not block.
        approval: what waits for a person's yes: each plan, none, or what a model wrote, where the robot's profile asks
            for approval.
        rev_chatgpt: the tutorial's parameter.

    Raises:
        WireError: nobody answers on that wire.
        InputError: the profile or the world cannot be used.
    """

    def __init__(
        self,
        setup: Setup,
        show: Write,
        connect: Connect = connect_wire,
        *,
        approval: Approval = "profile",
        rev_chatgpt: bool = False,
    ) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        profile = setup.profile
        options = replace(
            setup.options,
            approve=approval == "all",
            approve_models=approval == "profile" and profile.approval == "plan",
        )
        self._setup = setup = replace(setup, options=options)
        self._rev_chatgpt = rev_chatgpt
        self._show = show
        prepared = Prepared(setup, profile)
        prepared.understanding.interpret(
            "forward 1 m"
        )  # reads the tables now, not with the first instruction
        address, wiring = wire_address(setup.on), profile.wiring
        self._wire = connect(address, wiring, NODE)
        self._link = TopicLink(
            self._wire,
            "base",
            is_on_this_machine=is_on_this_machine(address),
            age_s=lambda: self._operators.age_s(),
        )
        if wiring.camera_topic:  # as this node finds it, remapped or in a namespace
            topic = self._wire.resolve(wiring.camera_topic)
            prepared.profile = replace(profile, wiring=replace(wiring, camera_topic=topic))
        self._next_look_s = 0.0
        self._has_twin = False
        self._question = Question()
        self._session = prepared.session(self._link, self._hear_event)
        self._operators = Operators(lambda: self._session.is_idle, self._lose_operator)

    def run(self, is_leaving: Callable[[], bool], on_ready: Callable[[], None]) -> None:
        """Run until `is_leaving`; `on_ready` is called once it listens. Understands and pumps in the calling thread.

        Raises:
            LinkError: the wire is gone.
        """
        for topic in (REPLY, EVENTS):
            self._wire.advertise(topic, Text)
        self._link.open()
        warm_up(self._setup.model)
        self._wire.subscribe(STOP, Flag, self._hear_stop)
        self._wire.subscribe(OPERATOR, Text, self._operators.hear_beat)
        self._operators.start()
        self._wire.subscribe(USER_INPUT, Text, self._hear)
        self._explain_parameters()
        gc.collect()
        gc.freeze()  # the words are many, and stay
        on_ready()
        while not is_leaving():
            self._session.pump(PUMP_S)
            self._look_for_twins()
        self._session.close()
        self._wire.close()

    def resolved(self, topic: str) -> str:
        """Return the name of that topic on the wire."""
        return self._wire.resolve(topic)

    def stop(self, why: str) -> None:
        """Stop the robot and drop what waits; from any thread."""
        self._session.stop(why)

    def introduce(self, ros_interfaces: RosInterfaces) -> None:
        """Offer to ROS what a node of it offers."""
        ros_interfaces.serve("~/stop", self._serve_stop)
        ros_interfaces.diagnose(self._setup.robot, self._diagnose)

    # --- the wire's thread ---

    def _serve_stop(self) -> tuple[bool, str]:
        try:
            self._session.stop("~/stop")
        except LinkError as error:
            return False, str(error)
        return True, "stop sent to control"

    def _diagnose(self) -> Diagnosis:
        from chatrobot.nodes.ros_interfaces import Diagnosis

        values = {"interpreter": self._setup.options.interpreter, "profile": self._setup.robot}
        if not self._link.has_control:
            return Diagnosis("warn", "no_control", values)
        return Diagnosis("ok", "ready", values)

    def _hear(self, message: Text) -> None:
        if message.data.strip():
            with contextlib.suppress(LinkError):  # the wire is closing
                if is_release(message.data):
                    self._session.release()  # control decides, and says what it did
                else:
                    self._operators.hear_text(message.data)
                    self._say_or_answer(message.data)

    def _say_or_answer(self, text: str) -> None:
        """Yes and no answer what was asked; whoever says something else does not want it done."""
        if self._question.turn is None:
            self._session.say(text)
            return
        yes = read_consent(text)
        if yes is None:
            self._session.say(text)  # first of all: it may be a stop
        self._question.answer(self._session, yes is True)

    def _lose_operator(self) -> None:
        with contextlib.suppress(LinkError):
            self._session.stop("operator lost")

    def _hear_stop(self, message: Flag) -> None:
        if message.data:
            with contextlib.suppress(LinkError):
                self._session.stop(STOP)

    # --- the pumping thread ---

    def _explain_parameters(self) -> None:
        language = self._session.understanding.language
        if self._setup.programs:
            self._say(say(language, "generate_code_on"))
        if self._rev_chatgpt:
            self._say(explain_server_held(self._setup.model, language), "warn")

    def _look_for_twins(self) -> None:
        """Two bases would do everything twice: say so, where the wire knows names."""
        now_s = time.monotonic()
        if now_s < self._next_look_s:
            return
        self._next_look_s = now_s + LOOK_S
        has_twin = any(name.endswith(f"/{NODE}") for name in self._wire.publishers_of(CHATGPT_NODE))
        if has_twin and not self._has_twin:
            self._say(say(self._session.understanding.language, "another_base"), "warn")
        self._has_twin = has_twin

    def _hear_event(self, event: Event) -> None:
        self._question.hear(event)
        language = self._session.understanding.language
        if isinstance(event, (events.Interpreted, events.ProgramWritten, events.Result)):
            self._publish(EVENTS, json.dumps(event.to_json(), separators=(",", ":"), ensure_ascii=False))
        if isinstance(event, events.Interpreted) and event.plan_text:
            self._say(event.reply)
        elif isinstance(event, events.Result):
            bare_stops = [say(language, code) for code in ("stopped_now", "stopped_now_unmeasured")]
            if not (self._session.is_moving and event.reply in bare_stops):
                # Else the end of what was stopped tells it, once the robot stands.
                self._say(event.reply, _SEVERITY_OF_RESULTS.get(event.outcome, "info"))
        elif isinstance(event, events.Said):
            self._say(event.text)
        elif isinstance(event, events.Notice):
            self._say(event.text or render_reason(event.reason, language), severity_of(event.reason))
        elif isinstance(event, events.ProgramWritten):
            self._say("\n".join([headline(event, language), *body(event, language)]))
        elif isinstance(event, events.Rehearsed) and event.needs_approval:
            self._ask(event, language)
        elif isinstance(event, events.Finished) and event.turn == 0 and event.reason is not None:
            self._say(render_reason(event.reason, language))

    def _ask(self, event: events.Rehearsed, language: str) -> None:
        """Programs read the question on the events' topic: `rehearsed`, with `needs_approval`."""
        about = {"length_m": event.length_m, "duration_s": event.duration_s, "limit_s": LAPSES_AFTER_S}
        found = [render_reason(finding.reason, language) for finding in event.findings]
        self._say(" ".join([*found, say(language, "ask_plan", **about)]))

    def _say(self, text: str, severity: Severity = "info") -> None:
        if text:
            self._show(severity, text)
            self._publish(REPLY, text)

    def _publish(self, topic: str, text: str) -> None:
        with contextlib.suppress(WireError):  # gone: the link tells
            self._wire.publish(topic, Text(text))
