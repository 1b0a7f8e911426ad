"""System Structure and Parameterization (SSP) 1.0 and 2.0: systems of FMUs in one file.

The standard: https://ssp-standard.org, by the Modelica Association.
"""

from motionfmu.ssp.ssp_import import Taken, take
from motionfmu.ssp.structure import SSD, Component, Connection, Connector, Structure, Value
from motionfmu.ssp.write import description, parameter_values

__all__ = [
    "SSD",
    "Component",
    "Connection",
    "Connector",
    "Structure",
    "Taken",
    "Value",
    "description",
    "parameter_values",
    "take",
]
