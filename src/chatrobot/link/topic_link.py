"""The link to a Motion that is a node of its own, and the topics of the nodes.

Envelopes go on `chatgpt_node`, events come on `chatrobot/events`, telemetry on `chatrobot/telemetry`: std_msgs/String
and std_msgs/Bool alone, so that nothing has to be built to listen.
"""

from __future__ import annotations

import contextlib
import json
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from chatrobot.core.clock import BEAT_HZ, LOCAL_BEAT_HZ, LOCAL_TERM_S, TERM_S
from chatrobot.core.errors import LinkError, WireError
from chatrobot.core.events import (
    Event,
    Finished,
    Interpreted,
    Notice,
    ProgramWritten,
    Rehearsed,
    Result,
    Started,
    Telemetry,
    event_from_json,
)
from chatrobot.core.geometry import ORIGIN, ZERO_TWIST
from chatrobot.core.process import own_identity, wake_promptly
from chatrobot.core.reason import Reason
from chatrobot.link.envelope import PROTOCOL, STOP_TOPIC, Envelope, Word, other_protocol, protocol_of
from chatrobot.link.motion_link import EventQueue, MotionLink, Sender
from chatrobot.robots.profile import OPEN_LOOP
from chatrobot.wire.messages import Text
from chatrobot.wire.wire import Wire

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

STOP = STOP_TOPIC
"""std_msgs/Bool: true stops."""

CONTROL = "chatrobot/control"
"""Every Motion says ten times a second that it is there: {"id", "node", "host", "pid", "hears": [leases]}."""

OPERATOR = "chatrobot/operator"
"""`input` says many times a second that it is there, and what it said last (`nodes/operator.py`)."""


class MotionBeat(NamedTuple):
    """A beat of a Motion about itself. `hears`: the leases of the sources it has heard.

    `open_loop`: the limits it drives within where it drives open loop, else None. `protocol`: of its link.
    """

    id: str
    name: str
    hears: frozenset[str]
    open_loop: dict[str, float] | None = None
    protocol: int = PROTOCOL


