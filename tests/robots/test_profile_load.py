"""Where profiles are found, and what is said when they are not."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from chatrobot.core.errors import ProfileError
from chatrobot.robots import load
from chatrobot.robots.load import list_profiles, load_profile

TEMPLATE = next(entry.file for entry in list_profiles() if entry.name == "generic_diff").read_text("utf-8")


def install(monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    """As if a package with this entry point were installed."""
    found = [EntryPoint(name="acme", value=value, group=load.ENTRY_POINT_GROUP)]
    monkeypatch.setattr(
        "importlib.metadata.entry_points", lambda group: found if group == found[0].group else []
    )


def write(folder: Path, name: str, text: str = TEMPLATE) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def test_a_copied_template_is_a_profile_named_after_its_file(tmp_path: Path) -> None:
    file = write(tmp_path, "my-robot.toml")
    assert load_profile(str(file)).name == "my-robot"
    assert load_profile("my-robot", [tmp_path]).name == "my-robot"


def test_an_unknown_name_lists_the_known_ones_and_the_nearest(tmp_path: Path) -> None:
    write(tmp_path, "zoe.toml")
    with pytest.raises(ProfileError, match="did you mean turtlebot3_burger") as caught:
        load_profile("TurtleBot3 burgr", [tmp_path])
    assert "wheeltec_mini_mec" in caught.value.allowed
    assert "zoe" in caught.value.allowed


def test_a_name_like_no_other_gets_no_guess() -> None:
    with pytest.raises(ProfileError) as caught:
        load_profile("xxxxxxxx")
    assert "did you mean" not in caught.value.allowed


def test_the_users_profile_stands_in_for_the_built_in_one(tmp_path: Path) -> None:
    write(tmp_path, "wheeltec_mini_mec.toml", TEMPLATE.replace("Generic differential base", "Mine"))
    assert load_profile("wheeltec_mini_mec", [tmp_path]).title == "Mine"
    entry = next(e for e in list_profiles([tmp_path]) if e.name == "wheeltec_mini_mec")
    assert entry.origin == "user"
    assert load_profile("wheeltec_mini_mec").title != "Mine"


def test_a_broken_profile_of_the_user_is_not_passed_over_for_the_built_in_one(tmp_path: Path) -> None:
    file = write(tmp_path, "turtlesim.toml", TEMPLATE.replace("value = 0.2,", "value = 200,", 1))
    with pytest.raises(ProfileError) as caught:
        load_profile("turtlesim", [tmp_path])
    assert caught.value.where.startswith(f"{file}:")


def test_a_folder_that_is_not_there_is_no_error(tmp_path: Path) -> None:
    assert load_profile("turtlesim", [tmp_path / "none"]).name == "turtlesim"


@pytest.mark.parametrize("name", ["none.toml", "./none", "a folder.toml"])
def test_a_file_that_cannot_be_read_is_named(name: str, tmp_path: Path) -> None:
    (tmp_path / "a folder.toml").mkdir()
    with pytest.raises(ProfileError, match=name.rsplit("/", maxsplit=1)[-1]):
        load_profile(str(tmp_path / name) if name.endswith(".toml") else name)


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "bot.toml"
    file.write_bytes(b"title = '\xff'")
    with pytest.raises(ProfileError, match="UTF-8"):
        load_profile(str(file))


def test_an_installed_package_brings_profiles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "acme_robots_for_test", "acme_rover.toml")
    write(tmp_path / "acme_robots_for_test", "turtlesim.toml")
    monkeypatch.syspath_prepend(tmp_path)
    install(monkeypatch, "acme_robots_for_test")
    assert load_profile("acme_rover").name == "acme_rover"
    origins = {entry.name: entry.origin for entry in list_profiles()}
    assert origins["acme_rover"] == "package"
    assert origins["turtlesim"] == "built-in"


@pytest.mark.parametrize("value", ["no_such_package_for_test.profiles", "no_such_package_for_test", "math"])
def test_a_package_without_its_folder_is_named_and_hides_no_other(
    value: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    install(monkeypatch, value)
    assert "turtlesim" in [entry.name for entry in list_profiles()]
    assert "entry point 'acme'" in caplog.text
    with pytest.raises(ProfileError, match="entry point 'acme'"):
        load_profile("acme_cart")
    assert load_profile("turtlesim").name == "turtlesim"


def test_loading_a_built_in_profile_imports_nothing_heavy() -> None:
    code = """
import sys
before = set(sys.modules)
from chatrobot.robots.load import load_profile
load_profile("wheeltec_mini_mec")
heavy = {"numpy", "pydantic", "yaml", "rich", "difflib", "importlib.metadata", "importlib.resources"}
print(sorted(heavy & (set(sys.modules) - before)))
"""
    environment = {"PYTHONPATH": str(Path(load.__file__).parents[2])}
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment
    )
    assert run.stdout.strip() == "[]"
