"""Two masses joined by a spring, found from their frequency response.

On the side of the drive, all in its unit of angle or way, with k + c s the spring and its damper:

    G(s) = (J2 s^2 + (c + d2) s + k) / (s D(s)) e^(-s T),
    D(s) = J1 J2 s^3 + (J1 (c + d2) + J2 (c + d1)) s^2
           + (J1 k + J2 k + c (d1 + d2) + d1 d2) s + k (d1 + d2)

is the motion per torque; the antiresonance is sqrt(k/J2), the resonance sqrt(k (1/J1 + 1/J2)).
"""

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.measured_response.response_estimate import MeasuredResponse
from motionfmu.base.errors import InputError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# Relative deviation above which a quantity is not told.
VAGUE = 0.3
# Relative error that no measured response is without: what a linear model leaves.
_LEAST = 2e-3
# Two masses are told if one leaves so much more of the weighted squares, in units of what is left
# of each: three quantities more take 3 of noise, and 50 by chance never.
_BETTER = 50.0
_FAR = 60.0  # logarithms beyond which nothing changes
_SHARES = ("motor", "load", "stiffness", "damping", "load_viscous", "ratio", "antiresonance")
_NOTHING = 1e-9  # of an information of 1: nothing is known
_NEAR = 6  # frequencies to either side whose differences weigh one
_WINDOW = np.ones(2 * _NEAR + 1) / (2 * _NEAR + 1)
_SMALL = 0.01  # share of the other mass, below which one is none
_STARTS, _BEST = 60, 4  # frequencies at which a search begins, and how many are followed


@dataclass(frozen=True)
class MassModel:
    """Two masses with a spring, friction and a delay.

    All on the side of the drive.

    Attributes
    ----------
    motor, load : float
        Inertias [kg.m2, or kg].
    stiffness, damping : float
        Of the spring [N.m/rad, or N/m] and its damper [N.m.s/rad, or N.s/m].
    motor_viscous, load_viscous : float
        Friction per speed.
    delay : float
        [s].
    """

    motor: float
    load: float = 0.0
    stiffness: float = math.inf
    damping: float = 0.0
    motor_viscous: float = 0.0
    load_viscous: float = 0.0
    delay: float = 0.0

    @property
    def antiresonance(self) -> float:
        """Frequency at which the motor stands [rad/s], without damping."""
        return math.sqrt(self.stiffness / self.load) if self.load > 0.0 else math.inf

    @property
    def resonance(self) -> float:
        """Frequency at which both swing [rad/s], without damping."""
        if not self.load > 0.0:
            return math.inf
        return math.sqrt(self.stiffness * (1.0 / self.motor + 1.0 / self.load))

    def response(self, omega: Array, load: bool = False) -> Complex:
        """Motion of the motor, or of the load, per torque.

        Parameters
        ----------
        omega : ndarray
            [rad/s].
        load : bool
            Whether the load's motion is wanted.

        Returns
        -------
        ndarray of complex
        """
        s = 1j * omega
        late = np.exp(-s * self.delay)
        if not self.load > 0.0:
            viscous = self.motor_viscous + self.load_viscous
            return np.asarray(late / (s * (self.motor * s + viscous)))
        spring = self.stiffness + self.damping * s
        one = (self.motor * s + self.motor_viscous) * s
        two = (self.load * s + self.load_viscous) * s
        whole = one * (two + spring) + two * spring
        return np.asarray(late * (spring if load else two + spring) / whole)


@dataclass(frozen=True)
class MassFit:
    """Two masses found from a response, and how sure they are.

    Attributes
    ----------
    model : MassModel
    deviations : dict
        Standard deviation of each quantity of the model, and of ``antiresonance``, ``resonance``
        [rad/s] and ``ratio`` (load over motor); infinite if it is not told.
    why : dict
        Why a quantity is not told, by its name.
    two : bool
        Whether the response shows two masses; else `model` is one, in `MassModel.motor`.
    left : float
        RMS of the difference of response and model, over the larger of them.
    alone : float
        The same of one mass.
    """

    model: MassModel
    deviations: Mapping[str, float]
    why: Mapping[str, str]
    two: bool
    left: float
    alone: float
    correlation: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def told(self, name: str) -> bool:
        """Whether a quantity is known.

        Parameters
        ----------
        name : str

        Returns
        -------
        bool
        """
        return name not in self.why

    @property
    def ratio(self) -> float:
        """Inertia of the load over that of the motor."""
        return self.model.load / self.model.motor


