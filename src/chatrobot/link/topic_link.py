"""The link to a Motion that is a node of its own: envelopes on `chatgpt_node`, events on `chatrobot/events`, and
telemetry on `chatrobot/telemetry`."""

from __future__ import annotations

import contextlib
import json
import threading
import time
from collections.abc import Callable
from typing import Any

from chatrobot.core.clock import BEAT_HZ, LOCAL_BEAT_HZ, LOCAL_TERM_S, TERM_S
from chatrobot.core.errors import LinkError, WireError
from chatrobot.core.events import (
    Finished,
    Interpreted,
    Notice,
    Outcome,
    ProgramWritten,
    Result,
    Telemetry,
    event_from_json,
)
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.motion_budget import OPEN_LOOP
from chatrobot.core.process import own_identity
from chatrobot.core.reason import Reason
from chatrobot.core.scheduling import wake_promptly
from chatrobot.link.envelope import PROTOCOL, Envelope, Word, other_protocol
from chatrobot.link.motion_link import EventQueue, Sender
from chatrobot.link.topics import CHATGPT_NODE, CONTROL, EVENTS, TELEMETRY, read_beat
from chatrobot.wire.messages import Text
from chatrobot.wire.wire import Wire

FIRST_ANSWER_S = 3.0
"""A plan waits this long for a control node to appear."""

SILENT_S = 1.0
"""A control node beats ten times a second; after this long without, the turns it had are over."""

FROZEN_S = 0.5
"""After a gap this long in our own beats it is we who were silent, and what control said is still to be read."""


class TopicLink(EventQueue):
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
        self._age_s = age_s
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
        self._in_flight: dict[int, str] = {}
        self._pose: Pose = ORIGIN
        self.beats = True
        self.is_simulated = False

    def open(self) -> None:
        """Listen, and begin to beat."""
        self._wire.advertise(CHATGPT_NODE, Text)
        self._wire.subscribe(CONTROL, Text, self._hear_control)
        self._wire.subscribe(TELEMETRY, Text, self._hear_event)  # first: older than an end that comes with it
        self._wire.subscribe(EVENTS, Text, self._hear_event)
        self.send("hello", term_s=self._term_s, process=self._process)
        threading.Thread(target=self._beat, name="beat", daemon=True).start()

    @property
    def is_lost(self) -> bool:
        """Never for good: a control node may come again."""
        return False

    @property
    def has_control(self) -> bool:
        """Whether a control node is there that hears us."""
        return self._present() is not None

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        if word == "program" or (word == "plan" and payload.get("mode") != "extend"):
            control = self._find_control()
            if control is None:
                self._conclude(turn, "failed", self._why_none())
                return
            self._in_flight[turn] = control
        self._publish(self._sender.envelope(word, turn, **payload))

    def abandon(self) -> None:
        self._closed.set()

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
        if isinstance(event, Telemetry):
            self._pose = event.pose
        elif isinstance(event, Finished):
            self._in_flight.pop(event.turn, None)
        self._events.put(event)

    # --- our own beats ---

    def _beat(self) -> None:
        wake_promptly()
        next_s = last_s = time.monotonic()
        while not self._closed.wait(max(0.0, next_s - time.monotonic())):
            now_s = time.monotonic()
            next_s = max(next_s + self._period_s, now_s)
            if self.beats:
                with contextlib.suppress(LinkError):
                    self.send("beat", term_s=self._term_s, process=self._process, age_s=self._age_s())
            if now_s - last_s > FROZEN_S:
                self._controls = dict.fromkeys(self._controls, now_s)
            last_s = now_s
            self._notice_silence(now_s)

    def _notice_silence(self, now_s: float) -> None:
        """End the turns of a control node that is gone; and should it come again, they must not run."""
        for turn, control in tuple(self._in_flight.items()):
            if now_s - self._controls.get(control, 0.0) > SILENT_S and self._in_flight.pop(turn, ""):
                with contextlib.suppress(LinkError):
                    self.send("stop", turn, why="control was silent")
                self._conclude(turn, "failed", Reason("control_silent"))

    def _conclude(self, turn: int, outcome: Outcome, reason: Reason) -> None:
        pose = self._pose
        self._events.put(Finished(turn, outcome, reason, pose, pose, 0.0, 0.0, 0.0, 0.0))

    def _publish(self, envelope: Envelope) -> None:
        try:
            self._wire.publish(CHATGPT_NODE, Text(envelope.to_bytes().decode()))
        except WireError as error:
            if not self._wire.comes_back:
                raise LinkError("the wire to the robot is closed") from error
