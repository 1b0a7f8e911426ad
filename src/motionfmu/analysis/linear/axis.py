"""The linear model of one axis of a scenario."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionfmu.analysis.linear.block import Block
from motionfmu.analysis.linear.parts import Parts, parts
from motionfmu.analysis.linear.plant import Point
from motionfmu.analysis.linear.wiring import Net, Port, period_of
from motionfmu.base.errors import InputError, suggestion
from motionfmu.run import Scenario, load
from motionfmu.scenarios.system import System
from motionfmu.scenarios.values import later

if TYPE_CHECKING:
    from motionfmu.analysis.linear.systems import (
        StandstillSystem,
    )  # its import takes a second, a tuning does without


@dataclass(frozen=True, repr=False)
class AxisModel:
    """Linear blocks of one axis, wired and timed as its FMUs.

    Made by `model`; a gain is changed by `changed`, systems come from `system` and `loop`.

    Attributes
    ----------
    scenario : Scenario
    axis : int
        From 1.
    at : dict
        Operating point as the user stated it: value by ``component.variable``.
    set : dict
        Values stronger than the scenario's.
    blocks : dict
        `motionfmu.analysis.linear.block.Sampled` or `Plant` by component.
    wires : dict
        Source by target, both as (component, variable).
    step_ns : int
        Communication step [ns].
    points : dict
        Operating point of each plant, by component.
    left_out : tuple of str
        Components without a linear law.
    """

    scenario: Scenario
    axis: int
    at: Mapping[str, float]
    set: Mapping[str, Any]
    blocks: Mapping[str, Block]
    wires: Mapping[Port, Port]
    step_ns: int
    points: Mapping[str, Point]
    left_out: tuple[str, ...]
    _parts: Parts = field(repr=False, compare=False)

    def __repr__(self) -> str:
        return (
            f"<AxisModel {self.scenario.name}: axis {self.axis}, inputs {', '.join(self.inputs)}>"
        )

    @property
    def inputs(self) -> list[str]:
        """Names of ports to which something can be added, and commands."""
        return [f"{c}.{n}" for c, b in self.blocks.items() for n in (*b.inputs, *b.commands)]

    @property
    def outputs(self) -> list[str]:
        """Names of all outputs."""
        return [f"{c}.{n}" for c, b in self.blocks.items() for n in b.ports]

    @property
    def others(self) -> tuple[int, ...]:
        """The axes that a plant couples with this one, usually none."""
        return self._parts.others

    def changed(self, set: Mapping[str, Any]) -> "AxisModel":
        """The same model with other values.

        Plants that they do not touch are kept.

        Parameters
        ----------
        set : mapping
            Value by ``component.variable``: parameters, or inputs that stay.

        Returns
        -------
        AxisModel

        Raises
        ------
        InputError
            A name or value is wrong.
        """
        return _build(self.scenario, self.axis, self.at, later(self.set, set), self._parts)

    def moved(self, at: Mapping[str, float]) -> "AxisModel":
        """The same model about another operating point.

        The scenario is not read again, and plants whose point is the same are kept.

        Parameters
        ----------
        at : mapping
            Value by ``component.variable``, in the units of the description.

        Returns
        -------
        AxisModel

        Raises
        ------
        InputError
            A name or value is wrong, or there is no such operating point.
        """
        return _build(self.scenario, self.axis, dict(at), self.set, self._parts)

    def system(
        self,
        inputs: str | Iterable[str],
        outputs: str | Iterable[str],
        cut: str | Iterable[str] = (),
        delays: Mapping[str, int] | None = None,
    ) -> "StandstillSystem":
        """The system from any inputs to any outputs.

        An input is added to what the wire brings to that port, and held over a period. An output is
        what a recording shows: row k stands before the step that begins at k periods. The
        period is the common one of all grids between the inputs and the outputs.

        Parameters
        ----------
        inputs, outputs : str or iterable of str
            Names from `inputs` and `outputs`, ``component.variable``.
        cut : str or iterable of str
            Inputs whose wire is cut.
        delays : mapping, optional
            Communication steps by which the wire of an input is delayed.

        Returns
        -------
        StandstillSystem
            A discrete control.StateSpace; names are ``component/variable``, because python-control
            allows no dots.

        Raises
        ------
        InputError
            A name is unknown, or the grids have no common period.
        """
        entries = [self.port(n, self.inputs, "input") for n in _listed(inputs)]
        exits = [self.port(n, self.outputs, "output") for n in _listed(outputs)]
        return self._between(self.net(cut, delays or {}), entries, exits)

    def _between(self, net: Net, entries: list[Port], exits: list[Port]) -> "StandstillSystem":
        found = period_of(net, entries, exits, self.scenario.document.file)
        from motionfmu.analysis.linear.systems import StandstillSystem

        return StandstillSystem(
            *(found.a, found.b, found.c, found.d, found.period_ns * 1e-9),
            inputs=[_name(p) for p in entries],
            outputs=[_name(p) for p in exits],
            states=[_name(p) for p in found.states],
            remove_useless_states=False,
            name=f"{self.scenario.name} axis {self.axis}",
        )

    def loop(
        self,
        at: str,
        cut: str | Iterable[str] = (),
        delays: Mapping[str, int] | None = None,
    ) -> "StandstillSystem":
        """The open loop at an input, for negative feedback.

        Cut there, once around, with the other sign.

        The closed loop is stable if 1 + L has no zero outside the unit circle.

        Parameters
        ----------
        at : str
            A wired input, ``component.variable``.
        cut : str or iterable of str
            Inputs of other loops to be cut too.
        delays : mapping, optional
            As in `system`.

        Returns
        -------
        StandstillSystem
            One input, one output.

        Raises
        ------
        InputError
            The input is not wired, or nothing comes back to it.
        """
        target = self.port(at, self.inputs, "input")
        if target not in self.wires:
            raise InputError(f"{at} has no wire: no loop is closed there")
        others = [name for name in _listed(cut) if name != at]
        net = replace(self.net(others, delays or {}), opened=target)
        around = self._between(net, [target], [target])
        if not around.nstates and not around.D.any():
            raise InputError(f"{at}: nothing comes back to it from {'.'.join(self.wires[target])}")
        from motionfmu.analysis.linear.systems import backward

        return backward(around, _name(self.wires[target]), f"loop at {_name(target)}")

    def net(self, cut: str | Iterable[str], delays: Mapping[str, int]) -> Net:
        """Blocks and wires, some cut or delayed.

        Parameters
        ----------
        cut : str or iterable of str
            Inputs whose wire is cut.
        delays : mapping
            Communication steps by which the wire of an input is delayed.

        Returns
        -------
        Net

        Raises
        ------
        InputError
            A name is unknown.
        """
        removed = {self.port(n, self.inputs, "input") for n in _listed(cut)}
        late = {self.port(n, self.inputs, "input"): int(d) for n, d in delays.items()}
        joined = {t: s for t, s in self.wires.items() if t not in removed}
        return Net(self.blocks, joined, self.step_ns, late)

    def port(self, name: str, known: list[str], kind: str) -> Port:
        """Component and variable of a name.

        Parameters
        ----------
        name : str
            ``component.variable``.
        known : list of str
            `inputs` or `outputs`.
        kind : str
            ``input`` or ``output``, for the message.

        Returns
        -------
        tuple of str

        Raises
        ------
        InputError
            It is not among them.
        """
        if name not in known:
            note = f" (no linear law: {', '.join(self.left_out)})" if self.left_out else ""
            raise InputError(
                f"{name} is no {kind} of the linear model{note}"
                + (suggestion(name, known) or f"; there are: {', '.join(known)}")
            )
        component, _, variable = name.partition(".")
        return component, variable

    def alike(self, other: "AxisModel") -> bool:
        """Whether another axis has the same values, wires and point.

        Parameters
        ----------
        other : AxisModel

        Returns
        -------
        bool
        """
        if self.scenario is not other.scenario or self.others or other.others:
            return self is other
        mine, theirs = self._parts.values, other._parts.values
        return (
            (self.at, self.set, self.step_ns) == (other.at, other.set, other.step_ns)
            and self.wires == other.wires
            and all(v[n] == theirs[c][n] for c, v in mine.items() for n in tuple(v.asked))
        )

    def values(self, component: str) -> Mapping[str, Any]:
        """Parameters and inputs that stay of a component.

        Parameters
        ----------
        component : str

        Returns
        -------
        mapping
        """
        return self._parts.values[component]

    def value(self, name: str) -> Any:
        """Value of a parameter or of an input that stays, of this axis.

        Parameters
        ----------
        name : str
            ``component.variable``.

        Returns
        -------
        float, int, bool or str

        Raises
        ------
        InputError
            There is no such variable, or nothing says its value.
        """
        component, _, variable = name.partition(".")
        if component not in self._parts.values:
            raise InputError(f"{name}: no component {component!r} in the linear model")
        try:
            return self._parts.values[component][variable]
        except KeyError:
            raise InputError(f"{name}: nothing says its value") from None


def _name(port: Port) -> str:
    return "/".join(port)


def _listed(names: str | Iterable[str]) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


def model(
    scenario: Scenario | str | Path,
    axis: int = 1,
    at: Mapping[str, float] | None = None,
    set: Mapping[str, Any] | None = None,
) -> AxisModel:
    """Make the linear model of one axis of a scenario.

    Plants are the CasADi equations that made the FMUs, linearised and put on their micro-grid;
    drives and cards are the sampled laws that their FMUs carry; delays are those of the master's
    steps, of the grids and of the wires.

    Parameters
    ----------
    scenario : Scenario, str or Path
    axis : int
        From 1.
    at : mapping, optional
        Operating point of the plants: values of their outputs and inputs by
        ``component.variable``, in the units of the description; the uniform motion that has them is
        found. Nothing stated: the state at the start. See `AxisModel.points`.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.

    Returns
    -------
    AxisModel

    Raises
    ------
    InputError
        A name or value is wrong, the axis is not active, or there is no such operating point.
    """
    loaded = scenario if isinstance(scenario, Scenario) else load(scenario)
    return _build(loaded, axis, dict(at or {}), dict(set or {}), None)


def _build(
    scenario: Scenario,
    axis: int,
    at: Mapping[str, float],
    set_: Mapping[str, Any],
    before: Parts | None,
) -> AxisModel:
    made = parts(scenario, axis, at, set_, before)
    return AxisModel(
        scenario,
        axis,
        at,
        set_,
        made.blocks,
        made.wires(),
        made.system.step_ns,
        made.points,
        made.left_out,
        made,
    )


def wired_with(axis: AxisModel, component: str) -> AxisModel:
    """The model of a component and of all that wires join with it, at first or second hand.

    What a gain does ends there. Of many machines in one scenario the others need not be looked at.
    """
    system = axis._parts.system
    found = _joined(system, component)
    alone = replace(
        system,
        components={c: fmu for c, fmu in system.components.items() if c in found},
        wires=tuple(w for w in system.wires if w.target.component in found),
    )
    return replace(
        axis,
        at={name: value for name, value in axis.at.items() if name.partition(".")[0] in found},
        blocks={c: b for c, b in axis.blocks.items() if c in found},
        wires={t: s for t, s in axis.wires.items() if t[0] in found},
        points={c: p for c, p in axis.points.items() if c in found},
        _parts=replace(axis._parts, system=alone),
    )


def _joined(system: System, component: str) -> set[str]:
    """Components that wires join with one, at first or second hand, and itself."""
    beside: dict[str, set[str]] = {}
    for wire in system.wires:
        ends = {wire.source.component, wire.target.component}
        for end in ends:
            beside.setdefault(end, set()).update(ends)
    found, left = {component}, [component]
    while left:
        new = beside.get(left.pop(), set()) - found
        found |= new
        left += new
    return found
