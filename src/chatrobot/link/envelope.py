"""The one envelope of the link: what Understanding's half says to Motion's half, whatever carries it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from chatrobot.core.reason import Reason
from chatrobot.programs.ros_args import MOST_ARGS, MOST_CHARS
from chatrobot.robots.profile import read_limit

PROTOCOL = 4
"""What both halves have to agree on, in the greeting of each. Another number where one half could misunderstand the
other; a stop is understood by all of them. Halves that say none are of release 0.1, and have number 1."""

Word = Literal[
    # {"term_s", "process", "protocol"}: opens the lease. `process` (core/process.py) is who beats, so that a beat which
    # a busy machine keeps back is told from a process that is stopped
    "hello",
    # {…, "age_s"}: keeps it; any word that names its term opens it for a Motion that came after the hello. `age_s`: how
    # long ago whoever gave the order was heard, where that is somebody else
    "beat",
    # {"plan_text", "mode", "more": bool, "approve": bool, "rehearse_only": bool, "longest_s": …, "instead_of": turn,
    # "tries": bool}:
    # `instead_of` is a turn that still has to wait, and is not done; where it waits no more, the plan is refused;
    # `tries`: with the mode `replace`, what is driven goes on where this plan is refused
    "plan",
    "look",  # asks for a `looked` event of this turn
    "watch",  # {"scans": bool}: a display wants `scan` events, or no more
    # {"vx_mps", "vy_mps", "wz_radps"}: a person's stick as it is held now, said anew many times a second while it is;
    # a zero, also one that is left out, lets go
    "steer",
    # {"code", "name", "remap": {from: to}, "args": [text], "mode", "approve", "ask_findings", "strict",
    # "rehearse_only"}
    "program",
    "approve",  # {"yes": bool, "edited": bool} answers a Rehearsed event that needs approval; edited: by another plan
    "stop",  # {"why": …, "keep": bool}; makes void what belongs to this turn and those before. keep: a pause
    "resume",  # {}: go on with the plan of this turn, which was paused
    # {"linear_factor", "angular_factor"}: go on with the plan of this turn so many times as fast
    "rescale",
    "cancel",  # {}: end the plan or program of this turn; others, running or queued, go on
    "emergency_stop",
    "release",
    "limit",  # {"max_distance_m", "max_time_s": number or "none"}; changes the motion budget, empty: asks for it
    # {"add": name, "circle": [x, y, radius]}, {"add": name, "polygon": [[x, y], …]} or {"remove": name}: an obstacle in
    # the simulation, metres in `odom`
    "obstacle",
    "goodbye",  # an orderly end: what is queued is still done, then the lease ends
]
OBSTACLE_RADIUS_M = 0.2
"""Of an obstacle that somebody puts there without saying how large it is."""
MODES = ("queue", "replace", "append", "extend")
"""What becomes of what runs already. `extend`: the next part of a plan of this very turn that was sent with `more`; the
part without `more` is the last and may be empty. What is to be approved, or only rehearsed, comes whole. `pauses`:
how many pauses its source had said before it; where Motion has heard more of them, one has overtaken it."""


STOP_COMMAND, STOP_TOPIC = "chatrobot stop", "chatrobot/stop"
"""The sources of stops that nobody says to a conversation."""
QUEUE_LIMIT = 10
"""What may wait while the robot moves, on either side; one more is refused rather than done in an hour."""
MOST_CHARACTERS = 65_536
"""Of one text; a reader of lines may have cut what is longer, so nothing of it is done."""

MOST_TIMES_AS_FAST = 100.0
"""Of a plan under way; its limits hold anyway, and this keeps infinities out of the arithmetic."""
MAX_CODE_CHARS = 60_000
"""Of a program in an envelope: a thousand lines and more, and it still fits into one packet."""
_MAX_REMAPS = 8
_Check = Callable[[object], bool]


def _text(most_chars: float = math.inf) -> _Check:
    return lambda value: isinstance(value, str) and len(value) <= most_chars


def _seconds(*, with_zero: bool) -> _Check:
    def is_seconds(value: object) -> bool:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return is_number and (value >= 0.0 if with_zero else value > 0.0) and value < math.inf  # type: ignore[operator]

    return is_seconds


_MOST_ASKED = 1e6


def _is_speed(value: object) -> bool:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_number and -_MOST_ASKED <= value <= _MOST_ASKED  # type: ignore[operator]


def _is_factor(value: object) -> bool:
    return _is_speed(value) and 0.0 < float(str(value)) <= MOST_TIMES_AS_FAST


def _is_limit(value: object) -> bool:
    try:
        return read_limit(value) > 0.0
    except ValueError:
        return False


def _is_count(value: object) -> bool:
    return type(value) is int and value >= 0


def _is_remap(value: object) -> bool:
    is_name = _text(200)
    return (
        isinstance(value, dict)
        and len(value) <= _MAX_REMAPS
        and all(is_name(name) for pair in value.items() for name in pair)
    )


def _is_args(value: object) -> bool:
    """A program's command line, short enough that source and arguments fit into one packet."""
    return (
        isinstance(value, list)
        and len(value) <= MOST_ARGS
        and all(isinstance(argument, str) for argument in value)
        and sum(map(len, value)) <= MOST_CHARS
    )


MOST_CORNERS = 64


def _are_numbers(value: object) -> bool:
    return isinstance(value, list) and len(value) <= 3 and all(map(_is_speed, value))


