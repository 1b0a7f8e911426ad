"""Network motion cards on the PC: configuration, plan, job file, protocol, server and page."""

from motionfmu.cards.config import CardConfig, load

__all__ = ["CardConfig", "load"]
