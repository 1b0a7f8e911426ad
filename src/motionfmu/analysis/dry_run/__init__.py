"""What a robot's program does, on its controller and card alone, before an arm moves."""

from motionfmu.analysis.dry_run.robot_dry_run import (
    DryMove,
    DryRun,
    InputChange,
    LineReserve,
    dry_run,
    program_files,
)

__all__ = ["DryMove", "DryRun", "InputChange", "LineReserve", "dry_run", "program_files"]
