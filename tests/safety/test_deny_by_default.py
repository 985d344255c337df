"""What is not listed as allowed is refused: everything that is not listed is sent."""

from __future__ import annotations

import itertools
import json
import keyword
import math
import string
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from chatrobot.core.errors import PlanTextError
from chatrobot.link.envelope import MODES, PAYLOADS, WORDS, Envelope
from chatrobot.plan.primitive import RESERVED_VERBS, primitives
from chatrobot.plan.text import parse_plan
from tests.link.link_rigs import SimulatedRig, finished, send_plan

GOOD: dict[str, dict[str, Any]] = {
    "hello": {"term_s": 0.3, "process": "boot pid:[1] 2 3", "protocol": 2},
    "beat": {"term_s": 0.3, "process": "boot pid:[1] 2 3", "protocol": 2, "age_s": 0.1},
    "plan": {
        "plan_text": "drive 1 m",
        "mode": "queue",
        "approve": False,
        "rehearse_only": False,
        "term_s": 0.3,
        "protocol": 2,
        "longest_s": 10,
        "instead_of": 3,
        "tries": True,
        "more": False,
        "pauses": 0,
    },
    "look": {},
    "watch": {"scans": True},
    "steer": {"vx_mps": 0.5, "vy_mps": -0.5, "wz_radps": 0},
    "program": {
        "code": "pass\n",
        "name": "square",
        "remap": {},
        "args": [],
        "mode": "queue",
        "approve": False,
        "ask_findings": True,
        "strict": True,
        "rehearse_only": False,
        "term_s": 0.3,
        "protocol": 2,
        "pauses": 0,
    },
    "approve": {"yes": True, "edited": True},
    "stop": {"why": "x", "keep": True},
    "resume": {},
    "rescale": {"linear_factor": 0.5, "angular_factor": 0.5},
    "cancel": {},
    "emergency_stop": {"why": "x"},
    "release": {},
    "limit": {"max_distance_m": 1, "max_time_s": "none"},
    "obstacle": {
        "add": "box",
        "circle": [1.0, 0.5, 0.2],
        "polygon": [[0, 0], [1, 0], [0, 1]],
        "remove": "box",
    },
    "goodbye": {},
}
FIELDS = sorted({field for fields in PAYLOADS.values() for field in fields})
VALUES: list[Any] = [
    None, True, False, 0, 1, -1, 10**400, 0.5, -0.5, math.nan, math.inf, -math.inf, "", "x", "queue", "now", [],
    ["queue"], {}, {"a": 1},
]  # fmt: skip
ALLOWED: dict[str, list[Any]] = {
    "term_s": [1, 10**400, 0.5],
    "longest_s": [1, 10**400, 0.5],
    "age_s": [0, 1, 10**400, 0.5],
    "process": ["", "x", "queue", "now"],
    "protocol": [0, 1, 10**400],
    "instead_of": [0, 1, 10**400],
    "tries": [False, True],
    "plan_text": ["", "x", "queue", "now"],
    "code": ["", "x", "queue", "now"],
    "name": ["", "x", "queue", "now"],
    "remap": [{}],
    "args": [[], ["queue"]],
    "ask_findings": [True, False],
    "strict": [True, False],
    "why": ["", "x", "queue", "now"],
    "mode": ["queue"],
    "approve": [True, False],
    "rehearse_only": [True, False],
    "yes": [True, False],
    "edited": [True, False],
    "more": [True, False],
    "keep": [True, False],
    "pauses": [0, 1, 10**400],
    "scans": [True, False],
    "linear_factor": [1, 0.5],
    "angular_factor": [1, 0.5],
    "vx_mps": [0, 1, -1, 0.5, -0.5],
    "vy_mps": [0, 1, -1, 0.5, -0.5],
    "wz_radps": [0, 1, -1, 0.5, -0.5],
    "max_distance_m": [1, 0.5],
    "max_time_s": [1, 0.5],
    "add": ["", "x", "queue", "now"],
    "remove": ["", "x", "queue", "now"],
    "circle": [[]],
    "polygon": [[]],
}
STOPS = ("stop", "emergency_stop")


def packet(word: Any, payload: Any, **more: Any) -> bytes:
    fields = {"word": word, "source": "console", "lease": "l", "sequence": 1, "turn": 0, "payload": payload}
    return json.dumps({**fields, **more}).encode()


def same(a: Any, b: Any) -> bool:
    return type(a) is type(b) and a == b


def test_every_word_and_field_of_the_list_is_known_to_this_test() -> None:
    assert set(GOOD) == set(WORDS)
    assert all(set(GOOD[word]) == set(PAYLOADS[word]) for word in WORDS)
    assert set(ALLOWED) == set(FIELDS)


@pytest.mark.parametrize("word", WORDS)
def test_what_is_listed_is_taken(word: str) -> None:
    envelope = Envelope.from_bytes(packet(word, GOOD[word]))
    assert envelope is not None
    assert envelope.payload == GOOD[word]
    assert Envelope.from_bytes(packet(word, {})) is not None


