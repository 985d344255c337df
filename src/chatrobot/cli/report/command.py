"""`chatrobot report FILE`: reads a recording, mends it if it was cut off, and writes what was asked for beside it."""

from __future__ import annotations

import argparse
import csv
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from chatrobot.cli.recorder import read_recording
from chatrobot.core.errors import UsageError

if TYPE_CHECKING:
    from chatrobot.cli.report.drive import Drive
    from chatrobot.cli.report.summary import Say

FORMATS = ("html", "svg", "png", "gif", "csv")
"""What a report can be; the first is made where none is asked for."""
_COLUMNS = ("t_s", "topic", "x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps", "wz_radps")
_DECIMALS = 6


def run(args: argparse.Namespace) -> int:
    """Write the report and say where it is. Always 0.

    Raises:
        InputError: the file is no recording, or what is to be written has another name than its kind.
        OSError: a file cannot be read or written.
    """
    path = Path(args.file).expanduser()
    outs = {
        kind: _out(path, kind, getattr(args, kind)) for kind in FORMATS if getattr(args, kind) is not None
    }
    outs = outs or {FORMATS[0]: _out(path, FORMATS[0], "")}
    from chatrobot.cli.report.drive import Drive
    from chatrobot.cli.report.summary import words_in

    recording, amiss = read_recording(args.file)
    drive = Drive.of(recording, args.language or None)
    say = words_in(drive.language)
    if amiss:
        print(f"chatrobot: {say(amiss)}", file=sys.stderr)
    for kind, out in outs.items():
        _private(out, _writer(kind, drive, say, amiss))
        print(say("written", file=out, size=f"{out.stat().st_size / 1000.0:.0f} kB"))
    return 0


def _out(path: Path, kind: str, chosen: str) -> Path:
    """Return the file to write: beside the recording where nobody says.

    Raises:
        UsageError: it ends as another kind of file, which it may be (a recording, say); or there is no such folder.
    """
    out = Path(chosen).expanduser() if chosen else path.with_suffix(f".{kind}")
    if out.suffix.lower() != f".{kind}":
        raise UsageError(
            f"{chosen!r} is not the name of a {kind.upper()} file",
            where=f"--{kind}",
            allowed=f"a name that ends in .{kind}, or none behind the recording: chatrobot report FILE --{kind}",
        )
    if not out.parent.is_dir():
        raise UsageError("there is no such folder", where=str(out.parent), allowed="a folder that is there")
    return out


def _writer(kind: str, drive: Drive, say: Say, amiss: str) -> Callable[[Path], object]:
    """Return what writes a report of that kind; each imports what it needs itself."""
    from chatrobot.cli.drawing.canvas import Canvas
    from chatrobot.cli.drawing.svg import SvgCanvas
    from chatrobot.cli.report import animation, figure, page

    writers: dict[str, Callable[[Path], object]] = {
        "html": lambda out: out.write_text(page.make_page(drive, say, amiss), "utf-8"),
        "svg": lambda out: figure.write_figure(drive, say, out, SvgCanvas),
        "png": lambda out: figure.write_figure(drive, say, out, Canvas),
        "gif": lambda out: animation.write_gif(drive, out),
        "csv": lambda out: _write_csv(drive, out),
    }
    return writers[kind]


def _private(out: Path, write: Callable[[Path], object]) -> None:
    """Write a file that only its owner can read, as a recording is, whole or not at all."""
    beside = out.with_name(f".{out.name}.{os.getpid()}")
    try:
        os.close(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        write(beside)
        os.replace(beside, out)
    finally:
        beside.unlink(missing_ok=True)


def _write_csv(drive: Drive, path: Path) -> None:
    """Write the table, in the order of time.

    `topic` is odom, telemetry (where the robot measured itself, by wheels and gyro), ground_truth, or cmd_vel, which
    has no pose.

    Raises:
        OSError: the file cannot be written.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(_COLUMNS)
        for t_s, topic, values in sorted(_rows(drive), key=lambda row: row[0]):
            writer.writerow(
                [f"{t_s:.{_DECIMALS}f}", topic, *("" if v is None else f"{v:.{_DECIMALS}f}" for v in values)]
            )


def _rows(drive: Drive) -> Iterator[tuple[float, str, tuple[float | None, ...]]]:
    recording = drive.recording
    poses = {"odom": recording.odometry, "telemetry": drive.telemetry, "ground_truth": recording.truth}
    for topic, samples in poses.items():
        yield from ((t_s, topic, sample[1:]) for t_s, sample in samples)
    yield from ((t_s, "cmd_vel", (None, None, None, *twist)) for t_s, twist in recording.commands)
