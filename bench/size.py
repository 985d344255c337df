"""What an install weighs: distributions and megabytes of the core, megabytes of memory of each process.

Run: python -m bench.size (makes a fresh virtual environment; takes a minute)
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.processes import RunningRobot

ROOT = Path(__file__).parent.parent


def installed(folder: Path) -> tuple[int, float]:
    """Distributions and megabytes, bytecode included, of a core install (pip and setuptools aside)."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    pip = [str(folder / "bin" / "python"), "-m", "pip", "--disable-pip-version-check"]
    subprocess.run([*pip, "install", "-q", str(ROOT)], check=True, stderr=subprocess.DEVNULL)
    listed = subprocess.run(
        [*pip, "list", "--format=freeze"], check=True, capture_output=True, text=True
    ).stdout
    names = [line.split("==")[0] for line in listed.splitlines()]
    ours = [name for name in names if name not in ("pip", "setuptools")]
    packages = next((folder / "lib").glob("python*/site-packages"))
    own_tools = ("pip", "setuptools", "pkg_resources", "_distutils_hack")
    size = sum(
        path.stat().st_size
        for path in packages.rglob("*")
        if path.is_file() and not path.relative_to(packages).parts[0].startswith(own_tools)
    )
    return len(ours), size / 1e6


def resident_mb(pid: int) -> float:
    """Resident memory of a process, megabytes."""
    for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    raise ValueError(f"process {pid} has no memory")


def processes(folder: Path) -> dict[str, float]:
    """Resident megabytes of the four processes of a session."""
    robot = RunningRobot(folder)
    try:
        robot.say("forward 10 cm")
        robot.wait_for_event("result")
        wire = robot.wire_path
        found = {"console": resident_mb(robot.process.pid), "Motion": resident_mb(robot.motion_pid)}
        for entry in os.listdir("/proc"):
            if entry.isdigit():
                words = (Path("/proc") / entry / "cmdline").read_bytes().split(b"\0")
                if str(wire).encode() in words:
                    for name, module in (
                        ("guard", b"chatrobot.guard"),
                        ("simulated robot", b"chatrobot.sim"),
                    ):
                        if module in words:
                            found[name] = resident_mb(int(entry))
        return found
    finally:
        robot.close()


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        for process, megabytes in processes(Path(name) / "robot").items():
            print(f"memory of {process:20s} {megabytes:7.1f} MB")
        count, megabytes = installed(Path(name) / "venv")
        print(f"core install: {count} distributions, {megabytes:.0f} MB")


if __name__ == "__main__":
    main()
