"""The generated look at the Booleans and enumerations of a state finds each of them."""

import subprocess
from pathlib import Path

import pytest
from conftest import ROOT

from motionfmu.fmu import cstructs

TEXT = r"""
#include <stdint.h>   /* struct model { char not_this; }; */
#define TWO 2
enum colour { RED, GREEN, BLUE = 7 };
enum { SIZE = 3 };
#define SHADES(X) \
    X(LIGHT, "a, b") /* X(NONE, "") */ \
    X(DARK, "c")
#define SHADE(name, text) name,
enum shade { SHADES(SHADE) };
typedef struct { int32_t n; bool flag; } OLD;
struct leaf {
    double x;
    bool flag, more[2][TWO]; /* bool none; */
    enum colour colour;
    enum shade shade;
};
struct plain { double x[SIZE]; int32_t n; };
static int use(const struct plain *p) { struct plain q = { { 0 }, 1 }; return p->n + q.n; }
struct model {
    struct leaf leaf[SIZE][2];
    struct plain plain;
    OLD old[2];
    struct inner { uint8_t byte; bool flag; } inner;
    struct { bool flag; enum { UP, DOWN } way[2]; };
    union { struct plain a; double b; } either;
};
"""
MAIN = """
int main(void)
{
    static struct model m;
    unsigned char *bytes = (unsigned char *)&m;
    if (!fmi_good_model(&m) || use(&m.plain) != 1) {
        return 1;
    }
    for (size_t i = 0; i < sizeof m; i++) {
        bytes[i] = 9;
        printf("%d", !fmi_good_model(&m));
        bytes[i] = 0;
    }
    return 0;
}
"""


def test_every_boolean_and_enumeration_is_found(tmp_path: Path) -> None:
    source, program = tmp_path / "all.c", tmp_path / "all"
    head = "#include <stdio.h>\n#include <stdbool.h>\n"
    source.write_text(head + TEXT + cstructs.flags([TEXT]) + MAIN)
    command = ["cc", "-std=c11", "-Wall", "-Wextra", "-Werror", f"-I{ROOT}/src/fmi", str(source)]
    subprocess.run([*command, "-o", str(program)], check=True)
    seen = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    # On every common machine: double 8 bytes, enumeration 4, each at a multiple of its size.
    leaf = "0" * 8 + "11111" + "000" + "1111" + "1111"
    whole = 6 * leaf + "0" * 32 + 2 * "00001000" + "0100" + "1000" + 2 * "1111"
    assert seen == whole + "0" * 32  # the union


@pytest.mark.parametrize("member", ["char *name;", "void (*call)(int);", "struct { int n; } x;"])
def test_what_a_state_cannot_have(member: str) -> None:
    with pytest.raises(ValueError, match="struct part: a state has neither pointers"):
        cstructs.flags([f"struct part {{ int a; {member} }}; struct model {{ struct part p; }};"])
    # Elsewhere it may be.
    assert cstructs.flags([f"struct part {{ {member} }}; struct model {{ int n; }};"])
