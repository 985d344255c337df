"""`chatrobot report`: what the page and the files beside it say of a recording."""

from __future__ import annotations

import csv
import errno
import os
import re
import shutil
import xml.dom.minidom
from pathlib import Path

import pytest
from PIL import Image

from chatrobot.cli.entry import main
from chatrobot.cli.recorder import read_recording
from chatrobot.cli.report.drive import Drive
from chatrobot.cli.report.page import make_page
from chatrobot.cli.report.summary import sentences, words_in
from chatrobot.cli.report.timeline import Timeline
from chatrobot.core.events import Finished, ModelCalled, ProgramLog, Result
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.language.normalise import has_chinese
from chatrobot.recording import topics
from chatrobot.recording.reader import read
from chatrobot.recording.repair import held
from chatrobot.recording.writer import RecordingWriter
from chatrobot.wire.messages import Odometry, TwistMessage
from tests.report.recorded import SAID, heard, told, write

HOSTILE = "</td></script><script>document.title='run'</script><img src=x onerror=\"document.title='run'\">\u202e\x00"


@pytest.fixture(scope="module")
def drive(recorded: Path) -> Drive:
    return Drive.of(read(recorded))


def report(path: Path, *options: str) -> int:
    return main(["report", str(path), *options])


def test_the_summary_counts_what_was_said_driven_stopped_limited_and_refused(drive: Drive) -> None:
    text = " ".join(sentences(drive, words_in("en")))
    assert "4 instructions were given: 2 done, 1 stopped, 1 refused." in text
    assert "Stops: you said “stop”." in text
    assert "Slowed by limits: highest speed." in text
    assert [mark.kind for mark in drive.marks] == ["stop", "limit", "refusal"]


def test_the_measured_way_is_as_long_as_the_results_say(drive: Drive) -> None:
    driven_m = sum(result.path_m for _, result in drive.results)
    assert drive.measured_m == pytest.approx(driven_m, abs=0.02)
    assert drive.true_m == pytest.approx(driven_m, abs=0.02)
    assert drive.told_m > driven_m + 2.0  # the kitchen was not reached


def test_every_text_of_the_session_and_the_program_is_in_the_timeline(drive: Drive) -> None:
    rows = Timeline(drive, words_in("en")).rows()
    assert [row.text for row in rows if row.kind == "heard"] == [SAID[0], "stop", *SAID[1:]]
    assert {"understood", "approved", "refused", "stopped", "limited", "program", "completed"} <= {
        row.kind for row in rows
    }
    assert any("def " in row.more for row in rows if row.kind == "program")


def test_the_page_refers_to_nothing_outside_and_allows_only_its_own_script(drive: Drive) -> None:
    page = make_page(drive, words_in("en"))
    assert len(page.encode()) < 300_000
    assert not re.search(r"https?:|//[a-z]|@import|url\(|<link|<img|<iframe| style=| on\w+=", page)
    assert "default-src 'none'; style-src 'sha256-" in page
    assert page.count("<script") == 1


def test_a_recorded_text_is_shown_and_never_runs(tmp_path: Path) -> None:
    results = (
        Result(1, "completed", HOSTILE),
        Finished(7, "failed", Reason(HOSTILE), *[Pose()] * 2, *[0.0] * 4),
    )
    model = ModelCalled(1, HOSTILE, 1, 10, 0, 5, None, False, 0.5)
    log = ProgramLog(1, 0.1, "INFO", HOSTILE)
    messages = [heard(0.1, 1, HOSTILE), *(told(0.2, event) for event in (*results, model, log, log))]
    drive = Drive.of(read(write(tmp_path / "run.mcap", messages)))
    page = make_page(drive, words_in("en"))
    assert page.count("<script") == 1
    assert "<img" not in page
    assert "\x00" not in page
    assert "&lt;script&gt;" in page


def test_a_recording_in_chinese_gives_a_report_in_chinese(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "run.mcap", [heard(0.0, 1, "向前走")], language="zh")
    assert report(path) == 0
    assert "报告" in capsys.readouterr().out
    assert '<html lang="zh-CN">' in (tmp_path / "run.html").read_text(encoding="utf-8")
    world = Drive.of(read(path)).world
    assert all(has_chinese(name) for name in (*world.places, *(one.name for one in world.obstacles)))
    assert report(path, "--language", "en") == 0
    assert '<html lang="en">' in (tmp_path / "run.html").read_text(encoding="utf-8")


