"""A machine that runs while somebody works at it."""

from motionfmu.live.exchange import Exchange, ExchangePlan
from motionfmu.live.journal import Action, Journal
from motionfmu.live.live_client import LiveClient, connect
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.pace import Pace

__all__ = [
    "Action",
    "Exchange",
    "ExchangePlan",
    "Journal",
    "LiveClient",
    "LiveMachine",
    "Pace",
    "connect",
]
