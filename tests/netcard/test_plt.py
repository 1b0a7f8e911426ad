"""HP-GL: outputs of foreign programs as another reader sees them, each command, what is wrong."""

import json
from pathlib import Path

import ezhpgl
import numpy as np
import pytest
from lines_apart import Lines, apart, length

from motionfmu.base.errors import InputError
from motionfmu.drawings import plt

FILES = sorted((Path(__file__).parent / "plt").glob("*.plt"))


def drawn(text: bytes | str, **options: object) -> Lines:
    """Drawn lines in plotter units."""
    text = text.encode("latin-1") if isinstance(text, str) else text
    return [p.points / 0.025 for p in plt.parse(text, **options).lines if p.down]  # type: ignore[arg-type]


def foreign(text: bytes) -> Lines:
    """The same as ezhpgl draws them, pieces between the ends of its operations."""
    read = json.loads(ezhpgl.parse(text, strict=False).to_json())
    found: Lines = []
    for page in read["pages"]:
        for operation in page["operations"]:
            g = operation["geometry"]
            for part in [g] if "points" in g else g["contours"]:
                points = np.array([[p["x"], p["y"]] for p in part["points"]]) / 0.025
                edges = part.get("edges", [{"start": 0, "end": len(points), "pen_down": True}])
                found += [points[e["start"] : e["end"] + 1] for e in edges if e["pen_down"]]
    return [p for p in found if len(p) > 1]


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.stem)
def test_a_foreign_file_is_drawn_as_another_reader_draws_it(file: Path) -> None:
    text = file.read_bytes()
    if file.stem == "commands":  # that reader rotates only with the size of a sheet
        text = text[: text.index(b"RO90")]
    ours = [p for p in drawn(text) if len(p) > 1]
    theirs = foreign(text if text.rstrip().endswith(b";") else text + b";")
    # Arcs: our chords are 0.005 mm off, theirs 5 degrees long.
    chords = file.stem == "commands"
    within = 0.5 if chords else 1e-6
    assert max(apart(ours, theirs), apart(theirs, ours)) < within
    assert length(ours) == pytest.approx(length(theirs), rel=1e-3 if chords else 1e-9)
    assert length(ours) > 5000.0


