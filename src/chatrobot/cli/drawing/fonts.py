"""The fonts of pictures: pillow's own for everything but Chinese, and what the system has."""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from PIL import ImageFont

Font = ImageFont.FreeTypeFont | ImageFont.ImageFont

_HAN_FILES = (
    "NotoSansCJK*", "NotoSansSC*", "SourceHanSans*", "wqy-microhei*", "wqy-zenhei*", "DroidSansFallback*",
    "PingFang*", "Hiragino*GB*", "STHeiti*", "msyh*", "simhei*", "uming*", "ukai*",
)  # fmt: skip


@cache
def latin(size_px: int) -> Font:
    """Return the font for everything but Chinese."""
    return ImageFont.load_default(size_px)


@cache
def han(size_px: int) -> Font | None:
    """Return a font that has Chinese, None on a system without one."""
    return installed(_HAN_FILES, size_px)


def is_latin(text: str) -> bool:
    """Tell whether `latin` has every character of `text`."""
    return all(ord(char) < 0x250 or char in "–—‘’“”…°·×" for char in text)


def font_for(text: str, size_px: int) -> Font | None:
    """Return a font that can show `text`, None where there is none."""
    return latin(size_px) if is_latin(text) else han(size_px)


def installed(files: tuple[str, ...], size_px: int) -> Font | None:
    """Return the first of these files that the system has as a font, None where it has none of them."""
    path = _find(files)
    return ImageFont.truetype(str(path), size_px) if path is not None else None


@cache
def _find(patterns: tuple[str, ...]) -> Path | None:
    for pattern in patterns:
        for folder in _folders():
            found = next((path for path in sorted(folder.rglob(pattern)) if path.is_file()), None)
            if found is not None:
                return found
    return None


def _folders() -> Iterator[Path]:
    data = Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local/share")
    folders = (
        *(data / "fonts", Path.home() / ".fonts", Path("/usr/share/fonts"), Path("/usr/local/share/fonts")),
        *(Path("/System/Library/Fonts"), Path("/Library/Fonts"), Path("C:/Windows/Fonts")),
    )
    return (folder for folder in folders if folder.is_dir())
