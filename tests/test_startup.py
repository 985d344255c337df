"""What each process loads: Motion knows no language, the guard nothing heavy, `stop` next to nothing."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import pytest

HEAVY = "numpy", "pydantic", "yaml", "rich", "prompt_toolkit", "PIL", "platformdirs"


def loaded_by(code: str) -> set[str]:
    """The modules in a fresh interpreter after `code`."""
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\nimport sys\nprint(*sys.modules, sep='\\n')"],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    return set(done.stdout.split())


def among(names: set[str], unwanted: tuple[str, ...]) -> list[str]:
    return sorted(name for name in names if name.startswith(unwanted))


def test_motion_knows_no_language_no_model_and_no_screen() -> None:
    for process in ("chatrobot.motion.process", "chatrobot.motion.planning_process"):
        loaded = loaded_by(f"import {process}")
        assert "chatrobot.motion.planner" in loaded
        assert not among(loaded, ("chatrobot.language", "chatrobot.models", "chatrobot.cli", "chatrobot.web"))
        assert not among(loaded, ("prompt_toolkit", "rich", "chatrobot.dialogue", "starlette", "uvicorn"))


def test_the_guard_is_light() -> None:
    loaded = loaded_by("import chatrobot.guard.__main__")
    assert not among(loaded, HEAVY)
    assert not among(
        loaded,
        (
            "chatrobot.dialogue",
            "chatrobot.link",
            "chatrobot.motion",
            "chatrobot.plan",
            "chatrobot.robots",
            "chatrobot.sim",
        ),
    )


@pytest.mark.parametrize("arguments", [["stop"], ["--version"]])
def test_stop_and_help_load_nothing_heavy(arguments: list[str]) -> None:
    run = f"with contextlib.suppress(SystemExit):\n main({arguments})"
    loaded = loaded_by(f"import contextlib\nfrom chatrobot.cli.entry import main\n{run}")
    assert not among(loaded, HEAVY)
    assert not among(
        loaded,
        (
            "chatrobot.dialogue",
            "chatrobot.motion",
            "chatrobot.compose",
            "chatrobot.language",
            "chatrobot.sim",
        ),
    )


def test_who_talks_needs_no_numpy() -> None:
    """Motion computes, in a process of its own; here it would cost a tenth of a second before the first prompt."""
    loaded = loaded_by("import chatrobot.cli.do, chatrobot.cli.console.app, chatrobot.cli.console.chat")
    assert "chatrobot.dialogue.session" in loaded
    assert not among(loaded, ("numpy", "pydantic", "yaml", "PIL", "chatrobot.governor.governor"))


def test_the_robots_processes_are_started_before_the_language_is_loaded() -> None:
    loaded = loaded_by(
        "import sys\nfrom chatrobot.link.processes import Processes\n"
        "def started(*_):\n print(*sys.modules, sep='\\n', flush=True)\n raise SystemExit\n"
        "Processes.start = started\n"
        "from chatrobot.cli.entry import main\nimport contextlib\n"
        "with contextlib.suppress(SystemExit):\n main(['do', 'forward 1 m'])"
    )
    assert "chatrobot.link.processes" in loaded
    assert not among(
        loaded, ("chatrobot.language", "chatrobot.dialogue.session", "chatrobot.models", "numpy")
    )


def test_stop_does_not_even_load_the_parser_of_arguments() -> None:
    assert "argparse" not in loaded_by("from chatrobot.cli.entry import main\nmain(['stop'])")


@pytest.mark.parametrize(
    ("arguments", "most"),
    [(["stop"], 0.4), (["--help"], 1.0), (["do", "forward 1 m", "--fast", "--world", "empty"], 5.0)],
)
def test_start_up_is_quick(arguments: list[str], most: float, tmp_path: Path) -> None:
    """So many times what Python needs for numpy and asyncio, in processor time; both the best of up to 15, in turn.

    Compiled once, as installed. A machine that is slow, or busy, slows both.
    """
    environment = {**os.environ, "XDG_RUNTIME_DIR": str(tmp_path), "PYTHONPYCACHEPREFIX": str(tmp_path)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)

    def cost_s(*command: str) -> float:
        before = os.times()
        command = (sys.executable, *command)
        done = subprocess.run(command, env=environment, check=False, capture_output=True, timeout=60)
        assert done.returncode == (1 if "stop" in command else 0), "a stop that finds nothing says so"
        after = os.times()
        return after.children_user + after.children_system - before.children_user - before.children_system

    measure_s, ours_s = math.inf, math.inf
    for _ in range(15):
        measure_s = min(measure_s, cost_s("-c", "import asyncio, numpy"))
        ours_s = min(ours_s, cost_s("-m", "chatrobot", *arguments))
        if ours_s < most * measure_s:
            return
    raise AssertionError(f"{ours_s:.2f} s, {ours_s / measure_s:.1f} times {measure_s:.2f} s")


def test_importing_chatrobot_loads_nothing_yet_offers_its_names() -> None:
    loaded = loaded_by("import chatrobot")
    assert among(loaded, ("chatrobot",)) == ["chatrobot"]

    import chatrobot

    for name in chatrobot.__all__:
        assert getattr(chatrobot, name) is not None
        assert name in dir(chatrobot)
    with pytest.raises(AttributeError):
        _ = chatrobot.nonsense


def test_the_control_node_knows_no_language_either() -> None:
    loaded = loaded_by("import chatrobot.cli.node, chatrobot.nodes.control, chatrobot.robots.load")
    assert "chatrobot.motion.motion" in loaded
    assert not among(
        loaded, ("chatrobot.language", "chatrobot.models", "chatrobot.compose", "chatrobot.cli.con")
    )
    assert not among(loaded, ("prompt_toolkit", "rich", "chatrobot.dialogue"))
