"""tf_transformations: Euler angles (static axes, `sxyz`) and quaternions (x, y, z, w)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Any:
    """Roll, pitch, yaw to [x, y, z, w]."""
    _check(axes)
    ci, si = math.cos(ai / 2.0), math.sin(ai / 2.0)
    cj, sj = math.cos(aj / 2.0), math.sin(aj / 2.0)
    ck, sk = math.cos(ak / 2.0), math.sin(ak / 2.0)
    return np.array(
        [
            si * cj * ck - ci * sj * sk,
            ci * sj * ck + si * cj * sk,
            ci * cj * sk - si * sj * ck,
            ci * cj * ck + si * sj * sk,
        ]
    )


def euler_from_quaternion(quaternion: Sequence[float], axes: str = "sxyz") -> tuple[float, float, float]:
    """[x, y, z, w] to roll, pitch, yaw; a quaternion of zeros is no turn."""
    _check(axes)
    x, y, z, w = (float(value) for value in quaternion)
    norm = x * x + y * y + z * z + w * w
    if norm < 1e-12:
        return 0.0, 0.0, 0.0
    roll = math.atan2(2.0 * (w * x + y * z), norm - 2.0 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x) / norm)))
    yaw = math.atan2(2.0 * (w * z + x * y), norm - 2.0 * (y * y + z * z))
    return roll, pitch, yaw


def quaternion_multiply(quaternion1: Sequence[float], quaternion0: Sequence[float]) -> Any:
    x0, y0, z0, w0 = quaternion0
    x1, y1, z1, w1 = quaternion1
    return np.array(
        [
            x1 * w0 + y1 * z0 - z1 * y0 + w1 * x0,
            -x1 * z0 + y1 * w0 + z1 * x0 + w1 * y0,
            x1 * y0 - y1 * x0 + z1 * w0 + w1 * z0,
            -x1 * x0 - y1 * y0 - z1 * z0 + w1 * w0,
        ]
    )


def quaternion_conjugate(quaternion: Sequence[float]) -> Any:
    x, y, z, w = quaternion
    return np.array([-x, -y, -z, w])


def quaternion_inverse(quaternion: Sequence[float]) -> Any:
    conjugate = quaternion_conjugate(quaternion)
    return conjugate / np.dot(conjugate, conjugate)


def _check(axes: str) -> None:
    if axes != "sxyz":
        raise NotImplementedError(f"axes {axes!r}: only 'sxyz' (roll, pitch, yaw) is available here")