@dataclass(frozen=True)
class _MassProblem:
    """Weighted residuals of a model in logarithms of its quantities."""

    omega: Array
    values: Complex
    weight: Array
    motor_viscous: float
    load: bool
    scale: float  # [s] of a delay of 1

    def model(self, x: Array) -> MassModel:
        x = np.clip(x, -_FAR, _FAR)
        whole, viscous = math.exp(x[0]), float(x[1]) * math.exp(x[0])
        delay = float(x[2]) * self.scale
        left = viscous - self.motor_viscous
        if len(x) == 3:
            return MassModel(whole, 0.0, math.inf, 0.0, self.motor_viscous, left, delay)
        ratio, anti = math.exp(x[3]), math.exp(x[4])
        load = whole * ratio / (1.0 + ratio)
        stiffness = anti * anti * load
        damping = math.exp(x[5]) * 2.0 * math.sqrt(stiffness * load)
        return MassModel(
            whole / (1.0 + ratio), load, stiffness, damping, self.motor_viscous, left, delay
        )

    def rest(self, x: Array) -> Array:
        away = (self.model(x).response(self.omega, self.load) - self.values) * self.weight
        return np.concatenate([away.real, away.imag])


def fit_masses(
    measured: MeasuredResponse, motor_viscous: float = 0.0, load: bool = False
) -> MassFit:
    """Fit two masses to a response of motion per torque.

    Weighted least squares of the complex values; deviations are those of the response, or of what
    is left, whichever is larger.

    Parameters
    ----------
    measured : MeasuredResponse
        Motion (angle or way) per torque or force, in units of the SI.
    motor_viscous : float
        Friction per speed on the side of the motor, which acts as that of the load does.
    load : bool
        Whether the load's motion was measured.

    Returns
    -------
    MassFit

    Raises
    ------
    InputError
        The response has less frequencies than are needed.
    """
    n = len(measured.omega)
    if n < 8:
        raise InputError(f"{measured.name}: {n} frequencies; 8 at least are wanted for two masses")
    size = np.abs(measured.values)
    known = np.where(np.isfinite(measured.deviation), measured.deviation, 0.0)
    rough = 0.05 * size if not known.any() else known
    weight = math.sqrt(2.0) / np.hypot(rough, _LEAST * size)  # of the real and imaginary part
    scale = 1.0 / float(measured.omega.max())
    problem = _MassProblem(measured.omega, measured.values, weight, motor_viscous, load, scale)
    first = _search(problem, _starts(problem, True), "soft_l1")
    # what no linear model explains (friction that is no line) repeats in every period: it is seen
    # in what is left around a frequency only
    rest = apart(measured.values, problem.model(first[0]).response(measured.omega, load))
    near = np.sqrt(np.convolve(np.pad(rest**2, _NEAR, "edge"), _WINDOW, "valid"))
    problem = replace(problem, weight=1.0 / np.maximum(1.0 / weight, math.sqrt(0.5) * near * size))
    one = _search(problem, _starts(problem, False))
    two = _search(problem, [first[0], *_starts(problem, True)[:1]])
    alone, both = (_left(problem, x) for x in (one[0], two[0]))
    model = problem.model(two[0])
    low, high = float(measured.omega.min()), float(measured.omega.max())
    seen = low < model.antiresonance < 1.05 * high if not load else low < model.resonance < high
    gained = 2 * n * ((alone[1] / max(both[1], 1e-300)) ** 2 - 1.0)
    shown = min(model.load, model.motor) > _SMALL * max(model.load, model.motor)
    told = bool(gained > _BETTER and seen and shown)
    x, jac = two if told else one
    model = problem.model(x)
    # a deviation is that of the noise, or of what the model leaves, whichever is larger
    freedom = max(2 * n - len(x), 1)
    chi = float(np.sum(problem.rest(x) ** 2)) / freedom
    covariance = _covariance(jac) * max(chi, 1.0 if known.any() else 0.0)
    deviations, why = _deviations(problem, x, covariance, (low, high))
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    return MassFit(
        model,
        deviations,
        why,
        told,
        _left(problem, x)[0],
        alone[0],
        covariance / np.outer(spread, spread),
    )


def _covariance(jac: Array) -> Array:
    """Inverse of the information; what it says nothing of gets a large variance, not none."""
    size = np.maximum(np.linalg.norm(jac, axis=0), 1e-300)
    values, ways = np.linalg.eigh((jac / size).T @ (jac / size))
    inverse = ways @ np.diag(1.0 / np.maximum(values, _NOTHING)) @ ways.T
    return np.asarray(inverse / np.outer(size, size))


