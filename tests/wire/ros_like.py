"""A process that knows nothing of ours and speaks DDS with types of its own, as ROS 2 defines them.

`python ros_like.py DOMAIN say TOPIC TEXT` publishes a std_msgs/String until its standard input closes, as all do;
`… drive TOPIC VX` a geometry_msgs/Twist at 50 Hz; `… hear TOPIC` prints each String it hears.
"""

# No `from __future__ import annotations`: Cyclone reads the annotations themselves.
import select
import sys
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import float64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic


@final
@dataclass
class String_(IdlStruct, typename="std_msgs::msg::dds_::String_"):  # noqa: N801
    data: str


@final
@dataclass
class Vector3_(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):  # noqa: N801
    x: float64
    y: float64
    z: float64


@final
@dataclass
class Twist_(IdlStruct, typename="geometry_msgs::msg::dds_::Twist_"):  # noqa: N801
    linear: Vector3_
    angular: Vector3_


QOS = Qos(Policy.Reliability.Reliable(0), Policy.History.KeepLast(10), Policy.Durability.Volatile)


def main(domain: str, verb: str, topic: str, what: str = "") -> None:
    participant = DomainParticipant(int(domain))
    kind = Twist_ if verb == "drive" else String_
    described = Topic(participant, f"rt/{topic}", kind)
    if verb == "hear":
        reader = DataReader(participant, described, QOS)
        while not select.select([sys.stdin], [], [], 0.02)[0]:
            for sample in reader.take(10):
                print(sample.data, flush=True)
        return
    writer = DataWriter(participant, described, QOS)
    zero = Vector3_(0.0, 0.0, 0.0)
    message = Twist_(Vector3_(float(what), 0.0, 0.0), zero) if verb == "drive" else String_(what)
    while not select.select([sys.stdin], [], [], 0.02)[0]:
        writer.write(message)


if __name__ == "__main__":
    main(*sys.argv[1:])
