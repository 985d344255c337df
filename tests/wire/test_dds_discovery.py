"""ROS's environment variables decide whom DDS meets; ours default to this machine."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest

from chatrobot.core.errors import UsageError, WireError
from chatrobot.wire.dds.graph import dds_topic_name
from chatrobot.wire.discovery import Discovery, configuration, discovery_from

ADDRESSES = ["192.168.1.7"]


@pytest.mark.parametrize(
    ("environ", "reach"),
    [
        ({}, "LOCALHOST"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, "SUBNET"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"}, "SUBNET"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "off"}, "OFF"),
        ({"ROS_LOCALHOST_ONLY": "1"}, "LOCALHOST"),
        ({"ROS_LOCALHOST_ONLY": "0"}, "SUBNET"),
        ({"ROS_LOCALHOST_ONLY": "1", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, "LOCALHOST"),
        ({"ROS_LOCALHOST_ONLY": "0", "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, "LOCALHOST"),
    ],
)
def test_the_range_is_ros_s_and_by_default_this_machine(environ: dict[str, str], reach: str) -> None:
    assert discovery_from(environ).range == reach


def test_the_domain_is_the_address_s_or_the_environment_s() -> None:
    assert discovery_from({}).domain_id == 0
    assert discovery_from({"ROS_DOMAIN_ID": "42"}).domain_id == 42
    assert discovery_from({"ROS_DOMAIN_ID": "42"}, 7).domain_id == 7


@pytest.mark.parametrize(
    "environ",
    [
        {"ROS_DOMAIN_ID": "233"},
        {"ROS_DOMAIN_ID": "-1"},
        {"ROS_DOMAIN_ID": "²"},
        {"ROS_AUTOMATIC_DISCOVERY_RANGE": "all"},
    ],
)
def test_what_cannot_be_used_is_named(environ: dict[str, str]) -> None:
    with pytest.raises(UsageError, match=next(iter(environ))):
        discovery_from(environ)


def test_peers_are_asked_one_by_one() -> None:
    discovery = discovery_from(
        {"CHATROBOT_PEERS": "robot, 10.0.0.5", "ROS_STATIC_PEERS": "10.0.0.5;10.0.0.6;"}
    )
    assert discovery.peers == ("robot", "10.0.0.5", "10.0.0.6")
    asked = [peer.get("address") for peer in ET.fromstring(configuration(discovery, ADDRESSES)).iter("Peer")]
    assert asked == ["localhost", "192.168.1.7", "robot", "10.0.0.5", "10.0.0.6"]


def test_a_machine_with_loopback_alone_is_not_asked_for_another_interface() -> None:
    def interfaces(addresses: list[str]) -> list[dict[str, str]]:
        return [
            found.attrib
            for found in ET.fromstring(configuration(Discovery(), addresses)).iter("NetworkInterface")
        ]

    loopback = {"address": "127.0.0.1", "priority": "0"}
    assert interfaces([]) == [loopback]
    assert interfaces(ADDRESSES) == [{"autodetermine": "true", "priority": "1"}, loopback]


def test_only_in_localhost_range_do_multicasts_stay_here() -> None:
    def lifetime(reach: str) -> str | None:
        discovery = discovery_from({"ROS_AUTOMATIC_DISCOVERY_RANGE": reach})
        return ET.fromstring(configuration(discovery, ADDRESSES)).findtext(".//MulticastTimeToLive")

    assert lifetime("LOCALHOST") == "0"
    assert lifetime("SUBNET") is None


def test_a_peer_s_name_cannot_break_the_configuration() -> None:
    configured = configuration(Discovery(peers=('"/><General>',)), ADDRESSES)
    assert [peer.get("address") for peer in ET.fromstring(configured).iter("Peer")][-1] == '"/><General>'


def test_the_user_s_own_configuration_alone_counts() -> None:
    assert (
        configuration(discovery_from({"CYCLONEDDS_URI": "file:///mine.xml"}), ADDRESSES) == "file:///mine.xml"
    )


@pytest.mark.parametrize(
    ("topic", "namespace", "name"),
    [
        ("cmd_vel", "", "rt/cmd_vel"),
        ("cmd_vel", "robot1", "rt/robot1/cmd_vel"),
        ("turtle1/pose", "/robot1/", "rt/robot1/turtle1/pose"),
        ("/clock", "robot1", "rt/clock"),
    ],
)
def test_topics_have_the_names_ros_gives_them(topic: str, namespace: str, name: str) -> None:
    assert dds_topic_name(topic, namespace) == name


@pytest.mark.parametrize("topic", ["", "/", "a b", "a//b", "a/", "速度", "rt;x"])
def test_what_is_no_topic_is_refused(topic: str) -> None:
    with pytest.raises(WireError):
        dds_topic_name(topic, "")
