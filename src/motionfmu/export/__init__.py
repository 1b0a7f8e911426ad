"""A scenario for other people's tools: its system as one FMU, or as an SSP of its FMUs."""

from motionfmu.export.system_fmu import Choice, as_fmu
from motionfmu.export.system_ssp import Written, as_ssp

__all__ = ["Choice", "Written", "as_fmu", "as_ssp"]
