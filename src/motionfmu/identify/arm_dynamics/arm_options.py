"""What is asked of a record of an arm, in Python or as an identify.toml has it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.base.errors import InputError
from motionfmu.identify.arm_dynamics.torque_laws import LAWS


@dataclass(frozen=True)
class ArmColumn:
    """What a column of six joints is.

    Parameters
    ----------
    signal : str
        ``component.variable`` of the arm: its torque, motor or link angle, or encoder phase.
    scale : float or list of float, optional
        Of the signal's unit per unit of the column; units say it if it is not given.
    unit : str, optional
        Of the column, if the record does not say it.
    """

    signal: str
    scale: float | list[float] | None = None
    unit: str | None = None


@dataclass(frozen=True)
class ArmOptions:
    """What is asked of a record.

    Parameters
    ----------
    columns : mapping
        What each column of the record is, by its name: an `ArmColumn`.
    laws : sequence of str, optional
        Extensions of the law of torque that are taken, instead of those that validation chooses.
    keep : float
        Share of the record, at its end, that is kept back for validation.
    low_pass : float, optional
        Of angles, before they are differentiated [Hz]; else chosen by the motion.
    """

    columns: Mapping[str, ArmColumn]
    laws: Sequence[str] | None = None
    keep: float = 0.3
    low_pass: float | None = None


class _ColumnTable(BaseModel):
    """A column of the record, by its name, with all joints; a text alone is its signal."""

    model_config = ConfigDict(extra="forbid", strict=True)
    signal: str  # component.variable of the arm: torque, motor or link angle, encoder phase
    # the signal's unit per unit of the column, or one for each joint; else units say it
    scale: float | list[float] | None = None
    unit: str | None = None  # of the column, if the record does not say it


class ArmTables(BaseModel):
    """What is taken of the record; an arm is identified as a whole."""

    model_config = ConfigDict(extra="forbid", strict=True)
    columns: dict[str, str | _ColumnTable] = Field(default_factory=dict)
    # extensions of the law of torque that all joints take; else validation chooses for each
    laws: list[str] | None = None
    # share of the record, at its end, that is kept back for validation
    keep: float = Field(default=0.3, gt=0.05, lt=0.8)
    # [Hz] low pass of the angles before they are differentiated; else chosen by the motion
    low_pass: float | None = Field(default=None, gt=0.0)
    # how the record's file is laid out: keys of a scenario's [record_file]
    record: dict[str, Any] = Field(default_factory=dict)


@dataclass(frozen=True)
class ArmAsked:
    """Options, and how the record's file is laid out."""

    options: ArmOptions
    layout: Mapping[str, Any] = field(default_factory=dict)


def asked_of(tables: Mapping[str, Any], place: str) -> ArmAsked:
    """Check tables and make options of them; `place` is named in messages."""
    try:
        asked = ArmTables.model_validate(dict(tables))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(p) for p in first["loc"] if not str(p).startswith("_"))
        if first["type"] == "extra_forbidden" and len(first["loc"]) == 1:
            raise InputError(
                f"{place}: {where} = {first['input']!r}: an arm is identified as a whole, there is"
                " no such key; columns, laws, keep, low_pass, record"
            ) from None
        raise InputError(f"{place}: {where} = {first['input']!r}: {first['msg'].lower()}") from None
    if not asked.columns:
        raise InputError(f"{place}: [columns] must say what the columns of the record are")
    for name in asked.laws or ():
        if name not in LAWS:
            raise InputError(f"{place}: laws: {name!r}: there are {', '.join(LAWS)}")
    columns = {
        name: ArmColumn(use) if isinstance(use, str) else ArmColumn(**use.model_dump())
        for name, use in asked.columns.items()
    }
    options = ArmOptions(columns, asked.laws, asked.keep, asked.low_pass)
    return ArmAsked(options, asked.record)
