"""The linear model of one axis of a scenario."""

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionfmu.errors import InputError
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.linear import law
from motionfmu.linear.block import Block
from motionfmu.linear.form import Gain
from motionfmu.linear.given import Values
from motionfmu.linear.plant import Linearised, Point
from motionfmu.linear.wiring import Net, Port, period_of
from motionfmu.run import Options, Scenario, load
from motionfmu.scenario.system import Wire
from motionfmu.scenario.values import settings

if TYPE_CHECKING:
    from motionfmu.linear.systems import System  # its import takes a second, a tuning does without


@functools.cache
def equation(fmu: str) -> Linearised:
    """The functions of a plant's equation, made once.

    Parameters
    ----------
    fmu : str

    Returns
    -------
    Linearised
    """
    found = law.carried(fmu)
    assert isinstance(found, Ode)
    return Linearised(found)


@dataclass(frozen=True)
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
        `motionfmu.linear.block.Sampled` or `Plant` by component.
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
    left_out: tuple[str, ...] = ()
    _cache: dict[Any, Any] = field(default_factory=dict, repr=False, compare=False)

    @property
    def inputs(self) -> list[str]:
        """Names of ports to which something can be added, and commands."""
        return [f"{c}.{n}" for c, b in self.blocks.items() for n in (*b.inputs, *b.commands)]

    @property
    def outputs(self) -> list[str]:
        """Names of all outputs."""
        return [f"{c}.{n}" for c, b in self.blocks.items() for n in b.ports]

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
        return _build(self.scenario, self.axis, self.at, {**self.set, **set}, self)

    def system(
        self,
        inputs: str | Iterable[str],
        outputs: str | Iterable[str],
        cut: str | Iterable[str] = (),
        delays: Mapping[str, int] | None = None,
    ) -> "System":
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
        System
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

    def _between(self, net: Net, entries: list[Port], exits: list[Port]) -> "System":
        found = period_of(net, entries, exits, self.scenario.document.file)
        from motionfmu.linear.systems import System

        return System(
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
    ) -> "System":
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
        System
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
        from motionfmu.linear.systems import backward

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
                f"{name} is no {kind} of the linear model{note}; there are: {', '.join(known)}"
            )
        component, _, variable = name.partition(".")
        return component, variable

    def values(self, component: str) -> Mapping[str, Any]:
        """Parameters and inputs that stay of a component.

        Parameters
        ----------
        component : str

        Returns
        -------
        mapping
        """
        found: Mapping[str, Any] = self._cache["values"][component]
        return found

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
        if component not in self._cache["values"]:
            raise InputError(f"{name}: no component {component!r} in the linear model")
        try:
            return self._cache["values"][component][variable]
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
    before: AxisModel | None,
) -> AxisModel:
    numbers = {n: v.plain if isinstance(v, Gain) else v for n, v in set_.items()}
    if before is None:
        resolved = scenario.resolved(Options(set=numbers))
    else:
        given = tuple(settings(scenario.resolver, numbers))
        resolved = replace(before._cache["system"], settings=given)
    components = resolved.components
    said = {c: law.carried(f) for c, f in components.items()}
    every = {c: Values(resolved, scenario, c, axis) for c in components}
    _check(scenario, axis, at, every)
    for name, value in set_.items():
        if isinstance(value, Gain):
            component, _, variable = name.partition(".")
            every[component].given[variable] = (value,) * axis
    for w in resolved.wires:
        source, name = w.source.component, w.source.port.name
        every[w.target.component].wired[w.target.port.name] = functools.partial(
            _constant, said[source], every[source], f"{source}.{name}"
        )
    blocks: dict[str, Block] = {}
    points: dict[str, Point] = {}
    # plants first: a law may ask for its outputs at their point
    for c in sorted(components, key=lambda c: isinstance(said[c], law.Law)):
        own = said[c]
        try:
            if isinstance(own, law.Law):
                blocks[c] = law.block(own, every[c], _fed(resolved.wires, c, points))
            elif own is not None:
                blocks[c], points[c] = _plant(c, components[c], (at, every[c]), before)
        except ValueError as error:
            raise InputError(f"{scenario.document.file}: {c}: {error}") from None
    blocks = {c: blocks[c] for c in components if c in blocks}
    joined = {}
    for w in resolved.wires:
        target = w.target.component, w.target.port.name
        from_ = w.source.component, w.source.port.name
        b, a = blocks.get(target[0]), blocks.get(from_[0])
        if b is not None and a is not None and target[1] in b.inputs and from_[1] in a.ports:
            joined[target] = from_
    return AxisModel(
        scenario,
        axis,
        at,
        set_,
        blocks,
        joined,
        resolved.step_ns,
        points,
        tuple(c for c in components if said[c] is None),
        {"system": resolved, "values": every, "plants": _keys(blocks, components, at, every)},
    )


