from types import SimpleNamespace

import pytest

from chatrobot.cli.console import commands
from chatrobot.cli.console.talk import Talk
from chatrobot.cli.console.words import Words
from chatrobot.core.clock import VirtualClock
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from tests.console.fakes import FakeFace, FakeSession


@pytest.fixture
def log():
    return []


@pytest.fixture
def talk(log):
    connection = SimpleNamespace(
        session=FakeSession(log), world=load_world("home"), profile=load_profile("wheeltec_mini_mec")
    )
    talk = Talk(connection, Words(), VirtualClock(), commands.run)
    talk.face = FakeFace(log)
    return talk