# One use of each command that draws or maps, each way it may be written.
EACH = [
    "IN;SP1;PU100,200;PD300,400,500,100;PU0,0;PD10,700;",
    "IN;SP1;PU100,100;PR;PD50,60,-20,30;PU10,10;PD5,5;PA;PD0,0;",
    "IN;SP1;PR100,100;PD;PR10,20,30,-5;PA500,500;",
    "IN;SP1;PU1000,0;PD;AA0,0,90,5;AA0,0,-180,5;",
    "IN;SP1;PU1000,0;PD;AR-500,100,120,5;",
    "IN;SP1;PU1000,1000;CI500,5;PD2000,2000;",
    "IN;SP1;PU1000,1000;PD;CI500,5;PD2000,2000;",
    "IN;SP1;PU1000,1000;CI-500,30;",
    "IN;SP1;PU100,100;EA500,300;PD200,200;",
    "IN;SP1;PU100,100;ER400,-300;PD200,200;",
    "IN;SP1;PU1000,1000;EW400,30,100,5;",
    "IN;SP1;PU1000,1000;EW-400,30,-100,5;",
    "IN;SP1;PU0,0;PD;AT500,500,1000,0,5;",
    "IN;SP1;PU100,100;PD;RT500,500,1000,0,5;",
    "IN;IP100,200,1100,2200;SC0,100,0,100;SP1;PU10,10;PD50,50,90,10;",
    "IN;IP0,0,1000,1000;SC0,10,0,10;IP100,100;SP1;PU1,1;PD5,5;",
    "IN;IP0,0,1000,1000;SC10,0,10,0;SP1;PU1,1;PD5,6;",
    "IN;IP0,0,1000,3000;SC0,10,0,10,1;SP1;PU1,1;PD5,6;",
    "IN;IP0,0,1000,3000;SC0,10,0,10,1,0,0;SP1;PU1,1;PD5,6;",
    "IN;IP0,0,1000,3000;SC0,3,0,2,2;SP1;PU1,1;PD5,6;",
    "IN;IP0,0,1000,1000;SC0,10,0,10;SP1;PU5,5;CI2,5;PD;AA5,5,90,5;",
    "IN;IP0,0,1000,1000;SC0,10,0,10;SP1;PU1,1;PD5,6;SC;PD700,700;",
    "IN;SP1;PU1,1;PR;DF;PD100,100;PD200,50;",
    "IN;SP1;PU100,100;PD200,200;IN;SP1;PD300,300;",
    "IN;SP1;PU100,100;PD200,200;SP0;PD400,400;SP2;PD500,500;",
    "IN;SP1;PU100,100;PM0;PD500,100,500,500;PM2;EP;",
    "IN;SP1;PU100,100;PM0;PD500,100,500,500;PM1;PU200,150;PD300,150,300,250;PM2;EP;PD0,0;",
    "IN;SP1;PU100,100;PM0;PD500,100;PU500,500;PD100,500;PM2;EP;",
    "IN;SP1;PU1000,1000;PM0;CI500,30;PM2;EP;",
    "IN;SP1;PU100,100;RA400,300;PU9,9;EP;",
    "IN;SP1;PU100,100;RR-50,300;EP;PD7,7;",
    "IN;SP1;PU100,100;WG300,10,-70,5;EP;",
    "IN;SP1;IP0,0,1000,1000;SC0,10,0,20;PU1,2;RA3,4;EP;",
    "IN;SP1;PU100,100;EA400,300;PM0;PD9,9,5,1;PM2;EP;",
    "IN;SP1;VS10;PU100,100;PD200,200;VS20,2;PD300,300;",
    "IN;SP1;SI0.2,0.3;SR;DI1,0;PU100,100;PD200,200;",
    "IN;SP1;PU1,1;PD20,20;@ ",
    "IN;IW-100,-100,5000,5000;SP1;PU1,1;PD20,20;",
    "IN;SP1;PU1.5,1.25;PD-20.75,+.5;",
    "INSP1PU1,1PD20,20",
    "in;sp1;pu1,1;pd20,20;pa;",
    "IN;SP1;PU 10 20;PD 30 , 40 , 50 60;",
    "IN;SP1;PU10,20;PD30,40\nPU50,50\nPD60,60\n",
    "IN;SP1;PU1000,0;AA0,0,90,5;PD0,0;",
    "IN;SP1;CT1;PU1000,1000;CI500,10;",
    "IN;IP0,0,1000,1000;SC0,10,0,10;SP1;PU1,1;PR;PD1,2,3,-1;",
]


