"""The folder of a person's recordings: how they are called, how long they are kept, and who mends them."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path

from chatrobot.core.errors import ChatRobotError, UsageError
from chatrobot.recording.repair import held, repair_elsewhere

FOLDER, SUFFIX = "recordings", ".mcap"
MOST_BYTES, KEPT_S = 500_000_000, 30 * 86_400
"""What all recordings of a folder take at most, and how long one is kept: the oldest go first."""
BARE_S = 60.0
"""A file that is still empty by then has lost its writer. Before, its writer may not hold it yet."""


def make_folder(data_folder: Path) -> Path:
    """Return the folder of the recordings, made so that only its owner can look into it.

    Raises:
        OSError: it cannot be made.
    """
    folder = data_folder / FOLDER
    data_folder.mkdir(parents=True, exist_ok=True)
    folder.mkdir(mode=0o700, exist_ok=True)
    return folder


def new_path(folder: Path, robot: str) -> Path:
    """Return a name that is free: `2025-01-31_14-05-09_wheeltec_mini_mec.mcap`."""
    stem = f"{time.strftime('%Y-%m-%d_%H-%M-%S')}_{''.join(c if c.isalnum() else '_' for c in robot)}"
    for number in range(1, 1000):
        path = folder / f"{stem}{f'_{number}' if number > 1 else ''}{SUFFIX}"
        if not path.exists():
            return path
    raise UsageError("a thousand recordings began this second", where=str(folder))


def check_new(path: Path) -> Path:
    """Return the path that a person chose for a recording.

    Raises:
        UsageError: nothing can be recorded there.
    """
    path = path.expanduser()
    if path.suffix != SUFFIX:
        raise UsageError(f"a recording is a {SUFFIX} file", where=str(path), allowed=f"{path.name}{SUFFIX}")
    if path.exists():
        raise UsageError("is there already, and is not written over", where=str(path), allowed="another name")
    if not path.parent.is_dir():
        raise UsageError("there is no such folder", where=str(path.parent), allowed="a folder that is there")
    return path


def tidy(folder: Path, *, most_bytes: float = MOST_BYTES, kept_s: float = KEPT_S) -> None:
    """Mend what was cut off, and delete what is too old or too much. What is being written is left alone.

    What cannot be mended or deleted stays: a recording must not fail because of an older one.
    """
    for path in sorted(folder.glob(f"*{SUFFIX}")):
        with contextlib.suppress(ChatRobotError, OSError):
            age_s = time.time() - path.stat().st_mtime
            _delete_if(path, age_s > kept_s or (age_s > BARE_S and not path.stat().st_size))
        with contextlib.suppress(ChatRobotError, OSError):
            repair_elsewhere(path)
    make_room(folder, most_bytes)


def make_room(folder: Path, most_bytes: float = MOST_BYTES) -> None:
    """Delete the oldest recordings until all together take no more than that."""
    sizes: list[tuple[float, Path, int]] = []
    for path in folder.glob(f"*{SUFFIX}"):
        with contextlib.suppress(OSError):
            state = path.stat()
            sizes.append((state.st_mtime, path, state.st_size))
    total = sum(size for _, _, size in sizes)
    for _, path, size in sorted(sizes):
        if total <= most_bytes:
            return
        with contextlib.suppress(OSError):
            total -= size if _delete_if(path, True) else 0


def _delete_if(path: Path, is_due: bool) -> bool:
    if not is_due:
        return False
    with held(path) as is_ours:
        if is_ours:
            path.unlink()
    return is_ours
