"""The C text that an FMU carries, as importers compile it or link it into a program."""

import re
from collections.abc import Iterable, Iterator, Mapping, Set
from xml.etree import ElementTree as ET

NAMES = "fmu_names.h"
PREFIX = "motionfmu_"  # of every name that an installed library shows

# Definitions of names that other C files can see: functions and tables, inline functions of
# headers, declarations of a list X(name, ..). To rename a name too many does no harm.
_FUNCTION = re.compile(
    r"^(?!static\b|typedef\b|extern\b)[A-Za-z_][\w \*]*?\b(\w+)\([^;{}]*\)\n\{", re.MULTILINE
)
_DATA = re.compile(
    r"^(?!static\b|typedef\b|extern\b)(?:const )?(?:struct \w+|[a-z]\w+) (\w+)(?:\[[^\]]*\])* = ",
    re.MULTILINE,
)
_STEM = re.compile(r"\bvoid (\w+)##name\(")
_LISTED = re.compile(r"\bX\((\w+),")
_DIRECTIVE = re.compile(r"^#(?:if|el|endif|include <).*", re.MULTILINE)
_GUARD = re.compile(r"#ifndef [A-Z0-9_]+_H\n")
_OWN = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
# glibc has mathematics in a separate library.
_LIBM = ("x86_64-linux", "aarch64-linux")
OPTIONS = "-ffp-contract=off"  # else a processor with fused operations rounds otherwise


def shown(texts: Iterable[str]) -> set[str]:
    """Names that C files and headers define for others."""
    found: set[str] = set()
    for text in texts:
        found.update(_FUNCTION.findall(text), _DATA.findall(text))
        stems, listed = _STEM.findall(text), _LISTED.findall(text)
        found.update(stem + name for stem in stems for name in listed)
    return found


def prefixed(text: str, names: Set[str]) -> str:
    """A header whose functions have the project's prefix: where they are declared or called, where
    a macro stands for one or joins a name to the stem of some. Other things may have the name of a
    function, but not one of the library's calls, which begin with MCC_."""

    def named(match: re.Match[str]) -> str:
        return PREFIX + match[0] if match[0] in names else match[0]

    def stem(match: re.Match[str]) -> str:
        return PREFIX + match[0] if any(n.startswith(match[1]) for n in names) else match[0]

    text = re.sub(r"\bMCC_\w+|\b[A-Za-z_]\w*(?=\s*\()", named, text)
    text = re.sub(r"(?<=\s)(?<!struct )(?<!enum )\b([A-Za-z]\w*_)(?=##)", stem, text)
    return re.sub(
        r"^(#define \w+ +)(\w+)\b",
        lambda m: m[1] + (PREFIX * (m[2] in names)) + m[2],
        text,
        flags=re.M,
    )


def short_names(names: Iterable[str]) -> str:
    """Text of the header by which functions of installed libraries are called as in the sources."""
    rows = "".join(f"#define {name}(...) {PREFIX}{name}(__VA_ARGS__)\n" for name in sorted(names))
    return f"""\
/* short_names - calls without the prefix {PREFIX}, as the documents and sources have them.
 * Leave it out in a program that has such names of its own. */
#ifndef MOTIONFMU_SHORT_NAMES_H
#define MOTIONFMU_SHORT_NAMES_H

#include <stddef.h> /* so that it is a text of C by itself */

{rows}
#endif
"""


def _systems(text: str) -> Iterator[str]:
    """The lines that include headers of the system, with the #if lines around them."""
    conditions: list[str] = []
    for line in _DIRECTIVE.findall(text):
        if line.startswith("#if"):
            conditions.append(f"{line}\n")
        elif line.startswith("#el"):
            conditions[-1] += f"{line}\n"
        elif line.startswith("#endif"):
            conditions.pop()
        else:
            within = [c for c in conditions if not _GUARD.fullmatch(c)]
            yield "".join(within) + f"{line}\n" + "#endif\n" * len(within)


def _names(identifier: str, texts: Iterable[str]) -> str:
    """Text of the header that gives every name of an FMU its model's prefix."""
    whole = list(texts)
    rows = "".join(f"#define {name} {identifier}_{name}\n" for name in sorted(shown(whole)))
    included = {rows for text in whole for rows in _systems(text)}
    headers = "".join(sorted(included, key=lambda rows: (rows.count("\n"), rows)))
    switched = "".join(
        f"#if !defined(FMI{v}_FUNCTION_PREFIX) && !defined(FMI{v}_OVERRIDE_FUNCTION_PREFIX) \\\n"
        f"    && !defined({identifier}_EXPORTS)\n"
        f"#define FMI{v}_FUNCTION_PREFIX {identifier}_\n#endif\n"
        for v in (2, 3)
    )
    return f"""\
/* Generated: names of this FMU begin with those of its model, so that several can be linked into
 * one program. The functions of FMI have their own names in a shared library, for which
 * FMI2_OVERRIDE_FUNCTION_PREFIX or FMI3_OVERRIDE_FUNCTION_PREFIX is defined, or what CMake defines
 * for a shared library of the model's name. */
#ifndef FMU_NAMES_H
#define FMU_NAMES_H

{switched}
{rows}
/* A core's names are not shown by a shared library; those of the system's headers stay as they
 * are. */
#if defined(FMU_CORE) && defined(__GNUC__) && !defined(_WIN32)
{headers}#pragma GCC visibility push(hidden)
#endif

#endif
"""


def renamed(
    identifier: str, units: Iterable[str], compiled: Iterable[str], files: Mapping[str, bytes]
) -> dict[str, bytes]:
    """C files and headers as they are packed.

    `units` are the C files with the functions of FMI, `compiled` all other files that are compiled
    by themselves.
    """
    seen = dict.fromkeys(compiled)
    waiting = list(seen)
    while waiting:
        new = [n for n in _OWN.findall(files[waiting.pop()].decode()) if n in files.keys() - seen]
        seen |= dict.fromkeys(new)
        waiting += new
    made = dict(files)
    made[NAMES] = _names(identifier, (files[name].decode() for name in seen)).encode()
    head = f'#include "{NAMES}"\n'.encode()
    made |= {name: head + files[name] for name in units}
    made |= {name: b"#define FMU_CORE\n" + head + files[name] for name in compiled}
    return made


def build_description(identifier: str, names: list[str]) -> bytes:
    """Text of FMI 3's buildDescription.xml, the same wherever it is made."""
    root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
    for platform in (*_LIBM, None):
        configuration = ET.SubElement(root, "BuildConfiguration", modelIdentifier=identifier)
        if platform:
            configuration.set("platform", platform)
        file_set = ET.SubElement(
            configuration, "SourceFileSet", language="C11", compilerOptions=OPTIONS
        )
        for name in names:
            ET.SubElement(file_set, "SourceFile", name=name)
        ET.SubElement(
            file_set,
            "PreprocessorDefinition",
            name="FMI3_OVERRIDE_FUNCTION_PREFIX",
            optional="true",
            description=f"For a shared library; without it functions are {identifier}_fmi3...",
        )
        if platform:
            ET.SubElement(configuration, "Library", name="m", external="true")
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
