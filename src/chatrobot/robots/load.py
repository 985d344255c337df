"""Finding profiles by name: the user's own folders first, then the built-in ones, then installed packages.

The user's come first so that a profile measured on one's own robot stands in for the built-in of that name; a
package that merely got installed cannot. Only files are looked at until one is asked for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from chatrobot.core.errors import ProfileError
from chatrobot.robots.parse import parse_profile
from chatrobot.robots.profile import RobotProfile

DEFAULT_PROFILE = "wheeltec_mini_mec"
ENTRY_POINT_GROUP = "chatrobot.profiles"

# Beside this file, not through importlib.resources: its import alone takes longer than reading a profile.
_BUILT_IN = Path(__file__).with_name("profiles")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*")


@dataclass(frozen=True)
class ProfileEntry:
    """A profile that exists, not read yet. `origin` says whose it is."""

    name: str
    origin: Literal["user", "built-in", "package"]
    file: Path

    def load(self) -> RobotProfile:
        """Read and check it. Raises ProfileError."""
        if not self.file.is_file():  # a named pipe would have us wait for ever
            raise ProfileError("this is not a file", where=str(self.file), allowed="a readable .toml file")
        return _read(self.file)


def load_profile(name_or_path: str, extra_dirs: Iterable[Path | str] = ()) -> RobotProfile:
    """The robot profile of that name, or in that TOML file (anything with a slash, or ending in .toml).

    Args:
        name_or_path: `wheeltec_mini_mec`, `./my_robot.toml`, …
        extra_dirs: folders with the user's own profiles; those that do not exist are passed over.

    Raises:
        ProfileError: there is none, or it cannot be used.
    """
    if name_or_path.endswith(".toml") or "/" in name_or_path or "\\" in name_or_path:
        return _read(Path(name_or_path))
    folders = tuple(extra_dirs)
    for entry in _entries(folders):
        if entry.name == name_or_path:
            return entry.load()
    raise _unknown(name_or_path, [entry.name for entry in list_profiles(folders)])


def list_profiles(extra_dirs: Iterable[Path | str] = ()) -> list[ProfileEntry]:
    """All profiles that `load_profile` finds by name, sorted by name; each name once, as it would be loaded.

    An installed package that names a profile folder that is not there is warned of: the others are none the worse.
    """
    found: dict[str, ProfileEntry] = {}
    try:
        for entry in _entries(tuple(extra_dirs)):
            found.setdefault(entry.name, entry)
    except ProfileError as error:
        import logging  # only then: it is slow to load

        logging.getLogger(__name__).warning("%s", error)
    return [found[name] for name in sorted(found)]


def profile_argument(name: str, directories: Sequence[Path] = ()) -> str:
    """Return what other processes find the profile by: a user's own by its file, for they know no config folder."""
    for entry in list_profiles(directories):
        if entry.name == name and entry.origin == "user":
            return str(entry.file)
    return name


def _entries(extra_dirs: Sequence[Path | str]) -> Iterator[ProfileEntry]:
    """In order of precedence, and lazily: the metadata of installed packages is slow to read."""
    for folder in extra_dirs:
        yield from _in_folder(Path(folder), "user")
    yield from _in_folder(_BUILT_IN, "built-in")
    for folder in _package_folders():
        yield from _in_folder(folder, "package")


def _in_folder(folder: Path, origin: Literal["user", "built-in", "package"]) -> Iterator[ProfileEntry]:
    for file in sorted(folder.glob("*.toml")):
        yield ProfileEntry(file.stem, origin, file)


def _package_folders() -> Iterator[Path]:
    """The folders of all packages that entry points of the group name (`acme = "acme_robots.profiles"`).

    Raises ProfileError for the first that is none, after the others.
    """
    from importlib.metadata import entry_points
    from importlib.util import find_spec

    broken = None
    for entry_point in entry_points(group=ENTRY_POINT_GROUP):
        try:
            spec = find_spec(entry_point.value)
        except ImportError:
            spec = None
        if spec is None or not spec.submodule_search_locations:
            broken = broken or ProfileError(
                f"{entry_point.value!r} is not a package with profiles",
                where=f"entry point {entry_point.name!r} of {ENTRY_POINT_GROUP}",
                allowed="a package folder that holds .toml files; or uninstall what brought it",
            )
            continue
        for location in spec.submodule_search_locations:
            yield Path(location)
    if broken is not None:
        raise broken


def _read(file: Path) -> RobotProfile:
    name = file.stem
    if not _NAME.fullmatch(name):
        raise ProfileError(
            f"{name!r} cannot be a robot's name",
            where=str(file),
            allowed="the file is named after the robot: letters, digits, _ and -, then .toml",
        )
    try:
        text = file.read_text(encoding="utf-8-sig")
    except OSError as error:
        problem = error.strerror or str(error)
        raise ProfileError(problem, where=str(file), allowed="a readable .toml file") from error
    except ValueError as error:
        raise ProfileError("this is not UTF-8 text", where=str(file), allowed="TOML in UTF-8") from error
    return parse_profile(text, name, str(file))


def _unknown(name: str, known: list[str]) -> ProfileError:
    from difflib import get_close_matches

    near = get_close_matches(name.lower().replace("-", "_").replace(" ", "_"), known, n=1, cutoff=0.5)
    hint = f"did you mean {near[0]}? " if near else ""
    return ProfileError(
        f"no robot profile is called {name!r}",
        allowed=f"{hint}there are: {', '.join(known)}; or the path of a .toml file",
    )


def profile_dirs(folder: Path | None) -> tuple[Path, ...]:
    """Return where a person's own robot profiles live, below their folder."""
    return (folder / "robots",) if folder is not None else ()
