"""The wheel is whole: what is built from this tree runs in an environment that has nothing of it."""

from __future__ import annotations

import json
import subprocess
import sys
import sysconfig
import venv
import zipfile
from collections.abc import Iterator
from email.message import Message
from email.parser import Parser
from pathlib import Path

import pytest

from tests.cli.running import environment

ROOT = Path(__file__).parent.parent
SOURCE = ROOT / "src"
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-deps"]
    subprocess.run([*command, "--wheel-dir", str(folder), str(ROOT)], check=True, timeout=300.0)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def metadata(wheel: Path) -> Message:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        return Parser().parsestr(archive.read(name).decode("utf-8"))


def files_of_the_source() -> Iterator[str]:
    for file in (SOURCE / "chatrobot").rglob("*"):
        if file.is_file() and "__pycache__" not in file.parts:
            yield str(file.relative_to(SOURCE))


def test_it_has_every_file_of_the_source_and_no_other(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        found = {name for name in archive.namelist() if ".dist-info/" not in name}
    assert found == set(files_of_the_source())
    assert "chatrobot/py.typed" in found


def test_an_index_can_show_what_it_is(metadata: Message) -> None:
    assert metadata["Description-Content-Type"] == "text/markdown"
    assert str(metadata.get_payload()) == (ROOT / "README.md").read_text(encoding="utf-8")
    assert metadata["License-Expression"] == "Apache-2.0"
    assert metadata["Summary"]
    classifiers = metadata.get_all("Classifier") or []
    assert {"Operating System :: POSIX :: Linux", "Typing :: Typed"} <= set(classifiers)
    assert (
        f"Programming Language :: Python :: {sys.version_info.major}.{sys.version_info.minor}" in classifiers
    )


def test_installed_alone_it_drives(wheel: Path, tmp_path: Path) -> None:
    venv.create(tmp_path / "venv", with_pip=True)
    python = tmp_path / "venv" / "bin" / "python"
    command = [
        str(python),
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--no-deps",
        str(wheel),
    ]
    subprocess.run(command, check=True, timeout=300.0)
    # What it depends on comes from here; this tree does not, for a .pth file within a .pth file is not read.
    where = [str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    site = subprocess.run(where, capture_output=True, text=True, check=True).stdout.strip()
    (Path(site) / "dependencies.pth").write_text(sysconfig.get_path("purelib"), encoding="utf-8")
    outside = {key: value for key, value in environment(tmp_path).items() if key != "PYTHONPATH"}
    origin = subprocess.run(
        [str(python), "-c", "import chatrobot; print(chatrobot.__file__)"],
        capture_output=True, text=True, check=True, cwd=tmp_path, env=outside,
    )  # fmt: skip
    assert origin.stdout.startswith(site)
    done = subprocess.run(
        [str(python.with_name("chatrobot")), "do", "forward 1 m", "--fast", "--json"],
        capture_output=True, text=True, cwd=tmp_path, env=outside, timeout=60.0,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout.splitlines()[-1])
    assert (result["event"], result["outcome"]) == ("result", "completed")
    assert result["path_m"] == pytest.approx(1.0, abs=0.02)
