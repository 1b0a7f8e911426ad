"""The server of a live machine: one machine, its page, its watchers."""

from motionfmu.live.server.app import MESSAGE_MAX, application
from motionfmu.live.server.grbl_port import GrblPort
from motionfmu.live.server.machine_link import MachineLink, MachineStart

__all__ = ["MESSAGE_MAX", "GrblPort", "MachineLink", "MachineStart", "application"]
