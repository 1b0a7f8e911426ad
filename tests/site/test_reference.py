"""The site's reference says what the code has: what changes there changes on the page."""

import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal
from xml.etree import ElementTree

import pytest
import typer
from conftest import FMUS, ROOT
from console import within
from py_mini_racer import MiniRacer
from pydantic import BaseModel, Field
from site_pages import (
    c_headers,
    commands,
    decisions,
    faults,
    file_keys,
    fmus,
    gallery,
    key_words,
    python_modules,
    speed,
    staging,
)
from site_pages.markdown import plain, table

from motionfmu import cli
from motionfmu.scenarios import fmus as built
from motionfmu.scenarios.table_sources import ORIGINS

pytestmark = [pytest.mark.more, pytest.mark.xdist_group("site")]


def rows(page: str) -> list[list[str]]:
    """Cells of all tables of a page."""
    lines = (line for line in page.splitlines() if line.startswith("| "))
    return [[c.strip() for c in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def application(text: str, default: int, name: str = "--often") -> typer.Typer:
    app = typer.Typer()

    @app.command()
    def first(often: Annotated[int, typer.Option(name, help=text, min=2)] = default) -> None:
        """Do it."""

    @app.command()
    def second(what: Annotated[Path, typer.Argument(help="Which one.")]) -> None:
        """Do another."""

    return app


def test_an_option_is_on_the_page_as_the_application_has_it() -> None:
    page = commands.page(commands.commands(application("How often.", 3)))
    assert ["`--often`", "whole number, 2 or more", "`3`", "How often."] in rows(page)
    assert ["`WHAT`", "path", "Which one."] in rows(page)
    other = commands.page(commands.commands(application("How soon.", 4, "--soon")))
    assert ["`--soon`", "whole number, 2 or more", "`4`", "How soon."] in rows(other)
    assert "often" not in other.lower()


def test_every_option_of_every_command_is_on_the_page() -> None:
    found = commands.commands(cli.app)
    page = commands.page(found)
    parts = {p.split("\n")[0]: p for p in page.split("\n## ")[1:]}
    head = page.split("\n## ")[0]
    assert parts.keys() == found.keys() and len(parts) > 30
    for name, part in parts.items():
        shown = within(*name.split(), "--help").stdout
        options = set(re.findall(r"^  (?:-\w, )?(--[\w-]+)", shown, re.MULTILINE))
        assert options, name
        options.discard("--help")
        assert {o for o in options if f"`{o}`" not in part + head} == set(), name


def test_every_argument_and_option_of_every_command_has_its_words() -> None:
    found = [(f"{name} {p.name}", p) for name, c in commands.commands(cli.app).items()
             for p in c.params if not getattr(p, "hidden", False)]  # fmt: skip
    assert len(found) > 200
    assert [name for name, p in found if not (p.help or "").strip()] == []


class Inner(BaseModel):
    """A table within."""

    speed: float = Field(default=2.5, gt=0, le=9)  # [mm/s] along the path


class Outer(BaseModel):
    """A file.

    Attributes
    ----------
    names : list of str
        What it is
        called.
    """

    names: list[str] = Field(min_length=1)
    # How it goes.
    way: Literal["up", "down"] = "up"
    part: dict[str, Inner] = Field(default_factory=dict)
    row: list[Inner] = Field(default_factory=list)


class Changed(Outer):
    way: Literal["up", "down", "across"] = "across"  # where it goes


def words_of_tests(kind: type) -> dict[str, str]:
    source = Path(__file__).read_text(encoding="utf-8")
    body = re.search(rf"^class {kind.__name__}\(.*?(?=^\S)", source, re.MULTILINE | re.DOTALL)
    assert body
    return key_words.attributes(kind.__doc__ or "") | key_words.comments(body[0])


def test_a_key_is_on_the_page_as_its_model_has_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_keys, "words_of", words_of_tests)
    page = file_keys.page(file_keys.TomlFile("a.toml", "A file.", Outer))
    assert ["`names`", "list of: text, 1 entry or more", "required", "What it is called."] in rows(
        page
    )
    assert ["`way`", '"up" or "down"', '`"up"`', "How it goes."] in rows(page)
    inner = ["`speed`", plain("number, > 0, <= 9"), "`2.5`", plain("[mm/s] along the path")]
    assert rows(page).count(inner) == 2
    assert "## `[part.NAME]`" in page and "## `[[row]]`" in page
    page = file_keys.page(file_keys.TomlFile("a.toml", "A file.", Changed))
    told = ["`way`", '"up" or "down" or "across"', '`"across"`', "where it goes"]
    assert told in rows(page)


@pytest.mark.parametrize("file", file_keys.files(), ids=lambda f: f.name)
def test_every_key_has_its_words(file: file_keys.TomlFile) -> None:
    found = rows(file_keys.page(file))
    assert [row[0] for row in found if not row[-1]] == []
    assert len(found) > 8


# Tables whose keys a scenario's author chooses.
CHOSEN = ("component", "connect", "set", "check", "expect", "limits", "levels", "columns", "over")


def test_keys_that_scenarios_use_are_on_the_page() -> None:
    listed = {f.name: f for f in file_keys.files()}
    page = file_keys.page(listed["scenario.toml"])
    origins = set(ORIGINS)
    assert all(f" {name} " in page for name in origins)
    files = sorted(ROOT.glob("scenarios/*/scenario.toml"))
    machines = [f for kind in ("machines", "rigs") for f in ROOT.glob(f"src/motionfmu/{kind}/*/*")]
    machines = [file for file in machines if file.name == "machine.toml"]
    assert len(files) > 50 and len(machines) > 10
    files += machines
    for file in files:
        tables = tomllib.loads(file.read_text(encoding="utf-8"))
        for name, value in tables.items():
            assert name in origins or f"`{name}`" in page or f"[{name}" in page, file
            if name in (*CHOSEN, "drive", "contrary") or not isinstance(value, dict | list):
                continue
            for part in value if isinstance(value, list) else [value]:
                for key in part if isinstance(part, dict) else ():
                    there = f"`{key}`" in page or f"[[{name}.{key}]]" in page
                    assert there or name == "record_file", f"{file}: {name}.{key}"


@pytest.mark.parametrize(
    ("name", "places"),
    [
        ("identify.toml", ("examples/*/*/identify.toml", "scenarios/*/identify.toml")),
        ("identify.toml of an FMU", ("fmus/*/identify.toml",)),
    ],
)
def test_keys_that_an_identification_uses_are_on_the_page(name: str, places: tuple[str]) -> None:
    page = file_keys.page(next(f for f in file_keys.files() if f.name == name))
    files = [file for place in places for file in sorted(ROOT.glob(place))]
    assert files
    for file in files:
        told = tomllib.loads(file.read_text(encoding="utf-8"))
        assert [k for k in told if f"`{k}`" not in page and f"[{k}" not in page] == [], file
        parts = {f"[arm.{k}]" if isinstance(v, dict) else f"`{k}`"
                 for k, v in told.get("arm", {}).items()}  # fmt: skip
        assert {p for p in parts if p not in page} == set(), file


def test_every_variable_is_on_its_fmus_page() -> None:
    names = fmus.names()
    assert names == sorted(p.parent.name for p in ROOT.glob("fmus/*/fmu.toml"))
    for name in names:
        page = rows(fmus.variables(list(built.ports(name).values())))
        found = {row[0].strip("`"): row for row in page}
        xml = ElementTree.fromstring(built.description_text(name))
        rows_ = [r for r in xml.iterfind("ModelVariables/*") if r.get("causality") != "independent"]
        assert len(rows_) > 3 and FMUS.is_dir()
        for row in rows_:
            shown = found[row.attrib["name"]]
            assert plain(row.get("description", "")) in shown[-1], (name, row.attrib)
            for limit in ("min", "max"):
                if limit in row.attrib:
                    number = plain(f"{float(row.attrib[limit]):.10g}")
                    assert any(number in cell for cell in shown), (name, row.attrib)


def test_a_changed_variable_changes_its_row() -> None:
    port = built.ports("mcc")["max_feed"]
    before = fmus.variables([port])
    for change in ({"doc": "Another."}, {"unit": "mm/s"}, {"start": "7"}, {"high": 9.5}):
        assert fmus.variables([replace(port, **change)]) != before
    assert "## Inputs" in fmus.variables([replace(port, causality="input")])
    assert ["`max_feed`", "real", "mm/min"] == rows(before)[2][:3]


# Numbers that tell of no fault.
NONE = {0: "it is none", -1: "none yet"}


def test_every_fault_says_what_to_do() -> None:
    found = list(faults.tables())
    page = faults.page(found)
    script = (ROOT / "src/motionfmu/live/serving/page/words.js").read_text("utf-8")
    live = MiniRacer()
    live.eval(re.sub("^export ", "", script, flags=re.MULTILINE))
    nothing = live.eval("advice({}, 1)")
    assert sum(len(one.meanings) for one in found) > 140
    for one in found:
        faulty = one.meanings.keys() - NONE
        assert faulty, one.fmu
        for number in faulty:
            told = one.advice.get(number, "")
            assert len(told) > 20 and told.endswith(".") and told != nothing, (one, number)
            assert any(r[0] == str(number) and r[-1] == plain(told) for r in rows(page))
            shown = {"advice": {str(number): told}}
            assert live.eval(f"advice({json.dumps(shown)}, {number})") == told
    assert {one.fmu for one in found} >= {f.parent.name for f in ROOT.glob("fmus/*/advice.toml")}
    one = next(t for t in found if t.fmu == "card_host")
    changed = replace(one, advice=dict.fromkeys(one.advice, "Do nothing."))
    assert "Do nothing." in faults.page([changed]) and "Do nothing." not in page


def test_the_page_of_speed_has_what_the_benchmark_has_kept() -> None:
    names = ("last", "peers", "growth")
    kept, *others = (json.loads((ROOT / f"tests/bench/{n}.json").read_text("utf-8")) for n in names)
    page = speed.page(kept, *others)
    first, *more = page.split("\n## ")
    found = {row[0]: row[1:] for row in rows(first)[2:]}
    assert list(found) == [plain(name) for name in kept["figures"]] and len(found) > 60
    for name, value in kept["figures"].items():
        figure, asked, bound = found[plain(name)]
        assert float(figure.replace(",", "")) == pytest.approx(value, rel=1e-3), name
        words = kept["asked"].get(name, "")
        assert asked == plain(words.removesuffix(" MISSED")), name
        assert bound == ("missed" if "MISSED" in words else "met" if words else ""), name
    assert kept["day"] in page and "x86\\_64" in page
    name = next(iter(kept["figures"]))
    other = kept | {"figures": kept["figures"] | {name: 12345.6}}
    assert [plain(name), "12,346", "", ""] in rows(speed.page(other, *others))
    later = speed.page(kept | {"day": "2001-02-03"}, *others)
    assert "12,346" not in page and "2001-02-03" in later
    peers, growth = others
    for text, kept_rows, column in ((more[0], peers["rows"], "what"), (more[1], growth, "name")):
        assert [row[0] for row in rows(text)[2:]] == [plain(row[column]) for row in kept_rows]
    for row, told in zip(peers["rows"], rows(more[0])[2:], strict=True):
        ratio = float(told[-1].replace(",", ""))
        assert ratio == pytest.approx(row["theirs"] / row["ours"], rel=1e-3)


HEADER = """/* thing - a thing that counts.
 *
 * - first
 *   and on
 * - second */
#ifndef THING_H
#define THING_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { THINGS = 3 /* how many */ };

struct thing {
    int32_t n; /* of it */
};

/* Counts on; returns the count. */
int32_t thing_count(struct thing *t,
                    int32_t by);

static inline int32_t thing_now(const struct thing *t)
{
    return t->n;
}

#ifdef __cplusplus
}
#endif

#endif
"""


def test_a_header_is_its_comments_and_declarations() -> None:
    found = c_headers.declarations(HEADER)
    assert [d.comment for d in found[1:]] == ["", "", "Counts on; returns the count.", ""]
    assert found[1].code == ["enum { THINGS = 3 /* how many */ };"]
    assert found[3].code == [
        "int32_t thing_count(struct thing *t,\n                    int32_t by);"
    ]
    assert found[4].code == ["static inline int32_t thing_now(const struct thing *t);"]
    page = c_headers.page("thing", {"thing.h": HEADER})
    assert "A thing that counts." in page and "- first and on\n- second\n" in page
    assert "cplusplus" not in page and "THING_H" not in page
    other = c_headers.page("thing", {"thing.h": HEADER.replace("int32_t by", "double by")})
    assert "double by" in other


def test_every_function_that_is_installed_is_on_a_page() -> None:
    from site_pages import sections

    pages = "\n".join(c_headers.page(c, h) for c, h in sections._headers(ROOT).items())
    installed = "\n".join(
        file.read_text("utf-8")
        for file in (ROOT / "build/include/motionfmu").glob("*.h")
        if file.name != "short_names.h"  # macros
    )
    names = set(re.findall(r"\b(motionfmu_\w+)\(", re.sub(r"/\*.*?\*/", "", installed, flags=re.S)))
    assert len(names) > 500
    assert {n for n in names if f"{n}(" not in pages} == set()


def test_a_module_has_its_page_if_it_gives_names(tmp_path: Path) -> None:
    package = tmp_path / "made"
    (package / "inner").mkdir(parents=True)
    (package / "__init__.py").write_text('__all__ = ["a"]\n')
    (package / "inner/__init__.py").write_text('"""Nothing to import."""\n')
    assert python_modules.modules(package) == ["made"]
    (package / "inner/__init__.py").write_text('__all__ = ["b"]\n')
    assert python_modules.modules(package) == ["made", "made.inner"]


def test_links_lead_to_pages_and_listings(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a/README.md").write_text("# A\n")
    (tmp_path / "a/code.c").write_text("int a;\n")
    staged = staging.Staged(tmp_path, tmp_path / "out", ["README.md", "a/README.md"])
    text = "[folder](a#b), [code](a/code.c), [gone](c.md), `[x](y)`\n```\n[folder](a)\n```\n"
    found = staging.rewritten(text, "README.md", staged)
    assert "[folder](a/README.md#b)" in found and "[gone](c.md)" in found
    assert '<a class="listing" href="files/a/code.c.html">code</a>' in found
    assert staged.listed == {"a/code.c"} and "```\n[folder](a)\n```" in found


def test_decisions_are_listed_by_subject_and_superseded_ones_last(tmp_path: Path) -> None:
    folder = tmp_path / "docs/decisions/roads"
    folder.mkdir(parents=True)
    subject = "| [roads](docs/decisions/roads) | Where cars go. |\n"
    (tmp_path / "DESIGN.md").write_text(subject + subject.replace("roads", "rails"))
    old = "*Decided 2026-11-21.*\n\n*Superseded on 2026-11-22 by [Right](../rails/right.md)*\n"
    (folder / "left.md").write_text(f"# Left\n\n{old}")
    (folder / "signs.md").write_text("# Signs\n\n*Decided 2026-11-22; changed 2026-11-24.*\n")
    pages = [f"docs/decisions/roads/{name}.md" for name in ("left", "signs")]
    made = decisions.pages_of(tmp_path, pages)
    assert list(made) == ["decisions.md", "decisions/roads.md", "decisions/rails.md"]
    assert rows(made["decisions.md"])[2:] == [
        ["[roads](decisions/roads.md)", "Where cars go.", "2"],
        ["[rails](decisions/rails.md)", "Where cars go.", "0"],
    ]
    text = made["decisions/roads.md"]

    def day(number: int) -> str:
        return f'<span class="day">2026-11-{number}</span>'

    assert rows(text)[2:] == [
        ["[Signs](../docs/decisions/roads/signs.md)", "", f"{day(22)}; changed {day(24)}"],
        [
            "[Left](../docs/decisions/roads/left.md)",
            "on 2026-11-22 by [Right](../docs/decisions/rails/right.md)",
            day(21),
        ],
    ]
    assert text.startswith("# Roads: decisions\n\nWhere cars go.\n")
    assert "/docs/decisions/roads/left.md" in text.split("{toctree}")[1]
    staged = staging.Staged(tmp_path, tmp_path / "out", ["DESIGN.md", *pages])
    found = staging.rewritten("[rails](../rails)", pages[0], staged)
    assert found == "[rails](../../../decisions/rails.md)\n"


def test_theory_is_what_a_readme_links() -> None:
    line = "Theory: [a](../../docs/theory/two-words.md), [b](../../../../docs/theory/one.md#place)."
    assert gallery.theory_of(f"{line}\n{line}") == ("two words", "one")
    other = "`docs/theory/x.md` [x](../../docs/theory.md) [y](docs/theory/figures/make.py)"
    assert gallery.theory_of(other) == ()


def test_what_a_cell_says_is_no_markup() -> None:
    assert plain("a|b *c* <d> $e$ [f](g)") == r"a\|b \*c\* \<d\> \$e\$ \[f\](g)"
    assert rows(table(("a", "b", "c"), [("1", "", "3")])) == [
        ["a", "c"],
        ["---", "---"],
        ["1", "3"],
    ]
