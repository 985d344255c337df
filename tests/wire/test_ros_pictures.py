"""Cameras' messages become pictures, or nothing: whatever a driver, a library or a bridge makes of their bytes."""

from __future__ import annotations

import base64
from array import array
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.wiring import Wiring
from chatrobot.wire.messages import Picture
from chatrobot.wire.ros_messages import (
    MOST_BYTES,
    compressed_from,
    file_format,
    image_from,
    is_sensor,
    read_depth,
    ros_form,
)

ROWS = bytes(range(12))


def image(**but: Any) -> Any:
    fields = {"encoding": "rgb8", "width": 2, "height": 2, "step": 6, "data": ROWS, **but}
    return SimpleNamespace(**fields)


@pytest.mark.parametrize(
    "data",
    [
        ROWS,
        np.frombuffer(ROWS, np.uint8),
        array("B", ROWS),
        list(ROWS),
        base64.b64encode(ROWS).decode(),
    ],
    ids=["bytes", "rosbags", "rclpy", "rosbridge, as numbers", "rosbridge, as base64"],
)
def test_bytes_are_the_same_in_every_library_s_clothes(data: Any) -> None:
    assert image_from(image(data=data), 1.0) == Picture(1.0, "rgb8", 2, 2, 6, ROWS)


@pytest.mark.parametrize(
    ("told", "meant"),
    [("rgb8", "rgb8"), ("bgr8", "bgr8"), ("mono8", "mono8"), ("8UC1", "mono8"), ("8UC3", "bgr8")],
)
def test_eight_bit_colours_and_grey_are_pictures(told: str, meant: str) -> None:
    picture = image_from(image(encoding=told), 1.0)
    assert picture is not None
    assert picture.encoding == meant


@pytest.mark.parametrize("encoding", ["16UC1", "32FC1", "yuv422_yuy2", "bayer_rggb8", ""])
def test_depths_and_what_we_cannot_show_are_passed_over(encoding: str) -> None:
    assert image_from(image(encoding=encoding), 1.0) is None


@pytest.mark.parametrize(
    "lie",
    [
        {"height": 3}, {"width": 3}, {"width": 0}, {"height": -1}, {"step": 5}, {"data": b""}, {"data": "no base64"},
        {"data": None}, {"data": bytes(MOST_BYTES + 1)}, {"data": [256]}, {"width": "wide"},
    ],
)  # fmt: skip
def test_numbers_that_contradict_the_bytes_are_an_error_of_the_kinds_promised(lie: dict[str, Any]) -> None:
    with pytest.raises((AttributeError, TypeError, ValueError)):
        image_from(image(**lie), 1.0)


@pytest.mark.parametrize(
    ("data", "encoding"),
    [(b"\xff\xd8\xff\xe0", "jpeg"), (b"\x89PNG\r\n\x1a\n", "png"), (b"GIF89a", ""), (b"", "")],
)
def test_a_file_is_what_its_first_bytes_say_whatever_the_driver_calls_it(data: bytes, encoding: str) -> None:
    assert file_format(data) == encoding
    found = compressed_from(SimpleNamespace(format="rgb8; jpeg compressed bgr8", data=data), 1.0)
    assert (found.encoding if found is not None else "") == encoding


@given(st.binary(max_size=64), st.integers(), st.integers(), st.integers(), st.text(max_size=8))
def test_whatever_comes_is_a_whole_picture_or_none(
    data: bytes, width: int, height: int, step: int, encoding: str
) -> None:
    try:
        picture = image_from(image(data=data, width=width, height=height, step=step, encoding=encoding), 1.0)
    except ValueError:
        return
    assert picture is None or len(picture.data) >= picture.row_bytes * picture.height_px > 0


def test_the_profile_decides_the_type_of_its_camera_s_topic_alone() -> None:
    wiring = Wiring(camera_topic="camera", camera_type="CompressedImage")
    assert ros_form("camera", Picture, wiring).type_name == "sensor_msgs/msg/CompressedImage"
    assert ros_form("other", Picture, wiring).type_name == "sensor_msgs/msg/Image"
    assert ros_form("camera", Picture, Wiring(camera_topic="camera")).type_name == "sensor_msgs/msg/Image"


def test_a_camera_is_listened_to_as_a_sensor_and_only_its_newest_picture_is_kept() -> None:
    assert is_sensor("camera", Picture, Wiring())
    assert read_depth(Picture) == 1
