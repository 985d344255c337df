"""What all tests share: a busy machine is no reason for a property to fail, so hypothesis sets no deadline."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("chatrobot", deadline=None)
settings.load_profile("chatrobot")
