"""The page of the network cards: one for all cards of a server."""

from motionfmu.cards.server_page.app import application
from motionfmu.cards.server_page.page_server import PageServer

__all__ = ["PageServer", "application"]
