"""Sentences that people read: how long they are, and their words.

``python tests/helpers/plain_english.py`` prints what breaks the rules and fails then.
"""

import re
import sys
from pathlib import Path

from sentences import of_file

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 40  # words of one sentence
MEAN = 25  # words of a page's sentences, on average
FEW = 5  # sentences below which an average says nothing

# What a word says instead; where it says nothing, the word goes.
FORBIDDEN = {
    "simply": "",
    "obviously": "",
    "of course": "",
    "please note": "",
    "seamless": "",
    "seamlessly": "",
    "powerful": "what it does",
    "cutting-edge": "",
    "state-of-the-art": "",
    "blazing": "a figure",
    "leverage": "use",
    "utilize": "use",
    "in order to": "to",
}


def replaced(glossary: str) -> dict[str, str]:
    """The glossary's word by each that it replaces and that its last column has as code."""
    rows = re.findall(r"^\| \*\*(.+?)\*\*.*\|([^|]*)\|$", glossary, re.MULTILINE)
    return {old: word for word, gone in rows for old in re.findall(r"`([^`]+)`", gone)}


TERMS = replaced((ROOT / "docs/glossary.md").read_text(encoding="utf-8"))

PLURAL = {re.sub(r"(?= )|$", "s", each, count=1): word for each, word in TERMS.items()}
BETTER = FORBIDDEN | TERMS | PLURAL
PLAINER = re.compile(rf"(?<![\w.-])(?:{'|'.join(BETTER)})(?![\w-])", re.IGNORECASE)
HISTORY = "CHANGELOG.md"  # what is said of a version has the words of that version


def breaks(name: str, text: str) -> list[str]:
    """What a file's text breaks, a line each: file, line, words, the beginning, what to do."""
    found = of_file(name, text)
    out = []
    for one in found:
        beginning = " ".join(one.text.split()[:8])
        where = f"{name}:{one.line}:"
        if one.words > LONGEST:
            out.append(
                f'{where} {one.words} words, at most {LONGEST}: "{beginning} ..."; '
                "make it two sentences with a verb each"
            )
        for word in PLAINER.findall(" ".join(one.text.split())) if not one.name else ():
            better = BETTER[word.lower()]
            if name == HISTORY and word.lower() not in FORBIDDEN:
                continue
            do = f'say "{better}"' if better else "leave it out"
            out.append(f'{where} "{word}" in "{beginning} ..."; {do}')
    prose = [one.words for one in found if one.prose]
    if name.endswith(".md") and len(prose) >= FEW and sum(prose) >= MEAN * len(prose):
        most = max((one for one in found if one.prose), key=lambda one: one.words)
        mean = sum(prose) / len(prose)
        out.append(
            f"{name}:{most.line}: {mean:.1f} words a sentence on average, below {MEAN}; split the "
            f'longest first, "{" ".join(most.text.split()[:8])} ..." of {most.words}'
        )
    return out


# What is held: the pages, what the package, the FMUs, scenarios and models say to a user, and the
# comments of C.
HELD = (
    *("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "DESIGN.md", "SECURITY.md", "docs/**/*.md"),
    *(f"{folder}/**/README.md" for folder in ("examples", "fmus", "modelica", "scenarios")),
    *("src/**/README.md", "tests/**/README.md"),
    *(f"src/motionfmu/**/*.{kind}" for kind in ("py", "js", "html")),
    *("src/**/*.h", "src/**/*.c", "src/**/*.inc", "fmus/**/*.c", "modelica/**/*.mo"),
    *(f"{folder}/**/*.toml" for folder in ("examples", "fmus", "scenarios", "src", "tests")),
)


def files(root: Path = ROOT) -> list[str]:
    """Every file that is held, by its name from the root."""
    return sorted({str(path.relative_to(root)) for glob in HELD for path in root.glob(glob)})


def main(root: Path = ROOT) -> int:
    """Print what breaks the rules."""
    out = [said for f in files(root) for said in breaks(f, (root / f).read_text(encoding="utf-8"))]
    print(*out, sep="\n", end="\n" if out else "")
    return 1 if out else 0


if __name__ == "__main__":
    sys.exit(main())