def _are_points(value: object) -> bool:
    return isinstance(value, list) and len(value) <= MOST_CORNERS and all(map(_are_numbers, value))


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


_GREETING: Mapping[str, _Check] = {
    "term_s": _seconds(with_zero=False),
    "process": _text(200),
    "protocol": _is_count,
}
_GOAL: Mapping[str, _Check] = {
    "mode": lambda value: value in MODES,
    "approve": _is_flag,
    "rehearse_only": _is_flag,
    "pauses": _is_count,
    "term_s": _GREETING["term_s"],
    "protocol": _is_count,
}
PAYLOADS: Mapping[str, Mapping[str, _Check]] = {
    "hello": _GREETING,
    "beat": {**_GREETING, "age_s": _seconds(with_zero=True)},
    "plan": {
        **_GOAL,
        "plan_text": _text(),
        "more": _is_flag,
        "longest_s": _seconds(with_zero=False),
        "instead_of": _is_count,
        "tries": _is_flag,
    },
    "look": {},
    "watch": {"scans": _is_flag},
    "steer": {"vx_mps": _is_speed, "vy_mps": _is_speed, "wz_radps": _is_speed},
    "program": {
        **_GOAL,
        "code": _text(MAX_CODE_CHARS),
        "name": _text(60),
        "remap": _is_remap,
        "args": _is_args,
        "mode": lambda value: value in MODES and value != "extend",
        "ask_findings": _is_flag,
        "strict": _is_flag,
    },
    "approve": {"yes": _is_flag, "edited": _is_flag},
    "stop": {"why": _text(), "keep": _is_flag},
    "resume": {},
    "rescale": {"linear_factor": _is_factor, "angular_factor": _is_factor},
    "cancel": {},
    "emergency_stop": {"why": _text()},
    "release": {},
    "limit": {"max_distance_m": _is_limit, "max_time_s": _is_limit},
    "obstacle": {"add": _text(60), "remove": _text(60), "circle": _are_numbers, "polygon": _are_points},
    "goodbye": {},
}
"""All that an envelope may say, with a check for every field of its payload."""

WORDS = tuple(PAYLOADS)


@dataclass(frozen=True)
class Envelope:
    """`sequence` grows with every envelope of a source; an old one is dropped. `lease` is the source's lease id."""

    word: Word
    source: str
    lease: str
    sequence: int
    turn: int = 0
    payload: dict[str, Any] = field(default_factory=dict)

    def to_bytes(self) -> bytes:
        """Write it as one packet, or one text on a topic."""
        return _ENCODER.encode(vars(self)).encode()

    @classmethod
    def from_bytes(cls, packet: bytes) -> Envelope | None:
        """The envelope in `packet`, None where it is not one: Motion never dies of what it is sent.

        What is not listed is refused: unknown words, unknown payload fields and values of the wrong kind. A stop
        is obeyed whatever its payload, which is then left out.
        """
        try:
            envelope = cls(**_DECODER.decode(packet.decode(json.detect_encoding(packet), "surrogatepass")))
        except (ValueError, TypeError, RecursionError):
            return None
        well_formed = (
            envelope.word in WORDS
            and isinstance(envelope.source, str)
            and isinstance(envelope.lease, str)
            and type(envelope.sequence) is int
            and type(envelope.turn) is int
        )
        if not well_formed:
            return None
        if _is_allowed(envelope.word, envelope.payload):
            return envelope
        return replace(envelope, payload={}) if envelope.word in ("stop", "emergency_stop") else None


def protocol_of(greeting: Mapping[str, Any]) -> int:
    """Read the protocol of a half from what it says of itself; 1 where it says none."""
    protocol = greeting.get("protocol", 1)
    return protocol if type(protocol) is int else 1


def _each_key_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refuse a key that stands twice: which is meant would be a guess. A stop is one in any case."""
    fields = dict(pairs)
    if len(fields) < len(pairs) and fields.get("word") not in ("stop", "emergency_stop"):
        raise ValueError("a key stands twice")
    return fields


_ENCODER = json.JSONEncoder(separators=(",", ":"))
_DECODER = json.JSONDecoder(object_pairs_hook=_each_key_once)
"""Made once: `json.dumps` and `json.loads` would make one for each of the many beats."""


def _is_allowed(word: Word, payload: Any) -> bool:
    fields = PAYLOADS[word]
    return isinstance(payload, dict) and all(key in fields and fields[key](payload[key]) for key in payload)


_LONGEST_S = 1e6


def seconds(value: object, otherwise_s: float) -> float:
    """A payload's duration; `otherwise_s` where it is none."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number and 0.0 <= value <= _LONGEST_S else otherwise_s  # type: ignore[arg-type,operator]


_READY = b"ready"


def ready() -> bytes:
    """Make what Motion's process says once, when it has its robot and its guard."""
    return _READY + f" {PROTOCOL}".encode()


def read_ready(packet: bytes) -> int | None:
    """Read the protocol of a Motion that is ready; None for anything else."""
    if packet == _READY:
        return 1
    said, _, protocol = packet.partition(b" ")
    return int(protocol) if said == _READY and protocol.isdigit() else None


def other_protocol(*, motion: int, dialogue: int) -> Reason:
    """Say why the halves cannot work together."""
    return Reason("other_protocol", {"motion": motion, "dialogue": dialogue})
