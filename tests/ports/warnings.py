"""`make warnings`: every C file of the build by other compilers, for which warnings are errors.

python tests/ports/warnings.py build [WORDS of paths]
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

COMPILERS = {
    "clang": "clang",
    "x86_64-w64-mingw32-gcc": "gcc-mingw-w64-x86-64",
}  # Debian's packages
# What belongs to a machine's program or to the usual compiler alone.
_GNU_ONLY = re.compile(r"-flto\S*|-fno-semantic-interposition|-MD|-fPIC")
_POSIX_ONLY = ("/src/python/", "/tests/", "/examples/")  # Python's binding is not for Windows


def commands(build: Path) -> dict[Path, list[str]]:
    """How each C file is compiled, once, with paths as the build has them and no outputs."""
    told = subprocess.run(
        ["ninja", "-C", str(build), "-t", "compdb"], capture_output=True, text=True, check=True
    ).stdout
    found: dict[Path, list[str]] = {}
    for row in json.loads(told):
        file = Path(row["directory"], row["file"]).resolve()
        words = shlex.split(row["command"])
        if file.suffix != ".c" or "-c" not in words or "zig" in " ".join(words[:3]):
            continue
        begin = next(k for k, word in enumerate(words) if word.startswith("-"))
        kept = [w for w in words[begin : words.index("-o")] if not _GNU_ONLY.fullmatch(w)]
        found.setdefault(
            file, [w for w in kept if w not in ("-MT", "-MF") and w[-2:] not in (".o", ".d")]
        )
    return found


def wanted(compiler: str, file: Path) -> bool:
    """Whether a compiler's machine has a use for a file."""
    return "mingw" not in compiler or not any(part in str(file) for part in _POSIX_ONLY)


def complaints(
    compiler: str, files: dict[Path, list[str]], more: Sequence[str] = ()
) -> Iterator[str]:
    """What a compiler says of files."""

    def compiled(one: tuple[Path, list[str]]) -> str:
        words = [compiler, *one[1], "-Werror", *more, "-c", str(one[0]), "-o", os.devnull]
        return subprocess.run(words, capture_output=True, text=True, errors="replace").stderr

    chosen = [(f, words) for f, words in files.items() if wanted(compiler, f)]
    with ThreadPoolExecutor(2) as pool:
        yield from filter(None, pool.map(compiled, chosen))


def main(build: str, *words: str) -> int:
    """Tell every complaint; 1 if there is one."""
    files = {
        f: c
        for f, c in commands(Path(build)).items()
        if not words or any(w in str(f) for w in words)
    }
    bad = 0
    for compiler, package in COMPILERS.items():
        if shutil.which(compiler) is None:
            sys.exit(f"there is no {compiler}: apt-get install {package}")
        told = list(complaints(compiler, files))
        print(f"{compiler}: {len(files)} files, {len(told)} with complaints", flush=True)
        print("".join(told), file=sys.stderr)
        bad += len(told)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
