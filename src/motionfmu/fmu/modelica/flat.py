"""Flatten a Modelica class, or refuse what is not handled."""

import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionfmu.fmu.modelica.arrays import Elements, Expression, Index, element_name, indices

# Sections of rumoca's flat form that must be empty, and what a Modelica author calls them.
_REFUSED = {
    "when_chains": "when-equation",
    "algorithms": "algorithm section",
    "initial_equations": "initial equation",
    "initial_algorithms": "initial algorithm",
    "initial_structured_equations": "initial equation",
    "initial_assert_equations": "assert in an initial equation",
    "enumeration_types": "enumeration type",
    "record_instances": "record",
    "definite_roots": "overconstrained connector",
    "potential_roots": "overconstrained connector",
}


class Unsupported(ValueError):
    """A construct of Modelica that this back end does not handle."""


@dataclass(frozen=True)
class Declaration:
    """One scalar component of the flat class, maybe an element of an array."""

    name: str  # flat, for example rotor.speed or mass[2]
    type: str  # Real, Integer or Boolean
    kind: str  # parameter, input, output (both only at the top level) or variable
    unit: str  # empty where nothing is declared
    description: str
    final: bool  # a final parameter or a constant, which cannot be set
    fixed: bool  # its start value is an initial condition
    binding: Expression | None
    start: Expression | None
    min: Expression | None
    max: Expression | None
    nominal: Expression | None
    base: str = ""  # name of the array it is an element of, else empty
    dims: tuple[int, ...] = ()  # of that array

    @property
    def port(self) -> str:
        """Name of the array of which this is an element; for a scalar its own name."""
        return self.base or self.name

    @property
    def top(self) -> bool:
        """Whether it belongs to the class itself, not a component."""
        return "." not in self.name


@dataclass(frozen=True)
class Equation:
    """One equation, residual = 0."""

    component: str  # the component in which it stands; empty for the class itself
    residual: Expression


@dataclass(frozen=True)
class Flat:
    """A flattened class."""

    name: str  # full name of the class
    description: str
    declarations: dict[str, Declaration]  # by flat name, in the order of the source
    equations: tuple[Equation, ...]
    asserts: tuple[tuple[Expression, str], ...]  # conditions with their messages
    functions: dict[str, Any]  # flat, by name


def flatten(package: Path, name: str) -> Flat:
    """Flatten one class, by its full name, of a folder with package.mo or one .mo file.

    A class that does not compile is a ValueError with rumoca's file, line and reason; one with a
    construct that is not handled is Unsupported, which names both.
    """
    import rumoca

    file = package / "package.mo" if package.is_dir() else package
    if not file.is_file():
        raise ValueError(f"{file}: there is no such Modelica file")
    try:
        model = rumoca.Session().load(str(file), model=name)
        doc = json.loads(model.to_json("flat", pretty=False))
    except BaseException as error:
        # A panic of rumoca's compiler, which some wrong models cause, is no Exception.
        if isinstance(error, rumoca.RumocaError) or type(error).__name__ == "PanicException":
            raise ValueError(_reason(file, error)) from None
        raise
    return read(doc, name)


def read(doc: dict[str, Any], name: str) -> Flat:
    """Read rumoca's flat form, parsed JSON; the class name is for messages, as in `flatten`."""
    if doc["is_partial"]:
        raise Unsupported(f"{name}: a partial class cannot be simulated")
    for section, construct in _REFUSED.items():
        if doc.get(section):
            where = _component(_first(doc[section]))
            raise Unsupported(f"{name}{where}: {construct} is not supported")
    if not all(map(_written_out, doc.get("structured_equations") or ())):
        raise Unsupported(f"{name}: a for-equation that is not written out is not supported")
    elements = Elements({n: v["dims"] for n, v in doc["variables"].items()})
    declarations = {
        element_name(n, k): _declaration(doc, name, n, _element(v, elements, k))
        for n, v in doc["variables"].items()
        for k in indices(v["dims"])
    }
    return Flat(
        name,
        doc["model_description"] or "",
        declarations,
        tuple(
            Equation(_component(e), elements.pick(e["residual"], k))
            for e in doc["equations"]
            for k in indices(elements.shape(e["residual"]))
        ),
        tuple(_assert(name, a) for a in doc["assert_equations"]),
        doc["functions"],
    )