def test_every_word_that_is_not_listed_is_refused() -> None:
    words = [*keyword.kwlist, *map("".join, itertools.product(string.ascii_lowercase, repeat=2))]
    words += [
        change(word) for word in WORDS for change in (str.upper, str.title, str.strip) if change(word) != word
    ]
    words += [f"{word} " for word in WORDS] + [f" {word}" for word in WORDS] + [word[:-1] for word in WORDS]
    words += ["move", "velocity", "twist", "cmd_vel", "widen", "set_limits", "unlatch", "override", ""]
    for word in words:
        assert Envelope.from_bytes(packet(word, {})) is None, word
    for odd in VALUES:
        assert Envelope.from_bytes(packet(odd, {})) is None, odd


@pytest.mark.parametrize("word", [word for word in WORDS if word not in STOPS])
def test_every_field_and_value_that_is_not_listed_is_refused(word: str) -> None:
    for field, value in itertools.product(
        [*FIELDS, "max_speed_mps", "limits", "priority", "force", ""], VALUES
    ):
        listed = field in PAYLOADS[word] and any(same(value, allowed) for allowed in ALLOWED[field])
        taken = Envelope.from_bytes(packet(word, {**GOOD[word], field: value}))
        assert (taken is not None) == listed, (field, value)
    for odd in VALUES:
        if odd != {} and not isinstance(odd, dict):
            assert Envelope.from_bytes(packet(word, odd)) is None, odd


@pytest.mark.parametrize("word", STOPS)
def test_a_stop_is_obeyed_whatever_hangs_on_it(word: str) -> None:
    for payload in ({"why": 7}, {"unheard": "of"}, [], None, "x", {"why": "x", "limits": {}}):
        envelope = Envelope.from_bytes(packet(word, payload))
        assert envelope is not None
        assert (envelope.word, envelope.payload) == (word, {})


@pytest.mark.parametrize("field", ["source", "lease", "sequence", "turn"])
def test_the_address_of_an_envelope_has_the_right_kind_of_values(field: str) -> None:
    for value in VALUES:
        kind = str if field in ("source", "lease") else int
        assert (Envelope.from_bytes(packet("beat", {}, **{field: value})) is not None) == (
            type(value) is kind
        )


def test_more_or_less_than_an_envelope_is_none() -> None:
    assert Envelope.from_bytes(packet("beat", {}, priority=3)) is None
    assert Envelope.from_bytes(b'{"word":"beat","source":"x","lease":"y"}') is None
    assert Envelope.from_bytes(b"[" * 100_000) is None
    assert Envelope.from_bytes(packet("beat", {}) + b"x") is None


def unlisted_verbs() -> Iterator[str]:
    listed = {primitive.verb for primitive in primitives()} | RESERVED_VERBS
    for word in (
        *keyword.kwlist, *map("".join, itertools.product(string.ascii_lowercase, repeat=2)), "exec", "import", "shell",
        "run", "fly", "publish", "cmd_vel", "set", "limit", "limits", "speed", "unlock", "release", "override", "eval",
        "sudo", "rm", "motor", "pwm", "faster", "disable", "governor", "include", "load", "call", "topic", "service",
    ):  # fmt: skip
        if word not in listed:
            yield word
    for verb in listed:
        yield from (verb + "s", verb + verb, "x" + verb)


def test_every_plan_verb_that_is_not_registered_is_refused() -> None:
    verbs = list(unlisted_verbs())
    assert len(verbs) > 700
    for verb in verbs:
        for rest in ("", " 1 m", " forward 1 m", ' "x"', "(1)", " = 1"):
            with pytest.raises(PlanTextError):
                parse_plan(verb + rest)


@pytest.mark.parametrize(
    "key", ["max_speed_mps", "limits", "speed_mps", "governor", "fence", "blind_speed_mps"]
)
def test_no_plan_text_sets_a_limit(key: str) -> None:
    for text in (
        f"{key} 99",
        f"{key} = 99",
        f"drive 1 m {key} 99",
        f"drive 1 m with {key}=99",
        f"set {key} 99",
    ):
        with pytest.raises(PlanTextError):
            parse_plan(text)


def test_words_beyond_the_limits_are_refused_however_they_are_put(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    for turn, text in enumerate(
        ("drive 1 m at 1.01 m/s", "drive 1 m at 99 m/s", "turn left 90 deg at 9 rad/s"), 1
    ):
        send_plan(rig, turn, text)
        assert finished(rig, turn).outcome == "refused"
    assert not any(any(velocity) for velocity in rig.velocities)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("code", "x" * 60_001),
        ("name", "x" * 61),
        ("remap", {"a": 1}),
        ("remap", {"a": "x" * 201}),
        ("remap", {str(number): "x" for number in range(9)}),
    ],
)
def test_a_program_that_is_too_large_is_refused(field: str, value: Any) -> None:
    assert Envelope.from_bytes(packet("program", {**GOOD["program"], field: value})) is None


def test_an_unlisted_mode_is_refused() -> None:
    assert MODES == ("queue", "replace", "append", "extend")
    for mode in ("", "now", "QUEUE", "force"):
        assert Envelope.from_bytes(packet("plan", {"plan_text": "drive 1 m", "mode": mode})) is None
