"""Keeps entries of one robot, by their names, in a file of the config folder; what goes wrong there is told once."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

from chatrobot.core.files import write_whole
from chatrobot.core.reason import Reason

Entry = Mapping[str, object]
_UNREADABLE = (ValueError, KeyError, AttributeError, TypeError, RecursionError)
"""What a file raises that somebody else has written to."""


class RobotFile:
    """The entries of one robot in a file that holds those of all robots.

    Args:
        folder: where the file is; None keeps them for this session only.
        name: of the file, without its end.
        codes: of the reasons why entries are not kept: the file cannot be written, or not be read.
        robot: profile name; another robot's entries mean nothing to this one.
        check: raises a `ValueError`, `KeyError` or `TypeError` for what is no entry.
    """

    def __init__(
        self,
        folder: Path | None,
        name: str,
        codes: tuple[str, str],
        robot: str,
        check: Callable[[str, Entry], object],
    ) -> None:
        self._path = folder / f"{name}.json" if folder is not None else None
        self._not_kept, self._not_read = codes
        self._robot, self._check = robot, check
        self._unkept: Reason | None = None
        self.entries = self._load()
        """By name. Whoever changes them calls `keep`."""

    def keep(self) -> None:
        """Write them down; a file that cannot be read stays as it is, for it may be mended."""
        try:
            if self._path is not None:
                robots, _ = self._read(self._path)
                robots[self._robot] = self.entries
                write_whole(self._path, json.dumps(robots, ensure_ascii=False, indent=1))
        except OSError as error:  # a full disk is no reason to stop a robot
            self._unkept = Reason(self._not_kept, {"why": error.strerror or str(error)})
        except _UNREADABLE:
            self._unkept = self._unreadable()

    def take_unkept(self) -> Reason | None:
        """Return why entries are kept for this session only; once, None where they are kept."""
        unkept, self._unkept = self._unkept, None
        return unkept

    def _unreadable(self) -> Reason:
        return Reason(self._not_read, {"file": str(self._path)})

    def _load(self) -> dict[str, Entry]:
        try:
            return self._read(self._path)[1] if self._path is not None else {}
        except (OSError, *_UNREADABLE):  # no reason not to drive
            self._unkept = self._unreadable()
            return {}

    def _read(self, path: Path) -> tuple[dict[str, object], dict[str, Entry]]:
        """What the file holds of all robots, and of ours. Raises one of `_UNREADABLE`."""
        if not path.exists():
            return {}, {}
        robots = json.loads(path.read_text(encoding="utf-8"))
        found: dict[str, Entry] = dict(robots.get(self._robot, {}))
        for name, entry in found.items():
            self._check(name, entry)
        return robots, found
