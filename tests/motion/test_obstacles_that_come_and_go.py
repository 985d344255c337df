"""Obstacles put into a running simulation: what waits is void, what runs goes on, around it or not at all."""

from __future__ import annotations

from chatrobot.compose import Setup, connect
from chatrobot.core.events import Event, Notice, Rehearsed, Result
from chatrobot.core.geometry import ORIGIN
from chatrobot.core.sensed_events import ObstacleChanged
from chatrobot.dialogue.options import Options
from chatrobot.motion.planning_process import PlanningProcess
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.sim.shapes import Circle
from chatrobot.sim.world import Obstacle


class Talk:
    """A session on simulated time in the furnished home."""

    def __init__(self, **options: bool) -> None:
        self.events: list[Event] = []
        setup = Setup(world="home", fast=True, options=Options(**options))  # type: ignore[arg-type]
        self.connection = connect(setup, self.events.append)
        self.session = self.connection.session

    def put_while(self, text: str, circle: list[float], after_s: float = 3.0) -> Result:
        """Say it, put a box there after so long, and see it through."""
        turn = self.session.say(text)
        self.pump(after_s)
        self.session.change_obstacle(add="box", circle=circle)
        return self.session.see_through(turn)

    def pump(self, duration_s: float) -> None:
        for _ in range(round(duration_s / 0.1)):
            self.session.pump(0.1)

    def told(self, kind: type[Event]) -> list[Event]:
        return [event for event in self.events if isinstance(event, kind)]

    @property
    def codes(self) -> list[str]:
        return [event.reason.code for event in self.events if isinstance(event, Notice)]


def test_a_way_that_is_not_free_any_more_leads_around_what_was_put_there() -> None:
    talk = Talk()
    result = talk.put_while("go to the kitchen", [1.2, 0.55, 0.2])
    kitchen = talk.connection.world.places["kitchen"]
    assert result.outcome == "completed"
    assert result.pose.distance_to(kitchen) < 0.05
    assert talk.codes == ["obstacle_added", "way_changed"]
    assert len(talk.told(Rehearsed)) == 2
    assert len(talk.told(Result)) == 1


def test_a_way_without_another_ends_where_the_robot_stands_and_says_why() -> None:
    talk = Talk()
    result = talk.put_while("forward 2 m", [1.5, 0.0, 0.2])
    assert result.outcome == "refused"
    assert "box" in result.reply
    assert 0.5 < result.pose.x_m < 1.1
    talk.session.change_obstacle(remove="box")
    talk.pump(1.0)  # until the lidar has seen that it is gone
    assert talk.session.do("forward 0.5 m").outcome == "completed"


def test_what_is_put_beside_the_way_changes_nothing() -> None:
    talk = Talk()
    assert talk.put_while("forward 2 m", [1.0, -1.0, 0.2]).outcome == "completed"
    assert talk.codes == ["obstacle_added"]


def test_a_question_is_void_once_something_was_put_anywhere() -> None:
    talk = Talk(approve=True)
    turn = talk.session.say("forward 1 m")
    talk.pump(0.5)
    assert turn not in talk.session.results
    talk.session.change_obstacle(add="box", circle=[-1.0, 0.0, 0.1])
    result = talk.session.see_through(turn)
    talk.session.approve(turn, yes=True)
    talk.session.pump(1.0)
    assert (result.outcome, result.path_m) == ("refused", 0.0)
    assert result.reason is not None
    assert result.reason.code == "approval_world_changed"


def test_a_stop_while_a_way_is_looked_for_is_a_stop() -> None:
    talk = Talk()
    turn = talk.session.say("go to the kitchen")
    talk.pump(3.0)
    talk.session.change_obstacle(add="box", circle=[1.2, 0.55, 0.2])
    talk.session.stop("enough")
    result = talk.session.see_through(turn)
    talk.session.pump(2.0)
    assert result.outcome == "stopped"
    assert len(talk.told(Rehearsed)) == 1


def test_what_was_put_there_is_known_and_cannot_stand_on_the_robot() -> None:
    talk = Talk()
    for request in ({"add": "box", "circle": [1.0, 1.0, 0.2]}, {"add": "box", "circle": [0.1, 0.0, 0.2]},
                    {"add": "far", "circle": [50.0, 1.0, 0.2]}, {"remove": "sofa"},
                    {"add": "x", "polygon": [[1, 1], [2, 2]]}):  # fmt: skip
        talk.session.change_obstacle(**request)
        talk.session.pump(0.1)
    assert talk.codes == [
        "obstacle_added", "obstacle_on_robot", "obstacle_far", "obstacle_unknown", "obstacle_unclear",
    ]  # fmt: skip
    assert len(talk.told(ObstacleChanged)) == 1
    assert [one.name for one in talk.connection.world.obstacles if one.is_added] == ["box"]
    assert "box" in talk.session.do("left 1 m, then forward 1 m").reply


def test_a_pupils_obstacle_is_in_that_pupils_rehearsals_alone() -> None:
    process = PlanningProcess(load_profile("wheeltec_mini_mec"), load_world("home"), 2)
    one, other = process.planners
    one.add((Obstacle("box", Circle(1.0, 0.0, 0.2)),))
    try:
        planned = [planner.plan(1, "drive 2 m", ORIGIN) for planner in (one, other)]
    finally:
        process.close()
        process.kill()
    assert [each.ok for each in planned] == [False, True]
