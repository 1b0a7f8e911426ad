"""The server of a live machine: one machine, its page, its watchers."""

from motionfmu.live.serving.grbl_port import GrblPort
from motionfmu.live.serving.machine_app import MESSAGE_MAX, application
from motionfmu.live.serving.machine_link import MachineLink, MachineStart

__all__ = ["MESSAGE_MAX", "GrblPort", "MachineLink", "MachineStart", "application"]
