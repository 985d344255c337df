"""`chatrobot do`, `plan` and the piped mode in simulated time."""

from __future__ import annotations

import array
import fcntl
import itertools
import json
import math
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

from tests.cli.running import PATIENCE_S, Command, environment

FAST = ("--fast", "--world", "empty")


def test_it_says_what_it_understood_what_will_happen_and_what_was_measured(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 1 m", *FAST)
    assert done.code == 0
    assert "drive 1 m" in done.out
    assert "s, 1.00 m" in done.out
    assert "1.00 m of 1.00 m" in done.out
    assert done.err == ""


def test_json_lines_come_in_their_order_and_nothing_else_is_printed(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 1 m", "--json", *FAST)
    names = [event["event"] for event in done.events if event["event"] != "progress"]
    assert names == ["interpreted", "rehearsed", "started", "result"]
    assert all(event["turn"] == 1 for event in done.events)
    (interpreted,) = done.named("interpreted")
    assert interpreted["by"] == "offline"
    assert interpreted["plan_text"] == "drive 1 m"
    (result,) = done.named("result")
    assert set(result) >= {
        "event", "turn", "outcome", "reply", "pose", "turned_rad", "path_m", "duration_s", "paused_s",
    }  # fmt: skip
    assert result["outcome"] == "completed"
    assert result["pose"]["x_m"] == pytest.approx(1.0, abs=0.02)


def test_a_trace_begins_at_the_origin_and_runs_on_through_all_turns(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 1 m", "turn left 90 degrees", "--json", "--trace", *FAST)
    poses = done.named("pose")
    assert (poses[0]["x_m"], poses[0]["y_m"], poses[0]["yaw_rad"]) == (0.0, 0.0, 0.0)
    gaps = [after["t_s"] - before["t_s"] for before, after in itertools.pairwise(poses)]
    assert min(gaps) > 0.0
    assert max(gaps) <= 0.05 + 1e-6
    assert poses[-1]["x_m"] == pytest.approx(1.0, abs=0.03)
    assert poses[-1]["yaw_rad"] == pytest.approx(math.pi / 2, abs=0.03)
    order = [(event["event"], event["turn"]) for event in done.events if event["event"] == "result"]
    assert order == [("result", 1), ("result", 2)]


def test_turns_of_a_dialogue_know_of_each_other(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 1 m", "again", "--json", *FAST)
    assert done.code == 0
    assert done.named("result")[-1]["pose"]["x_m"] == pytest.approx(2.0, abs=0.04)


@pytest.mark.parametrize(
    ("text", "outcome", "code"),
    [
        ("forward 1 m", "completed", 0),
        ("where are you?", "answered", 0),
        ("florble the wug", "unclear", 3),
        ("fly to the moon", "refused", 4),
        ("stop", "stopped", 5),
    ],
)
def test_the_exit_code_is_that_of_the_outcome(chatrobot: Command, text: str, outcome: str, code: int) -> None:
    done = chatrobot("do", text, "--json", *FAST)
    assert done.named("result")[-1]["outcome"] == outcome
    assert done.code == code


def test_a_robot_that_gets_stuck_has_failed(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 2 m", "--json", "--sim", "stuck_after_m=0.5,blocked=stall", *FAST)
    assert done.named("result")[-1]["outcome"] == "failed"
    assert done.code == 1


def test_the_exit_code_is_that_of_the_last_turn(chatrobot: Command) -> None:
    assert chatrobot("do", "florble the wug", "forward 1 m", *FAST).code == 0
    assert chatrobot("do", "forward 1 m", "florble the wug", *FAST).code == 3


def test_who_asks_in_chinese_is_answered_in_chinese(chatrobot: Command) -> None:
    done = chatrobot("do", "前进一米", *FAST)
    assert done.code == 0
    assert "完成" in done.out


@pytest.mark.parametrize(
    ("locale", "strange", "program"),
    [
        ("zh_CN", "没听懂", "语言模型"),
        ("de_DE", "nicht verstanden", "Sprachmodell"),
        ("C", "did not", "language model"),
    ],
)
def test_what_is_in_no_language_is_answered_in_that_of_the_system(
    chatrobot: Command, monkeypatch: pytest.MonkeyPatch, locale: str, strange: str, program: str
) -> None:
    monkeypatch.setenv("LC_ALL", f"{locale}.UTF-8")
    assert strange in chatrobot("do", "xyzzy", *FAST).out
    assert program in chatrobot("program", "new", "xyzzy", *FAST).out
    assert "Done: drove" in chatrobot("do", "forward 10 cm", *FAST).out


def test_two_runs_with_one_seed_are_one_run(chatrobot: Command) -> None:
    arguments = ("do", "forward 1 m", "--json", "--trace", "--sim", "noise=on,seed=7", *FAST)
    assert chatrobot(*arguments).named("pose") == chatrobot(*arguments).named("pose")


def test_a_number_that_is_none_is_still_json(chatrobot: Command) -> None:
    def refuse(constant: str) -> float:
        raise AssertionError(constant)

    done = chatrobot("do", "forward 1 m", "--json", "--sim", "odom_wrong=nan", *FAST)
    for line in done.out.splitlines():
        json.loads(line, parse_constant=refuse)


# --- approval ---


def test_without_a_terminal_nobody_can_approve(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 1 m", "--approve", "--json", *FAST)
    assert done.code == 4
    assert "--yes" in done.err
    assert not done.named("started")


# --- plan ---


def test_plan_rehearses_and_moves_nothing(chatrobot: Command) -> None:
    done = chatrobot("plan", "forward 1 m", "--json", "--world", "empty")
    assert done.code == 0
    assert [event["event"] for event in done.events] == ["interpreted", "rehearsed", "result"]
    (rehearsed,) = done.named("rehearsed")
    assert rehearsed["ok"]
    assert rehearsed["length_m"] == pytest.approx(1.0, abs=0.01)
    assert done.named("result")[0]["path_m"] == 0.0


def test_plan_draws_the_way(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "way.png"
    assert chatrobot("plan", "forward 20 m", "--png", str(file), "--world", "home").code == 4
    assert file.read_bytes().startswith(b"\x89PNG")


def test_where_there_is_no_plan_there_is_no_picture(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "way.png"
    done = chatrobot("plan", "where are you?", "--png", str(file))
    assert "no plan to draw" in done.err
    assert not file.exists()


def test_a_picture_that_cannot_be_written_is_told(chatrobot: Command, tmp_path: Path) -> None:
    done = chatrobot("plan", "forward 1 m", "--png", str(tmp_path / "no" / "such" / "way.png"))
    assert done.code == 1
    assert "No such file" in done.err


def test_plan_says_what_would_be_hit(chatrobot: Command) -> None:
    done = chatrobot("plan", "forward 20 m", "--world", "home")
    assert done.code == 4
    assert "wall" in done.out


# --- lines from a pipe ---


def test_every_line_of_a_pipe_is_done_before_goodbye(chatrobot: Command) -> None:
    done = chatrobot(*FAST, stdin="forward 1 m\n\nturn left 90 degrees\n")
    assert done.code == 0
    assert "1.00 m of 1.00 m" in done.out
    assert "90" in done.out.splitlines()[-1]


def test_lines_about_a_text_of_a_pipe_stand_under_it(chatrobot: Command) -> None:
    out = chatrobot(*FAST, stdin="forward 1 m\nblorf\nback 2 m\n").out
    about = dict.fromkeys(("forward 1 m", "blorf", "back 2 m"), "")
    for part in out.removeprefix("> ").split("\n> "):
        text, _, lines = part.partition("\n")
        about[text] += lines
    assert "Done: drove 1.00 m of 1.00 m." in about["forward 1 m"]
    assert "I did not understand “blorf”" in about["blorf"]
    assert "Done: drove 2.00 m of 2.00 m." in about["back 2 m"]


def test_a_last_line_without_its_newline_counts(chatrobot: Command) -> None:
    assert len(chatrobot("--json", *FAST, stdin="forward 1 m\nback 1 m").named("result")) == 2


def test_an_empty_pipe_is_an_orderly_end(chatrobot: Command) -> None:
    done = chatrobot("--json", *FAST, stdin="")
    assert (done.code, done.out) == (0, "")


def test_json_in_json_out(chatrobot: Command) -> None:
    said = '{"text": "forward 1 m"}\nturn left 90 degrees\n{"text": "前进 50 厘米"}\n'
    done = chatrobot("--json", *FAST, stdin=said)
    assert [event["turn"] for event in done.named("result")] == [1, 2, 3]
    assert done.code == 0


OBJECTS_OF_NO_KNOWN_FORM = ["{", '{"text": 3}', '{"approve": "x"}', "{}", '{"text": ""}', "{" * 5000]
OTHER_JSON = ["5", "-0.5", "null", "true", "[]", '["forward 1 m"]', '"forward 1 m"', '""']


@pytest.mark.parametrize("line", [*OBJECTS_OF_NO_KNOWN_FORM, *OTHER_JSON])
def test_a_line_that_is_no_instruction_is_told_and_ends_nothing(chatrobot: Command, line: str) -> None:
    done = chatrobot("--json", *FAST, stdin=f"{line}\nforward 1 m\n")
    assert done.code == 0
    (notice,) = done.named("notice")
    assert (notice["turn"], notice["reason"]["code"]) == (0, "bad_input_line")
    (result,) = done.named("result")
    assert (result["turn"], result["outcome"]) == (1, "completed")


def test_bytes_that_are_no_text_end_nothing(chatrobot: Command) -> None:
    done = chatrobot("--json", *FAST, stdin=b"\xff\xfe\x00\nforward 1 m\n")
    assert done.code == 0
    assert [event["outcome"] for event in done.named("result")][-1] == "completed"


def test_a_plan_is_approved_over_json(chatrobot: Command) -> None:
    with chatrobot.start("--json", "--approve", *FAST) as robot:
        robot.say("forward 1 m")
        assert robot.event("rehearsed")["needs_approval"]
        robot.say('{"approve": true}')
        assert robot.event("result")["outcome"] == "completed"
        robot.say("back 1 m")
        robot.event("rehearsed")
        robot.say('{"approve": false}')
        assert robot.event("result")["outcome"] == "refused"
        assert robot.end() == 4


# --- signals and streams ---


def test_ctrl_c_ends_a_long_simulation(chatrobot: Command) -> None:
    with chatrobot.start("do", "wait 3000 seconds", "forward 1 m", "--json", *FAST) as robot:
        robot.event("started")
        robot.process.send_signal(signal.SIGINT)
        assert robot.event("result")["outcome"] == "stopped"
        assert robot.end() == 5


def test_a_second_ctrl_c_quits_at_once_whatever_hangs(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "chatrobot", "do", "forward 500 m", "--json", "--trace", *FAST]
    command += ["--max-distance", "none", "--max-time", "none"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, env=environment(tmp_path)) as process:
        assert process.stdout is not None
        wait_until_full(process.stdout.fileno())  # nobody reads: it hangs in the middle of a write
        process.send_signal(signal.SIGINT)
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(0.5)
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE_S) == 130


MOST_OF_A_PIPE = 32768


def wait_until_full(descriptor: int) -> None:
    """Until nothing more goes into a pipe that holds something: its writer waits for a reader."""
    waiting, before, unchanged = array.array("i", [0]), 0, 0
    deadline_s = time.monotonic() + PATIENCE_S
    while unchanged < 50:
        assert time.monotonic() < deadline_s
        time.sleep(0.02)
        fcntl.ioctl(descriptor, termios.FIONREAD, waiting)
        unchanged = unchanged + 1 if waiting[0] == before > MOST_OF_A_PIPE else 0
        before = waiting[0]


def test_an_output_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "chatrobot", "do", "forward 1 m", *FAST]
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            command, stdout=full, stderr=subprocess.PIPE, env=environment(tmp_path), timeout=PATIENCE_S
        )
    assert (done.returncode, b"standard output: No space left on device" in done.stderr) == (5, True)


@pytest.mark.parametrize("closed", ["<&-", "<&- >&- 2>&-"])
def test_closed_streams_do_no_harm(tmp_path: Path, closed: str) -> None:
    command = f'"{sys.executable}" -m chatrobot do "forward 1 m" --fast --world empty {closed}'
    assert (
        subprocess.run(["sh", "-c", command], env=environment(tmp_path), timeout=PATIENCE_S).returncode == 0
    )


# --- the rest ---


def test_schema_prints_the_json_schema_of_plans(chatrobot: Command) -> None:
    done = chatrobot("schema")
    assert done.code == 0
    assert json.loads(done.out)["$id"].startswith("chatrobot-plan/")


def test_a_folder_that_is_none_is_told_in_a_sentence(chatrobot: Command, tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("", encoding="utf-8")
    done = chatrobot("do", "remember this place as home", "--config-dir", str(file), *FAST)
    assert done.code == 2
    assert "is not a folder" in done.err


def test_a_goodbye_ends_a_dialogue_and_a_session(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 0.2 m", "bye", "forward 1 m", "--json", *FAST)
    replies = ["Done: drove 0.20 m of 0.20 m.", "Goodbye."]
    assert [event["reply"] for event in done.named("result")] == replies
    assert [event["reason"]["text"] for event in done.named("notice")] == ["forward 1 m"]
    assert done.code == 4
    done = chatrobot("--json", *FAST, stdin="forward 0.2 m\nbye\nforward 1 m\nforward 2 m\n")
    replies += [f"“forward {way} m” came after the goodbye, so it was not done." for way in (1, 2)]
    assert [event["reply"] for event in done.named("result")] == replies
    assert [event["turn"] for event in done.named("interpreted")] == [1, 2]
    assert done.code == 4
    done = chatrobot("--json", *FAST, stdin="forward 0.2 m\n再见\n")
    assert (done.named("result")[-1]["reply"], done.code) == ("再见。", 0)


@pytest.mark.parametrize("line", ["quit", "Exit", "/quit", "/exit"])
def test_a_line_that_quits_lets_those_before_it_be_done_and_those_after_it_be_named(
    chatrobot: Command, line: str
) -> None:
    done = chatrobot("--json", *FAST, stdin=f"forward 0.2 m\n{line}\nforward 1 m\n{line}\nturn left\n")
    outcomes = {event["turn"]: event["outcome"] for event in done.named("result")}
    assert outcomes == {1: "completed", 2: "refused", 3: "refused"}
    assert done.code == 4
    assert chatrobot("--json", *FAST, stdin=f"forward 0.2 m\n{line}\n").code == 0


def test_a_stop_after_a_line_that_quits_overtakes_it_all_the_same(chatrobot: Command) -> None:
    done = chatrobot("--json", *FAST, stdin="wait 3000 seconds\nquit\nstop\n")
    assert {event["turn"]: event["outcome"] for event in done.named("result")} == {1: "stopped", 2: "stopped"}


@pytest.mark.parametrize("text", ["/limit", "/map big", "/release", "release the emergency stop"])
def test_a_command_of_the_console_is_told_to_be_one(chatrobot: Command, text: str) -> None:
    for done in (chatrobot("do", text, *FAST), chatrobot(*FAST, stdin=f"{text}\n")):
        assert (done.code, " console" in done.out) == (4, True)
        assert "did not understand" not in done.out


def test_an_emergency_stop_is_said_to_end_with_the_command(chatrobot: Command) -> None:
    done = chatrobot("do", "/estop", *FAST)
    assert (done.code, "holds until this command ends" in done.out) == (5, True)


def test_an_emergency_stop_names_no_way_out_that_lines_have_not(chatrobot: Command) -> None:
    done = chatrobot("--json", *FAST, stdin="/estop\nforward 1 m\n/release\n")
    replies = [event["reply"] for event in done.named("result")]
    assert ["/release" not in reply and "new one" in reply for reply in replies] == [True] * 3


def test_the_line_after_a_question_answers_it(chatrobot: Command) -> None:
    done = chatrobot("--fast", "--json", stdin="forward 5 m\nyes\nwhere are you?\n")
    assert [event["outcome"] for event in done.named("result")] == ["refused", "completed", "answered"]
    done = chatrobot("--fast", "--json", stdin="forward 5 m\nno\n")
    assert [event["outcome"] for event in done.named("result")] == ["refused", "answered"]


def test_what_a_person_sees_of_a_plan_is_tidy_and_what_runs_is_exact(chatrobot: Command) -> None:
    said = (
        "do",
        "forward 0.1 m, then turn left 1/7 turn",
        "--fast",
        "--world",
        "empty",
    )
    exact = chatrobot(*said, "--json").named("interpreted")[0]["plan_text"]
    shown = chatrobot(*said).out
    assert "51.42857142857143" in exact
    assert "turn left 51.4 deg" in shown
    assert "51.428" not in shown


def test_progress_is_no_part_of_what_a_pipe_gets(chatrobot: Command) -> None:
    assert "%" not in chatrobot("do", "forward 2 m", "--fast", "--world", "empty").out


@pytest.mark.parametrize("text", ["stop", "emergency stop"])
def test_a_stop_word_is_understood_where_nothing_can_be_stopped(chatrobot: Command, text: str) -> None:
    done = chatrobot("plan", text, "--json")
    assert (done.code, done.events[-1]["outcome"]) == (0, "answered")
