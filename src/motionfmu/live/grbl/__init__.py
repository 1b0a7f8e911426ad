"""A machine as a Grbl 1.1 controller: the protocol, without I/O."""

from motionfmu.live.grbl.grbl_binding import GrblBinding
from motionfmu.live.grbl.grbl_controller import GrblController
from motionfmu.live.grbl.grbl_machine import MachineOrders, MachineView
from motionfmu.live.grbl.grbl_settings import GrblSettings

__all__ = ["GrblBinding", "GrblController", "GrblSettings", "MachineOrders", "MachineView"]