@pytest.mark.parametrize("text", EACH)
def test_each_command_is_drawn_as_another_reader_draws_it(text: str) -> None:
    ours = [p for p in drawn(text) if len(p) > 1]
    theirs = foreign(text.encode() if text.rstrip().endswith(";") else text.encode() + b";")
    assert max(apart(ours, theirs), apart(theirs, ours)) < 0.01


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("INPU;PD5,6", [[[0, 0], [5, 6]]]),
        ("in;sp1;pu-4,-4;pd4,5,4,7;", [[[-4, -4], [4, 5], [4, 7]]]),
        ("PD5,6", [[[0, 0], [5, 6]]]),
        ("PU1,1;PD;PA2,2;PA3,3;", [[[1, 1], [1, 1], [2, 2], [3, 3]]]),
        ("IN;PU10,10;PR;PD0,-4,-1,-4;PA;PU0,0", [[[10, 10], [10, 6], [9, 2]]]),
        ("SP1;PU0,0\r\nPD0,10\r\n20,30\r\n", [[[0, 0], [0, 10], [20, 30]]]),
        ("PU0,0PD1-2+3.5,.5", [[[0, 0], [1, -2], [3.5, 0.5]]]),
        ("PU 0 0;PD\t1 , 2 ;", [[[0, 0], [1, 2]]]),
        ("MK4,4,0,0;IN;PA;SP1;CB1;PU4,4;PD4,5;;!PG;;", [[[4, 4], [4, 5]]]),
        ("\x1b.(\x1b.@100;2:\x1b%0BIN;PD1,1;\x1b%0A rubbish \x1b%-12345X", [[[0, 0], [1, 1]]]),
        ("@PJL ENTER PD7,7\nIN;PD1,1;@ \0\x1a", [[[0, 0], [1, 1]]]),
        ("LBPD9,9;\x03PD1,1", [[[684, 0], [1, 1]]]),
        ("DT#;LBPD9,9;\x03#PD1,1;IN;LBx\x03", [[[684, 0], [1, 1]]]),
        ('CO"PD9,9"PD1,1;SMPPD2,2', [[[0, 0], [1, 1], [2, 2]]]),
        ("PD1,1;CO note PD9,9;PD2,2;", [[[0, 0], [1, 1], [2, 2]]]),
        ("PD1,1;CO PD9,9\nPD8,8;PD2,2;CO to the end PD7,7", [[[0, 0], [1, 1], [2, 2]]]),
        ('PD1,1;CO "a;PD9,9";PD2,2;CO"";PD3,3', [[[0, 0], [1, 1], [2, 2], [3, 3]]]),
        ('PD1,1;MG"PD9,9;";MGPD8,8;PD2,2', [[[0, 0], [1, 1], [2, 2]]]),
        ('BP1,"PD9,9;",5,1PD1,1;', [[[0, 0], [1, 1]]]),
        ("BLPD9,9;\x03PD1,1;PB;PD2,2;PB\nPD3,3", [[[0, 0], [1, 1], [2, 2], [3, 3]]]),
        ("\xef\xbb\xbfIN;PD1,1", [[[0, 0], [1, 1]]]),
        ("SP0;PD5,5;SP2;PU0,0;PD1,1", [[[0, 0], [1, 1]]]),
        ("SP1;PD1,1;SP2;PD2,2", [[[0, 0], [1, 1]], [[1, 1], [2, 2]]]),
        ("IP0,0,100,200;SC0,10,0,10;PU1,1;PD2,2;SC;PD5,5", [[[10, 20], [20, 40], [5, 5]]]),
        ("IP0,0,100,200;SC0,10,0,10,1;PD10,10", [[[0, 0], [100, 150]]]),
        ("IP10,20,90,90;SC5,2,6,3,2;PU5,6;PD6,7", [[[10, 20], [12, 23]]]),
        ("RO90;PU10,0;PD20,0,20,5;RO;PD1,1", [[[0, 10], [0, 20], [-5, 20], [1, 1]]]),
        ("RO270;PD10,5", [[[0, 0], [5, -10]]]),
        ("PU1,1;EA3,2;PD9,9", [[[1, 1], [3, 1], [3, 2], [1, 2], [1, 1], [9, 9]]]),
        ("PM0;PD2,0,2,2;PM1;PU5,5;PD6,5,6,6;PM2;EP", [[[0, 0], [2, 0], [2, 2], [0, 0]],
                                                       [[5, 5], [6, 5], [6, 6], [5, 5]]]),
        ("PU3,3;PM0;PD5,3,5,5;PM2;PD4,4", [[[3, 3], [4, 4]]]),
        ("PM0;PD2,0,2,2;PU;PM2;EP", [[[0, 0], [2, 0], [2, 2]]]),
        # Rectangles and wedges become the polygon, too, in the place of one before.
        ("PM0;PD2,0,2,2;PM2;PU1,1;RA3,4;PU9,9;EP;PD8,8",
            [[[1, 1], [3, 1], [3, 4], [1, 4], [1, 1]], [[9, 9], [8, 8]]]),
        ("PU1,1;WG2,90,90,90;EP", [[[1, 1], [1, 3], [-1, 1], [1, 1]]]),
        ("PU1,1;ER1,2;PU5,5;EP", [[[1, 1], [2, 1], [2, 3], [1, 3], [1, 1]]] * 2),
        ("RO90;PU1,2;RA3,4;EP", [[[-2, 1], [-2, 3], [-4, 3], [-4, 1], [-2, 1]]]),
        ("PU1,1;RR1,1;DF;EP", []),
        ("PD;AA0,0,90;PU10,0;PD;AA0,0,90,45", [[[10, 0], [10, 0], [7.0711, 7.0711], [0, 10]]]),
        ("PU10,0;CI10,120", [[[20, 0], [5, 8.6603], [5, -8.6603], [20, 0]]]),
        ("PU1,1;PD;PU", [[[1, 1], [1, 1]]]),
        ("IW0,0,9,9;PD9,9", [[[0, 0], [9, 9]]]),
    ],
)  # fmt: skip
def test_commands_and_quirks(text: str, lines: list) -> None:
    found = [p for p in drawn(text) if len(p) > 1]
    if "AA0,0,90;" in text:
        found = found[-1:]
    assert [np.round(p, 4).tolist() for p in found] == [
        np.asarray(p, float).tolist() for p in lines
    ]


