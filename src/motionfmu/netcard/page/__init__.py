"""The page of the network cards: one for all cards of a server."""

from motionfmu.netcard.page.app import application

__all__ = ["application"]
