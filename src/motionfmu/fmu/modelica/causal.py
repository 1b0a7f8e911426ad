"""From flat equations to dx/dt = xdot(x, u, p), block by block."""

from collections.abc import Iterable, Iterator
from pathlib import Path

import casadi as ca

from motionfmu.fmu.modelica import elimination
from motionfmu.fmu.modelica.expression import Evaluator
from motionfmu.fmu.modelica.flat import Declaration, Expression, Flat, Unsupported, flatten
from motionfmu.fmu.modelica.nodes import steps_on
from motionfmu.fmu.modelica.ode import Ode


def load(package: Path, name: str) -> Ode:
    """Flatten a class, by its full name, and make its differential equation; see `flatten`."""
    return build(flatten(package, name))


def build(flat: Flat) -> Ode:
    """Make the differential equation of a flat class; Unsupported names class and construct."""
    names = _FlatNames(flat)
    residuals = [names.evaluate(e) for e in _residuals(flat)]
    inputs, outputs = _of_kind(flat, "input"), _of_kind(flat, "output")
    states = [d for d in _of_kind(flat, "variable", "output") if d.fixed]
    x, u, p = (names.column(d.name for d in g) for g in (states, inputs, names.parameters))
    unknowns, solution = _explicit(names, residuals, states)
    y = ca.substitute(names.column(d.name for d in outputs), unknowns, solution)
    start, sizes = names.each(states, "start", 0.0), names.each(states, "nominal", 1.0)
    checks = tuple((names.evaluate(c), text) for c, text in flat.asserts)
    _refuse_variables(
        names,
        [
            *((f"start of {d.name}", s) for d, s in zip(states, start, strict=True)),
            *((f"nominal of {d.name}", s) for d, s in zip(states, sizes, strict=True)),
            *((f'assert "{text}"', c) for c, text in checks),
        ],
        ca.vertcat(x, u, unknowns),
    )
    return Ode(
        name=flat.name,
        description=flat.description,
        states=tuple(states),
        inputs=tuple(inputs),
        parameters=tuple(names.parameters),
        outputs=tuple(outputs),
        x=x,
        u=u,
        p=p,
        xdot=solution[: len(states)],
        y=y,
        start=ca.vertcat(*start),
        checks=checks,
        sizes=ca.vertcat(*sizes),
        u0=tuple(names.number(d, "start") or 0.0 for d in inputs),
        p0=tuple(names.default(d) for d in names.parameters),
        limits={
            d.name: (names.number(d, "min"), names.number(d, "max"), names.number(d, "nominal"))
            for d in [*inputs, *outputs, *names.parameters]
        },
    )


def _of_kind(flat: Flat, *kinds: str) -> list[Declaration]:
    """Declarations of some kinds, in the order of the class."""
    return [d for d in flat.declarations.values() if d.kind in kinds]