@pytest.mark.parametrize(
    ("text", "where", "why"),
    [
        ("IN;\nPD1,2,3;", "line 2, column 1, byte 4", "PD: 3 coordinates, an even number"),
        ("IN;\r\n PD1,2-;", "line 2, column 7, byte 11", "'-' is no number"),
        ("PD1,1073741825;", "line 1, column 1, byte 0", "is beyond 1073741824"),
        ("PD1,1;#", "line 1, column 7, byte 6", "'#' begins no instruction"),
        ("SC0,1,0,1;", "line 1, column 1, byte 0", "scale without P1 and P2"),
        ("SC0,1,0;", "byte 0", "3 numbers, 0, 4, 5 or 7 wanted"),
        ("IP0,0,1,1;SC1,1,0,1;", "byte 10", "a range that is empty"),
        ("IN;LBno end", "line 1, column 4, byte 3", "the text has no end"),
        ("CI;", "byte 0", "0 numbers, 1 to 2 wanted"),
        ("AA1,1,400;", "byte 0", "an arc of 400 degrees"),
        ("RO45;", "byte 0", "0, 90, 180 or 270"),
        ("SP-1;", "byte 0", "pen -1, 0 to 255"),
        ("IW0,0,5,5;PD6,6;", "byte 10", "leaves the window"),
        ("PM2;", "byte 0", "polygon mode has not begun"),
        ("VS0;", "byte 0", "above 0 wanted"),
        ("PE?", "byte 2", "an encoded number that does not end"),
        ("PE\xc1;", "byte 3", "an odd number of coordinates"),
        ("BZ1,2,3;", "byte 0", "a multiple of 6"),
        ('PD1,1;CO"no end;PD9,9;', "byte 6", "the text in quotes has no end"),
        ("PE\xc1\xc1XX;", "byte 4", "an encoded number that does not end"),
        ("PE\xc1\xc1PU\xc1;", "byte 7", "an odd number of coordinates"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(text: str, where: str, why: str) -> None:
    with pytest.raises(InputError) as told:
        plt.parse(text.encode("latin-1"), "x.plt")
    assert str(told.value).startswith("x.plt: line ")
    assert where in str(told.value) and why in str(told.value), told.value


def test_fills_are_noted_or_refused() -> None:
    text = b"PM0;PD2,0,2,2;PM2;FP;EP;FP;"
    notes = plt.parse(text).notes
    assert [(n.text, n.count, n.byte) for n in notes] == [("FP: filled area", 2, 18)]
    with pytest.raises(InputError, match="filled areas are not drawn"):
        plt.parse(text, fills=False)


def test_a_frame_of_the_machine_scales_files_without_ip() -> None:
    (line,) = drawn("SC0,1,0,1;PD1,1", frame=(100.0, 200.0, 300.0, 500.0))
    assert line.tolist() == [[0, 0], [300, 500]]


def encoded(values: np.ndarray, base: int, fraction: int) -> str:
    """Numbers as PE has them."""
    text = ""
    for value in np.round(values * 2.0**fraction).astype(int).tolist():
        rest = 2 * abs(value) + (value < 0)
        while rest >= base:
            text += chr(63 + rest % base)
            rest //= base
        text += chr((191 if base == 64 else 95) + rest)
    return text


@pytest.mark.parametrize(("base", "fraction"), [(64, 0), (32, 0), (64, 3), (32, 5)])
def test_encoded_polylines(base: int, fraction: int) -> None:
    draws = np.random.default_rng(base + fraction)
    steps = np.round(draws.normal(0.0, 300.0, (50, 2)) * 2.0**fraction) / 2.0**fraction
    flags = ("7" if base == 32 else "") + (f">{encoded(np.array([fraction]), base, 0)}")
    start = encoded(np.array([100.0, -50.0]), base, fraction)
    text = f"PE{flags}<={start}{encoded(steps.ravel(), base, fraction)};"
    (line,) = drawn(text)
    wanted = np.vstack([[100.0, -50.0], steps]).cumsum(axis=0)
    np.testing.assert_allclose(line, wanted, atol=1e-6)
    pens = plt.parse(f"PE:{encoded(np.array([3]), 64, 0)}{encoded(steps[0], 64, 0)};".encode("l1"))
    assert list(pens.layers) == [3]


@pytest.mark.parametrize("base", [64, 32])
@pytest.mark.parametrize("end", [";", "PUSP0;PG;", "PU;", "SP\n0;", "\x1b%0APU9"])
def test_an_encoded_line_may_end_with_the_next_instruction(base: int, end: str) -> None:
    """As AutoCAD ends its pages; a number over two lines is still one."""
    digits = encoded(np.array([3.0, 4.0, 700.0, -900.0]), base, 0)
    digits = digits[:-2] + "\r\n" + digits[-2:]
    (line,) = drawn(f"IN;PE{'7' if base == 32 else ''}{digits}{end}")
    np.testing.assert_allclose(line, [[0, 0], [3, 4], [703, -896]], atol=1e-9)


def test_a_file_that_an_editor_wrote_as_utf_8() -> None:
    """The last digits of PE have two bytes then, in one base alone."""
    text = f"IN;PE<={encoded(np.array([3.0, 4.0]), 64, 0)}{encoded(np.arange(80.0) - 40, 64, 0)};"
    (raw,) = drawn(text)
    for mark in (b"", b"\xef\xbb\xbf"):
        (again,) = drawn(mark + text.encode("utf-8"))
        assert again.tolist() == raw.tolist()
    assert len(raw) == 41


PAGES = "IN;SP1;{0}PU0,0;PD9,0;{1}PU0,5;PD0,9,9,9;PU;{1}{1}PD7,7;LBPG;\x03{1}PU0,0;{2}"


@pytest.mark.parametrize("sheet", ["PG;", "PG1;", "AF", "AH;", "FR;", "BP;", "!PG;;"])
def test_a_page_of_a_file_with_several(sheet: str) -> None:
    """None is drawn over another; a sheet that nothing is drawn on is none."""
    text = PAGES.format(sheet, sheet, sheet)
    pages = [[[[0, 0], [9, 0]]], [[[0, 5], [0, 9], [9, 9]]], [[[9, 9], [7, 7]]]]
    for page, lines in enumerate(pages, 1):
        read = plt.parse(text.encode(), page=page)
        assert [(p.points / 0.025).round(6).tolist() for p in read.lines if p.down] == lines
        assert (read.page, read.pages) == (page, 3)
    for page in (0, 4):
        with pytest.raises(InputError, match=f"x.plt: no page {page}, it has 3 pages"):
            plt.parse(text.encode(), "x.plt", page=page)
    single = plt.parse(f"{sheet}PD1,1;{sheet}".encode())
    assert single.pages == 1
    with pytest.raises(InputError, match="drawing: no page 2, it has one page"):
        plt.parse(b"PD1,1;", page=2)


def test_layers_bytes_and_speeds() -> None:
    text = b"IN;SP2;VS5;PU0,0;PD4,0;SP1;VS;PU8,8;PD9,9;"
    read = plt.parse(text)
    assert {pen: len(lines) for pen, lines in read.layers.items()} == {1: 1, 2: 1}
    (second,) = read.layers[2]
    assert text[second.first :].startswith(b"PD4,0;") and second.speed == 50.0
    assert read.layers[1][0].speed == 0.0
    np.testing.assert_allclose(read.extent, [[0.0, 0.0], [0.225, 0.225]])


def test_arcs_keep_to_their_tolerance() -> None:
    (line,) = drawn("PU1000,2000;CI5000;")
    radius = np.linalg.norm(line - (1000, 2000), axis=1)
    np.testing.assert_allclose(radius, 5000.0, rtol=1e-12)
    middle = np.linalg.norm(0.5 * (line[1:] + line[:-1]) - (1000, 2000), axis=1)
    off = (5000.0 - middle).max() * 0.025
    assert 0.0045 < off <= 0.005 + 1e-9


def test_nothing_but_input_errors_and_no_hang() -> None:
    """Random changes of the corpus: bytes put in, taken out, swapped; cuts; parts of two files."""
    texts = [f.read_bytes()[:1500] for f in FILES]
    texts += [
        b"PE7>%<=abcdefghijklmnopqrst;PE:\xe0<\xc0\xd0;CI5;SC0,1,0,1;IP0,0,1,1;RO90;PM0;PM2;EP"
    ]
    draws = np.random.default_rng(5)
    refused = 0
    for _ in range(500):
        text = bytearray(texts[draws.integers(len(texts))])
        for _ in range(draws.integers(1, 3)):
            at = int(draws.integers(len(text) + 1))
            kind = draws.integers(4)
            if kind == 0:
                text[at : at + 1] = bytes([draws.integers(256)])
            elif kind == 1:
                del text[at : at + int(draws.integers(1, 40))]
            elif kind == 2:
                text[at:at] = b"PUPDPAPRCIAAARATRTEAEREWPMEPSCIPROIWPELBDTCTBZ-9.,;0"[
                    (k := 2 * int(draws.integers(26))) : k + 2
                ]
            else:
                other = texts[draws.integers(len(texts))]
                text[at:] = other[int(draws.integers(len(other))) :]
        try:
            plt.parse(bytes(text))
        except InputError:
            refused += 1
    assert 50 < refused < 480


SPACE, LINE = 1.5 * 0.19 * 400, 2.0 * 0.27 * 400  # [plotter units] of a letter of 1.9 x 2.7 mm
ROOT2 = 2.0**0.5


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("LBabcd#", (4 * SPACE, 0.0)),
        ("LB#", (0.0, 0.0)),
        # Carriage return along the line, line feed two heights down; one label goes on as another.
        ("LBabc\r\nde#", (2 * SPACE, -LINE)),
        ("LBabc\n#", (3 * SPACE, -LINE)),
        ("LBabc#LBde#LB\r\n#", (0.0, -LINE)),
        ("LBab\b#", (SPACE, 0.0)),
        ("LBab\tc#", (9 * SPACE, 0.0)),
        ("LB\x01\x0b\x0ea#", (SPACE, 0.0)),
        # CP: cells to the right and up, without numbers as CR and LF.
        ("CP3,-2;", (3 * SPACE, -2 * LINE)),
        ("LBabc#CP;", (0.0, -LINE)),
        ("LBabc#CP-1,1;LBx\r#", (0.0, LINE)),
        # Size in centimetres and in per cent of P1 .. P2.
        ("SI0.4,0.5;LBab\n#", (2 * 1.5 * 160, -2 * 200)),
        ("SI.4,.5;SI;LBab#", (2 * SPACE, 0.0)),
        ("IP0,0,8000,4000;SR1,2;LBab\n#", (2 * 1.5 * 80, -2 * 80)),
        ("SR2,2;IP0,0,8000,4000;SR;LBa#", (1.5 * 60, 0.0)),
        ("SI-0.19,0.27;LBab#", (-2 * SPACE, 0.0)),
        ("ES1,0.5;LBab\n#", (4 * SPACE, -1.5 * LINE)),
        # Direction by run and rise, in per cent of P1 .. P2, and turned with the sheet.
        ("DI1,1;LBab#", (2 * SPACE / ROOT2, 2 * SPACE / ROOT2)),
        ("DI1,1;LB\n#", (LINE / ROOT2, -LINE / ROOT2)),
        ("DI0,-2;LBab\r\n#", (-LINE, 0.0)),
        ("IP0,0,8000,4000;DR1,2;LBa#", (SPACE / ROOT2, SPACE / ROOT2)),
        ("RO90;LBab\n#", (LINE, 2 * SPACE)),
        ("DI0,1;DI;LBa#", (SPACE, 0.0)),
        # The path of the letters; a line feed is a quarter turn clockwise from it.
        ("DV1;LO3;LBabc\n#", (-SPACE, -3 * LINE)),
        ("DV2;LO7;LBab\n#", (-2 * SPACE, LINE)),
        ("DV3;LBab\n#", (SPACE, 2 * LINE)),
        ("DV1,1;LO6;LB\n#", (SPACE, 0.0)),
        # Label origins: behind a label another goes on, or the pen is where it was.
        ("LO2;LBab#", (2 * SPACE, 0.0)),
        ("LO5;LBab#", (0.0, 0.0)),
        ("DV2;LO9;LBab#", (-2 * SPACE, 0.0)),
        ("DV2;LO9;LBab#LO1;LBab#", (-2 * SPACE, 0.0)),
        # What moves the pen sets the point to which the carriage returns; DF takes all back.
        ("LBab#PR0,7;LBc\r#", (2 * SPACE, 7.0)),
        ("LBab#DI;LBc\r#", (2 * SPACE, 0.0)),
        ("SI1,1;DI1,1;DV1;ES1;DF;DT#;LBa#", (SPACE, 0.0)),
        ("PM0;PR9,9;LBabc#PM2;", (0.0, 0.0)),
    ],
)
def test_the_pen_stands_behind_a_label(text: str, place: tuple[float, float]) -> None:
    """HP's reference: cells of 1.5 widths and 2 heights, carriage return point, DV and LO."""
    (line,) = drawn(f"IN;DT#;{text}RO0;PR;PD30,40;")
    assert line == pytest.approx(np.add(place, [[0.0, 0.0], [30.0, 40.0]]), abs=1e-9)


def test_a_way_elsewhere_does_not_pass_the_end_of_a_label() -> None:
    found = plt.parse(b"IN;PU100,0;LBabc\x03PU0,500;PD10,510;LBx\x03PD20,510;").lines
    ways = [(p.down, np.round(p.points / 0.025, 4).tolist()) for p in found]
    end = [round(10.0 + SPACE, 4), 510.0]
    assert ways == [
        (False, [[0, 0], [100, 0], [0, 500]]),
        (True, [[0, 500], [10, 510]]),
        (False, [[10, 510], end]),
        (True, [end, [20, 510]]),
    ]


def test_letters_of_two_bytes_are_one() -> None:
    (line,) = drawn("LBäö\x03PR;PD1,0".encode())
    assert line[0] == pytest.approx([2 * SPACE, 0.0])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("SI1;", "column 1, byte 0: SI: 1 numbers, 0 or 2 wanted"),
        ("PU;DI0,0;", "column 4, byte 3: DI: 0, 0 is no direction"),
        ("DV4;", "DV: 4, 0: a path 0 to 3 and 0 or 1 wanted"),
        ("LO10;", "LO: 10: 1 to 9, 11 to 19 or 21 wanted"),
        ("ES1,2,3;", "ES: 3 numbers, 0 or 1 to 2 wanted"),
        ("CP1;", "CP: 1 numbers, 0 or 2 wanted"),
    ],
)
def test_wrong_letters_are_named(text: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        plt.parse(text.encode())
    assert told in str(caught.value)
