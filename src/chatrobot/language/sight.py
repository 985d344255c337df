"""Questions about what an eye would see. Without one they are answered by what the lidar measures."""

from __future__ import annotations

import re

_SIGHT = re.compile(
    r"\b(?:see|seeing|camera|picture|photo|image|colou?r|look(?:s|ing)? like)\b|看|颜色|照片|图片|摄像头|相机",
    re.IGNORECASE,
)
_ASKS = re.compile(
    r"[?？吗呢]|什么|谁|几|哪|^\W*(?:what|who|which|where|how|is|are|do|does|can|could|tell|describe)\b",
    re.IGNORECASE,
)


def asks_to_see(text: str) -> bool:
    """Whether `text` asks for what only a picture shows."""
    return bool(_SIGHT.search(text) and _ASKS.search(text))
