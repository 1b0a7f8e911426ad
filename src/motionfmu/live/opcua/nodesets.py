"""The published nodesets of companion specifications, loaded into a server."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from asyncua import Server

from motionfmu.base.errors import InputError

MACHINE_TOOL = "http://opcfoundation.org/UA/MachineTool/"
_STANDARD = "http://opcfoundation.org/UA/"  # the server has it
_NAMES = "{http://opcfoundation.org/UA/2011/03/UANodeSet.xsd}"


@dataclass(frozen=True)
class Nodeset:
    """A file of nodes: the namespace that it defines, and those that it needs."""

    file: Path
    uri: str
    published: str
    needs: tuple[str, ...]


def found(folder: Path) -> dict[str, Nodeset]:
    """The nodesets of a folder and those below it, by namespace: of several the latest."""
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder")
    latest: dict[str, Nodeset] = {}
    for file in sorted(folder.rglob("*.xml")):
        for nodeset in _models(file):
            known = latest.get(nodeset.uri)
            if known is None or known.published < nodeset.published:
                latest[nodeset.uri] = nodeset
    return latest


def _models(file: Path) -> Iterator[Nodeset]:
    """What a file says that it defines: nothing, if it is none of nodes."""
    try:
        for _, element in ElementTree.iterparse(file):
            if element.tag == f"{_NAMES}Models":
                for model in element.iter(f"{_NAMES}Model"):
                    needs = (m.get("ModelUri", "") for m in model.iter(f"{_NAMES}RequiredModel"))
                    published = model.get("PublicationDate", "")
                    yield Nodeset(file, model.get("ModelUri", ""), published, tuple(needs))
                return
    except ElementTree.ParseError as error:
        raise InputError(f"{file}: {error}") from None


def order(nodesets: dict[str, Nodeset], folder: Path, uri: str = MACHINE_TOOL) -> list[Nodeset]:
    """The nodesets that one needs, each behind those that it needs itself, and that one."""
    done: dict[str, Nodeset] = {}

    def add(wanted: str, way: tuple[str, ...]) -> None:
        if wanted in done or wanted == _STANDARD or wanted in way:
            return
        if wanted not in nodesets:
            needed = f", which {way[-1]} needs" if way else ""
            raise InputError(f"{folder}: no nodeset of {wanted}{needed}")
        for need in nodesets[wanted].needs:
            add(need, (*way, wanted))
        done[wanted] = nodesets[wanted]

    add(uri, ())
    return list(done.values())


async def load(server: Server, folder: Path) -> None:
    """Load OPC UA for Machine Tools and what it needs; `InputError` if a file is wrong."""
    for nodeset in order(found(folder), folder):
        try:
            # Without code for their structures, which are no values of a live machine's nodes.
            await server.import_xml(str(nodeset.file), auto_load_definitions=False)
        except Exception as error:  # the importer raises what its parts raise
            raise InputError(f"{nodeset.file}: {type(error).__name__}: {error}") from None
