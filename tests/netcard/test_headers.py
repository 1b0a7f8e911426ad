"""The card's headers: what compilers read from them, when they are written, what is refused."""

import re
import shutil
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT
from console import within

from motionfmu.cards.config import read
from motionfmu.cards.headers import texts, write

EXAMPLE = ROOT / "examples/network_card_firmware"
TEXT = (EXAMPLE / "card.toml").read_text()
WARNINGS = ["-Wall", "-Wextra", "-Werror", "-pedantic"]
COMPILERS = [
    ["gcc", "-std=c89"],
    ["gcc", "-std=c11"],
    ["g++", "-x", "c++"],
    ["arm-none-eabi-gcc", "-std=c89"],
]
# By hand, from the example's file and the two changes below.
WANTED = {
    "MC_IP_0": 192, "MC_IP_3": 50, "MC_NETMASK_2": 255, "MC_NETMASK_3": 0, "MC_GATEWAY_3": 1,
    "MC_MAC_0": 2, "MC_MAC_5": 1, "MC_SERVER_IP_3": 10, "MC_SERVER_PORT": 8765, "MC_CARD_ID": 1,
    "MC_AXES": 2, "MC_X_PULSES_PER_M": 1_000_000, "MC_X_LIMIT_NEG": -5000,
    "MC_X_LIMIT_POS": 410_000, "MC_Y_LIMIT_POS": 290_000, "MC_X_LIMIT_LEVEL": 1,
    "MC_X_SPEED_MAX": 200_000, "MC_X_SPEED_MIN": 500, "MC_X_ACC_MAX": 1_000_000,
    "MC_X_JERK_MAX_LOW": 50_000_000, "MC_X_JERK_MAX_HIGH": 0, "MC_X_JERK_MAX": 50_000_000,
    "MC_Y_JERK_MAX_LOW": 5_000_000_000 - 2**32, "MC_Y_JERK_MAX_HIGH": 1,
    "MC_X_ORIGIN_TRIGGER": 1, "MC_TRIGGER_LOW": 3, "MC_X_HOME_ORDER": 1, "MC_Y_HOME_ORDER": 2,
    "MC_X_HOME_DIRECTION": 0, "MC_X_HOME_SPEED": 20_000, "MC_X_HOME_SLOW": 1000,
    "MC_X_HOME_BACK": 2000, "MC_X_HOME_TRAVEL": 450_000, "MC_X_HOME_OFFSET": 5000,
    "MC_DDA_PERIOD_NS": 1_000_000, "MC_FIFO_DEPTH": 512, "MC_PULSE_WIDTH_NS": 1000,
    "MC_DIR_SETUP_NS": 5000, "MC_DIR_HOLD_NS": 5000, "MC_ON_LINK_LOSS": 0, "MC_MUST_HOME": 0,
    "MC_PEN_MOVER": 0, "MC_PEN_OUTPUT": 0, "MC_PEN_UP_LEVEL": 0, "MC_PEN_DWELL_US": 30_000,
    "MC_PRIORITY_PARSER": 7, "MC_PRIORITY_STORAGE": 6, "MC_PRIORITY_HOME": 5,
    "MC_PRIORITY_HOME_ACTIVE": 2, "MC_PRIORITY_STOP": 4, "MC_PRIORITY_PAUSE": 3,
    "MC_PRIORITY_RUN": 1, "MC_IN_0_ACTION": 1, "MC_IN_3_ACTION": 2, "MC_IN_15_ACTION": 0,
    "MC_IN_7_EDGE": 2, "MC_IN_0_DEBOUNCE_US": 10_000, "MC_OUT_PEN": 0, "MC_OUT_VALVE": 5,
}  # fmt: skip
CHANGED = TEXT.replace("jerk_max         = 50000\n", "jerk_max = 5e6\n") + (
    '[inputs.7]\nedge = "both"\n'
)


def made(folder: Path, text: str = TEXT, crlf: bool = False) -> Path:
    write(read(text, "card.toml"), folder, "card.toml", crlf)
    return folder


