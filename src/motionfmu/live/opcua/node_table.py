"""Nodes of the companion specifications, as type_nodes.txt lists them."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.resources import files

FILE = "type_nodes.txt"
RULES = {
    "M": "ModellingRule_Mandatory",
    "O": "ModellingRule_Optional",
    "MP": "ModellingRule_MandatoryPlaceholder",
    "OP": "ModellingRule_OptionalPlaceholder",
}
_REFERENCES = {"FromState", "ToState", "GeneratesEvent"}


@dataclass(frozen=True)
class Specification:
    """A companion specification: prefix in browse names, namespace, edition of its nodeset."""

    prefix: str
    uri: str
    version: str
    published: datetime


@dataclass(frozen=True)
class TypeNode:
    """A node of a specification; names have the prefix of their namespace, the standard's none."""

    specification: Specification
    number: int
    node_class: str
    name: str
    base: str  # the type of which it is a subtype or an instance
    parent: int | None
    rule: str | None = None
    by: str = ""  # reference from its parent, or from its base
    data: str | None = None
    rank: int = -1
    abstract: bool = False
    value: int | None = None
    names: tuple[str, ...] = ()
    references: tuple[tuple[str, int], ...] = field(default=())

    @property
    def is_type(self) -> bool:
        """Whether its base is what it is a subtype of."""
        return self.node_class in ("ObjectType", "DataType")


def type_nodes() -> list[TypeNode]:
    """All nodes of the table, each behind its parent."""
    return list(_read(files(__package__).joinpath(FILE).read_text(encoding="utf-8")))


def _read(text: str) -> Iterator[TypeNode]:
    specification: Specification | None = None
    above: list[int] = []
    for line in text.splitlines():
        words = line.split()
        if not words or words[0] == "#":
            continue
        if words[0] == "=":
            published = datetime.fromisoformat(words[4]).replace(tzinfo=UTC)
            specification = Specification(words[1], words[2], words[3], published)
            continue
        assert specification is not None
        depth = (len(line) - len(line.lstrip())) // 2
        parent = above[depth - 1] if depth else None
        above[depth:] = [int(words[0])]
        yield _node(specification, parent, words)


def _node(specification: Specification, parent: int | None, words: list[str]) -> TypeNode:
    number, node_class, name, base, *more = words
    pairs = [w.split("=", 1) for w in more if "=" in w]
    said = {k: v for k, v in pairs if k not in _REFERENCES}
    usual = "HasProperty" if base == "PropertyType" else "HasComponent"
    return TypeNode(
        specification,
        int(number),
        node_class,
        name,
        base,
        parent,
        rule=next((w for w in more if w in RULES), None),
        by=said.get("by", "HasSubtype" if node_class.endswith("Type") else usual),
        data=said.get("data"),
        rank=int(said.get("rank", -1)),
        abstract="abstract" in more,
        value=int(said["value"]) if "value" in said else None,
        names=tuple(said["names"].split(",")) if "names" in said else (),
        references=tuple((k, int(v)) for k, v in pairs if k in _REFERENCES),
    )