def read_beat(text: str) -> MotionBeat | None:
    """None where it is something else."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(data, dict) or not {"id", "node", "host", "pid"} <= data.keys():
        return None
    name = f"{data['node']} (process {data['pid']} on {data['host']})"
    hears = data.get("hears")
    leases = frozenset(map(str, hears)) if isinstance(hears, list) else frozenset[str]()
    return MotionBeat(str(data["id"]), name[:120], leases, _numbers(data.get("open_loop")), protocol_of(data))


def _numbers(values: object) -> dict[str, float] | None:
    """The numbers by their names, where it is that."""
    if not isinstance(values, dict):
        return None
    return {str(name): float(value) for name, value in values.items() if isinstance(value, (int, float))}


FIRST_ANSWER_S = 3.0
"""A plan waits this long for a control node to appear."""

SILENT_S = 1.0
"""A control node beats ten times a second; after this long without, the turns it had are over."""

FROZEN_S = 0.5
"""After a gap this long in our own beats it is we who were silent, and what control said is still to be read."""


@dataclass
class _InFlight:
    """A turn that a control node has, and what it has told of it: should it fall silent, its end is told from that."""

    control: str
    planned: Rehearsed | None = None
    began: tuple[float, Telemetry] | None = None
    """When it began to move the robot, and where."""
    measured: bool = True

    def end(self, last: Telemetry, heard_s: float) -> dict[str, Any]:
        """Return what it came to: fields of `Finished`. Where nothing is measured, that is what was sent at most."""
        if self.began is None:
            stood = {"turned_rad": 0.0, "path_m": 0.0, "duration_s": 0.0}
            return {"start": last.pose, "pose": last.pose, **stood}
        began_s, first = self.began
        duration_s = max(0.0, heard_s - began_s)
        planned_m = self.planned.length_m if self.planned is not None else 0.0
        if not self.measured and self.planned is not None and self.planned.duration_s:
            planned_m *= min(1.0, duration_s / self.planned.duration_s)
        return {
            "start": first.pose,
            "pose": last.pose,
            "turned_rad": last.pose.yaw_rad - first.pose.yaw_rad,
            "path_m": last.path_m - first.path_m,
            "duration_s": duration_s,
            "planned_m": planned_m,
            "open_ended": self.planned is not None and self.planned.open_ended,
            "measured": self.measured,
        }


class TopicLink(EventQueue, MotionLink):
    """Talks to whichever control node is there; it may come, go and come again.

    A thread beats the lease. If this process freezes or dies, the beats end and Motion stops the robot. `open`
    begins; a constructor touches nothing.

    Args:
        wire: the robot's.
        is_on_this_machine: beats come at 25 Hz and a lease's term is 0.18 s; else 10 Hz and 0.3 s.
        age_s: how long ago whoever gave the order was heard, where that is another process.
    """

    def __init__(
        self,
        wire: Wire,
        source: str,
        *,
        is_on_this_machine: bool,
        age_s: Callable[[], float] = lambda: 0.0,
    ) -> None:
        super().__init__()
        self.age_s = age_s
        self._process = own_identity()
        self._wire = wire
        self._sender = Sender(source)
        self._period_s = 1.0 / (LOCAL_BEAT_HZ if is_on_this_machine else BEAT_HZ)
        self._term_s = LOCAL_TERM_S if is_on_this_machine else TERM_S
        self._closed = threading.Event()
        self._controls: dict[str, float] = {}
        self._strangers: dict[int, float] = {}
        """When a control node of another protocol was last heard, by that."""
        self._control_came = threading.Condition()
        self._in_flight: dict[int, _InFlight] = {}
        self._telemetry = Telemetry(0, ORIGIN, ZERO_TWIST, 0.0)

    def open(self) -> None:
        """Listen, and begin to beat."""
        self._wire.advertise(CHATGPT_NODE, Text)
        self._wire.subscribe(CONTROL, Text, self._hear_control)
        self._wire.subscribe(TELEMETRY, Text, self._hear_event)  # first: older than an end that comes with it
        self._wire.subscribe(EVENTS, Text, self._hear_event)
        self.send("hello", term_s=self._term_s, process=self._process)
        threading.Thread(target=self._beat, name="beat", daemon=True).start()

    @property
    def has_control(self) -> bool:
        """Tell whether a control node is there that hears us."""
        return self._present() is not None

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        if word == "program" or (word == "plan" and payload.get("mode") != "extend"):
            control = self._find_control()
            if control is None:
                self._conclude(turn, self._why_none(), _InFlight(""))
                return
            self._in_flight[turn] = _InFlight(control)
        self._publish(self._sender.envelope(word, turn, **payload))

    def close(self) -> None:
        if self._closed.is_set():
            return
        with contextlib.suppress(LinkError):
            self.send("goodbye")
        self._closed.set()

    # --- control ---

    def _hear_control(self, message: Text) -> None:
        about = read_beat(message.data)
        if about is not None:
            with self._control_came:
                if about.protocol != PROTOCOL:
                    self._strangers[about.protocol] = time.monotonic()
                    self._control_came.notify_all()
                elif self._sender.lease in about.hears:
                    if about.open_loop is not None and about.id not in self._controls:
                        self._events.put(Notice(0, Reason(OPEN_LOOP, about.open_loop)))
                    self._controls[about.id] = time.monotonic()
                    self._control_came.notify_all()

    def _present(self) -> str | None:
        """A control node that beats, and hears us."""
        since_s = time.monotonic() - SILENT_S
        return next((known for known, at_s in tuple(self._controls.items()) if at_s > since_s), None)

    def _find_control(self) -> str | None:
        """A control node, waited for. That a wire knows it as a listener is not enough: it must have heard us."""
        with self._control_came:
            self._control_came.wait_for(
                lambda: self._present() is not None or self._stranger() is not None, FIRST_ANSWER_S
            )
        return self._present()

    def _stranger(self) -> int | None:
        """The protocol of a control node that beats, and is none for us."""
        since_s = time.monotonic() - SILENT_S
        return next((known for known, at_s in self._strangers.items() if at_s > since_s), None)

    def _why_none(self) -> Reason:
        stranger = self._stranger()
        if stranger is None:
            return Reason("no_control")
        return other_protocol(motion=stranger, dialogue=PROTOCOL)

    def _hear_event(self, message: Text) -> None:
        try:
            event = event_from_json(json.loads(message.data))
        except (ValueError, AttributeError, RecursionError):
            return  # whoever wrote that is none of ours
        if isinstance(event, (Interpreted, ProgramWritten, Result)):
            return  # a base's own, ours among them
        if isinstance(event, Notice) and event.reason.code == OPEN_LOOP:
            return  # its beats tell, also whoever comes later
        self._note(event)
        self._events.put(event)

    def _note(self, event: Event) -> None:
        """Note what the end of a turn would be told from."""
        known = self._in_flight.get(event.turn)
        if isinstance(event, Telemetry):
            self._telemetry = event
        elif isinstance(event, Finished):
            self._in_flight.pop(event.turn, None)
        elif known is None:
            return
        elif isinstance(event, Rehearsed) and known.began is None:  # not what is left after a pause
            known.planned = event
        elif isinstance(event, Started):
            known.began, known.measured = known.began or (time.monotonic(), self._telemetry), event.measured

    # --- our own beats ---

    def _beat(self) -> None:
        wake_promptly()
        next_s = last_s = time.monotonic()
        while not self._closed.wait(max(0.0, next_s - time.monotonic())):
            now_s = time.monotonic()
            next_s = max(next_s + self._period_s, now_s)
            if self.beats:
                with contextlib.suppress(LinkError):
                    self.send("beat", term_s=self._term_s, process=self._process, age_s=self.age_s())
            if now_s - last_s > FROZEN_S:
                self._controls = dict.fromkeys(self._controls, now_s)
            last_s = now_s
            self._notice_silence(now_s)

    def _notice_silence(self, now_s: float) -> None:
        """End the turns of a control node that is gone; and should it come again, they must not run."""
        for turn, known in tuple(self._in_flight.items()):
            heard_s = self._controls.get(known.control, 0.0)
            if now_s - heard_s > SILENT_S and self._in_flight.pop(turn, None) is not None:
                with contextlib.suppress(LinkError):
                    self.send("stop", turn, why="control was silent")
                self._conclude(turn, Reason("control_silent"), known, heard_s)

    def _conclude(self, turn: int, reason: Reason, known: _InFlight, heard_s: float = 0.0) -> None:
        """End a turn whose end no control node tells."""
        end = known.end(self._telemetry, heard_s)
        self._events.put(Finished(turn, "failed", reason, paused_s=0.0, **end))

    def _publish(self, envelope: Envelope) -> None:
        try:
            self._wire.publish(CHATGPT_NODE, Text(envelope.to_bytes().decode()))
        except WireError as error:
            if not self._wire.comes_back:
                raise LinkError("the wire to the robot is closed") from error
