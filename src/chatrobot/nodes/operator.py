"""Is the person who said it still there? `input` beats while it lives; `base` stops the robot when it falls silent.

Text on `user_input` carries no name, so a beat tells what was said last: a text that no beat claims comes from
somebody who just published it, and binds nobody.
"""

from __future__ import annotations

import contextlib
import json
import threading
import time
import uuid
from collections.abc import Callable

from chatrobot.core.clock import BEAT_HZ, LOCAL_BEAT_HZ, LOCAL_TERM_S, TERM_S
from chatrobot.core.errors import WireError
from chatrobot.core.process import own_identity, watch_process
from chatrobot.core.scheduling import wake_promptly
from chatrobot.governor.lease import LATE_S, LONGEST_S, Lease
from chatrobot.link.topics import OPERATOR
from chatrobot.wire.messages import Text
from chatrobot.wire.wire import Wire

LOOK_S = 0.02
CLAIMED_WITHIN_S = 1.0
"""A beat and the text that it claims come on two topics, in any order."""

LONGEST_TERM_S = LONGEST_S
_CLAIMED = 200
"""Characters of a text that a beat repeats."""


class OperatorBeat:
    """The end of who speaks. `start` begins to beat; a process that freezes or dies ends it without a word."""

    def __init__(self, wire: Wire, *, is_on_this_machine: bool) -> None:
        self._wire = wire
        self._id = uuid.uuid4().hex
        self._process = own_identity()
        self._period_s = 1.0 / (LOCAL_BEAT_HZ if is_on_this_machine else BEAT_HZ)
        self._term_s = LOCAL_TERM_S if is_on_this_machine else TERM_S
        self._said, self._count = "", 0
        self._closed = threading.Event()
        wire.advertise(OPERATOR, Text)

    def start(self) -> None:
        """Begin to beat."""
        threading.Thread(target=self._beat, name="operator", daemon=True).start()

    def claim(self, text: str) -> None:
        """This is about to be said, by us."""
        self._said, self._count = text[:_CLAIMED], self._count + 1
        self._publish(leaves=False)

    def close(self) -> None:
        """End in order: what was said is still done."""
        self._closed.set()
        self._publish(leaves=True)

    def _beat(self) -> None:
        wake_promptly()
        while not self._closed.wait(self._period_s):
            self._publish(leaves=False)

    def _publish(self, *, leaves: bool) -> None:
        about = {
            "id": self._id, "said": self._said, "count": self._count, "term_s": self._term_s, "leaves": leaves,
            "process": self._process,
        }  # fmt: skip
        with contextlib.suppress(WireError):
            self._wire.publish(OPERATOR, Text(json.dumps(about, separators=(",", ":"))))


class Operators:
    """The end of who listens: stops the robot when somebody falls silent whose words are being done.

    Args:
        is_idle: nothing runs and nothing waits.
        stop: called from a thread of this class's own.
    """

    def __init__(
        self,
        is_idle: Callable[[], bool],
        stop: Callable[[], None],
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self._is_idle = is_idle
        self._stop = stop
        self._now_s = now_s
        self._lock = threading.Lock()
        self._texts: dict[str, float] = {}
        self._claims: dict[str, tuple[int, str, float]] = {}
        self._beats: dict[str, Lease] = {}
        self._bound: set[str] = set()
        self._looked_s = now_s()

    def start(self) -> None:
        """Begin to watch."""
        threading.Thread(target=self._watch, name="operators", daemon=True).start()

    def hear_text(self, text: str) -> None:
        """Something was said on `user_input`."""
        now_s = self._now_s()
        with self._lock:
            if self._is_idle():
                self._bound.clear()
                self._texts.clear()
            self._texts = {
                said: at_s for said, at_s in self._texts.items() if now_s - at_s < CLAIMED_WITHIN_S
            }
            self._texts[text[:_CLAIMED]] = now_s
            for operator, (_, said, at_s) in self._claims.items():
                self._bind(operator, said, at_s, now_s)

    def hear_beat(self, message: Text) -> None:
        """Take in a beat; anything else that somebody put on that topic is ignored."""
        try:
            about = json.loads(message.data)
            operator, said, count = str(about["id"]), str(about["said"]), int(about["count"])
            term_s = min(max(float(about["term_s"]), 0.0), LONGEST_TERM_S)
            leaves, process = about["leaves"] is True, str(about.get("process", ""))
        except (ValueError, TypeError, KeyError, OverflowError, RecursionError):
            return
        now_s = self._now_s()
        with self._lock:
            if leaves:
                self._bound.discard(operator)
                self._claims.pop(operator, None)
                self._beats.pop(operator, None)
                return
            beats = self._beats.get(operator)
            if beats is None:
                self._beats[operator] = Lease(operator, term_s, now_s, watch_process(process))
            else:
                beats.last_beat_s = now_s
            known = self._claims.get(operator)
            if known is None or known[0] != count:
                self._claims[operator] = (count, said, now_s)
                self._bind(operator, said, now_s, now_s)

    def look(self) -> None:
        """Stop, once, where somebody bound has fallen silent, is stopped or is gone.

        Where this process was held up (it may be loading a library) it is we who did not listen: that time does not
        count. Motion sees by our own beats whether we are there. A beat that is only late is Motion's affair, too: our
        own beat tells it how late (`age_s`).
        """
        now_s = self._now_s()
        with self._lock:
            late_s, self._looked_s = now_s - self._looked_s - 2.0 * LOOK_S, now_s
            if late_s > 0.0:
                for beats in self._beats.values():
                    beats.last_beat_s += late_s
            gone = {operator for operator in self._bound if _is_gone(self._beats.get(operator), now_s)}
            self._bound -= gone
            for operator in gone:
                self._claims.pop(operator, None)
        if gone and not self._is_idle():
            self._stop()

    def age_s(self) -> float:
        """Return the age of the oldest last beat of those whose words are done; 0 where none is late. Any thread."""
        now_s = self._now_s()
        bound = filter(None, (self._beats.get(operator) for operator in tuple(self._bound)))
        return max((_late_age_s(beats, now_s) for beats in bound), default=0.0)

    def _bind(self, operator: str, said: str, claimed_at_s: float, now_s: float) -> None:
        if said in self._texts and now_s - claimed_at_s < CLAIMED_WITHIN_S:
            self._bound.add(operator)

    def _watch(self) -> None:
        while True:
            time.sleep(LOOK_S)
            self.look()


def _is_gone(beats: Lease | None, now_s: float) -> bool:
    if beats is None:
        return True
    age_s = now_s - beats.last_beat_s
    if beats.is_stopped is None:
        return age_s > beats.term_s
    return age_s > LONGEST_S or (age_s > beats.term_s - LATE_S and beats.is_stopped())


def _late_age_s(beats: Lease, now_s: float) -> float:
    age_s = now_s - beats.last_beat_s
    return age_s if beats.is_stopped is not None and age_s > beats.term_s - 2.0 * LATE_S else 0.0
