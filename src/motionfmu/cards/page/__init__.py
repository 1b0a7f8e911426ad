"""The page of the network cards: one for all cards of a server."""

from motionfmu.cards.page.app import application
from motionfmu.cards.page.serving import Serving

__all__ = ["Serving", "application"]
