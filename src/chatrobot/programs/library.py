"""Programs that were kept: by name, with their source, where they come from, and how their runs went."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Literal

from chatrobot.core.errors import InputError
from chatrobot.core.files import write_whole

MAX_NAME_CHARS = 60
KEPT_RUNS = 20
_ABOUT, _SOURCE = "about.json", "program.py"
AGENT = "agent"
"""Kept in place of a model's name: a client over MCP wrote it, whatever model that uses."""


@dataclass(frozen=True)
class Provenance:
    """The origin of a program. `model` is PROVIDER:NAME, `AGENT`, or "" for none; `date` is ISO 8601, UTC."""

    sentence: str = ""
    by: Literal["offline", "model", "person"] = "person"
    model: str = ""
    date: str = ""
    versions: int = 1

    @property
    def author(self) -> Literal["offline", "model", "person", "agent"]:
        """Return who wrote it: what is kept calls an agent a model."""
        return "agent" if self.by == "model" and self.model == AGENT else self.by

    @property
    def model_name(self) -> str:
        """Return PROVIDER:NAME; "" where none of ours had a part in it."""
        return "" if self.model == AGENT else self.model


@dataclass(frozen=True)
class RunRecord:
    """The end of one run, as odometry measured it."""

    date: str
    outcome: str
    path_m: float = 0.0
    turned_rad: float = 0.0
    duration_s: float = 0.0


@dataclass(frozen=True)
class KeptProgram:
    """One program. `rehearsal` is what the last rehearsal showed, `remap` what its topics are led to."""

    name: str
    source: str
    description: str = ""
    provenance: Provenance = field(default_factory=Provenance)
    remap: Mapping[str, str] = field(default_factory=dict)
    rehearsal: Mapping[str, Any] = field(default_factory=dict)
    runs: tuple[RunRecord, ...] = ()


class Library:
    """The programs in a folder, one folder each, so that a person can read and edit them with any editor.

    Args:
        folder: the configuration folder; None keeps them for this session only.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder / "programs" if folder is not None else None
        self._kept: dict[str, KeptProgram] = {}

    def names(self) -> tuple[str, ...]:
        """Return all names, sorted."""
        return tuple(sorted(program.name for program in self._all()))

    def all(self) -> tuple[KeptProgram, ...]:
        """Return all programs, sorted by name."""
        return tuple(sorted(self._all(), key=lambda program: program.name))

    def get(self, name: str) -> KeptProgram:
        """Return the program of that name, whatever its case and spaces.

        Raises:
            InputError: there is none; the message lists those that are.
        """
        found = self.find(name)
        if found is None:
            known = ", ".join(self.names()) or "none is kept yet: chatrobot program new TEXT"
            raise InputError(f"there is no program {name!r}", where="program", allowed=f"programs: {known}")
        return found

    def find(self, name: str) -> KeptProgram | None:
        """Return the program of that name, or None."""
        key = folder_name(name)
        return next((program for program in self._all() if folder_name(program.name) == key), None)

    def place(self, name: str) -> str:
        """Return the file of that program's source, kept yet or not; "" where nothing is written to files."""
        return str(self._folder / folder_name(name) / _SOURCE) if self._folder is not None else ""

    def free_name(self, wanted: str) -> str:
        """Return `wanted`, or with the first number behind it that makes it new."""
        wanted = clean_name(wanted) or "program"
        taken = {folder_name(name) for name in self.names()}
        if folder_name(wanted) not in taken:
            return wanted
        return next(
            name for n in range(2, len(taken) + 3) if folder_name(name := f"{wanted} {n}") not in taken
        )

    def keep(self, program: KeptProgram) -> None:
        """Keep it; an older one of that name is replaced.

        Raises:
            InputError: the name cannot be one.
        """
        if not clean_name(program.name):
            raise InputError(
                f"{program.name!r} cannot be the name of a program", allowed="letters, digits and spaces"
            )
        self._kept[folder_name(program.name)] = program
        if self._folder is not None:
            self._write(self._folder / folder_name(program.name), program)

    def edit(self, name: str, source: str) -> KeptProgram:
        """Give a kept program another source; forget what is known of the old one's rehearsal."""
        old = self.get(name)
        provenance = replace(old.provenance, by="person", versions=old.provenance.versions + 1)
        new = replace(old, source=source, provenance=provenance, rehearsal={}, remap={})
        self.keep(new)
        return new

    def rename(self, old: str, new: str) -> None:
        """Rename a program. Raises InputError where there is no `old`, or a `new` already."""
        program, new = self.get(old), clean_name(new)
        taken = self.find(new)
        if not new or (taken is not None and taken.name != program.name):
            problem = f"there is a program {new!r} already" if new else "the new name is empty"
            raise InputError(problem, where="rename", allowed="another name")
        self.keep(replace(program, name=new))
        if folder_name(new) != folder_name(program.name):
            self.remove(program.name)  # last: where the new one cannot be kept the old one stays

    def remove(self, name: str) -> None:
        """Remove a program. Raises InputError where there is none."""
        program = self.get(name)
        self._kept.pop(folder_name(program.name), None)
        if self._folder is not None:
            shutil.rmtree(self._folder / folder_name(program.name))

    def note_rehearsal(self, name: str, rehearsal: Mapping[str, Any]) -> None:
        """Keep what its last rehearsal showed, where the program itself is kept."""
        program = self.find(name)
        if program is not None:
            self.keep(replace(program, rehearsal=rehearsal))

    def note_run(self, name: str, run: RunRecord) -> None:
        """Keep how a run of it went, where the program itself is kept."""
        program = self.find(name)
        if program is not None:
            self.keep(replace(program, runs=(*program.runs, run)[-KEPT_RUNS:]))

    # --- on disk ---

    def _all(self) -> Iterator[KeptProgram]:
        if self._folder is None:
            yield from self._kept.values()
        elif self._folder.is_dir():
            for about in sorted(self._folder.glob(f"*/{_ABOUT}")):
                yield self._read(about)

    def _read(self, about: Path) -> KeptProgram:
        try:
            data = json.loads(about.read_text(encoding="utf-8"))
            source = (about.parent / _SOURCE).read_text(encoding="utf-8")
            return KeptProgram(
                str(data["name"]),
                source,
                str(data["description"]),
                Provenance(**data["provenance"]),
                dict(data["remap"]),
                dict(data["rehearsal"]),
                tuple(RunRecord(**run) for run in data["runs"]),
            )
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InputError(
                f"it cannot be read: {error}", where=str(about), allowed="mend the file, or remove its folder"
            ) from error

    def _write(self, folder: Path, program: KeptProgram) -> None:
        about = {key: value for key, value in asdict(program).items() if key != "source"}
        write_whole(folder / _SOURCE, program.source)
        write_whole(folder / _ABOUT, json.dumps(about, ensure_ascii=False, indent=1))


def clean_name(name: str) -> str:
    """Return a name as it is kept: printable words with one space between them."""
    words = re.sub(r"[^\w\- ]+", " ", name.replace("_", " ")).split()
    return " ".join(words)[:MAX_NAME_CHARS].strip(" -")


def folder_name(name: str) -> str:
    """Return the folder of a name; two names of the same folder are the same name."""
    return clean_name(name).casefold().replace(" ", "_") or "_"


def today() -> str:
    """Return this moment, as it stands in what is kept."""
    return datetime.now(timezone.utc).isoformat(timespec="seconds")
