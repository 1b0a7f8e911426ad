"""A live machine as an OPC UA server after OPC 40501-1, OPC UA for Machine Tools."""

from motionfmu.live.opcua.opcua_server import OpcUaServer

__all__ = ["OpcUaServer"]
