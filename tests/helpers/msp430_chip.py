"""The document's interrupt routine on a processor that is ticked clock by clock; whole numbers."""

import re

GRAIN = 64  # phases are whole numbers of 1/GRAIN line period
LATENCY = 6
# Flag, pin whose level tells the direction, and which way a low level counts, in the order tested.
EDGES = (("04", "10", 1), ("08", "10", -1), ("10", "04", -1), ("20", "04", 1))
CLEARED = "          mov.b #00H,&P1IFG\n          reti\n"


def _routine() -> str:
    """The routine as the document does it: a chain of tests, one body for each way to count.

    Behind the chain the home input, which the document demands and does not list.
    """
    text = ""
    for k, (flag, pin, low) in enumerate(EDGES):
        last = k == len(EDGES) - 1
        text += f"Edge{k}     bit.b #{flag}H,&P1IFG\n"
        text += f"          jz    {'Home' if last else f'Edge{k + 1}'}\n"
        text += f"          bit.b #{pin}H,&P1IN\n"
        text += f"          jz    {'Up' if low > 0 else 'Down'}\n"
        # the last one runs into Down
        text += "" if last else f"          jmp   {'Down' if low > 0 else 'Up'}\n"
    for label, step in (("Down", "dec"), ("Up", "inc")):
        text += f"{label:10}{step}  wMCounter\n          {step}  wSt\n{CLEARED}"
    text += "Home      bit.b #01H,&P1IFG\n          jz    Leave\n"
    text += "          clr   wMCounter\n          bis.b #01H,fHome\n"
    return text + f"Leave     {CLEARED.lstrip()}"


LISTING = _routine()


def repaired(listing: str) -> str:
    """The flag that is served is cleared before the level is read, the others stay."""
    lines = [line for line in listing.splitlines() if "mov.b #00H,&P1IFG" not in line]
    text = "\n".join(lines) + "\n"
    text = text.replace("jz    Leave", "jz    Gone").rstrip()[: -len("reti")].rstrip()
    text += "\n          reti\nGone      reti\n"
    test = re.compile(r"(bit\.b (#\w+),&P1IFG\n\s+jz\s+\w+\n)")
    return test.sub(r"\1          bic.b \2,&P1IFG\n", text)


def assemble(listing: str) -> tuple[list[tuple[str, list[str]]], dict[str, int]]:
    """Instructions with operands, and the addresses of the labels."""
    code: list[tuple[str, list[str]]] = []
    labels = {}
    for line in listing.splitlines():
        if not line.strip():
            continue
        words = line.split()
        if line[0] != " ":
            labels[words.pop(0)] = len(code)
        code.append((words[0], words[1].split(",") if len(words) > 1 else []))
    return code, labels


def cycles(name: str, operands: list[str]) -> int:
    """Clocks of an instruction, MSP430x1xx family user's guide (SLAU049), 3.4.4."""
    if name in ("jz", "jmp"):
        return 2
    if name == "reti":
        return 5
    if name in ("inc", "dec", "clr"):  # add #1, sub #1, mov #0: from the constant generator
        return 4
    return 4 if int(operands[0][1:-1], 16) in (0, 1, 2, 4, 8) else 5


class Chip:
    """Pins, flags, counters and the processor."""

    def __init__(self, one: bool, timer: int, timer_cycles: int) -> None:
        self.code, self.labels = assemble(repaired(LISTING) if one else LISTING)
        self.timer, self.timer_cycles = timer, timer_cycles
        self.memory = {"P1IFG": 0, "wMCounter": 0, "wSt": 0, "fHome": 0}
        self.way: dict[int, int] = {}  # of the edge behind each flag
        self.taken = 0  # flag being served
        self.edges = self.lost = self.turned = self.passed = self.served = 0
        self.clock = 0
        self.running: str = ""
        self.left = self.at = 0
        self.timer_flag = self.zero = False
        self.quarter: int | None = None
        self.home = False

    def pins(self, quarter: int) -> None:
        """The scale's lines, through the inverters."""
        assert self.quarter is not None
        while self.quarter != quarter:
            before = self.quarter
            self.quarter += 1 if quarter > before else -1
            changed = self.lines(before) ^ self.lines(self.quarter)
            rises = bool(self.lines(self.quarter) & changed)
            flag = changed if rises else changed << 1
            self.passed += 1
            self.edges += self.quarter - before
            if self.memory["P1IFG"] & flag:
                self.lost += 1
            else:
                self.memory["P1IFG"] |= flag
                self.way[flag] = self.quarter - before

    @staticmethod
    def lines(quarter: int) -> int:
        """P1IN of A (04H) and B (10H): 74HC14 turns A = 1 1 0 0, B = 0 1 1 0 round."""
        return (0, 0, 4, 4)[quarter % 4] | (16, 0, 0, 16)[quarter % 4]

    def execute(self) -> None:
        """Do what an instruction does in its last clock."""
        name, operands = self.code[self.at]
        self.at += 1
        memory = self.memory
        if name == "bit.b":
            mask = int(operands[0][1:-1], 16)
            assert self.quarter is not None
            port = self.lines(self.quarter) if operands[1] == "&P1IN" else memory["P1IFG"]
            self.zero = not port & mask
            if operands[1] == "&P1IFG" and not self.zero:
                self.taken = mask
        elif name == "bic.b":
            memory["P1IFG"] &= ~int(operands[0][1:-1], 16)
        elif name == "mov.b":
            others = memory["P1IFG"] & ~self.taken & 0x3C
            self.lost += bin(others).count("1")
            memory["P1IFG"] = 0
        elif name in ("inc", "dec"):
            step = 1 if name == "inc" else -1
            memory[operands[0]] = (memory[operands[0]] + step) % 65536
            if operands[0] == "wMCounter":
                self.served += 1
                self.turned += step != self.true_way
        elif name == "clr":
            memory["wMCounter"] = 0
        elif name == "jmp" or (name == "jz" and self.zero):
            self.at = self.labels[operands[0]]
        elif name == "reti":
            self.running = ""
        if name == "bit.b" and operands[1] == "&P1IFG" and not self.zero:
            self.true_way = self.way.get(self.taken, 0)

    def accept(self) -> None:
        """A free processor takes the timer's interrupt before the port's."""
        if self.running:
            return
        if self.timer_flag:
            self.timer_flag, self.running = False, "timer"
            self.left = LATENCY + self.timer_cycles
        elif self.memory["P1IFG"]:
            self.running, self.at, self.taken = "port", 0, 0
            self.left = LATENCY + cycles(*self.code[0])

    def tick(self, quarter: int) -> None:
        """One clock: pins, timer, processor."""
        self.clock += 1
        self.pins(quarter)
        if self.clock % self.timer == 0:
            self.timer_flag = True
        if self.running:
            self.left -= 1
            if self.left == 0 and self.running == "timer":
                self.running = ""
            elif self.left == 0:
                self.execute()
                if self.running:
                    self.left = cycles(*self.code[self.at])
        self.accept()

    def sample(self, before: int, now: int, clocks: int, home: bool) -> None:
        """Clocks in which the phase goes from one value to another, in 1/GRAIN line period."""
        if self.quarter is None:
            self.quarter = (4 * now) // GRAIN
        else:
            for k in range(1, clocks + 1):
                self.tick(4 * (before * clocks + (now - before) * k) // (GRAIN * clocks))
            if home and not self.home:
                self.memory["P1IFG"] |= 1
        self.accept()
        self.home = home
