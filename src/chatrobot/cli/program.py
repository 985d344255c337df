"""`chatrobot program ACTION …`: programs written, kept, shown, run, exported."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Callable
from pathlib import Path

from chatrobot.cli.approval import edited_text
from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.folders import config_folder, profile_folders
from chatrobot.cli.json_lines import json_line, printer_for
from chatrobot.cli.keyboard import Keyboard
from chatrobot.cli.lines import has_keyboard
from chatrobot.cli.parameters import with_parameter_files
from chatrobot.cli.recorder import recorded
from chatrobot.core.errors import UsageError
from chatrobot.dialogue.options import Options
from chatrobot.language.phrases import render_reason, say
from chatrobot.language.program_request import may_be_called
from chatrobot.link.envelope import MAX_CODE_CHARS
from chatrobot.programs.check import no_python
from chatrobot.programs.library import KeptProgram, Library, clean_name
from chatrobot.programs.ros_args import RosArgumentsError, check_args

_READ_BYTES = 1_000_000


def run(args: argparse.Namespace) -> int:
    """Return the exit code of the last turn, or 0 where nothing was to be driven.

    Raises:
        InputError: there is no such program, file or folder.
    """
    return _ACTIONS[args.action](args)


def _library(args: argparse.Namespace) -> Library:
    return Library(config_folder(args))


# --- those that drive ---


def _new(args: argparse.Namespace) -> int:
    return _drive(args, lambda conversation: conversation.session.say_program(args.text, args.called))


def _run(args: argparse.Namespace) -> int:
    path = Path(args.name).expanduser()
    source = _read(path) if path.suffix == ".py" else None
    program = _library(args).get(args.name) if source is None else None
    given = with_parameter_files(args.program_args)  # in the sandbox it can open none
    try:
        check_args(given)
    except RosArgumentsError as error:
        raise UsageError(str(error), where="behind --") from error

    def say(conversation: Conversation) -> int:
        authoring = conversation.session.authoring
        assert authoring is not None
        draft = authoring.draft_of(program) if program else authoring.draft_of_file(path, source or "")
        return conversation.session.say_draft(draft.with_args(given))

    return _drive(args, say)


def _read(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(_READ_BYTES + 1)
    except OSError as error:
        raise UsageError(f"cannot be read ({error.strerror})", where=str(path)) from error
    if len(data) > _READ_BYTES:
        allowed = f"{MAX_CODE_CHARS} characters at most"
        raise UsageError(f"longer than {_READ_BYTES} bytes", where=str(path), allowed=allowed)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise UsageError("not UTF-8 text", where=str(path)) from error


def _drive(args: argparse.Namespace, say: Callable[[Conversation], int]) -> int:
    printer = printer_for(args)
    can_ask = has_keyboard() and not args.json
    is_new = args.action == "new"
    options = Options(
        approve=args.approve and not args.yes,
        ask_findings=not args.yes,
        ask_new=is_new and can_ask and not args.yes,
    )
    approver = Approver(can_ask=can_ask)
    setup = setup_from(args, options=options, programs=True)
    with Conversation(setup, printer, approver, recorded(args)) as conversation:
        Keyboard(conversation, approver).start()
        conversation.see_through_edits(say(conversation))
    return conversation.exit_code


# --- those that do not ---


def _list(args: argparse.Namespace) -> int:
    from rich.cells import cell_len, set_cell_size

    programs = _library(args).all()
    for program in programs:
        if args.json:
            print(json_line({"event": "program", **_about(program)}), end="")
        else:
            print(f"{set_cell_size(program.name, max(24, cell_len(program.name) + 2))}{_summary(program)}")
    if not programs and not args.json:
        print('No programs are kept yet: chatrobot program new "…"')
    return 0


def _about(program: KeptProgram) -> dict[str, object]:
    provenance = program.provenance
    return {
        "name": program.name,
        "description": program.description,
        "sentence": provenance.sentence,
        "by": provenance.author,
        "model": provenance.model_name,
        "date": provenance.date,
        "versions": provenance.versions,
        "rehearsal": dict(program.rehearsal),
        "runs": [vars(run) for run in program.runs],
    }


def _summary(program: KeptProgram) -> str:
    parts = [program.provenance.model_name or program.provenance.author]
    if program.rehearsal:
        parts.append(f"{program.rehearsal['duration_s']:.1f} s, {program.rehearsal['length_m']:.2f} m")
    if program.runs:
        parts.append(f"runs: {len(program.runs)}, last {program.runs[-1].outcome}")
    return "  ".join(parts)


def _show(args: argparse.Namespace) -> int:
    from chatrobot.dialogue.programs.draft import numbered
    from chatrobot.programs.check import check
    from chatrobot.robots.load import load_profile

    library = _library(args)
    program = library.get(args.name)
    place = library.place(program.name)
    if args.json:
        about = {"event": "program", **_about(program), "source": program.source, "place": place}
        print(json_line(about), end="")
        return 0
    profile = load_profile(args.robot, profile_folders(args))
    print(f"{program.name}  ({_summary(program)})")
    if program.provenance.sentence:
        print(f"asked for: {' '.join(program.provenance.sentence.split())}")
    print(f"source: {place}")
    if program.description:
        print(program.description)
    for run in program.runs:
        print(f"run {run.date}: {run.outcome}, {run.path_m:.2f} m, {run.duration_s:.1f} s")
    print()
    for line in numbered(program.source, check(program.source, profile).marks, "en"):
        print(line)
    return 0


def _edit(args: argparse.Namespace) -> int:
    library = _library(args)
    program = library.get(args.name)
    if not (args.file or has_keyboard()):
        raise UsageError(
            "an editor needs a terminal",
            allowed=f"chatrobot program edit {shlex.quote(args.name)} --file FILE.py",
        )
    source = _read(Path(args.file).expanduser()) if args.file else edited_text(program.source, ".py")
    if source == program.source:
        print("Nothing was changed.")
        return 0
    problem = no_python(source)
    if problem is not None:
        where = args.file or _set_aside(library.place(program.name), source)
        way_out = f"“{program.name}” stays as it was; mend the file, then --file {shlex.quote(where)}"
        raise UsageError(render_reason(problem.reason, "en").rstrip("."), where=where, allowed=way_out)
    library.edit(program.name, source)
    print(f"Saved “{program.name}”. It is rehearsed again when it runs.")
    return 0


def _set_aside(place: str, source: str) -> str:
    """Keep what was typed beside the program, for it to be mended; return where."""
    path = Path(place).with_name("edited.py")
    path.write_text(source, encoding="utf-8")
    return str(path)


def _rename(args: argparse.Namespace) -> int:
    library = _library(args)
    old = library.get(args.name).name
    if old == clean_name(args.to):
        print(f"“{old}” has that name already.")
        return 0
    if not may_be_called(args.to):
        raise UsageError(say("en", "program_no_name", name=args.to).rstrip("."), allowed="another name")
    library.rename(old, args.to)
    print(f"Renamed “{old}” to “{clean_name(args.to)}”.")
    return 0


def _remove(args: argparse.Namespace) -> int:
    library = _library(args)
    name = library.get(args.name).name
    library.remove(name)
    print(f"Removed “{name}”.")
    return 0


def _export(args: argparse.Namespace) -> int:
    from chatrobot.programs.export import export, workspace

    program = _library(args).get(args.name)
    folder = export(program, Path(args.dir).expanduser())
    for path in sorted(workspace(program)):
        print(f"{args.dir}/{path}")
    print(f"To build and run it where ROS 2 is: {shlex.quote(f'{folder}/build_run.sh')}")
    return 0


_ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "new": _new, "list": _list, "show": _show, "run": _run,
    "edit": _edit, "rename": _rename, "remove": _remove, "export": _export,
}  # fmt: skip
