"""rclpy.callback_groups"""

from __future__ import annotations

from typing import Any


class CallbackGroup:
    """Says which callbacks may run beside which. Entities that no executor may run now wait."""

    def __init__(self) -> None:
        self.entities: set[int] = set()

    def add_entity(self, entity: Any) -> None:
        self.entities.add(id(entity))

    def has_entity(self, entity: Any) -> bool:
        return id(entity) in self.entities

    def can_execute(self, entity: Any) -> bool:
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Any number at a time."""

    def can_execute(self, entity: Any) -> bool:
        return True

    def beginning_execution(self, entity: Any) -> bool:
        return True

    def ending_execution(self, entity: Any) -> None:
        pass


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One at a time."""

    def __init__(self) -> None:
        super().__init__()
        self._active: Any = None

    def can_execute(self, entity: Any) -> bool:
        return self._active is None

    def beginning_execution(self, entity: Any) -> bool:
        if self._active is not None:
            return False
        self._active = entity
        return True

    def ending_execution(self, entity: Any) -> None:
        if self._active is entity:
            self._active = None
