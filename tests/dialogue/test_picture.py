"""Whatever a camera sends, a model is shown a small JPEG of it, or nothing."""

from __future__ import annotations

import io

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from chatrobot.dialogue.llm.camera import MOST_SIDE_PX, as_jpeg
from chatrobot.wire.messages import Picture

RED, GREEN = (200, 30, 20), (20, 180, 40)


def raw(encoding: str, width: int = 64, height: int = 48, padding: int = 5) -> Picture:
    """Left half red, right half green, with some bytes at the end of each row that mean nothing."""
    pixels = {
        "rgb8": (bytes(RED), bytes(GREEN)),
        "bgr8": (bytes(reversed(RED)), bytes(reversed(GREEN))),
        "mono8": (b"\x20", b"\xe0"),
    }[encoding]
    row = pixels[0] * (width // 2) + pixels[1] * (width // 2) + b"\xaa" * padding
    return Picture(1.0, encoding, width, height, len(row), row * height)


def file(format: str, size: tuple[int, int] = (64, 48), **options: object) -> bytes:
    stream = io.BytesIO()
    Image.new("RGB", size, RED).save(stream, format, **options)  # type: ignore[arg-type]
    return stream.getvalue()


def opened(jpeg: bytes | None) -> Image.Image:
    assert jpeg is not None
    image = Image.open(io.BytesIO(jpeg), formats=("JPEG",))
    image.load()
    return image


@pytest.mark.parametrize("encoding", ["rgb8", "bgr8"])
def test_colours_are_the_ones_the_camera_saw_whatever_their_order(encoding: str) -> None:
    image = opened(as_jpeg(raw(encoding)))
    assert image.size == (64, 48)
    assert image.getpixel((10, 20)) == pytest.approx(RED, abs=12)
    assert image.getpixel((50, 40)) == pytest.approx(GREEN, abs=12)


def test_grey_stays_grey() -> None:
    image = opened(as_jpeg(raw("mono8")))
    assert image.mode == "L"
    assert image.getpixel((10, 20)) == pytest.approx(0x20, abs=8)


@pytest.mark.parametrize("encoding", ["jpeg", "png"])
def test_a_compressed_picture_is_shown_too(encoding: str) -> None:
    image = opened(as_jpeg(Picture(1.0, encoding, 0, 0, 0, file(encoding))))
    assert image.getpixel((10, 20)) == pytest.approx(RED, abs=12)


@pytest.mark.parametrize(
    "picture",
    [raw("rgb8", 1920, 1080), Picture(1.0, "jpeg", 0, 0, 0, file("jpeg", (1080, 1920)))],
    ids=["raw", "jpeg"],
)
def test_a_large_picture_is_made_small(picture: Picture) -> None:
    jpeg = as_jpeg(picture)
    assert max(opened(jpeg).size) == MOST_SIDE_PX
    assert jpeg is not None
    assert len(jpeg) < 150_000


def test_where_it_was_taken_and_with_what_stays_here() -> None:
    exif = Image.Exif()
    exif[0x010F] = "a camera's maker"
    assert not opened(as_jpeg(Picture(1.0, "jpeg", 0, 0, 0, file("jpeg", exif=exif)))).getexif()


@pytest.mark.parametrize("encoding", ["jpeg", "png"])
@pytest.mark.parametrize("keep", [3, 20, 200])
def test_a_file_that_breaks_off_is_no_picture(encoding: str, keep: int) -> None:
    assert as_jpeg(Picture(1.0, encoding, 0, 0, 0, file(encoding, (640, 480))[:keep])) is None


def test_a_small_file_that_claims_to_be_vast_is_not_unpacked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("chatrobot.dialogue.llm.camera.MOST_PIXELS", 640 * 480)
    assert as_jpeg(Picture(1.0, "png", 0, 0, 0, file("png", (640, 480)))) is not None
    assert as_jpeg(Picture(1.0, "png", 0, 0, 0, file("png", (641, 480)))) is None


@given(st.data())
def test_a_file_with_broken_bytes_is_a_picture_or_none_and_never_an_error(data: st.DataObject) -> None:
    encoding = data.draw(st.sampled_from(["jpeg", "png"]))
    broken = bytearray(file(encoding))
    for at in data.draw(st.lists(st.integers(0, len(broken) - 1), max_size=5)):
        broken[at] = data.draw(st.integers(0, 255))
    jpeg = as_jpeg(Picture(1.0, encoding, 0, 0, 0, bytes(broken)))
    assert jpeg is None or max(opened(jpeg).size) <= MOST_SIDE_PX