class _FlatNames:
    """Symbols and parameter values by flat name."""

    def __init__(self, flat: Flat):
        self.flat = flat
        self.evaluate = Evaluator(flat, self.symbol, self.derivative)
        declared = flat.declarations.values()
        self.parameters = [d for d in declared if d.kind == "parameter" and d.top and not d.final]
        self.derivatives: dict[str, ca.SX] = {}
        self._pending: list[str] = []  # parameters whose binding is being evaluated
        own = [d for d in declared if d.kind != "parameter"] + self.parameters
        self._known = {d.name: ca.SX.sym(d.name) for d in own}

    def refuse(self, what: str) -> Unsupported:
        """Make the error for a construct that is not handled."""
        return Unsupported(f"{self.flat.name}: {what}")

    def column(self, names: Iterable[str]) -> ca.SX:
        """Symbols of some names."""
        return ca.vertcat(ca.SX(0, 1), *(self._known[n] for n in names))

    def symbol(self, name: str) -> ca.SX:
        """Symbol of a variable, or the value of a bound parameter."""
        if name in self._known:
            return self._known[name]
        d = self.flat.declarations.get(name)
        if d is None:
            raise self.refuse(f"{name} is not supported here")
        if d.binding is None:  # its start is no value, for rumoca invents one
            raise self.refuse(f"parameter {name} has no value")
        if name in self._pending:
            raise self.refuse(f"parameter {name} depends on itself")
        self._pending.append(name)
        self._known[name] = self.evaluate(d.binding)
        self._pending.pop()
        return self._known[name]

    def derivative(self, name: str) -> ca.SX:
        """Symbol of der(name)."""
        d = self.flat.declarations[name]
        if d.kind not in ("variable", "output"):
            raise self.refuse(f"der({name}) of a {d.kind} is not supported")
        return self.derivatives.setdefault(name, ca.SX.sym(f"der({name})"))

    def number(self, d: Declaration, attribute: str) -> float | None:
        """Value of an attribute; None where it is not declared."""
        expression = getattr(d, attribute)
        if expression is None:
            return None
        value = self.evaluate(expression)
        if not value.is_constant():
            raise self.refuse(
                f"{attribute} of {d.name} depends on other variables: make it a number,"
                " or the parameter final"
            )
        return float(value)

    def each(self, declared: list[Declaration], attribute: str, default: float) -> list[ca.SX]:
        """An attribute of some variables; the default where it is not declared."""
        found = [getattr(d, attribute) for d in declared]
        return [self.evaluate(e) if e else ca.SX(default) for e in found]

    def default(self, d: Declaration) -> float:
        """Value of a parameter as declared."""
        value = self.number(d, "binding")
        if value is None:
            raise self.refuse(f"parameter {d.name} has no value")
        return value


def _residuals(flat: Flat) -> list[Expression]:
    """Residuals of all equations; ``Real y = e`` gives y - e."""
    found = [e.residual for e in flat.equations]
    for d in flat.declarations.values():
        if d.kind in ("variable", "output") and d.binding is not None:
            own = {"VarRef": {"name": {"name": d.name}, "subscripts": []}}
            found.append({"Binary": {"op": "Sub", "lhs": own, "rhs": d.binding}})
    return found


def _explicit(
    names: _FlatNames, residuals: list[ca.SX], states: list[Declaration]
) -> tuple[ca.SX, ca.SX]:
    """All unknowns, the derivatives of the states first, and what they are by the equations."""
    for d in states:
        if d.name not in names.derivatives:
            raise names.refuse(f"{d.name} has fixed = true but no derivative")
    x = names.column(d.name for d in states)
    slopes = ca.vertcat(*(names.derivatives[d.name] for d in states))
    rest = [d.name for d in _of_kind(names.flat, "variable", "output") if not d.fixed]
    others = names.column(rest)
    dummies = [name for name in rest if name in names.derivatives]
    residuals = residuals + _dummy_derivatives(names, residuals, dummies, (x, slopes, others))
    unknowns = ca.vertcat(slopes, others, *(names.derivatives[n] for n in dummies))
    return unknowns, _solve(names, ca.vertcat(*residuals), unknowns)


def _refuse_variables(names: _FlatNames, told: list[tuple[str, ca.SX]], variables: ca.SX) -> None:
    """Refuse the first of some expressions, each with its name, that is not of parameters alone."""
    for text, e in told:
        if ca.depends_on(e, variables):
            raise names.refuse(f"{text} depends on more than parameters, which is not supported")


def _linear(e: ca.SX, v: ca.SX) -> tuple[ca.SX, ca.SX] | None:
    """Matrix A and vector b of expressions e = A v + b; None if e is not linear in v."""
    a = ca.jacobian(e, v)
    if ca.depends_on(a, v) or steps_on(e, v):
        return None
    return a, ca.substitute(e, v, ca.SX.zeros(v.numel()))


