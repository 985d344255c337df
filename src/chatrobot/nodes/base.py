"""`base`: from `user_input` to `chatgpt_node`: understands, asks Motion's node, and tells how it went."""

from __future__ import annotations

import contextlib
import gc
import json
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from chatrobot.core.errors import LinkError, WireError
from chatrobot.core.events import (
    Event,
    FindingSeen,
    Finished,
    Interpreted,
    Notice,
    ProgramWritten,
    Rehearsed,
    Result,
    Said,
)
from chatrobot.core.motion_budget import NOT_CHOSEN
from chatrobot.dialogue.llm.camera import wire_camera
from chatrobot.dialogue.llm.requests import Interpreter
from chatrobot.dialogue.llm.setup import ModelSetup, warm_up
from chatrobot.dialogue.llm.terms import ModelOptions
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.programs.authoring import Authoring
from chatrobot.dialogue.programs.draft import body, headline
from chatrobot.dialogue.question import Question
from chatrobot.dialogue.session import Session
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.consent import read_consent
from chatrobot.language.phrases import render_reason, say
from chatrobot.link.approval import LAPSES_AFTER_S
from chatrobot.link.topic_link import TopicLink
from chatrobot.link.topics import CHATGPT_NODE, EVENTS, OPERATOR, REPLY, STOP, USER_INPUT
from chatrobot.models.seam import Model
from chatrobot.nodes.log import Severity, Write
from chatrobot.nodes.operator import Operators
from chatrobot.nodes.told import severity_of
from chatrobot.plan.context import RoutePlanner
from chatrobot.plan.route import GridRoutePlanner
from chatrobot.programs.library import Library
from chatrobot.reflex import is_release
from chatrobot.robots.load import load_profile
from chatrobot.robots.open_loop import as_chosen
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.load import load_world
from chatrobot.sim.world import World
from chatrobot.wire.connect import (
    Connect,
    advertise,
    connect_wire,
    is_on_this_machine,
    publishers_of,
    resolved,
)
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


@dataclass(frozen=True)
class BaseOptions:
    """`folder` is where places live; None for nowhere. The two flags are the tutorial's parameters. `model`
    is asked what is not understood without one. `approval`: what waits for a person's yes: each plan, none, or what a
    model wrote, where the robot's profile asks for approval. `open_loop`: control drives a robot without odometry."""

    wire: str
    profile: str
    world: str = "empty"
    folder: Path | None = None
    generate_code: bool = False
    rev_chatgpt: bool = False
    interpreter: Interpreter = "auto"
    model: Model | None = None
    model_options: ModelOptions = field(default_factory=ModelOptions)
    approval: Approval = "profile"
    open_loop: bool = False


