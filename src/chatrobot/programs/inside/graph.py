"""Who publishes, listens and serves within the program: the topics and services that need nobody outside.

Publishers and services are known by their handles.
"""

from __future__ import annotations

from copy import deepcopy
from typing import Any

_subscriptions: dict[str, list[Any]] = {}
_publishers: dict[str, list[Any]] = {}
_services: dict[str, Any] = {}
nodes: list[Any] = []


def add_subscription(subscription: Any) -> None:
    """What was published before comes to it if both sides keep it (transient local)."""
    _subscriptions.setdefault(subscription.handle.name, []).append(subscription)
    for publisher in _publishers.get(subscription.handle.name, ()):
        for message in publisher.kept_for(subscription):
            subscription._receive(deepcopy(message))


def remove_subscription(subscription: Any) -> None:
    _subscriptions[subscription.handle.name].remove(subscription)


def add_publisher(publisher: Any) -> None:
    _publishers.setdefault(publisher.name, []).append(publisher)


def remove_publisher(publisher: Any) -> None:
    _publishers[publisher.name].remove(publisher)


def publish(publisher: Any, message: Any) -> None:
    """To every subscription of that topic and type, each with a copy of its own."""
    for subscription in tuple(_subscriptions.get(publisher.name, ())):
        if subscription.msg_type is publisher.msg_type:
            subscription._receive(deepcopy(message))


def count_publishers(topic: str) -> int:
    return len(_publishers.get(topic, ()))


def count_subscriptions(topic: str) -> int:
    return len(_subscriptions.get(topic, ()))


def topic_types() -> list[tuple[str, list[str]]]:
    found: dict[str, list[str]] = {}
    for ends in (_publishers, _subscriptions):
        for topic, entities in ends.items():
            for entity in entities:
                names = found.setdefault(topic, [])
                if entity.msg_type._type_name not in names:
                    names.append(entity.msg_type._type_name)
    return sorted(found.items())


def add_service(service: Any) -> None:
    _services[service.name] = service


def remove_service(service: Any) -> None:
    if find_service(service.name, service.srv_type) is service:
        del _services[service.name]


def find_service(name: str, srv_type: Any) -> Any:
    """None where nobody serves it."""
    service = _services.get(name)
    return service if service is not None and service.srv_type is srv_type else None


def service_types() -> list[tuple[str, list[str]]]:
    return sorted((name, [served.srv_type._type_name]) for name, served in _services.items())
