"""The page of the network cards: one for all cards of a server."""

from motionfmu.netcard.page.app import application
from motionfmu.netcard.page.serving import Serving

__all__ = ["Serving", "application"]
