"""rclpy.event_handler"""

from __future__ import annotations

from typing import Any


class _Callbacks:
    def __init__(self, **callbacks: Any) -> None:
        self.__dict__.update(callbacks)


class PublisherEventCallbacks(_Callbacks):
    """Taken and never called: in the box no QoS goes wrong."""


class SubscriptionEventCallbacks(_Callbacks):
    """Taken and never called: in the box no QoS goes wrong."""
