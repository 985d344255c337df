"""The tutorial's text demo with a language model that answers in its form, through the three nodes on the real wire."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from chatrobot.models.fake.server import FakeModel
from tests.models.rig import KEY, serving
from tests.nodes.node_rig import NodeRig, running
from tests.nodes.test_tutorial_demo import FIRST_PROMPT

pytestmark = pytest.mark.realtime

FORM = "linear.x = {},linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = {}"
REPLIES = [
    {"match": "^forward$", "text": FORM.format(0.3, 0)},
    {"match": "^backward$", "text": FORM.format(-0.3, 0)},
    {"match": "^left$", "text": FORM.format(0, 0.8)},
    {"match": "^right$", "text": f"I would answer “{FORM.format(0, -0.8)}” here."},
    {"match": "was not used", "text": "I would rather not."},
    {"match": "connected your output", "text": "Understood. I will answer in that form."},
]


@pytest.fixture(scope="module")
def fake() -> Iterator[FakeModel]:
    with serving(REPLIES) as served:
        yield served


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory, fake: FakeModel) -> Iterator[NodeRig]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("OPENAI_BASE_URL", f"{fake.url}/v1")
        patch.setenv("OPENAI_API_KEY", KEY)
        with running(tmp_path_factory.mktemp("nodes"), "control", "input") as made:
            made.nodes["base"] = made.start(
                "node",
                "base",
                "--on",
                "dds",
                "--model",
                "openai:fake",
                "--ros-args",
                "-p",
                "revChatGPT:=True",
            )
            made.nodes["base"].wait_for_line("openai-responses:fake")
            yield made


def test_word_for_word_with_a_model_that_answers_in_its_form(rig: NodeRig, fake: FakeModel) -> None:
    first = rig.do(FIRST_PROMPT)
    assert (first["outcome"], first["reply"]) == ("answered", "Understood. I will answer in that form.")
    x0, _, yaw0 = rig.pose()
    assert rig.do("forward")["outcome"] == "completed"
    assert rig.pose()[0] - x0 == pytest.approx(0.3, abs=0.03)
    assert rig.do("backward")["outcome"] == "completed"
    assert rig.pose()[0] - x0 == pytest.approx(0.0, abs=0.03)
    assert rig.do("left")["outcome"] == "completed"
    assert rig.pose()[2] - yaw0 == pytest.approx(0.8, abs=0.05)
    assert rig.do("right")["outcome"] == "unclear"
    assert math.isclose(rig.pose()[2] - yaw0, 0.8, abs_tol=0.05)
    assert all(call.path.endswith("/responses") for call in fake.calls)
