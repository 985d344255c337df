"""What a person measured, as a correction of what odometry tells; and how it gets into the user's profile."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from chatrobot.core.errors import ProfileError
from chatrobot.core.files import write_whole
from chatrobot.robots.load import list_profiles
from chatrobot.robots.parse import parse_profile
from chatrobot.robots.profile import Calibration

PLAUSIBLE = (0.7, 1.4)
"""A correction beyond this is none: wheels of another size, the wrong profile, or a wrong unit."""

_NUMBER = re.compile(r"([+-]?\d+(?:[.,]\d+)?)\s*([^\d\s]*)")
_TABLE = re.compile(r"^\[calibration\].*?(?=^\[|\Z)", re.MULTILINE | re.DOTALL)
METRES = {
    **dict.fromkeys(("", "m", "metre", "metres", "meter", "meters", "米"), 1.0),
    **dict.fromkeys(("cm", "centimetres", "centimeters", "厘米", "公分"), 0.01),
    **dict.fromkeys(("mm", "毫米"), 0.001),
}
DEGREES = {"": 1.0, "°": 1.0, "deg": 1.0, "degree": 1.0, "degrees": 1.0, "度": 1.0}


def read_measure(text: str, units: dict[str, float]) -> float | None:
    """A number with or without one of `units`, in the unit that counts 1; None for anything else."""
    match = _NUMBER.fullmatch(text.strip().lower())
    if match is None or match[2] not in units:
        return None
    return float(match[1].replace(",", ".")) * units[match[2]]


@dataclass(frozen=True)
class Measured:
    """One motion: how far it really went and how far it seemed to go, in one and the same unit."""

    true: float
    seen: float

    @property
    def ratio(self) -> float:
        """Return what odometry has to be multiplied by."""
        return self.true / self.seen

    @property
    def is_plausible(self) -> bool:
        """The ratio is one that wheels of the right robot may have."""
        return self.seen > 0.0 and PLAUSIBLE[0] <= self.ratio <= PLAUSIBLE[1]


def corrected(before: Calibration, metre: Measured | None, turn: Measured | None, source: str) -> Calibration:
    """Return what makes odometry tell the truth, where it told `seen` under `before`."""
    return Calibration(
        distance_scale=round(before.distance_scale * (metre.ratio if metre else 1.0), 5),
        turn_scale=round(before.turn_scale * (turn.ratio if turn else 1.0), 5),
        source=source,
    )


def save_calibration(profile: str, calibration: Calibration, folder: Path) -> Path:
    """Write it into the user's profile; the file.

    Args:
        profile: by name, or a file, which is then the one that is changed.
        folder: of the user's own profiles; a built-in profile is copied there first, and so takes its own place.

    Raises:
        ProfileError: there is no such profile.
        OSError: it cannot be written.
    """
    file = Path(profile) if _is_file(profile) else _file_of(profile, (folder,))
    if file is None:
        raise ProfileError(
            "there is no such profile", where=profile, allowed="a name that chatrobot robots lists"
        )
    text = _without_table(file) + (
        "\n[calibration]\n"
        f"distance_scale = {calibration.distance_scale!r}\n"
        f"turn_scale = {calibration.turn_scale!r}\n"
        f'source = "{calibration.source}"\n'
    )
    target = file if file == Path(profile) else folder / f"{profile}.toml"
    parse_profile(text, target.stem, str(target))
    write_whole(target, text)
    return target


def reset_calibration(profile: str, folder: Path) -> Path | None:
    """Take the correction out of the user's profile; the file it stood in, None where there is none.

    A copy of a built-in profile that holds nothing else is removed: the built-in one counts again.

    Args:
        profile: by name, or a file.
        folder: of the user's own profiles.

    Raises:
        OSError: it cannot be read or written.
    """
    file = Path(profile) if _is_file(profile) else folder / f"{profile}.toml"
    if not file.exists() or not _TABLE.search(file.read_text(encoding="utf-8-sig")):
        return None
    text = _without_table(file)
    original = None if _is_file(profile) else _file_of(profile)
    if original is not None and text == _without_table(original):
        file.unlink()
    else:
        write_whole(file, text)
    return file


def _is_file(profile: str) -> bool:
    return profile.endswith(".toml") or "/" in profile


def _file_of(name: str, folders: tuple[Path, ...] = ()) -> Path | None:
    return next((entry.file for entry in list_profiles(folders) if entry.name == name), None)


def _without_table(file: Path) -> str:
    return _TABLE.sub("", file.read_text(encoding="utf-8-sig")).rstrip("\n") + "\n"