def compiled(command: list[str], folder: Path, lines: str) -> subprocess.CompletedProcess[str]:
    source = folder / "t.c"
    source.write_text('#include "mc_config.h"\n#include "mc_config.h"\n' + lines)
    line = [*command, *WARNINGS, f"-I{folder}", "-c", str(source), "-o", str(folder / "t.o")]
    return subprocess.run(line, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("command", COMPILERS, ids=" ".join)
def test_a_compiler_reads_the_values_of_the_file(command: list[str], tmp_path: Path) -> None:
    if not shutil.which(command[0]):
        pytest.skip(f"no {command[0]} here")
    made(tmp_path, CHANGED)
    values = ",\n".join(f"(unsigned int)({name})" for name in WANTED)
    result = compiled(
        command,
        tmp_path,
        f'extern const unsigned int v[];\n__attribute__((section("values")))'
        f" const unsigned int v[] = {{\n{values} }};\n",
    )
    assert result.returncode == 0, result.stderr
    objcopy = command[0].replace("gcc", "objcopy") if "eabi" in command[0] else "objcopy"
    subprocess.run(
        [objcopy, "-O", "binary", "--only-section=values", tmp_path / "t.o", tmp_path / "v"],
        check=True,
    )
    read_back = struct.unpack(f"<{len(WANTED)}I", (tmp_path / "v").read_bytes())
    assert dict(zip(WANTED, read_back, strict=True)) == {k: v % 2**32 for k, v in WANTED.items()}


def test_a_jerk_of_more_than_32_bits_is_one_number_where_there_is_long_long(tmp_path: Path) -> None:
    made(tmp_path, CHANGED)
    good = "int t[MC_Y_JERK_MAX == 5000000000ULL ? 1 : -1];"
    assert compiled(["gcc", "-std=c11"], tmp_path, good).returncode == 0
    assert compiled(["gcc", "-std=c11"], tmp_path, good.replace("5000", "5001")).returncode != 0
    assert "long long" in compiled(["gcc", "-std=c89"], tmp_path, good).stderr
    text = (tmp_path / "mc_axes.h").read_text()
    assert "MC_X_JERK_MAX 50000000UL /*" in text and "MC_Y_JERK_MAX 5000000000ULL /*" in text


def test_every_macro_is_named_once_and_has_a_comment_and_a_range() -> None:
    headers = texts(read(TEXT, "card.toml"), "card.toml")
    together = "".join(headers.values())
    names = re.findall(r"#define (MC_\w+) ", together)
    assert len(names) == len(set(names)) == 155
    assert all(len(line) < 200 and line.isascii() for line in together.splitlines())
    for name, comment in re.findall(r"#define (MC_[XY]_\w+) [^/\n]*(/\*)?", together):
        assert comment or name.endswith("_LOW")
        tested = name if "JERK" not in name else name.removesuffix("_HIGH").removesuffix("_LOW")
        assert f'#error "{tested}: ' in together
    assert set(headers) == {f"mc_{p}.h" for p in "config network axes home io motion".split()}


@pytest.mark.parametrize(
    ("name", "value", "word"),
    [
        ("MC_X_SPEED_MAX", "500001UL", "MC_X_SPEED_MAX: 1 .. 500000 pulses/s"),
        ("MC_X_SPEED_MAX", "0UL", "MC_X_SPEED_MAX: 1 .. 500000 pulses/s"),
        ("MC_X_SPEED_MIN", "200001UL", "MC_X_SPEED_MIN must be <= MC_X_SPEED_MAX"),
        ("MC_X_LIMIT_NEG", "410000L", "MC_X_LIMIT_NEG must be < MC_X_LIMIT_POS"),
        ("MC_X_LIMIT_NEG", "(-2147483648L)", "MC_X_LIMIT_NEG: -2147483647 .. 2147483647"),
        ("MC_X_JERK_MAX_HIGH", "232831UL", "MC_X_JERK_MAX: 1 .. 1000000000000000 pulses/s"),
        ("MC_X_ORIGIN_TRIGGER", "4U", "MC_X_ORIGIN_TRIGGER: 0 .. 3"),
        ("MC_X_HOME_SPEED", "200001UL", "MC_X_HOME_SPEED must be <= MC_X_SPEED_MAX"),
        ("MC_DDA_PERIOD_NS", "1000010UL", "MC_DDA_PERIOD_NS: 250000 .. 10000000 ns, a multiple"),
        ("MC_PULSE_WIDTH_NS", "2600UL", "MC_X_SPEED_MAX: more than MC_PULSE_WIDTH_NS lets"),
        ("MC_FIFO_DEPTH", "15U", "MC_FIFO_DEPTH: 16 .. 2304 frames"),
        ("MC_PRIORITY_RUN", "2U", "MC_PRIORITY_RUN must be < MC_PRIORITY_HOME_ACTIVE"),
        ("MC_IN_3_ACTION", "6U", "MC_IN_3_ACTION: 0 .. 5"),
        ("MC_SERVER_PORT", "0U", "MC_SERVER_PORT: 1 .. 65535"),
    ],
)
def test_a_compiler_refuses_a_header_changed_by_hand(
    name: str, value: str, word: str, tmp_path: Path
) -> None:
    made(tmp_path)
    for file in tmp_path.glob("mc_*.h"):
        text = file.read_text()
        file.write_text(re.sub(rf"(?m)^(#define {name}) \S+", rf"\1 {value}", text))
    result = subprocess.run(
        ["gcc", "-E", "-std=c89", "-xc", "-"],
        input=f'#include "{tmp_path}/mc_config.h"\n',
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode != 0 and f'#error "{word}' in result.stderr


def test_headers_are_the_same_bytes_again_and_stay_untouched(tmp_path: Path) -> None:
    config = read(TEXT, "card.toml")
    first = write(config, tmp_path / "a", "card.toml")
    assert len(first) == 6 == len(list((tmp_path / "a").iterdir()))
    before = {f: (f.stat().st_mtime_ns, f.stat().st_ino) for f in first}
    assert write(config, tmp_path / "a", "card.toml") == []
    assert {f: (f.stat().st_mtime_ns, f.stat().st_ino) for f in first} == before
    faster = read(TEXT.replace("speed_min        = 0.5", "speed_min = 0.75", 1), "card.toml")
    assert [f.name for f in write(faster, tmp_path / "a", "card.toml")] == ["mc_axes.h"]
    assert write(config, tmp_path / "b", "card.toml", crlf=True)
    for file in first:
        other = (tmp_path / "b" / file.name).read_bytes()
        assert b"\r\n" in other and other.count(b"\n") == other.count(b"\r\n")
        if file.name != "mc_axes.h":
            assert other.replace(b"\r\n", b"\n") == file.read_bytes()
    assert compiled(["gcc", "-std=c89"], tmp_path / "b", "int x;\n").returncode == 0


def test_the_name_of_the_file_cannot_end_a_comment() -> None:
    for text in texts(read(TEXT, ""), "a*/ int x;\n\u00fc.toml").values():
        assert text.isascii() and text.split("*/")[1].startswith("\n#ifndef")


def test_the_command_is_a_hook_wrong_values_end_the_build(tmp_path: Path) -> None:
    file = tmp_path / "card.toml"
    file.write_text(TEXT)
    assert within("card", "headers", file, "-o", tmp_path / "inc").returncode == 0
    file.write_text(TEXT.replace("8765", "0").replace("dwell    = 0.03", "dwell = -1"))
    result = within("card", "headers", file, "-o", tmp_path / "other")
    assert result.returncode == 2
    assert [m.split(": ")[1] for m in result.stderr.splitlines()[1:]] == ["motion.pen.dwell = -1"]
    assert result.stderr.startswith(f"motionfmu: {file}:8: network.port = 0: ")
    assert not (tmp_path / "other").exists()
    (tmp_path / "taken").write_text("")
    file.write_text(TEXT)
    result = within("card", "headers", file, "-o", tmp_path / "taken")
    assert result.returncode == 2 and result.stderr.count("\n") == 1


def test_the_firmware_project_builds_runs_and_builds_no_more_than_it_must(tmp_path: Path) -> None:
    project = tmp_path / "firmware"
    shutil.copytree(EXAMPLE, project, ignore=shutil.ignore_patterns("build"))

    def make(*goals: str, status: int = 0) -> str:
        hook = f"MOTIONFMU={sys.executable} -m motionfmu"
        line = ["make", "-C", project, "CFLAGS=-std=c89 -Wall -Wextra -Werror -pedantic", hook]
        result = subprocess.run([*line, *goals], capture_output=True, text=True, check=False)
        assert (result.returncode == 0) == (status == 0), result.stdout + result.stderr
        return result.stdout + result.stderr

    listed = re.findall(r"\]\(([\w.]+)\)", (EXAMPLE / "README.md").read_text())
    assert {f.name for f in project.iterdir()} == {*listed, "README.md", "page.png"}
    printed = make("run")
    assert printed.count(" -c ") == 2
    assert "frame 100: output 0 high output 5 pulse 30000 us\n" in printed
    assert "frame 500: semaphore 1 is full: this give is lost\n" in printed
    assert "1000 frames, X 100000, Y 0 pulses\n" in printed
    assert " -c " not in make()
    file = project / "card.toml"
    file.write_text(file.read_text().replace('action = "pause"', 'action = "none"'))
    assert "the pause button is wired to input 3" in make(status=2)
