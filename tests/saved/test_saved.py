"""What a user of release 0.1 has saved, installed and written against its names works unchanged.

`config` is a config folder that release 0.1 wrote, `packages` a package of somebody else's that it loaded, `names.toml`
what it called things.
"""

from __future__ import annotations

import ast
import dataclasses
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from chatrobot.cli.console.chat import _history
from chatrobot.core import events, wiring
from chatrobot.core.event import _TYPES
from chatrobot.dialogue.places import Places
from chatrobot.link import topic_link as topics
from chatrobot.models import providers
from chatrobot.models.config import ModelConfig, resolve
from chatrobot.options import PARAMETERS
from chatrobot.plan import primitive
from chatrobot.programs.library import Library
from chatrobot.robots import load
from chatrobot.robots.load import load_profile
from chatrobot.wire import connect

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
NAMES = tomllib.loads((HERE / "names.toml").read_text(encoding="utf-8"))
ROBOT = "wheeltec_mini_mec"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(HERE / "config", tmp_path / "config"))


def test_places_are_known(folder: Path) -> None:
    places = Places(folder, ROBOT, "22485bfaa7234047ad28c9b728e58093").all()
    assert places.keys() == {"window", "书桌"}
    assert places["window"].usable
    assert places["window"].pose.x_m == pytest.approx(0.5, abs=1e-3)


def test_a_program_that_was_edited_is_kept_with_its_runs_and_runs_again(folder: Path) -> None:
    program = Library(folder).get("small square")
    assert (program.provenance.by, program.provenance.versions) == ("person", 2)
    assert [run.outcome for run in program.runs] == ["completed", "completed"]
    chatrobot("program", "run", "small square", "--fast", "--yes", "--config-dir", str(folder))
    assert [run.outcome for run in Library(folder).get("small square").runs] == ["completed"] * 3


def test_what_was_typed_and_the_model_that_was_chosen_are_known(folder: Path) -> None:
    assert [*_history(folder / "history").load_history_strings()] == [
        "two\nlines",
        "这里叫书桌",
        "forward 50 cm",
    ]
    choice = resolve("", ModelConfig(folder, environ={}))
    assert choice is not None
    assert choice.name == "ollama:qwen3"


def test_profiles_and_the_calibration_in_them_are_known(folder: Path) -> None:
    calibrated = load_profile(ROBOT, [folder / "robots"]).calibration
    assert (calibrated.distance_scale, calibrated.turn_scale) == (0.97, 1.0)
    assert load_profile("my_robot", [folder / "robots"]).title == "My robot"


def test_another_packages_profile_primitive_and_provider_are_found() -> None:
    found = python(
        "from chatrobot.models.providers import providers; from chatrobot.plan.text import format_plan, parse_plan;"
        "from chatrobot.robots.load import load_profile;"
        "print(load_profile('acme_one').title, format_plan(parse_plan('wiggle 3')), providers()['acme'].title)"
    )
    assert found == "Acme One wiggle 3 Acme\n"


def test_groups_and_topics_have_their_names() -> None:
    groups = {primitive.ENTRY_POINT_GROUP, load.ENTRY_POINT_GROUP, providers.ENTRY_POINTS}
    assert groups == {*NAMES["entry_point_groups"].split()}
    assert connect.ENTRY_POINT_GROUP == "chatrobot.wires"
    ours = {value for module in (topics, wiring) for value in vars(module).values() if isinstance(value, str)}
    assert ours >= {*NAMES["topics"].split()}


@pytest.mark.parametrize("node", NAMES["parameters"])
def test_ros_parameters_have_their_names(node: str) -> None:
    assert {parameter.name for parameter in PARAMETERS[node]} >= {*NAMES["parameters"][node].split()}


@pytest.mark.parametrize("name", NAMES["events"])
def test_json_lines_have_their_keys(name: str) -> None:
    assert events.Event in _TYPES[name].__mro__
    assert {field.name for field in dataclasses.fields(_TYPES[name])} >= {*NAMES["events"][name].split()}


def test_reasons_have_their_codes() -> None:
    """Every code stands as a text in the code, be it in a `Reason` or as a constant."""
    texts = {
        node.value
        for file in (ROOT / "src" / "chatrobot").rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    assert not {*NAMES["reasons"]["codes"].split()} - texts


def chatrobot(*words: str) -> None:
    subprocess.run([sys.executable, "-m", "chatrobot", *words], check=True, stdin=subprocess.DEVNULL)


def python(code: str) -> str:
    """What it prints where that package is installed."""
    path = os.pathsep.join([str(HERE / "packages"), str(ROOT / "src")])
    env = {**os.environ, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, env=env
    ).stdout
