"""An exported program is a whole workspace."""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
import time
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
        f"{ROOT}/square_dance/run.py",
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


@pytest.mark.parametrize(
    ("source", "called"),
    [
        (NODE, "from square_dance.program import main"),
        ("import rclpy\nrclpy.init()\n", "runpy.run_module('square_dance.program'"),
        ("def main(speed):\n    pass\n", "runpy.run_module('square_dance.program'"),
    ],
)
def test_a_main_is_called_and_a_script_or_a_main_that_wants_arguments_is_run_as_one(
    source: str, called: str
) -> None:
    files = workspace(KeptProgram("square dance", source))
    assert "square_dance.run:main" in files[f"{ROOT}/setup.py"]
    assert called in files[f"{ROOT}/square_dance/run.py"]


ENDING = """
import sys
import time


class ExternalShutdownException(Exception): ...


def main():
    try:
        print('drives', flush=True)
        while True:
            time.sleep(0.01)
    finally:
        time.sleep(0.5)
        print('told to stand', flush=True)
        {last}
"""


def run(folder: Path, source: str) -> subprocess.Popen[str]:
    """As its executable would, where only Python is."""
    root = export(KeptProgram("square dance", source), folder / "ws") / "src" / "square_dance"
    code = "import sys; from square_dance.run import main; sys.exit(main())"
    return subprocess.Popen(
        [sys.executable, "-c", code], cwd=root, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


@pytest.mark.parametrize(
    ("last", "error"),
    [
        ("pass", ""),
        ("raise RuntimeError('publisher context is invalid')", "publisher context is invalid"),
    ],
)
def test_a_second_ctrl_c_as_launch_sends_it_breaks_off_nothing(tmp_path: Path, last: str, error: str) -> None:
    process = run(tmp_path, ENDING.format(last=last))
    assert process.stdout is not None
    assert process.stdout.readline() == "drives\n"
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.1)
    out, err = process.communicate(timeout=20.0)
    assert (out, process.returncode) == ("told to stand\n", 0)
    assert "Traceback" not in err
    assert error in err


def test_what_breaks_by_itself_is_shown_as_ever(tmp_path: Path) -> None:
    process = run(tmp_path, "def main():\n    raise RuntimeError('oh')\n")
    _, err = process.communicate(timeout=20.0)
    assert process.returncode == 1
    assert "Traceback" in err


def test_a_program_around_which_ros_is_shut_down_ends_in_order(tmp_path: Path) -> None:
    source = ENDING.replace("time.sleep(0.01)", "raise ExternalShutdownException").format(
        last="raise RuntimeError('rcl_shutdown already called')"
    )
    process = run(tmp_path, source)
    _, err = process.communicate(timeout=20.0)
    assert process.returncode == 0
    assert "Traceback" not in err


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
