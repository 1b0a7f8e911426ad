"""What is chosen for an exported system: the version of FMI, and the variables that it shows."""

from collections.abc import Collection

from motionfmu.base.errors import InputError, suggestion
from motionfmu.run.run_plan import RunPlan
from motionfmu.scenarios.system import End

# Version of SSP by the version of FMI of its FMUs.
VERSIONS = {2: "1.0", 3: "2.0"}
_SHOWN = ("Float64", "Int32", "Boolean")


def check_version(fmi: int) -> None:
    """Refuse a version of FMI in which nothing is written."""
    if fmi not in VERSIONS:
        raise InputError(f"FMI {fmi!r}: {' or '.join(map(str, VERSIONS))}")


def also_shown(
    scenario: RunPlan, patterns: Collection[str], causalities: Collection[str]
) -> list[End]:
    """Outputs that a scenario records, and numbers and Booleans that patterns name beside them."""
    found = {e.name: e for e in scenario.ends}
    for pattern in patterns:
        ends = [e for kind in causalities for e in scenario.resolver.matching(pattern, kind)]
        if not ends:
            known = (e.name for kind in causalities for e in scenario.resolver.matching("*", kind))
            what = " or ".join(causalities)
            raise InputError(f"--inner {pattern}: matches no {what}{suggestion(pattern, known)}")
        found |= {e.name: e for e in ends if e.port.type in _SHOWN}
    return list(found.values())
