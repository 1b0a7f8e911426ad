"""The page of the network cards: one for all cards of a server."""

from motionfmu.base.page_server import PageServer
from motionfmu.cards.server_page.app import application

__all__ = ["PageServer", "application"]