def _left(problem: _MassProblem, x: Array) -> tuple[float, float]:
    """RMS of what is left of the values, and of the weighted residuals."""
    rest = apart(problem.values, problem.model(x).response(problem.omega, problem.load))
    weighted = np.mean(problem.rest(x) ** 2)
    return float(np.sqrt(np.mean(rest**2))), float(np.sqrt(weighted))


def apart(a: Complex, b: Complex) -> Array:
    """Difference of two responses over the larger of them, 0 to 2."""
    return np.asarray(np.abs(a - b) / np.maximum(np.abs(a), np.abs(b)))


def _starts(problem: _MassProblem, two: bool) -> list[Array]:
    """Guesses; those of two masses that leave least of the magnitudes."""
    omega = problem.omega
    push = np.abs(problem.values) * omega * omega  # acceleration per torque
    whole = -math.log(float(np.median(push[: max(3, len(push) // 4)])))
    base = np.array([whole, 0.0, 0.0])
    if not two:
        return [base]
    places = np.geomspace(float(omega[0]), float(omega[-1]), _STARTS)
    dip = float(omega[int(np.argmin(push))])
    peak = float(omega[int(np.argmax(push))])
    guesses = []
    for anti, factor in itertools.product([*places, dip], (1.03, 1.1, 1.3, 1.7, 2.5, 4.0, 0.0)):
        high = peak if factor == 0.0 else factor * anti
        if high <= 1.02 * anti:
            continue
        x = np.array([*base, math.log((high / anti) ** 2 - 1.0), math.log(anti), math.log(0.03)])
        size = np.log(push) - np.log(
            np.abs(problem.model(x).response(omega, problem.load)) * omega * omega
        )
        x[0] -= float(np.median(size))
        guesses.append((float(np.mean(np.abs(size - np.median(size)))), x))
    return [x for _, x in sorted(guesses, key=lambda pair: pair[0])[:_BEST]]


def _search(
    problem: _MassProblem, starts: list[Array], loss: str = "linear"
) -> tuple[Array, Array]:
    """The best of all searches, and its derivatives."""
    from scipy.optimize import least_squares

    best = None
    for x in starts:
        found = least_squares(problem.rest, x, x_scale="jac", loss=loss, max_nfev=200)
        if best is None or found.cost < best.cost:
            best = found
    assert best is not None
    return np.asarray(best.x), np.asarray(best.jac)


def _quantities(model: MassModel) -> dict[str, float]:
    found = {
        "motor": model.motor,
        "load": model.load,
        "stiffness": model.stiffness,
        "damping": model.damping,
        "load_viscous": model.load_viscous,
        "delay": model.delay,
    }
    if model.load > 0.0:
        found |= {
            "ratio": model.load / model.motor,
            "antiresonance": model.antiresonance,
            "resonance": model.resonance,
        }
    return found


# CCN 16: each reason for which a quantity is not told is a branch.
def _deviations(
    problem: _MassProblem, x: Array, covariance: Array, band: tuple[float, float]
) -> tuple[dict[str, float], dict[str, str]]:
    """Deviations of all quantities, and why one is not told."""
    at = _quantities(problem.model(x))
    deviations, why = {}, {}
    steps = np.maximum(1e-5 * np.abs(x), 1e-6)
    for name, value in at.items():
        if len(x) == 3 and name in ("load", "stiffness", "damping"):
            deviations[name] = math.inf
            why[name] = "the response shows one mass"
            continue
        slope = np.zeros(len(x))
        for k, step in enumerate(steps):
            moved = [x.copy(), x.copy()]
            moved[0][k] += step
            moved[1][k] -= step
            a, b = (_quantities(problem.model(m))[name] for m in moved)
            slope[k] = (a - b) / (2.0 * step)
        spread = math.sqrt(max(float(slope @ covariance @ slope), 0.0))
        deviations[name] = spread
        if name != "delay" and not spread <= VAGUE * abs(value):
            why[name] = f"its deviation is {100 * min(spread / max(abs(value), 1e-300), 99):.0f} %"
        elif name == "load_viscous" and value < 0.0:
            why[name] = "it comes out negative"
    if problem.load:  # its response is told by the sum of the inertias, the resonance and damping
        for name in _SHARES:
            why.setdefault(name, "the motion of the load alone does not tell the motor's share")
    if "resonance" in at and at["resonance"] > 1.3 * band[1] and not problem.load:
        for name in ("motor", "ratio", "resonance"):
            why.setdefault(name, "the resonance lies above the band")
    return deviations, why
