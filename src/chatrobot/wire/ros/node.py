"""One ROS 2 node: a context of its own, so that nothing else in the process matters to it, and a thread that delivers.

rclpy's own signal handlers stay off: they close the context while a zero still has to go out. Who wants Ctrl-C to
end it stops the robot first, and then calls `close`.
"""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Sequence
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.exceptions import InvalidNamespaceException, InvalidNodeNameException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from chatrobot.core.errors import UsageError, WireError

JOIN_S = 5.0

_NOT_TO_THE_TERMINAL = "--disable-stdout-logs"
"""rclpy's logger publishes on /rosout and writes its file; `RosNode.log` writes to the terminal."""


class RosNode:
    """See the module. Callbacks come on its thread.

    Args:
        name: of the node; `-r __node:=…` in `ros_args` goes before it.
        namespace: without or with a leading slash; `-r __ns:=…` goes before it.
        ros_args: what stood behind `--ros-args`.
        domain_id: None for ROS_DOMAIN_ID's.

    Raises:
        UsageError: the arguments or names cannot be used.
        WireError: ROS cannot be opened here.
    """

    def __init__(
        self,
        name: str,
        *,
        namespace: str = "",
        ros_args: Sequence[str] = (),
        domain_id: int | None = None,
    ) -> None:
        self.context = Context()
        arguments = ["chatrobot", "--ros-args", _NOT_TO_THE_TERMINAL, *ros_args]
        try:
            rclpy.init(
                args=arguments,
                context=self.context,
                domain_id=domain_id,
                signal_handler_options=SignalHandlerOptions.NO,
            )
            self.handle: Any = rclpy.create_node(
                name, context=self.context, namespace=namespace.strip("/") or None
            )
        except (InvalidNodeNameException, InvalidNamespaceException) as error:
            rclpy.try_shutdown(context=self.context)
            raise UsageError(str(error), where=name) from error
        except RuntimeError as error:
            rclpy.try_shutdown(context=self.context)
            if ros_args:
                raise UsageError(f"ROS cannot use these: {error}", where="--ros-args") from error
            raise WireError(f"ROS cannot be opened: {error}") from error
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.handle)
        self._closed = False
        self._has_left = False
        self._farewell = self.handle.create_guard_condition(self._leave)
        self._thread = threading.Thread(target=self._deliver, name="ros", daemon=True)
        self._thread.start()

    @property
    def is_closed(self) -> bool:
        """It has left, or somebody has closed its context."""
        return self._closed

    @property
    def has_own_time(self) -> bool:
        """Tell whether `use_sim_time` is set: time is what `/clock` says."""
        return bool(self.handle.get_parameter("use_sim_time").value)

    def now_s(self) -> float:
        """ROS's time: that of the wall, or of a simulation; the latter is zero until `/clock` has been heard."""
        nanoseconds: int = self.handle.get_clock().now().nanoseconds
        return nanoseconds * 1e-9

    def wait_for_time(self, timeout_s: float) -> bool:
        """Block until there is a time; False where nobody tells it."""
        ends_s = time.monotonic() + timeout_s
        while self.now_s() <= 0.0:
            if time.monotonic() > ends_s:
                return False
            time.sleep(0.02)
        return True

    def log(self, severity: str, text: str) -> None:
        """Into ROS's log, and on standard error as ROS writes it there: `severity` is info, warn or error.

        Blocks its thread, and no other, where the terminal is held up (Ctrl-S) or nobody reads the pipe: rclpy itself
        would write with Python's lock held, and with it stop the whole process.
        """
        logger = self.handle.get_logger()
        stamp = self.handle.get_clock().now().nanoseconds
        seconds, nanoseconds = divmod(stamp, 1_000_000_000)
        with contextlib.suppress(OSError):
            line = f"[{severity.upper()}] [{seconds}.{nanoseconds:09d}] [{logger.name}]: {text}"
            print(line, file=sys.stderr, flush=True)
        if severity == "info":  # on lines of their own: rclpy keeps one severity for each line that calls it
            logger.info(text)
        elif severity == "warn":
            logger.warning(text)
        else:
            logger.error(text)

    def close(self) -> None:
        """Leave; from any thread, its own too. Closing twice does no harm."""
        if not self._closed:
            self._closed = True
            with contextlib.suppress(
                RuntimeError
            ):  # its thread has left already: somebody closed the context
                self._farewell.trigger()
        if self._thread is not threading.current_thread():
            self._thread.join(JOIN_S)

    def _leave(self) -> None:
        """Called by the executor on its own thread, so that nothing is destroyed that the caller still wakes."""
        self._has_left = True

    def _deliver(self) -> None:
        try:
            while not self._has_left:
                self._executor.spin_once()
        except ExternalShutdownException:
            pass  # somebody has closed the context: publishing says so from now on
        finally:
            self._closed = True
            self._executor.shutdown()
            self.handle.destroy_node()
            rclpy.try_shutdown(context=self.context)
