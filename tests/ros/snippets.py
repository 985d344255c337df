"""Small programs whose printed lines are the same in the box and under rclpy."""

# ruff: noqa: E501 - programs in strings
from __future__ import annotations

HEAD = """import time, sys, warnings
warnings.simplefilter("ignore")
import rclpy, rclpy.logging, rclpy.utilities
from std_msgs.msg import String
from geometry_msgs.msg import Twist
from std_srvs.srv import Trigger
def t(f):
    try: r = f(); print("->", r if isinstance(r, (int, float, str, bool, list, type(None))) else type(r).__name__)
    except BaseException as e: print(type(e).__module__ + "." + type(e).__name__, "|", (str(e).splitlines() or [""])[0].split(", at /")[0].split(" object at")[0])
rclpy.init()
"""
SNIPPETS = {
    "node": """n = rclpy.create_node("n", namespace="/ns")
print(n.get_name(), n.get_namespace(), n.get_fully_qualified_name(), n.get_logger().name)
print(n.resolve_topic_name("t"), n.resolve_topic_name("/t"), n.resolve_topic_name("~/t"), n.resolve_service_name("s"))
p = n.create_publisher(String, "chat", 5)
print(p.topic_name, p.qos_profile.depth, p.get_subscription_count())
s = n.create_subscription(String, "chat", lambda m: None, 5)
time.sleep(0.3)
print(s.topic_name, p.get_subscription_count(), n.count_subscribers("chat"), s.topic_name)
print(len(list(n.publishers)) > 0, len(list(n.subscriptions)), len(list(n.timers)), len(list(n.clients)))
print(n.destroy_publisher(p), n.destroy_publisher(p), n.destroy_subscription(s))
""",
    "node errors": """for name in ("1abc", "", "a b", "a/b", "ünï"):
    t(lambda: rclpy.create_node(name))
for ns in ("bad ns", "/a//b", "x/1y"):
    t(lambda: rclpy.create_node("ok", namespace=ns))
n = rclpy.create_node("n")
for topic in ("", "a b", "1abc", "/a/1b", "a//b", "a/", "~x", "a~", "{x}", "a-b", "/", "~", "foo/~"):
    t(lambda: n.create_publisher(String, topic, 10))
t(lambda: n.create_service(Trigger, "bad srv", lambda a, b: b))
t(lambda: n.create_client(Trigger, "bad srv"))
t(lambda: n.create_publisher(String, "x", "10"))
t(lambda: n.create_publisher(String, "x", -1))
t(lambda: n.create_publisher(String, "x", 1.5))
t(lambda: n.create_subscription(String, "x", lambda m: None))
t(lambda: n.create_timer("1", lambda: None))
t(lambda: n.create_timer(-1.0, lambda: None))
t(lambda: n.create_rate(0))
t(lambda: setattr(n, "timers", []))
t(lambda: setattr(n, "clients", []))
t(lambda: setattr(n, "services", []))
t(lambda: setattr(n, "subscriptions", []))
t(lambda: setattr(n, "handle", 1))
""",
    "types": """n = rclpy.create_node("n")
t(lambda: n.create_publisher("std_msgs/String", "x", 10))
t(lambda: n.create_publisher(str, "x", 10))
t(lambda: n.create_publisher(Trigger, "x", 10))
t(lambda: n.create_service(String, "x", lambda a, b: b))
p = n.create_publisher(String, "x", 10)
for bad in ("text", 5, None, Twist()):
    t(lambda: p.publish(bad))
t(lambda: p.publish())
c = n.create_client(Trigger, "s")
t(lambda: c.call_async("x"))
t(lambda: c.call_async(Trigger))
print(c.service_is_ready(), c.wait_for_service(timeout_sec=0.2))
""",
    "parameters": """from rclpy.parameter import Parameter
from rcl_interfaces.msg import ParameterDescriptor, FloatingPointRange, IntegerRange
n = rclpy.create_node("n")
print(n.declare_parameter("a", 1).value, n.declare_parameter("b", 2.5).value, n.declare_parameter("c", "x").type_)
print([p.name for p in n.declare_parameters("ns", [("d", True), ("e", [1, 2]), ("f", ["x"])])])
t(lambda: n.declare_parameter("a", 1))
t(lambda: n.declare_parameter("", 1))
t(lambda: n.declare_parameter(5, 1))
t(lambda: n.get_parameter("zzz"))
t(lambda: n.get_parameter("ns.e").value)
t(lambda: n.get_parameter("ns.d").get_parameter_value().bool_value)
t(lambda: n.set_parameters([Parameter("zzz", value=1)]))
t(lambda: n.set_parameters(["a"]))
r = n.set_parameters([Parameter("a", value=3), Parameter("b", value=1), Parameter("c", value="y")])
print([(x.successful, x.reason) for x in r], n.get_parameter("a").value, n.get_parameter("c").value)
t(lambda: n.get_parameter_or("zzz", Parameter("zzz", value=9)).value)
print(n.has_parameter("a"), n.has_parameter("use_sim_time"), n.get_parameter("use_sim_time").value)
n.undeclare_parameter("a"); t(lambda: n.get_parameter("a")); t(lambda: n.undeclare_parameter("a"))
n.declare_parameter("ro", 1, ParameterDescriptor(read_only=True))
r = n.set_parameters([Parameter("ro", value=2)])
print(r[0].successful, r[0].reason)
t(lambda: n.undeclare_parameter("ro"))
n.declare_parameter("rg", 0.5, ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)]))
r = n.set_parameters([Parameter("rg", value=2.0)])
print(r[0].successful, r[0].reason)
t(lambda: n.declare_parameter("rh", 7, ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=5)])))
n.declare_parameter("typed", Parameter.Type.DOUBLE)
t(lambda: n.get_parameter("typed"))
print(n.describe_parameter("rg").type, n.get_parameter_type("rg"), sorted(n.get_parameters_by_prefix("ns")))
t(lambda: Parameter("x", Parameter.Type.INTEGER, 1.0))
print(Parameter("x", value=[1.0]).type_, Parameter("x").type_, Parameter("x", Parameter.Type.STRING, "q").value)
n2 = rclpy.create_node("n2", allow_undeclared_parameters=True)
print(n2.get_parameter("foo").value, n2.get_parameter("foo").type_, n2.set_parameters([Parameter("foo", value=1)])[0].successful, n2.get_parameter("foo").value)
n3 = rclpy.create_node("n3", parameter_overrides=[Parameter("o", value=5)])
print(n3.declare_parameter("o", 1).value)
t(lambda: rclpy.create_node("n4", parameter_overrides=[Parameter("o", value=5)]).declare_parameter("o", "x"))
""",
    "qos": """from rclpy.qos import *
from rclpy.duration import Duration
t(lambda: QoSProfile())
t(lambda: QoSProfile(history=HistoryPolicy.KEEP_LAST))
t(lambda: QoSProfile(depth="x"))
q = QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.TRANSIENT_LOCAL)
print(q.depth, repr(q.reliability), repr(q.durability), repr(q.history), q == QoSProfile(depth=3), q != q)
print(qos_profile_sensor_data.depth, repr(qos_profile_sensor_data.reliability), qos_profile_system_default.depth)
print(QoSReliabilityPolicy.RELIABLE, ReliabilityPolicy.RELIABLE.value, QoSHistoryPolicy.KEEP_ALL.value, DurabilityPolicy.VOLATILE.value)
print(QoSPresetProfiles.SENSOR_DATA.value.depth, ReliabilityPolicy.RELIABLE.short_key, HistoryPolicy.short_keys())
""",
    "time": """from rclpy.time import Time
from rclpy.duration import Duration, Infinite
from rclpy.clock import Clock, ClockType
a, b = Time(seconds=1.5), Time(seconds=1, nanoseconds=5)
print(a, b, a - b, a > b, a == b, a.seconds_nanoseconds(), a.to_msg(), Duration(seconds=1.25), str(Duration(seconds=1)))
print(a + Duration(seconds=1), a - Duration(seconds=1), Duration(seconds=2) > Duration(seconds=1), Duration(seconds=1) == Duration(nanoseconds=10**9))
for f in (lambda: a - Time(clock_type=ClockType.ROS_TIME), lambda: a < Time(clock_type=ClockType.ROS_TIME), lambda: Time(seconds=-1), lambda: a + 1, lambda: a - 1,
          lambda: Time(seconds=2**62), lambda: a < 1, lambda: a == 1, lambda: b - Duration(seconds=5), lambda: Duration(seconds=2**62), lambda: Time(clock_type=5), lambda: Duration(1)):
    t(f)
n = rclpy.create_node("n")
c = n.get_clock()
print(c, c.clock_type, type(c).__name__, type(c.now()).__name__, Clock(), abs(c.now().nanoseconds / 1e9 - time.time()) < 1)
print(type(c.now() - c.now()).__name__, c.ros_time_is_active)
print(Duration(seconds=1).to_msg(), Duration.from_msg(Duration(seconds=1).to_msg()))
""",
    "timers": """n = rclpy.create_node("n")
calls = []
tm = n.create_timer(0.1, lambda: calls.append(1))
print(tm.is_ready(), tm.is_canceled(), tm.timer_period_ns, 0 < tm.time_until_next_call() <= 10**8, tm.time_since_last_call() >= 0)
end = time.monotonic() + 0.55
while time.monotonic() < end: rclpy.spin_once(n, timeout_sec=0.02)
print(len(calls))
tm.cancel(); print(tm.is_canceled(), tm.time_until_next_call())
rclpy.spin_once(n, timeout_sec=0.2); print(len(calls))
tm.reset(); print(tm.is_canceled()); rclpy.spin_once(n, timeout_sec=0.3); print(len(calls))
print(n.destroy_timer(tm), n.destroy_timer(tm))
t(lambda: tm.cancel()); t(lambda: tm.is_ready()); t(lambda: tm.reset())
late = []
tm2 = n.create_timer(0.1, lambda: late.append(round(time.monotonic() - t0, 1)))
t0 = time.monotonic()
time.sleep(0.35)
for _ in range(3): rclpy.spin_once(n, timeout_sec=0.3)
print(late)
""",
    "pubsub": """n = rclpy.create_node("n")
got = []
s = n.create_subscription(String, "chat", lambda m: got.append(m.data), 10)
p = n.create_publisher(String, "chat", 10)
time.sleep(0.3)
m = String()
for i in range(3):
    m.data = str(i); p.publish(m)
time.sleep(0.3)
for _ in range(8): rclpy.spin_once(n, timeout_sec=0.05)
print(got)
got2 = []
n.create_subscription(String, "chat", lambda m, info: got2.append((m.data, type(info).__name__ in ("dict", "MessageInfo"))), 3)
time.sleep(0.3)
p.publish(String(data="z"))
time.sleep(0.2)
for _ in range(4): rclpy.spin_once(n, timeout_sec=0.05)
print(got, got2)
n.destroy_publisher(p); t(lambda: p.publish(m))
""",
    "order": """n = rclpy.create_node("n")
log = []
def tick():
    log.append("t"); time.sleep(0.12)
n.create_timer(0.1, tick)
s = n.create_subscription(String, "chat", lambda m: log.append(m.data), 10)
p = n.create_publisher(String, "chat", 10)
time.sleep(0.3)
for i in range(3): p.publish(String(data=str(i)))
time.sleep(0.2)
for _ in range(6): rclpy.spin_once(n, timeout_sec=0.01)
print(log)
""",
    "futures": """from rclpy.task import Future, Task
f = Future()
print(f.done(), f.result(), f.cancelled(), f.exception())
f.add_done_callback(lambda x: print("cb", x is f, x.result()))
f.set_result(3); print(f.done(), f.result())
f.add_done_callback(lambda x: print("late"))
g = Future(); g.set_exception(ValueError("no")); t(lambda: g.result()); print(g.exception(), g.done())
h = Future(); h.cancel(); print(h.cancelled(), h.done(), h.result())
n = rclpy.create_node("n")
k = Future()
n.create_timer(0.1, lambda: k.set_result("ok"))
print(rclpy.spin_until_future_complete(n, k), k.result())
b = time.monotonic(); rclpy.spin_until_future_complete(n, Future(), timeout_sec=0.3); print(round(time.monotonic() - b, 1))
""",
    "services": """from rclpy.executors import SingleThreadedExecutor
n = rclpy.create_node("n"); m = rclpy.create_node("m")
srv = n.create_service(Trigger, "go", lambda req, res: (setattr(res, "message", "hi"), res)[1])
c = m.create_client(Trigger, "go")
print(c.wait_for_service(2.0), srv.srv_name, c.srv_name)
ex = SingleThreadedExecutor(); ex.add_node(n); ex.add_node(m)
f = c.call_async(Trigger.Request())
ex.spin_until_future_complete(f, timeout_sec=2.0)
print(f.done(), f.result())
bad = n.create_service(Trigger, "bad", lambda req, res: None)
c2 = m.create_client(Trigger, "bad"); c2.wait_for_service(2.0)
f2 = c2.call_async(Trigger.Request())
t(lambda: ex.spin_until_future_complete(f2, timeout_sec=1.0)); print(f2.done())
boom = n.create_service(Trigger, "boom", lambda req, res: 1 / 0)
c3 = m.create_client(Trigger, "boom"); c3.wait_for_service(2.0)
f3 = c3.call_async(Trigger.Request())
t(lambda: ex.spin_until_future_complete(f3, timeout_sec=1.0)); print(f3.done())
print(set(ex.get_nodes()) == {n, m}, n.executor is ex, ex.add_node(n)); ex.remove_node(n); print(n.executor is ex)
""",
    "executors": """from rclpy.executors import *
from rclpy.callback_groups import *
n = rclpy.create_node("n")
ex = SingleThreadedExecutor()
print(ex.add_node(n), ex.add_node(n), n.executor is ex)
b = time.monotonic(); ex.spin_once(timeout_sec=0.2); print(round(time.monotonic() - b, 1))
task = ex.create_task(lambda a: a * 2, 21); ex.spin_once(timeout_sec=0.5); print(task.done(), task.result())
async def co(): return "co"
task = ex.create_task(co); ex.spin_until_future_complete(task, timeout_sec=1.0); print(task.result())
ex.shutdown(); ex.spin_once(timeout_sec=0.1); ex.spin(); print("past")
print(n.default_callback_group.__class__.__name__)
""",
    "lifecycle": """n = rclpy.create_node("n")
print(rclpy.ok(), n.context.ok())
t(lambda: rclpy.init())
rclpy.shutdown()
print(rclpy.ok(), n.context.ok())
t(lambda: rclpy.shutdown())
t(lambda: rclpy.create_node("late"))
t(lambda: rclpy.spin(n))
t(lambda: rclpy.spin_once(n, timeout_sec=0.1))
t(lambda: n.create_timer(1.0, lambda: None))
t(lambda: n.create_publisher(String, "x", 10))
n.destroy_node(); n.destroy_node()
rclpy.try_shutdown(); rclpy.init(); print(rclpy.ok()); rclpy.try_shutdown(); rclpy.try_shutdown(); print(rclpy.ok())
rclpy.init(args=["--ros-args", "-r", "a:=b"]); print(rclpy.utilities.remove_ros_args(["prog", "x", "--ros-args", "-r", "a:=b", "--", "y"]))
t(lambda: rclpy.init(None))
""",
    "destroyed": """n = rclpy.create_node("n")
p = n.create_publisher(String, "x", 10)
tm = n.create_timer(1.0, lambda: None)
c = n.create_client(Trigger, "s")
n.destroy_node()
t(lambda: p.publish(String())); t(lambda: tm.cancel()); t(lambda: c.service_is_ready()); t(lambda: c.call_async(Trigger.Request()))
t(lambda: n.create_publisher(String, "y", 10)); t(lambda: n.create_timer(1.0, lambda: None)); t(lambda: n.get_name()); t(lambda: rclpy.spin_once(n, timeout_sec=0.1))
""",
    "logging": """n = rclpy.create_node("n")
l = n.get_logger()
print(l.get_effective_level(), l.is_enabled_for(10), l.info("x"), l.debug("y"), l.get_child("k").name)
t(lambda: l.info("x", foo=1)); t(lambda: l.info()); t(lambda: l.info(5)); t(lambda: l.info("a", "b")); t(lambda: rclpy.logging.get_logger(""))
l.set_level(rclpy.logging.LoggingSeverity.WARN); print(l.info("z"), l.warn("w"), l.warning("w"), l.error("e"), l.fatal("f"))
for i in range(3): print(l.error("once", once=True), l.error("skip", skip_first=True), l.error("thr", throttle_duration_sec=10.0))
print(rclpy.logging.get_logger("q").name, rclpy.logging.LoggingSeverity.INFO.value)
""",
}