def test_each_kind_of_file_is_written_beside_the_recording_or_where_it_is_wanted(
    recorded: Path, tmp_path: Path
) -> None:
    path = tmp_path / "run.mcap"
    shutil.copy(recorded, path)
    assert report(path, "--svg", "--png", str(tmp_path / "other.png"), "--gif", "--csv") == 0
    assert not (tmp_path / "run.html").exists()
    xml.dom.minidom.parse(str(tmp_path / "run.svg"))
    with Image.open(tmp_path / "other.png") as png, Image.open(tmp_path / "run.gif") as gif:
        assert png.size[0] == 1000
        assert 20 < getattr(gif, "n_frames", 1) < 150
    with (tmp_path / "run.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["topic"] for row in rows} == {"odom", "telemetry", "ground_truth", "cmd_vel"}
    last = [row for row in rows if row["topic"] == "odom"][-1]
    assert float(last["x_m"]) == pytest.approx(read(path).odometry[-1][1].x_m, abs=1e-6)
    assert {oct(file.stat().st_mode & 0o777) for file in tmp_path.glob("*.[sg]*")} == {"0o600"}


def cut_off(folder: Path) -> tuple[Path, Path]:
    """Write a recording, and the first third of it."""
    poses = [(0.02 * i, topics.ODOM, Odometry(0.0, 0.01 * i, 0.0, 0.0, 0.5, 0.0, 0.0)) for i in range(2000)]
    whole = write(folder / "whole.mcap", poses)
    path = folder / "cut.mcap"
    path.write_bytes(whole.read_bytes()[: whole.stat().st_size // 3])
    return whole, path


def test_a_recording_that_was_cut_off_is_mended_and_the_page_says_so(tmp_path: Path) -> None:
    whole, path = cut_off(tmp_path)
    assert report(path) == 0
    assert "was repaired" in (tmp_path / "cut.html").read_text(encoding="utf-8")
    assert 0.0 < read(path).duration_s < read(whole).duration_s
    assert report(path) == 0
    assert "was repaired" not in (tmp_path / "cut.html").read_text(encoding="utf-8")


def test_a_recording_that_was_cut_off_is_read_from_a_copy_where_its_folder_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, path = cut_off(tmp_path)
    before, opened = path.read_bytes(), os.open

    def open_elsewhere(at: str | Path, flags: int, mode: int = 0o777, dir_fd: int | None = None) -> int:
        if flags & os.O_CREAT and Path(at).parent == tmp_path:  # root may write what its owner may not
            raise PermissionError(errno.EACCES, "Permission denied")
        return opened(at, flags, mode, dir_fd=dir_fd)

    made = tmp_path / "elsewhere" / "cut.html"
    made.parent.mkdir()
    monkeypatch.setattr(os, "open", open_elsewhere)
    assert report(path, "--html", str(made)) == 0
    assert "is not at its end" in made.read_text(encoding="utf-8")
    recording, amiss = read_recording(str(path))
    assert (recording.path, amiss) == (path, "unfinished")
    assert 0.0 < recording.duration_s < read(whole).duration_s
    assert path.read_bytes() == before


@pytest.mark.parametrize("content", [b"", b"PNG", b"\x89MCAP0\r\n" + bytes(400)])
def test_a_file_that_is_no_recording_is_refused_with_what_would_be_one(
    content: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "notes.mcap"
    path.write_bytes(content)
    assert report(path) == 2
    said = capsys.readouterr().err
    assert "notes.mcap: is no" in said or "notes.mcap: is not a recording" in said
    assert "mcap" in said.lower()
    assert not (tmp_path / "notes.html").exists()


def test_a_report_never_overwrites_a_recording(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = recorded.read_bytes()
    assert report(recorded, "--svg", str(recorded)) == 2
    assert "ends in .svg" in capsys.readouterr().err
    assert recorded.read_bytes() == before


def test_a_recording_that_is_being_written_is_left_alone_and_shown_so_far(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "now.mcap"
    with path.open("wb") as file:
        RecordingWriter(file, {}, str).flush()
        with held(path):
            before = path.read_bytes()
            assert report(path) == 0
            assert path.read_bytes() == before
    assert "not at its end" in capsys.readouterr().err
    assert "not at its end" in path.with_suffix(".html").read_text(encoding="utf-8")


def test_an_empty_recording_and_one_without_odometry_say_so(tmp_path: Path) -> None:
    for name in ("empty", "words"):
        path = tmp_path / f"{name}.mcap"
        if name == "empty":
            with path.open("wb") as file:
                RecordingWriter(file, {}, str).close()
        else:
            write(
                path,
                [told(1.0, Result(1, "answered", "fine")), (1.0, topics.CMD_VEL, TwistMessage(0.1, 0, 0))],
            )
        assert report(path, *(f"--{kind}" for kind in ("html", "svg", "png", "gif", "csv"))) == 0
    assert "Nothing is in this recording." in (tmp_path / "empty.html").read_text(encoding="utf-8")
    words = (tmp_path / "words.html").read_text(encoding="utf-8")
    assert "nothing to draw on a map" in words
    assert "One instruction was given: answered." in words


def test_what_is_broken_in_a_recording_is_left_out(tmp_path: Path) -> None:
    nan = float("nan")
    poses = [
        Odometry(0.0, x_m, 0.0, 0.0, nan if x_m == 0.1 else 0.1, 0.0, 0.0)
        for x_m in (0.0, 0.1, nan, 0.2, 50.0)
    ]
    messages = [(0.1 * i, topics.ODOM, pose) for i, pose in enumerate(poses)]
    messages += [
        told(0.3, {"event": "rehearsed", "turn": "x"}),
        told(0.3, {"event": "nobody's"}),
        told(0.3, {"a": 1}),
    ]
    drive = Drive.of(read(write(tmp_path / "run.mcap", messages)))
    assert drive.measured_m == pytest.approx(0.2)  # odometry that jumps has not driven there
    assert len(drive.measured) == 2
    make_page(drive, words_in("zh"))
