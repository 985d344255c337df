"""Who may send a velocity is counted: in the source, and on a real DDS domain (tests/nodes/test_release.py)."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import chatrobot
from chatrobot.guard import __main__ as guard_process
from chatrobot.link.envelope import PAYLOADS
from chatrobot.wire.messages import TwistMessage

SOURCE = Path(chatrobot.__file__).parent
WRITERS = {"motion/safety/stop.py", "guard/__main__.py", "link/in_process.py"}
"""The transport; the guard, which knows zeros alone; the guard's rule on simulated time."""

CARRIERS = {"motion/safety/connection_monitor.py", "sim/network_wire.py", "sim/robot.py"}
"""Hand on what they were given: a wire around a wire, and the robot's own end with its sensors."""

OTHER_GRAPHS = (
    "programs/",
    "motion/programs/rehearsal_environment.py",
    "motion/programs/execution.py",
    "testing/",
    "wire/",
)
"""The test kit has robots of its own.
A program publishes to the box it is in, and what it holds is governed like anything else; a backend is a wire."""

HARMLESS = {"Text", "Flag", "Odometry"}


def calls(attribute: str) -> Iterator[tuple[str, ast.Call]]:
    for path in SOURCE.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        if f".{attribute}(" not in text:
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == attribute:
                yield path.relative_to(SOURCE).as_posix(), node


def test_the_writers_of_velocities_are_counted() -> None:
    found = defaultdict(int)
    for file, call in calls("publish"):
        made = call.args[1] if len(call.args) > 1 else None
        kind = getattr(getattr(made, "func", made), "id", "?")
        if (
            not file.startswith(OTHER_GRAPHS)
            and file not in CARRIERS
            and kind not in HARMLESS
            and kind != "text"
        ):
            found[file] += 1
    assert set(found) == WRITERS
    assert found == {"motion/safety/stop.py": 3, "guard/__main__.py": 1, "link/in_process.py": 1}


def test_the_guard_can_make_no_velocity_but_zero() -> None:
    sent = [call.args[1] for file, call in calls("publish") if file.startswith("guard/")]
    assert [ast.unparse(message) for message in sent] == ["ZERO"]
    for file in (SOURCE / "guard").glob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        assert not [
            node
            for node in ast.walk(tree)
            if getattr(getattr(node, "func", None), "id", "") == "TwistMessage"
        ]
        assert not [node for node in ast.walk(tree) if getattr(node, "id", "") == "ZERO" and is_stored(node)]
    assert TwistMessage(0.0, 0.0, 0.0) == guard_process.ZERO


def is_stored(node: ast.AST) -> bool:
    return isinstance(getattr(node, "ctx", None), ast.Store)


def test_every_word_that_the_source_sends_is_listed_with_all_its_fields() -> None:
    seen = set()
    for attribute in ("send", "envelope"):
        for file, call in calls(attribute):
            word = call.args[0] if call.args else None
            if isinstance(word, ast.Constant) and isinstance(word.value, str) and word.value in PAYLOADS:
                fields = {keyword.arg for keyword in call.keywords} - {None, "turn"}
                assert fields <= set(PAYLOADS[word.value]), f"{file}:{call.lineno}"
                seen.add(word.value)
            elif isinstance(word, ast.Constant) and isinstance(word.value, str) and call.keywords:
                raise AssertionError(
                    f"{file}:{call.lineno} sends {word.value!r}, which is no word of an envelope"
                )
    assert {"hello", "beat", "plan", "stop", "emergency_stop", "release", "goodbye", "approve"} <= seen
