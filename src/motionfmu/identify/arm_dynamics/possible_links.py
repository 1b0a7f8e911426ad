"""Values of the plant that make what was found, near to those believed before.

Base parameters leave most masses and centres open, and a plant has bounds; the links' products of
inertia about their centres stay as they are. So masses, centres, second moments and inertias of
motors are moved as little as possible, in units of what they are believed to be wrong by. They are
moved until the base parameters are those found, each weighted by its covariance. Moments of inertia
are sums of second moments in pairs, as a body has them.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from motionfmu.identify.arm_dynamics.arm_plant import ArmPlant
from motionfmu.identify.arm_dynamics.base_parameters import BaseParameters
from motionfmu.identify.arm_dynamics.link_regressor import PRODUCTS, standard

Array = NDArray[np.float64]
# What is believed before: masses, moments and motors to this share of themselves, centres to this
# share of the arm's reach over its joints [m]; the least, as a share of the largest of a kind.
_BELIEVED, _PLACE, _LEAST = 0.3, 0.3, 0.02
# What moves them counts so little beside what was found that it decides only what that leaves open.
_WEAK = 1e-2
_MOST = 300  # evaluations
# Moments of inertia of second moments, and the other way.
_PAIRS = np.ones((3, 3)) - np.eye(3)
_SECOND = 0.5 * np.ones((3, 3)) - np.eye(3)
# A base parameter is not asked to be met closer than this share of its deviation.
_LOWEST = 1e-4


@dataclass(frozen=True)
class PossibleLinks:
    """Values of the plant's parameters, in their shapes."""

    mass: Array  # (joints,) [kg]
    center: Array  # (joints, 3) [m]
    inertia: Array  # (joints, 3) [kg.m2]
    motor_inertia: Array  # (joints,) [kg.m2] at the motors
    misfit: float  # largest difference of a base parameter, in its standard deviations

    def standard(self, plant: ArmPlant) -> Array:
        """Standard parameters with the load, and the motors' inertia at the joints."""
        return _standard(plant, self.mass, self.center, self.inertia, self.motor_inertia)


def _standard(plant: ArmPlant, mass: Array, center: Array, inertia: Array, motors: Array) -> Array:
    links = standard(mass, center, inertia)
    links[:, PRODUCTS] += plant.of(plant.table.links.product)
    load = plant.table.load
    links[-1] += standard(
        plant.of(load.mass).reshape(1),
        plant.of(load.center).reshape(1, 3),
        plant.of(load.inertia).reshape(1, 3),
    )[0]
    return np.concatenate([links.ravel(), motors * plant.ratio**2])


def believed(plant: ArmPlant) -> PossibleLinks:
    """The plant's own values."""
    links = plant.table.links
    return PossibleLinks(
        plant.of(links.mass),
        plant.of(links.center),
        plant.of(links.inertia),
        plant.of(plant.table.motors.inertia),
        0.0,
    )


def possible_links(
    plant: ArmPlant,
    base: BaseParameters,
    found: tuple[Array, Array],
    motors: Mapping[int, tuple[float, float]],
) -> PossibleLinks:
    """The possible links nearest to `found`, base parameters and their covariance.

    `motors` are inertias at the joint that gears tell, with their deviations.
    """
    values, covariance = found
    n = plant.count
    before = believed(plant)
    second = np.maximum(before.inertia @ _SECOND, 0.0)
    begin = np.concatenate(
        [before.mass, before.center.ravel(), second.ravel(), before.motor_inertia]
    )
    reach = float(np.linalg.norm(plant.origins, axis=1).sum()) / n
    size = np.repeat(before.mass * (_PLACE * reach) ** 2, 3)

    def unsure(x: Array) -> Array:
        return _BELIEVED * np.maximum(np.abs(x), _LEAST * np.abs(x).max() + 1e-12)

    scale = np.concatenate(
        [
            unsure(before.mass),
            np.full(3 * n, _PLACE * reach),
            _BELIEVED * np.maximum(second.ravel(), size),
            unsure(before.motor_inertia),
        ]
    )
    s, v = np.linalg.eigh(_scaled(covariance)[0])
    unit = _scaled(covariance)[1]
    whiten = (v / np.sqrt(np.maximum(s, _LOWEST * s[-1]))).T / unit

    def parts(x: Array) -> tuple[Array, Array, Array, Array]:
        m, c, p, j = np.split(x, [n, 4 * n, 7 * n])
        return m, c.reshape(n, 3), p.reshape(n, 3) @ _PAIRS, j

    def rest(z: Array) -> Array:
        m, c, i, j = parts(begin + scale * z)
        met = whiten @ (base.combine @ _standard(plant, m, c, i, j) - values)
        gears = [(j[k] * plant.ratio[k] ** 2 - x) / d for k, (x, d) in motors.items()]
        return np.concatenate([met, gears, _WEAK * z])

    low = np.full(len(begin), -np.inf)
    low[:n] = low[4 * n :] = 0.0
    low[7 * n :] = 1e-3 * before.motor_inertia
    bounds = (low - begin) / scale
    start = np.maximum(np.zeros(len(begin)), bounds + 1e-9)
    ends = bounds, np.full(len(begin), np.inf)
    solved = least_squares(rest, start, bounds=ends, x_scale="jac", max_nfev=_MOST)
    m, c, i, j = parts(begin + scale * solved.x)
    off = base.combine @ _standard(plant, m, c, i, j) - values
    worst = float(np.abs(off / np.sqrt(np.diag(covariance))).max())
    return PossibleLinks(m, c, i, j, worst)


def _scaled(covariance: Array) -> tuple[Array, Array]:
    unit = np.sqrt(np.diag(covariance))
    return covariance / np.outer(unit, unit), unit