class BaseNode:
    """A session whose texts come from a topic and whose Motion is another node.

    Args:
        show: hears every sentence for people, besides the topic, and how severe it is; it must not block.

    Raises:
        WireError: nobody answers on that wire.
        InputError: the profile or the world cannot be used.
    """

    def __init__(self, options: BaseOptions, show: Write, connect: Connect = connect_wire) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        self._options = options
        self._show = show
        profile = as_chosen(load_profile(options.profile), NOT_CHOSEN, open_loop=options.open_loop)
        world = load_world(options.world)
        understanding = Understanding(profile, world, options.folder)
        understanding.interpret("forward 1 m")  # reads the tables now, not with the first instruction
        self._wire = connect(options.wire, profile.wiring, NODE)
        self._link = TopicLink(
            self._wire,
            "base",
            is_on_this_machine=is_on_this_machine(options.wire),
            age_s=lambda: self._operators.age_s(),
        )
        self._next_look_s = 0.0
        self._has_twin = False
        self._question = Question()
        authoring = self._authoring(profile, world, understanding) if options.generate_code else None
        session_options = Options(
            interpreter=options.interpreter,
            approve=options.approval == "all",
            approve_models=options.approval == "profile" and profile.approval == "plan",
        )
        model_setup = self._model_setup(profile)
        self._session = Session(
            self._link, understanding, self._hear_event, session_options, authoring, model_setup
        )
        self._operators = Operators(lambda: self._session.is_idle, self._lose_operator)

    def _model_setup(self, profile: RobotProfile) -> ModelSetup | None:
        """Plans come in parts where the profile allows it; otherwise whole, and who said it is asked for a yes."""
        options = self._options
        if options.model is None:
            return None
        streams = profile.approval == "stream" and profile.can_turn_on_the_spot
        wiring = profile.wiring
        if wiring.camera_topic:  # as this node finds it, remapped or in a namespace
            wiring = replace(wiring, camera_topic=resolved(self._wire, wiring.camera_topic))
        camera = wire_camera(options.wire, wiring)
        return ModelSetup(options.model, replace(options.model_options, streams=streams), profile, camera)

    def run(self, is_leaving: Callable[[], bool], on_ready: Callable[[], None]) -> None:
        """Until `is_leaving`; `on_ready` is called once it listens. Understands and pumps in the calling thread.

        Raises:
            LinkError: the wire is gone.
        """
        for topic in (REPLY, EVENTS):
            advertise(self._wire, topic, Text)
        self._link.open()
        warm_up(self._options.model)
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
        """The name of that topic on the wire."""
        return resolved(self._wire, topic)

    def stop(self, why: str) -> None:
        """Stop the robot and drop what waits; from any thread."""
        self._session.stop(why)

    def introduce(self, ros_interfaces: RosInterfaces) -> None:
        """Offer to ROS what a node of it offers."""
        ros_interfaces.serve("~/stop", self._serve_stop)
        ros_interfaces.diagnose(self._options.profile, self._diagnose)

    # --- the wire's thread ---

    def _serve_stop(self) -> tuple[bool, str]:
        try:
            self._session.stop("~/stop")
        except LinkError as error:
            return False, str(error)
        return True, "stop sent to control"

    def _diagnose(self) -> Diagnosis:
        from chatrobot.nodes.ros_interfaces import Diagnosis

        values = {"interpreter": self._options.interpreter, "profile": self._options.profile}
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
        if self._options.generate_code:
            self._say(say(language, "generate_code_on"))
        if self._options.rev_chatgpt:
            model = self._options.model
            code = "revchatgpt_gone" if model is not None else "revchatgpt_no_model"
            self._say(say(language, code, model=model.name if model is not None else ""), "warn")

    def _look_for_twins(self) -> None:
        """Two bases would do everything twice: say so, where the wire knows names."""
        now_s = time.monotonic()
        if now_s < self._next_look_s:
            return
        self._next_look_s = now_s + LOOK_S
        has_twin = any(name.endswith(f"/{NODE}") for name in publishers_of(self._wire, CHATGPT_NODE))
        if has_twin and not self._has_twin:
            self._say(say(self._session.understanding.language, "another_base"), "warn")
        self._has_twin = has_twin

    def _hear_event(self, event: Event) -> None:
        self._question.hear(event)
        language = self._session.understanding.language
        if isinstance(event, (Interpreted, ProgramWritten, Result)):
            self._publish(EVENTS, json.dumps(event.to_json(), separators=(",", ":"), ensure_ascii=False))
        if isinstance(event, Interpreted) and event.plan_text:
            self._say(event.reply)
        elif isinstance(event, Result):
            if not (self._session.is_moving and event.reply in _bare_stops(language)):
                # Else the end of what was stopped tells it, once the robot stands.
                self._say(event.reply, _SEVERITY_OF_RESULTS.get(event.outcome, "info"))
        elif isinstance(event, Said):
            self._say(event.text)
        elif isinstance(event, Notice):
            self._say(event.text or render_reason(event.reason, language), severity_of(event.reason))
        elif isinstance(event, ProgramWritten):
            self._say_written(event, language)
        elif isinstance(event, Rehearsed) and event.needs_approval:
            self._ask(event, language)
        elif isinstance(event, Finished) and event.turn == 0 and event.reason is not None:
            self._say(render_reason(event.reason, language))

    def _ask(self, event: Rehearsed, language: str) -> None:
        """Programs read the question on the events' topic: `rehearsed`, with `needs_approval`."""
        about = {"length_m": event.length_m, "duration_s": event.duration_s, "limit_s": LAPSES_AFTER_S}
        self._say(" ".join([*_sentences(event.findings, language), say(language, "ask_plan", **about)]))

    def _say_written(self, event: ProgramWritten, language: str) -> None:
        """In one message, as a person reads it; programs find the parts of it on the events' topic."""
        self._say("\n".join([headline(event, language), *body(event, language)]))

    def _authoring(self, profile: RobotProfile, world: World, understanding: Understanding) -> Authoring:
        def routes() -> RoutePlanner | None:
            return None if world.is_empty else GridRoutePlanner(world, profile)

        options = self._options
        return Authoring(
            profile,
            Library(options.folder),
            understanding.interpret,
            model=options.model,
            prefers_model=options.interpreter == "model",
            routes=routes,
        )

    def _say(self, text: str, severity: Severity = "info") -> None:
        if text:
            self._show(severity, text)
            self._publish(REPLY, text)

    def _publish(self, topic: str, text: str) -> None:
        with contextlib.suppress(WireError):  # gone: the link tells
            self._wire.publish(topic, Text(text))


def _bare_stops(language: str) -> tuple[str, ...]:
    """What is said of a stop that tells no more than that it came."""
    return tuple(say(language, code) for code in ("stopped_now", "stopped_now_unmeasured"))


def _sentences(findings: Iterable[FindingSeen], language: str) -> list[str]:
    return [render_reason(finding.reason, language) for finding in findings]
