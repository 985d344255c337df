"""How a client goes that has crashed: without a goodbye."""

from __future__ import annotations

import contextlib
import socket

from chatrobot.link.in_process import InProcessLink, SecondInProcessLink
from chatrobot.link.motion_link import MotionLink
from chatrobot.link.socket_link import SocketLink
from chatrobot.link.topic_link import TopicLink


def abandon(link: MotionLink) -> None:
    """Let its client be gone: Motion stops the robot at once."""
    if isinstance(link, (InProcessLink, SecondInProcessLink)):
        link.beats, link._closed = False, True
        if isinstance(link, InProcessLink):
            link._motion.lose(link.sender.lease)
        else:
            link._first._motion.lose_second(link.sender.lease)
        return
    assert isinstance(link, (SocketLink, TopicLink))
    link._closed.set()
    if isinstance(link, SocketLink):
        with contextlib.suppress(OSError):
            link._line.shutdown(socket.SHUT_RDWR)