def _fed(wires: Iterable[Wire], component: str, points: Mapping[str, Point]) -> dict[str, float]:
    """Outputs of a component as the operating points of the plants have them."""
    found = {}
    for w in wires:
        if w.source.component == component and w.target.component in points:
            found[w.source.port.name] = points[w.target.component].values[w.target.port.name]
    return found


def _keys(
    blocks: Mapping[str, Block],
    components: Mapping[str, str],
    at: Mapping[str, float],
    every: Mapping[str, Values],
) -> dict[str, Any]:
    return {c: _key(c, components[c], at, every[c]) for c in blocks if _is_plant(components[c])}


def _is_plant(fmu: str) -> bool:
    return isinstance(law.carried(fmu), Ode)


def _key(component: str, fmu: str, at: Mapping[str, float], own: Values) -> Any:
    names = [d.name for d in equation(fmu).ode.parameters]
    asked = sorted((n, v) for n, v in at.items() if n.startswith(f"{component}."))
    return fmu, asked, own["micro_step"], [float(own[n]) for n in names]


def _plant(
    component: str,
    fmu: str,
    given: tuple[Mapping[str, float], Values],
    before: AxisModel | None,
) -> tuple[Block, Point]:
    """A plant about its point; the one of an earlier model if nothing of it has changed."""
    at, own = given
    if before is not None and before._cache["plants"].get(component) == _key(
        component, fmu, at, own
    ):
        return before.blocks[component], before.points[component]
    parts = equation(fmu)
    p = parts.parameters({d.name: own[d.name] for d in parts.ode.parameters})
    inputs = {}
    for d in parts.ode.inputs:
        if d.name not in own.wired:
            inputs[d.name] = float(own[d.name])
    mine = {n.partition(".")[2]: v for n, v in at.items() if n.startswith(f"{component}.")}
    point = parts.point(p, mine, inputs)
    return parts.block(p, point, float(own["micro_step"])), point


def _constant(said: Any, own: Values, name: str) -> Any:
    found = law.constant(said, own, name.partition(".")[2]) if isinstance(said, law.Law) else None
    if found is None:
        raise ValueError(f"it depends on {name}, of which no law says a value")
    return found


def _check(
    scenario: Scenario, axis: int, at: Mapping[str, float], every: Mapping[str, Values]
) -> None:
    for c, own in every.items():
        switch = scenario.resolver.ports[c].get("active")
        if switch is None:
            continue
        count = switch.count
        if not 1 <= axis <= count:
            raise InputError(f"axis = {axis}: {c} has axes 1 to {count}")
        if not own["active"]:
            raise InputError(f"axis = {axis}: it is not active in {c} ({c}.active)")
    for name, value in at.items():
        component, _, variable = name.partition(".")
        fmu = scenario.document.body.component.get(component)
        if fmu is None or not _is_plant(fmu):
            raise InputError(f"at {name} = {value!r}: {component!r} is no plant of the scenario")
        known = equation(fmu).ode
        if variable not in [d.name for d in (*known.inputs, *known.outputs)]:
            raise InputError(f"at {name} = {value!r}: {fmu} has no such input or output")
        if not isinstance(value, int | float):
            raise InputError(f"at {name} = {value!r}: a number wanted")
