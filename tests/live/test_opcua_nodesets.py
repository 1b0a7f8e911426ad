"""Published nodesets instead of own types: which files are taken, in which order; refusals."""

import asyncio
import re
from pathlib import Path

import pytest
from opcua_bench import STATE, bench

from motionfmu.base.errors import InputError
from motionfmu.live.opcua import machine_nodes
from motionfmu.live.opcua.channel_watch import ChannelMode, ChannelState
from motionfmu.live.opcua.node_table import TypeNode, type_nodes
from motionfmu.live.opcua.node_tree import NodeTree
from motionfmu.live.opcua.nodesets import MACHINE_TOOL, found, order

STANDARD = "http://opcfoundation.org/UA/"


def nodeset(
    folder: Path, name: str, needs: tuple[str, ...] = (), day: str = "2024-01-01", uri: str = ""
) -> Path:
    file = folder / f"{name}.xml"
    file.parent.mkdir(parents=True, exist_ok=True)
    rows = "".join(f'<RequiredModel ModelUri="{n}"/>' for n in (STANDARD, *needs))
    file.write_text(
        '<UANodeSet xmlns="http://opcfoundation.org/UA/2011/03/UANodeSet.xsd"><Models>'
        f'<Model ModelUri="{uri or name}" PublicationDate="{day}T00:00:00Z">{rows}</Model>'
        "</Models></UANodeSet>"
    )
    return file


def test_states_and_transitions_are_those_of_their_types() -> None:
    nodes = {(n.specification.prefix, n.number): n for n in type_nodes()}
    numbers = {
        (n.specification.prefix, n.parent): n.value for n in nodes.values() if n.value is not None
    }

    def is_part(prefix: str, number: int, kind: int, name: str) -> bool:
        node = nodes[prefix, number]
        return (node.parent, node.name.rpartition(":")[2]) == (kind, name)

    for state, number in machine_nodes._PROGRAM_STATES.items():
        assert is_part("MachineTool", number, 15, state.name)
        assert numbers["MachineTool", number] == state
    for (begin, end), (number, value) in machine_nodes._TRANSITIONS.items():
        assert is_part("MachineTool", number, 15, f"{begin.name}To{end.name}")
        assert numbers["MachineTool", number] == value
    for name, number in machine_nodes._ITEM_STATES.items():
        assert is_part("Machinery", number, 1002, name)
    for name, number in machine_nodes._OPERATION_MODES.items():
        assert is_part("MachineTool", number, 1003, name)
    for mode in (ChannelMode, ChannelState):
        (names,) = (
            n.names for n in nodes.values() if n.names and _above(nodes, n) == mode.__name__
        )
        assert names == tuple(m.name for m in mode)


def _above(nodes: dict[tuple[str, int], TypeNode], node: TypeNode) -> str:
    assert node.parent is not None
    return nodes[node.specification.prefix, node.parent].name.rpartition(":")[2]


def test_each_nodeset_comes_behind_those_that_it_needs(tmp_path: Path) -> None:
    nodeset(tmp_path, "a/tool", ("b", "c"), uri=MACHINE_TOOL)
    nodeset(tmp_path, "b", ("c",))
    nodeset(tmp_path, "c", day="2022-01-01")
    newer = nodeset(tmp_path, "new/c", day="2023-01-01", uri="c")
    nodeset(tmp_path, "other", ("nowhere",))
    (tmp_path / "types.xml").write_text("<Types/>")
    files = [n.file for n in order(found(tmp_path), tmp_path)]
    assert files == [newer, tmp_path / "b.xml", tmp_path / "a/tool.xml"]


def test_what_is_not_there_or_broken_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="none: no such folder"):
        found(tmp_path / "none")
    with pytest.raises(InputError, match=rf"^{tmp_path}: no nodeset of {MACHINE_TOOL}$"):
        order(found(tmp_path), tmp_path)
    nodeset(tmp_path, "tool", ("b",), uri=MACHINE_TOOL)
    with pytest.raises(InputError, match=rf"no nodeset of b, which {MACHINE_TOOL} needs$"):
        order(found(tmp_path), tmp_path)
    (tmp_path / "cut.xml").write_text("<UANodeSet>")
    with pytest.raises(InputError, match=r"cut\.xml: no element found"):
        found(tmp_path)


def started(folder: Path, nodes: Path) -> list[str]:
    async def work() -> list[str]:
        async with bench(folder, nodes) as b:
            assert await b.client.ask("missing", "own:part") == []
            read: list[str] = await b.read(STATE)
            return read

    return asyncio.run(work())


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Own types as nodesets, a file for each specification."""
    from asyncua import Server

    folder = tmp_path_factory.mktemp("nodesets")

    async def work() -> None:
        server = Server()
        await server.init()
        await NodeTree(server).begin()
        needs = f'<RequiredModel ModelUri="{STANDARD}" PublicationDate="2022-01-01T00:00:00Z"/>'
        for specification in dict.fromkeys(n.specification for n in type_nodes()):
            file = folder / f"{specification.prefix}.xml"
            await server.export_xml_by_ns(str(file), [specification.uri], export_values=True)
            model = f'ModelUri="{specification.uri}" PublicationDate="2025-01-01T00:00:00Z"'
            told = f"</NamespaceUris><Models><Model {model}>{needs}</Model></Models>"
            file.write_text(file.read_text().replace("</NamespaceUris>", told))
            day = f"{specification.published:%Y-%m-%dT00:00:00Z}"
            needs += f'<RequiredModel ModelUri="{specification.uri}" PublicationDate="{day}"/>'

    asyncio.run(work())
    return folder


@pytest.mark.more
def test_types_can_come_from_files(exported: Path, tmp_path: Path) -> None:
    assert started(tmp_path, exported) == ["Initializing"]


@pytest.mark.more
def test_an_older_nodeset_is_refused(exported: Path, tmp_path: Path) -> None:
    for file in exported.glob("*.xml"):
        text = file.read_text()
        if file.stem == "MachineTool":
            text, count = re.subn(
                r'<UAVariable NodeId="ns=\d+;i=225".*?</UAVariable>', "", text, flags=re.S
            )
            assert count == 1
        (tmp_path / file.name).write_text(text)
    wanted = f"nodeset of {MACHINE_TOOL} has no MachineTool:OperationMode: 1.02.0 or later"
    with pytest.raises(InputError, match=wanted):
        started(tmp_path, tmp_path)


@pytest.mark.more
def test_a_file_that_cannot_be_loaded_is_told(exported: Path, tmp_path: Path) -> None:
    for file in exported.glob("*.xml"):
        text = file.read_text().replace(' NodeId="ns=', ' NodeId="ns=x', file.stem == "Machinery")
        (tmp_path / file.name).write_text(text)
    with pytest.raises(InputError, match=r"/Machinery\.xml: \w+Error: "):
        started(tmp_path, tmp_path)
