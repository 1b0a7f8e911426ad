"""The server of a live machine: one machine, its page, its watchers."""

from motionfmu.live.server.app import application
from motionfmu.live.server.machine_link import MachineLink

__all__ = ["MachineLink", "application"]
