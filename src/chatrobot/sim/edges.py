"""Edges and circles as arrays: clearance, contact with a footprint, and rays, all at once for a whole world."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from chatrobot.core.geometry import Pose
from chatrobot.sim.shapes import Circle, Point, Polygon, Shape

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


class Footprint:
    """A convex, counter-clockwise polygon as half-planes: inside is where `normals @ p <= offsets`."""

    def __init__(self, points: tuple[Point, ...]) -> None:
        self.corners = np.array(points, dtype=float)  # [sides, 2]
        self.sides = np.roll(self.corners, -1, axis=0) - self.corners
        outward = np.stack((self.sides[:, 1], -self.sides[:, 0]), axis=1)
        self.normals = outward / np.linalg.norm(outward, axis=1, keepdims=True)
        self.offsets = np.einsum("ij,ij->i", self.normals, self.corners)


class Edges:
    """The outlines of shapes: `_starts`, `_vectors` [m, 2] of polygon edges, `_centres` [k, 2], `_radii` [k]."""

    def __init__(self, shapes: Sequence[Shape]) -> None:
        corners = [
            (a, (b[0] - a[0], b[1] - a[1]))
            for shape in shapes
            if isinstance(shape, Polygon)
            for a, b in zip(shape.points, shape.points[1:] + shape.points[:1])
        ]
        circles = [shape for shape in shapes if isinstance(shape, Circle)]
        self._starts = np.array([a for a, _ in corners], dtype=float).reshape(-1, 2)
        self._vectors = np.array([v for _, v in corners], dtype=float).reshape(-1, 2)
        self._lengths_squared = np.maximum(np.einsum("ij,ij->i", self._vectors, self._vectors), 1e-18)
        self._centres = np.array([(c.x_m, c.y_m) for c in circles], dtype=float).reshape(-1, 2)
        self._radii = np.array([c.radius_m for c in circles], dtype=float)

    def clearance_m(self, x_m: float, y_m: float) -> float:
        """Return metres from a point to the nearest outline."""
        nearest_m = math.inf
        if len(self._starts):
            to_point = np.array((x_m, y_m)) - self._starts
            along = np.einsum("ij,ij->i", to_point, self._vectors) / self._lengths_squared
            gap = to_point - np.clip(along, 0.0, 1.0)[:, None] * self._vectors
            nearest_m = math.sqrt(float(np.einsum("ij,ij->i", gap, gap).min()))
        if len(self._radii):
            to_centre = np.hypot(self._centres[:, 0] - x_m, self._centres[:, 1] - y_m)
            nearest_m = min(nearest_m, float(np.abs(to_centre - self._radii).min()))
        return nearest_m

    def touch(self, body: Footprint, pose: Pose) -> bool:
        """Return True where any outline meets the footprint of a robot at `pose`."""
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        turn = np.array(((cos, -sin), (sin, cos)))
        position = np.array((pose.x_m, pose.y_m))
        return self._edges_touch(body, turn, position) or self._circles_touch(body, turn, position)

    def _edges_touch(self, body: Footprint, turn: Floats, position: Floats) -> bool:
        """Clip all edges against the footprint's half-planes at once: Cyrus and Beck (1978)."""
        if not len(self._starts):
            return False
        into_normals = turn @ body.normals.T
        gaps = (self._starts - position) @ into_normals - body.offsets  # [m, sides], above 0 is outside
        slopes = self._vectors @ into_normals
        slopes[np.abs(slopes) < 1e-12] = 1e-12  # parallel: crosses far away, on the right side
        crossings = -gaps / slopes
        enters = np.where(slopes < 0.0, crossings, 0.0).max(axis=1)
        leaves = np.where(slopes > 0.0, crossings, 1.0).min(axis=1)
        return bool(np.any(np.maximum(enters, 0.0) <= np.minimum(leaves, 1.0)))

    def _circles_touch(self, body: Footprint, turn: Floats, position: Floats) -> bool:
        if not len(self._radii):
            return False
        centres = (self._centres - position) @ turn
        inside = np.all(centres @ body.normals.T <= body.offsets, axis=1)
        to_centre = centres[:, None, :] - body.corners[None, :, :]
        along = np.einsum("ijk,jk->ij", to_centre, body.sides) / np.einsum("jk,jk->j", body.sides, body.sides)
        gaps = to_centre - np.clip(along, 0.0, 1.0)[:, :, None] * body.sides[None, :, :]
        distances = np.linalg.norm(gaps, axis=2).min(axis=1)
        return bool(np.any(inside | (distances <= self._radii)))

    def raycast(self, eye: Pose, beams: int) -> Floats:
        """Return metres along `beams` equally spaced directions, the first at -pi in the frame of `eye`.

        Returns:
            [beams]; inf where a ray meets nothing.
        """
        angles = eye.yaw_rad - math.pi + math.tau / beams * np.arange(beams)
        directions = np.stack((np.cos(angles), np.sin(angles)))  # [2, beams]
        ranges = np.full(beams, np.inf)
        if len(self._starts):
            np.minimum(ranges, self._ray_to_edges(eye, directions), out=ranges)
        if len(self._radii):
            np.minimum(ranges, self._ray_to_circles(eye, directions), out=ranges)
        return ranges

    def _ray_to_edges(self, eye: Pose, directions: Floats) -> Floats:
        """Ray eye + r d meets edge a + u e where r = (a x e) / (d x e) and u = (a x d) / (d x e)."""
        beams = directions.shape[1]
        to_start = self._starts - np.array((eye.x_m, eye.y_m))
        edges, which = self._pairs(to_start, eye.yaw_rad, beams)
        (ax, ay), (ex, ey) = to_start[edges].T, self._vectors[edges].T
        dx, dy = directions[:, which]
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / (dx * ey - dy * ex)
            ranges = (ax * ey - ay * ex) * inverse
            along = (dy * ax - dx * ay) * inverse
            is_hit = (along >= 0.0) & (along <= 1.0) & (ranges >= 0.0)
        nearest = np.full(beams, np.inf)
        np.minimum.at(nearest, which[is_hit], ranges[is_hit])
        return nearest

    def _pairs(self, to_start: Floats, yaw_rad: float, beams: int) -> tuple[Indices, Indices]:
        """Return the edges and the beams that may meet, each [pairs]: beams between the ends of an edge as the eye sees
        it, and one more on either side. A map has thousands of edges, each in the way of a few beams."""
        to_end = to_start + self._vectors
        per_rad = beams / math.tau
        begin = (np.arctan2(to_start[:, 1], to_start[:, 0]) - yaw_rad + math.pi) * per_rad
        end = (np.arctan2(to_end[:, 1], to_end[:, 0]) - yaw_rad + math.pi) * per_rad
        span = (end - begin + beams / 2.0) % beams - beams / 2.0
        first = np.floor(np.minimum(begin, begin + span)).astype(np.intp) - 1
        counts = np.minimum(np.ceil(np.abs(span)).astype(np.intp) + 4, beams)
        edges = np.repeat(np.arange(len(counts)), counts)
        nth = np.arange(len(edges)) - np.repeat(np.cumsum(counts) - counts, counts)
        return edges, (first[edges] + nth) % beams

    def _ray_to_circles(self, eye: Pose, directions: Floats) -> Floats:
        to_centre = self._centres - np.array((eye.x_m, eye.y_m))
        along = to_centre @ directions  # [k, beams]
        beside_squared = np.einsum("ij,ij->i", to_centre, to_centre)[:, None] - along**2
        squared = self._radii[:, None] ** 2
        half_chord = np.sqrt(np.maximum(squared - beside_squared, 0.0))
        ranges = along - half_chord
        ranges = np.where(ranges >= 0.0, ranges, along + half_chord)  # from within: the far rim
        np.copyto(ranges, np.inf, where=(beside_squared > squared) | (ranges < 0.0))
        nearest: Floats = ranges.min(axis=0)
        return nearest
