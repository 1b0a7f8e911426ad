"""The words of a line by letter, its codes by modal group."""

from second.parameters import Wrong

GROUPS = {
    "other": (40, 100, 280, 281, 300, 301, 520, 530, 920, 921, 922, 923),
    "motion": (
        *(0, 10, 20, 30, 50, 51, 52, 53, 331, 382, 383, 384, 385, 730, 740, 800),
        *(810, 820, 830, 840, 850, 860, 870, 880, 890),
    ),
    "plane": (170, 180, 190),
    "distance": (900, 910),
    "centre": (901, 911),
    "feed": (930, 940, 950),
    "units": (200, 210),
    "cutter": (400, 410, 411, 420, 421),
    "length": (430, 431, 432, 490),
    "return": (980, 990),
    "system": (540, 550, 560, 570, 580, 590, 591, 592, 593),
    "path": (610, 611, 640),
    "spindle mode": (960, 970),
    "polar": (150, 160),
    "scale": (500, 510),
    "turn": (680, 690),
}
M_GROUPS = {
    "stop": (0, 1, 2, 30, 60, 99),
    "io": (62, 63, 64, 65, 66, 67, 68),
    "change": (6, 61),
    "turning": (3, 4, 5, 19),
    "coolant": (7, 8, 9),
    "saving": (70, 71, 72, 73),
    "overrides": (48, 49, 50, 51, 52, 53),
    "call": (98,),
    "user": tuple(range(100, 200)),
}
G_GROUP = {code: group for group, codes in GROUPS.items() for code in codes}
M_GROUP = {code: group for group, codes in M_GROUPS.items() for code in codes}
# What only Fanuc's controls have.
FANUC_GROUP = {90: "exact", 670: "modal", 541: "system", 1540: "system"}
NEAR = 1e-4  # of a code


class Words:
    """What a line says; `use` takes letters as spoken for, `rest` says which are left."""

    def __init__(
        self, pairs: list[tuple[str, float]], angles: bool, whole: str = "", fanuc: bool = False
    ) -> None:
        self.fanuc = fanuc
        self.value: dict[str, float] = {}
        self.code: dict[str, int] = {}  # ten times the number of G; M as it is
        self.used: set[str] = set()
        self.whole_numbers = whole  # letters whose value is written without a point
        self.axes = "xyzabc" if angles else "xyzuvw"
        self.m_count = 0
        idle: set[str] = set()  # axes that the machine does not have
        for letter, value in pairs:
            if letter in "gm":
                self.add_code(letter, value)
            elif letter in self.value:
                raise Wrong(f"{letter} twice")
            elif letter in "abcuvw" and letter not in self.axes:
                if value != 0.0 or letter in idle:
                    raise Wrong(f"no {letter}")
                idle.add(letter)
            else:
                self.value[letter] = value

    def add_code(self, letter: str, value: float) -> None:
        number = value * 10.0 if letter == "g" else value
        code = round(number)
        group = (G_GROUP if letter == "g" else M_GROUP).get(code)
        if letter == "g" and self.fanuc:
            group = FANUC_GROUP.get(code, group)
        if group is None or abs(number - code) > NEAR * (10.0 if letter == "g" else 1.0):
            raise Wrong(f"{letter}{value:g}")
        self.m_count += letter == "m"
        # A motion word beside G80 counts.
        if group == "motion" and 800 in (code, self.code.get(group)) and group in self.code:
            code = max((code, self.code[group]), key=lambda c: c != 800)
        elif group in self.code or self.m_count > 4:
            raise Wrong(f"two codes of a group, {group}")
        self.code[group] = code

    def use(self, letters: str) -> dict[str, float]:
        """The words of these letters, which are then spoken for."""
        self.used.update(c for c in letters if c in self.value)
        return {c: self.value[c] for c in letters if c in self.value}

    def one(self, letter: str) -> float | None:
        return self.use(letter).get(letter)

    def whole(self, letter: str, least: int, most: int) -> int:
        """A whole number within bounds; `Wrong` without one."""
        value = self.one(letter)
        if value is None or abs(value - round(value)) > NEAR or not least <= round(value) <= most:
            raise Wrong(f"{letter}")
        return round(value)

    def has(self, letters: str) -> bool:
        return any(c in self.value for c in letters)

    def rest(self) -> set[str]:
        return set(self.value) - self.used
