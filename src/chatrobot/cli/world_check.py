"""What is wrong with a world that can be read: each problem with its line, and what would be right."""

from __future__ import annotations

from collections.abc import Iterator

from chatrobot.core.errors import WorldError
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.plan.context import NoRoute
from chatrobot.plan.route import MARGIN_M, GridRoutePlanner
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.load import WorldFile
from chatrobot.sim.world import World, check_start


def problems(file: WorldFile, profile: RobotProfile) -> Iterator[WorldError]:
    """Give what keeps that robot from beginning there, or from reaching one of its places."""
    world = file.world
    try:
        check_start(world, profile, file.where_is("start"))
    except WorldError as error:
        yield error
        return  # from there no place is reached
    if _leaves_area(world, ORIGIN):
        yield WorldError(
            "the start lies outside allowed_area", where=file.where_is("start"), allowed="inside it"
        )
    if world.is_empty:
        return
    routes = GridRoutePlanner(world, profile)
    for name, pose in world.places.items():
        where = file.where_is(name)
        if _leaves_area(world, pose):
            yield WorldError(
                f"the place {name!r} lies outside allowed_area", where=where, allowed="inside it"
            )
        way = routes.route(ORIGIN, (pose.x_m, pose.y_m), named_place=True)
        if isinstance(way, NoRoute):
            yield _unreached(world, name, where, way.reason, profile)


def _leaves_area(world: World, pose: Pose) -> bool:
    return world.allowed_area is not None and world.allowed_area.distance_m(pose.x_m, pose.y_m) > 0.0


def _unreached(world: World, name: str, where: str, reason: Reason, profile: RobotProfile) -> WorldError:
    needed_m = profile.footprint_radius_m + MARGIN_M
    if reason.code != "target_blocked":
        return WorldError(
            f"there is no way from the start to the place {name!r}",
            where=where,
            allowed=f"a way that is {2.0 * needed_m:.2f} m wide everywhere: {profile.title}",
        )
    values = reason.values
    room_m, obstacle = float(values["clearance_m"]), values.get("obstacle", "an obstacle")
    stands = f"lies in the {obstacle}" if room_m <= 0.0 else f"is {room_m:.2f} m from the {obstacle}"
    free = ""
    if "nearest_x_m" in values:
        nearest = world.start.compose(Pose(float(values["nearest_x_m"]), float(values["nearest_y_m"])))
        free = f"; the nearest free point is x_m: {nearest.x_m:.2f}, y_m: {nearest.y_m:.2f}"
    return WorldError(
        f"the place {name!r} {stands}", where=where, allowed=f"{needed_m:.2f} m of room to every side{free}"
    )


_ENGLISH, _CHINESE = ("go to the {}", "drive to {}"), ("去{}", "开到{}")


def unsaid_names(file: WorldFile, profile: RobotProfile) -> Iterator[WorldError]:
    """Give the names of places that mean something else in a sentence, or nothing."""
    from chatrobot.dialogue.understanding import Understanding
    from chatrobot.language.normalise import has_chinese
    from chatrobot.plan.steps import Go

    understanding = Understanding(profile, file.world, None)
    for main in file.world.places:
        for name in file.world.names_of(main):
            for said in _CHINESE if has_chinese(name) else _ENGLISH:
                sentence = said.format(name)
                plan = understanding.interpret(sentence).plan
                step = plan.steps[0] if plan is not None and len(plan.steps) == 1 else None
                if not (isinstance(step, Go) and file.world.place(step.place) == file.world.places[main]):
                    yield WorldError(
                        f"“{sentence}” is not understood: {name!r} has a meaning of its own, or none",
                        where=file.where_is(main),
                        allowed="another name",
                    )
                    break
