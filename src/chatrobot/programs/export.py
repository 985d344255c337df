"""A program as a ROS 2 workspace of its own: a colcon package that builds and runs where only ROS is."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import escape

from chatrobot.core.errors import InputError
from chatrobot.programs.library import KeptProgram

_DEPENDENCIES = ("rclpy", "geometry_msgs", "std_msgs", "sensor_msgs", "nav_msgs", "std_srvs", "builtin_interfaces",
                 "rcl_interfaces", "turtlesim", "tf_transformations")  # fmt: skip
_RESERVED = frozenset(
    {"test", "launch", "rclpy", "geometry_msgs", "std_msgs", "sensor_msgs", "nav_msgs", "std_srvs"}
)

_PACKAGE_XML = """\
<?xml version="1.0"?>
<?xml-model href="http://download.ros.org/schema/package_format3.xsd" schematypens="http://www.w3.org/2001/XMLSchema"?>
<package format="3">
  <name>{package}</name>
  <version>0.1.0</version>
  <description>{description}</description>
  <maintainer email="you@example.com">you</maintainer>
  <license>Apache-2.0</license>

{depends}

  <exec_depend>launch</exec_depend>
  <exec_depend>launch_ros</exec_depend>

  <export>
    <build_type>ament_python</build_type>
  </export>
</package>
"""

_SETUP_PY = """\
from glob import glob

from setuptools import find_packages, setup

package_name = '{package}'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='you',
    maintainer_email='you@example.com',
    description={description!r},
    license='Apache-2.0',
    entry_points={{
        'console_scripts': [
            '{executable} = {package}.run:main',
        ],
    }},
)
"""

_SETUP_CFG = """\
[develop]
script_dir=$base/lib/{package}
[install]
install_scripts=$base/lib/{package}
"""

_LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(
            package='{package}',
            executable='{executable}',
            output='screen',
            remappings={remappings!r},
        ),
    ])
"""

_RUN = '''\
"""Runs the program. Ctrl-C ends it as it ends ROS's own nodes, with exit code 0."""
{imports}
import signal
import sys
import time

REPEATS_S = 2.0  # `ros2 launch` sends a second Ctrl-C, which must not break off what the program does as it ends


def main():
    interrupted_s = None

    def interrupt(_number, _frame):
        nonlocal interrupted_s
        if interrupted_s is None:
            interrupted_s = time.monotonic()
        elif time.monotonic() - interrupted_s < REPEATS_S:
            return
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    try:
{call}
    except KeyboardInterrupt:
        return 0
    except Exception as error:
        if interrupted_s is None and not shut_down(error):
            raise
        print(f'It was asked to end; as it ended: {{error}}', file=sys.stderr)
        return 0
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def shut_down(error):
    """Whether it ended because ROS was shut down around it (SIGTERM)."""
    while error is not None and type(error).__name__ != 'ExternalShutdownException':
        error = error.__context__
    return error is not None
'''

_CALLS = {
    True: ("", "        from {package}.program import main as run\n        return run()"),
    False: ("import runpy", "        runpy.run_module('{package}.program', run_name='__main__')"),
}
"""Imports and the call, by whether the program has a `main`; one without is run as `python program.py` would."""

_BUILD_RUN = """\
#!/usr/bin/env bash
# Builds the package and runs it. Source your ROS 2 first: source /opt/ros/<distribution>/setup.bash
set -e
cd "$(dirname "$0")"
colcon build --packages-select {package}
source install/setup.bash
ros2 run {package} {executable} "$@"
"""


def package_name(name: str) -> str:
    """Return a name that colcon and ROS take: lower case letters, digits and single underscores, a letter first."""
    slug = re.sub(r"_+", "_", re.sub(r"[^a-z0-9]+", "_", name.casefold())).strip("_")
    if not slug or not slug[0].isalpha() or slug in _RESERVED:
        slug = f"robot_program_{slug}".rstrip("_")
    return slug


def export(program: KeptProgram, folder: Path) -> Path:
    """Write the workspace into `folder` (new, or empty) and return it.

    Raises:
        InputError: there is something in that folder already.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder} is not empty", where="export", allowed="a new or an empty folder")
    for path, text in workspace(program).items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    (folder / "build_run.sh").chmod(0o755)
    return folder


def workspace(program: KeptProgram) -> Mapping[str, str]:
    """Return the files of the workspace by their paths in it."""
    package = package_name(program.name)
    imports, call = _CALLS[_has_main(program.source)]
    words = {"package": package, "executable": package, "description": _description(program)}
    remappings = [(topic, target) for topic, target in program.remap.items()]
    root = f"src/{package}"
    return {
        "build_run.sh": _BUILD_RUN.format(**words),
        f"{root}/package.xml": _PACKAGE_XML.format(
            package=package, description=escape(words["description"]), depends=_depends(program.source)
        ),
        f"{root}/setup.py": _SETUP_PY.format(**words),
        f"{root}/setup.cfg": _SETUP_CFG.format(**words),
        f"{root}/resource/{package}": "",
        f"{root}/launch/{package}.launch.py": _LAUNCH.format(remappings=remappings, **words),
        f"{root}/{package}/__init__.py": "",
        f"{root}/{package}/program.py": program.source,
        f"{root}/{package}/run.py": _RUN.format(imports=imports, call=call.format(package=package)),
    }


def _description(program: KeptProgram) -> str:
    said = program.provenance.sentence or program.description or program.name
    return " ".join(said.split())[:200]


def _depends(source: str) -> str:
    used = {name.split(".")[0] for name in _imported(source)} | {"rclpy"}
    return "\n".join(f"  <exec_depend>{name}</exec_depend>" for name in _DEPENDENCIES if name in used)


def _imported(source: str) -> set[str]:
    try:
        tree = ast.parse(source)
    except SyntaxError:
        return set(_DEPENDENCIES)
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
    return names


def _has_main(source: str) -> bool:
    """A `main` at the top that can be called without arguments, as console scripts are."""
    try:
        tree = ast.parse(source)
    except SyntaxError:
        return False
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and node.name == "main":
            return len(node.args.args) + len(node.args.posonlyargs) <= len(node.args.defaults)
    return False
