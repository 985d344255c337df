"""An exported program is a whole workspace."""

from __future__ import annotations

import ast
import os
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from chatrobot.core.errors import InputError
from chatrobot.programs.export import export, package_name, workspace
from chatrobot.programs.library import KeptProgram, Provenance
from tests.programs.replies import NODE

PROGRAM = KeptProgram("square dance", NODE, provenance=Provenance('dance <fast> & "well"'))
ROOT = "src/square_dance"


def test_the_workspace_is_whole() -> None:
    assert set(workspace(PROGRAM)) == {
        "build_run.sh",
        f"{ROOT}/package.xml",
        f"{ROOT}/setup.py",
        f"{ROOT}/setup.cfg",
        f"{ROOT}/resource/square_dance",
        f"{ROOT}/launch/square_dance.launch.py",
        f"{ROOT}/square_dance/__init__.py",
        f"{ROOT}/square_dance/program.py",
    }


def test_every_python_file_is_python() -> None:
    for path, text in workspace(PROGRAM).items():
        if path.endswith(".py"):
            ast.parse(text)


def test_the_package_names_what_the_program_imports() -> None:
    root = ElementTree.fromstring(workspace(PROGRAM)[f"{ROOT}/package.xml"])
    assert [found.text for found in root.findall("exec_depend")] == [
        "rclpy",
        "geometry_msgs",
        "launch",
        "launch_ros",
    ]
    assert root.findtext("description") == 'dance <fast> & "well"'


def test_a_main_is_the_entry_point_and_a_plain_script_is_run_as_one() -> None:
    assert "square_dance.program:main" in workspace(PROGRAM)[f"{ROOT}/setup.py"]
    script = KeptProgram("square dance", "import rclpy\nrclpy.init()\n")
    assert "square_dance.run:main" in workspace(script)[f"{ROOT}/setup.py"]
    assert f"{ROOT}/square_dance/run.py" in workspace(script)


def test_a_main_that_wants_arguments_is_no_entry_point() -> None:
    program = KeptProgram("x", "def main(speed):\n    pass\n")
    assert "x.run:main" in workspace(program)["src/x/setup.py"]


def test_an_agreed_remap_stands_in_the_launch_file() -> None:
    program = KeptProgram("square dance", NODE, remap={"/turtle1/cmd_vel": "cmd_vel"})
    assert "[('/turtle1/cmd_vel', 'cmd_vel')]" in workspace(program)[f"{ROOT}/launch/square_dance.launch.py"]


@pytest.mark.parametrize(
    ("name", "package"),
    [
        ("Square Dance!", "square_dance"),
        ("方块舞", "robot_program"),
        ("2 laps", "robot_program_2_laps"),
        ("a--b", "a_b"),
        ("rclpy", "robot_program_rclpy"),
    ],
)
def test_the_package_has_a_name_that_ros_takes(name: str, package: str) -> None:
    assert package_name(name) == package


def test_build_run_is_a_script_that_can_be_started(tmp_path: Path) -> None:
    folder = export(PROGRAM, tmp_path / "ws")
    assert os.access(folder / "build_run.sh", os.X_OK)
    subprocess.run(["bash", "-n", str(folder / "build_run.sh")], check=True)


def test_nothing_is_written_over(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("x", encoding="utf-8")
    with pytest.raises(InputError, match="not empty"):
        export(PROGRAM, tmp_path)
