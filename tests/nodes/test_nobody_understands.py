"""`input` says so where only `control` listens: it hears stops and understands nothing else."""

from __future__ import annotations

from contextlib import ExitStack, closing

import pytest

from chatrobot.core.wiring import Wiring
from chatrobot.link.topic_link import CONTROL, OPERATOR, USER_INPUT
from chatrobot.nodes.input import InputNode
from chatrobot.wire.connect import wire_address
from chatrobot.wire.dds.wire import DdsWire
from chatrobot.wire.discovery import Discovery
from chatrobot.wire.messages import Text
from tests.nodes import node_rig
from tests.processes import wait_until

ADDRESS = wire_address("dds")


@pytest.fixture
def domain() -> Discovery:
    return Discovery(domain_id=next(node_rig._domains))


def is_heard(node: InputNode) -> bool:
    return node.say("forward 30 cm")


def test_an_order_that_no_base_hears_is_told(domain: Discovery) -> None:
    def wire(name: str) -> DdsWire:
        return stack.enter_context(closing(DdsWire(Wiring(), name, discovery=domain)))

    with ExitStack() as stack:
        control = wire("chatrobot_control")
        control.subscribe(USER_INPUT, Text, lambda _: None)
        control.publish(CONTROL, Text("{}"))
        node = stack.enter_context(
            closing(InputNode(ADDRESS, Wiring(), lambda _: None, lambda _, __, name: wire(name)))
        )
        wait_until(lambda: not is_heard(node))
        base = wire("chatrobot_base")
        base.subscribe(OPERATOR, Text, lambda _: None)
        base.subscribe(USER_INPUT, Text, lambda _: None)
        wait_until(lambda: is_heard(node))
        base.close()
        wait_until(lambda: not is_heard(node))


def test_a_node_of_ones_own_that_listens_is_enough(domain: Discovery) -> None:
    with closing(DdsWire(Wiring(), "my_base", discovery=domain)) as own:
        own.subscribe(USER_INPUT, Text, lambda _: None)
        with closing(
            InputNode(
                ADDRESS, Wiring(), lambda _: None, lambda _, w, name: DdsWire(w, name, discovery=domain)
            )
        ) as node:
            assert is_heard(node)
