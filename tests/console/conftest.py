from types import SimpleNamespace

import pytest

from chatrobot.cli.console import commands
from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.console.words import Words
from chatrobot.core.clock import VirtualClock
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from tests.console.fakes import FakeDisplay, FakeSession


@pytest.fixture
def log():
    return []


@pytest.fixture
def controller(log):
    connection = SimpleNamespace(
        session=FakeSession(log), world=load_world("home"), profile=load_profile("wheeltec_mini_mec")
    )
    controller = ChatController(connection, Words(), VirtualClock(), commands.run)
    controller.display = FakeDisplay(log)
    return controller
