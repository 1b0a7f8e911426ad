"""An XML text as elements that know their lines."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import shown


@dataclass
class XmlElement:
    """An element of an XML file."""

    tag: str
    given: dict[str, str]
    file: str
    line: int
    children: list["XmlElement"] = field(default_factory=list)
    text: str = ""

    def all(self, tag: str) -> Iterator["XmlElement"]:
        """Children of a name."""
        return (c for c in self.children if c.tag == tag)

    def first(self, tag: str) -> "XmlElement | None":
        """The first child of a name."""
        return next(self.all(tag), None)

    def wrong(self, told: str) -> InputError:
        """A message with file, line and element."""
        name = self.given.get("name")
        return InputError(
            f"{self.file}:{self.line}: <{self.tag}>{f' {name}' if name else ''}: {told}"
        )

    def words(self, key: str, count: int, usual: tuple[float, ...] | None) -> tuple[float, ...]:
        """Finite numbers of an attribute; what is usual if it is not there."""
        text = self.given.get(key)
        if text is None:
            if usual is None:
                raise self.wrong(f"{key} is missing")
            return usual
        try:
            found = tuple(float(x) for x in text.split())
        except ValueError:
            found = ()
        if len(found) != count or not all(abs(x) < LARGEST for x in found):
            wanted = "a number" if count == 1 else f"{count} numbers"
            raise self.wrong(f"{key} = {shown(text)}: {wanted} wanted")
        return found

    def number(self, key: str, usual: float | None = None) -> float:
        """A finite number of an attribute."""
        return self.words(key, 1, None if usual is None else (usual,))[0]

    def word(self, key: str) -> str:
        """Text of an attribute, not empty."""
        if not self.given.get(key, "").strip():
            raise self.wrong(f"{key} is missing")
        return self.given[key].strip()


# No length, mass or angle of a machine is so large; infinite and NaN are above, too.
LARGEST = 1e12


def xml_of(text: str, file: str) -> XmlElement:
    """The root of an XML text; what is no XML, or declares entities, is refused."""
    found: list[XmlElement] = []
    around: list[XmlElement] = []
    parser = expat.ParserCreate()

    def begin(tag: str, given: dict[str, str]) -> None:
        element = XmlElement(tag, given, file, parser.CurrentLineNumber)
        (around[-1].children if around else found).append(element)
        around.append(element)

    def end(_: str) -> None:
        around.pop()

    def characters(part: str) -> None:
        around[-1].text += part

    def declared(*_: object) -> None:
        raise InputError(f"{file}:{parser.CurrentLineNumber}: a document type is not read")

    parser.StartElementHandler, parser.EndElementHandler = begin, end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = characters, declared
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        told = expat.ErrorString(error.code)
        raise InputError(f"{file}:{error.lineno}: no XML: {told}") from None
    return found[0]
