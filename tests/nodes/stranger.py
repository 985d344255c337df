"""A process that knows nothing of ours: says one std_msgs/String as ROS 2 defines it, once somebody listens.

`python stranger.py DOMAIN TOPIC TEXT`
"""

# No `from __future__ import annotations`: Cyclone reads the annotations themselves.
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@final
@dataclass
class String_(IdlStruct, typename="std_msgs::msg::dds_::String_"):  # noqa: N801
    data: str


def main(domain: str, topic: str, text: str) -> None:
    participant = DomainParticipant(int(domain))
    qos = Qos(Policy.Reliability.Reliable(0), Policy.History.KeepLast(10), Policy.Durability.Volatile)
    writer = DataWriter(participant, Topic(participant, f"rt/{topic}", String_), qos)
    while writer.get_publication_matched_status().current_count == 0:
        time.sleep(0.01)
    writer.write(String_(text))
    writer.wait_for_acks(duration(seconds=5))


if __name__ == "__main__":
    main(*sys.argv[1:])
