"""A house for each module; what a test told it is taken back."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from tests.dialogue.program_rig import House

from chatrobot.dialogue.options import Options


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[House]:
    house = House("empty", tmp_path_factory.mktemp("config"))
    yield house
    house.connection.close()


@pytest.fixture
def house(shared: House) -> Iterator[House]:
    yield shared
    shared.authoring.model, shared.authoring.prefers_model = None, False
    shared.on_event = lambda _: None
    shared.session.options = Options()
