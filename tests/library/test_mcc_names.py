"""The document's names: table of the README, headers, exported symbols and tests agree."""

import re
import subprocess

from conftest import ROOT

# The source document prints 89 function names, one of them twice; the second is circle_yzuvw here.
NAMES = 89


def table(text: str) -> dict[str, list[str]]:
    """Test files by function name, from the rows with three columns of names, meaning, tests."""
    rows = re.findall(r"^\| (`MCC_.*?) \| .* \| (`.*`) \|$", text, re.M)
    found: dict[str, list[str]] = {}
    for names, tests in rows:
        for name in re.findall(r"`(MCC_\w+)`", names):
            assert name not in found, f"{name} stands twice"
            found[name] = re.findall(r"`(\S+)`", tests)
    return found


README = table((ROOT / "src/controllers/mcc/README.md").read_text())


def declared() -> set[str]:
    headers = [f for f in (ROOT / "src/controllers/mcc").glob("*.h") if f.name != "mccl.h"]
    text = "\n".join(f.read_text() for f in headers)
    return set(re.findall(r"^[a-z]\w* (MCC_\w+)\(", text, re.M))


def exported() -> set[str]:
    listing = subprocess.run(
        ["nm", "-g", "--defined-only", ROOT / "build/libmcc.a"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    return set(re.findall(r" T (MCC_\w+)$", listing, re.M))


def test_the_table_has_every_name_of_the_document() -> None:
    assert len(README) == NAMES


def test_the_table_is_what_the_headers_declare() -> None:
    assert set(README) == declared()


def test_what_is_declared_is_there() -> None:
    assert declared() == exported()


# Comments, strings, characters; code that is switched off.
NO_CODE = re.compile(
    r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|^#if 0\b.*?^#endif",
    re.DOTALL | re.MULTILINE,
)
# int (*const calls[])(...) = { one, two };
TABLE = re.compile(r"\(\s*\*\s*(?:const\s+)?(\w+)\s*\[\w*\]\s*\)\s*\([^;{]*\)\s*=\s*\{([^}]*)\}")


def called(text: str) -> set[str]:
    """Names that a C test calls: in an expression, or through a table whose elements it calls."""
    code = NO_CODE.sub(" ", text)
    # A type before it makes a declaration or a definition.
    found = {
        m[2]
        for m in re.finditer(r"(\w+[\s*]+)?\b(MCC_\w+)\s*\(", code)
        if not m[1] or re.match(r"(return|else|case|do|goto)\b", m[1])
    }
    for table, names in TABLE.findall(code):
        if re.search(rf"\b{table}\s*\[[^\]]*\]\s*\(", code):
            found |= set(re.findall(r"\bMCC_\w+", names))
    return found


def test_the_named_test_calls_the_function() -> None:
    missing = []
    for name, files in README.items():
        texts = [next(ROOT.glob(f"tests/core/*/{f}")).read_text() for f in files]
        missing += [] if any(name in called(t) for t in texts) else [name]
    assert missing == []


def test_a_name_that_is_not_called_is_no_test() -> None:
    calls = "int (*const f[])(void) = { MCC_b, MCC_c };"
    text = f"""
        int MCC_declared(struct mcc *m);
        struct mcc *MCC_pointed(void);
        /* MCC_comment(1); */ // MCC_line(2);
        const char *s = "MCC_string(3) \\" MCC_quoted(4)";
        #define NAME MCC_named
        static int (*const g[])(void) = {{ MCC_table }};
        static {calls}
        #if 0
        MCC_off(5);
        #endif
        int main(void) {{ return MCC_a (1) + CHECK_EQ(MCC_d(&m), 1) + f[0](); }}
    """
    text = re.sub(r"^ +", "", text, flags=re.M)
    assert called(text) == {"MCC_a", "MCC_b", "MCC_c", "MCC_d"}


def test_the_parameters_are_a_type_of_the_headers() -> None:
    text = "\n".join(f.read_text() for f in (ROOT / "src/controllers/mcc").glob("*.h"))
    assert "} MCC_MACH_PARAM;" in text and "epcio_axis_param[AXES]" in text


def test_the_table_reader_can_fail() -> None:
    row = "| `MCC_a` `MCC_b` | does | `x.c` `y.c` |\n| `task_c` | no | `z.c` |\n| `MCC_d` | two |\n"
    assert table(row) == {"MCC_a": ["x.c", "y.c"], "MCC_b": ["x.c", "y.c"]}
