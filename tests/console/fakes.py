"""A session and a screen that only note what they are told."""

from rich.text import Text

from chatrobot.cli.drawing.map_text import MapText
from chatrobot.core.errors import LinkError
from chatrobot.core.events import Interpreted, Rehearsed
from chatrobot.core.geometry import Pose


class FakeSession:
    """Notes what it is told."""

    def __init__(self, log):
        self.log = log
        self.is_idle = True
        self.is_moving = False
        self.is_paused = self.is_plan_paused = False
        self.is_lost = False
        self.stops = 0
        self.authoring = None

    def _note(self, *what):
        if self.is_lost:
            raise LinkError("Motion is gone")
        self.log.append(what)
        return len(self.log)

    def say(self, text):
        return self._note("say", text)

    def say_program(self, text):
        return self._note("say_program", text)

    def say_plan(self, plan_text):
        return self._note("say_plan", plan_text)

    def say_edited_plan(self, plan_text, instead_of=""):  # noqa: ARG002
        return self._note("say_edited_plan", plan_text)

    def stop(self, why=""):
        self.stops += 1
        self._note("stop", why)

    def emergency_stop(self, why=""):
        self._note("emergency_stop", why)

    def release(self):
        self._note("release")

    def limit(self, **limits):
        self._note("limit", limits)

    def change_obstacle(self, **request):
        self._note("obstacle", request)

    def approve(self, turn, yes, **_):
        self._note("approve", turn, yes)


class FakeDisplay:
    """Notes what it shows in the same list."""

    width, echoes = 100, False

    def __init__(self, log):
        self.log = log

    def print(self, *lines):
        self.log += [("print", str(line) if isinstance(line, Text) else repr(line)) for line in lines]

    def refresh(self):
        pass

    def edit(self, plan_text):
        self.log.append(("edit", plan_text))

    def leave(self, code):
        self.log.append(("leave", code))


def do_posted(controller):
    """What the pumping thread would do."""
    while not controller.pump._jobs.empty():
        controller.pump._jobs.get()()


def told(log):
    """What the session was told, without what was shown."""
    return [entry for entry in log if entry[0] not in ("print",)]


def shown(log):
    return "\n".join(entry[1] for entry in log if entry[0] == "print")


def ask(controller):
    """A plan of turn 1 waits for a yes."""
    controller.hear(Interpreted(1, "offline", "drive 1 m", ""))
    controller.hear(
        Rehearsed(1, True, 3.6, 1.0, Pose(1.0), (), ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)), needs_approval=True)
    )


def draw_map_text(world, extent, *, trail=(), pose=None, **how):
    """One map, drawn at once."""
    return MapText(world, extent, **how).lines(trail=trail, pose=pose)