def _reason(file: Path, error: BaseException) -> str:
    """One line ``file:line: what`` of a class that does not compile.

    Rumoca tells the line of a syntax error only inside a picture of it, and no line for a name it
    does not know; that name is looked for.
    """
    import rumoca

    text = str(error).splitlines()[0]
    sources = sorted(file.parent.rglob("*.mo")) if file.name == "package.mo" else [file]
    for source in sources:
        for d in rumoca.validate(str(source)):
            if found := re.search(r"\.mo:(\d+):\d+\]", d.message):
                return f"{source}:{found[1]}: {text}"
    if name := re.search(r"'([\w.]+)'$", text):
        for source in sources:
            for number, line in enumerate(source.read_text().splitlines(), 1):
                if re.search(rf"\b{re.escape(name[1])}\b", line):
                    return f"{source}:{number}: {text}"
    return f"{file}: {text}"


def _first(section: Any) -> Any:
    return next(iter(section.values())) if isinstance(section, dict) else section[0]


def _component(item: Any) -> str:
    """Text " (component x)" of a construct, if rumoca tells it."""
    origin = item.get("origin") if isinstance(item, dict) else None
    known = origin.get("ComponentEquation", {}) if isinstance(origin, dict) else {}
    found = known.get("component", "")
    return f" (component {found})" if found else ""


def _tag(value: Any) -> str:
    """Name of a Rust enum that is either "Name" or {"Name": data}."""
    return value if isinstance(value, str) else next(iter(value))


def _written_out(loop: dict[str, Any]) -> bool:
    """Whether rumoca gives all equations of a for-equation; of some kinds it gives two only."""
    points = math.prod(b["upper"] - b["lower"] + 1 for b in loop["domain"]["binders"])
    return loop["interiors_materialized"] or points <= 2


def _element(v: dict[str, Any], elements: Elements, index: Index) -> dict[str, Any]:
    """The declaration of one element of a variable."""
    keys = [k for k in ("binding", "start", "min", "max", "nominal") if v[k] is not None]
    return {**v, **{k: elements.pick(v[k], index) for k in keys}, "index": index}


def _declaration(doc: dict[str, Any], model: str, name: str, v: dict[str, Any]) -> Declaration:
    variability, causality = _tag(v["variability"]), _tag(v["causality"])
    kind = doc["variable_type_names"].get(name, "Real")
    refused = {
        f"type {kind}": kind not in ("Real", "Integer", "Boolean"),
        "discrete": variability == "Discrete",
        "stream": v["stream"],
        "an expandable connector": v["from_expandable_connector"],
    }
    for construct, present in refused.items():
        if present:
            raise Unsupported(f"{model}: {name} is {construct}, which is not supported")
    constant = variability in ("Parameter", "Constant")
    top = "." not in name
    role = "variable"
    if constant:
        role = "parameter"
    elif top and causality in ("Input", "Output"):
        role = causality.lower()
    return Declaration(
        element_name(name, v["index"]),
        kind,
        role,
        v["unit"] or "",
        v["description"] or "",
        variability == "Constant" or name in doc["variable_final_flags"] or v["is_protected"],
        bool(v["fixed"]) and all(v["fixed"]),
        binding=v["binding"],
        start=v["start"],
        min=v["min"],
        max=v["max"],
        nominal=v["nominal"],
        base=name if v["dims"] else "",
        dims=tuple(v["dims"]),
    )


def _assert(model: str, item: dict[str, Any]) -> tuple[Expression, str]:
    message = item["message"].get("Literal", {}).get("value", {}).get("String")
    if message is None:
        raise Unsupported(f"{model}{_component(item)}: assert without a constant text")
    if item["level"] is not None:
        raise Unsupported(f"{model}{_component(item)}: assert with a level")
    return item["condition"], message