def _linear_parts(names: _FlatNames, e: ca.SX, v: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Matrix A and vector b of expressions e = A v + b; an e that is not linear is refused."""
    found = _linear(e, v)
    if found is None:
        unknowns = ", ".join(map(str, ca.symvar(v)))
        raise names.refuse(f"nonlinear equations for {unknowns} are not supported")
    return found


def _dummy_derivatives(
    names: _FlatNames,
    residuals: list[ca.SX],
    dummies: list[str],
    symbols: tuple[ca.SX, ca.SX, ca.SX],
) -> list[ca.SX]:
    """Equations for der(z) of variables z that are no states.

    ``der(z) - dz/dx xdot``, with z(x) from equations without derivatives; `symbols` are states,
    their derivatives, and all other unknowns.
    """
    x, slopes, others = symbols
    found = _by_states(names, residuals, dummies, others)
    inputs = names.column(d.name for d in _of_kind(names.flat, "input"))
    for name in dummies:
        if name not in found:
            raise names.refuse(
                f"der({name}): {name} is neither a state (fixed = true) nor given by states"
            )
        if ca.depends_on(found[name], inputs):
            raise names.refuse(f"der({name}) asks for the derivative of an input")
    return [names.derivatives[n] - ca.jtimes(found[n], x, slopes) for n in dummies]


def _by_states(
    names: _FlatNames, residuals: list[ca.SX], dummies: list[str], others: ca.SX
) -> dict[str, ca.SX]:
    """Variables, the dummies among them if they can be found, by states and inputs.

    An equation without derivatives gives its unknown where it is the last one in it.
    """
    derivatives = ca.vertcat(*names.derivatives.values())
    left = {i: e for i, e in enumerate(residuals) if not ca.depends_on(e, derivatives)}
    wanted = set(dummies)
    found: dict[str, ca.SX] = {}
    unknown = set(map(str, ca.symvar(others)))
    progress = True
    while progress and wanted - found.keys():
        progress = False
        for i, e in list(left.items()):
            missing = {str(s) for s in ca.symvar(e)} & unknown - found.keys()
            if len(missing) > 1:
                continue
            del left[i]
            if missing:
                (name,) = missing
                v = names.symbol(name)
                known = ca.vertcat(ca.SX(0, 1), *map(names.symbol, found))
                e = ca.substitute(e, known, ca.vertcat(ca.SX(0, 1), *found.values()))
                parts = _linear(e, v)
                if parts is None:
                    continue
                a, b = parts
                found[name] = -b / a
                progress = True
    return found


def _coupled(names: _FlatNames, a: ca.SX, b: ca.SX, labels: list[str]) -> ca.SX:
    """Solve A x = b for parameters near their values."""
    try:
        return elimination.solve(a, b, {d.name: names.default(d) for d in names.parameters}, labels)
    except elimination.NoPivot as error:
        raise names.refuse(str(error)) from None


def _blocks(
    names: _FlatNames, residuals: ca.SX, unknowns: ca.SX
) -> Iterator[tuple[list[int], list[int]]]:
    """Rows and columns of each block, those first on which later ones depend."""
    count = unknowns.numel()
    if residuals.numel() != count:
        raise names.refuse(f"{residuals.numel()} equations for {count} unknowns")
    pattern = ca.jacobian(residuals, unknowns).sparsity()
    if ca.sprank(ca.DM(pattern)) < count:
        raise names.refuse("the equations are structurally singular (a constraint on states?)")
    blocks, rows, columns, row_start, column_start, _, _ = pattern.btf()
    for k in range(blocks):
        yield (
            rows[row_start[k] : row_start[k + 1]],
            columns[column_start[k] : column_start[k + 1]],
        )


def _solve(names: _FlatNames, residuals: ca.SX, unknowns: ca.SX) -> ca.SX:
    """Solve residuals = 0 by its block lower triangular form."""
    labels = [str(unknowns[i]) for i in range(unknowns.numel())]
    values: dict[int, ca.SX] = {}
    place = {label: c for c, label in enumerate(labels)}
    for rows, mine in _blocks(names, residuals, unknowns):
        e = ca.vertcat(*(residuals[r] for r in rows))
        v = ca.vertcat(*(unknowns[c] for c in mine))
        solved_before = [place[n] for n in map(str, ca.symvar(e)) if place.get(n) in values]
        if solved_before:
            known = ca.vertcat(*(unknowns[c] for c in solved_before))
            e = ca.substitute(e, known, ca.vertcat(*(values[c] for c in solved_before)))
        a, b = _linear_parts(names, e, v)
        if len(mine) == 1:
            solved = -b / a
        else:
            solved = _coupled(names, a, -b, [labels[c] for c in mine])
        values.update((c, solved[i]) for i, c in enumerate(mine))
    return ca.vertcat(*(values[c] for c in range(len(labels))))
