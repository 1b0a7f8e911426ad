"""Random numbers and expressions of part programs."""

import random

FUNCTIONS = ("abs", "cos", "fix", "fup", "round", "sin", "exists", "sqrt", "acos", "atan", "tan")


class Values:
    """Writes values; `names` are the named parameters that have one."""

    def __init__(self, seed: int, expressions: bool) -> None:
        self.r = random.Random(seed)
        self.expressions = expressions
        self.names = ["_global"]

    def number(self, low: float = -20.0, high: float = 20.0) -> str:
        """A literal."""
        if self.r.random() < 0.05:  # in full, as programs print what they have computed
            return f"{self.r.uniform(low, high):.{self.r.randint(15, 60)}f}"
        digits = self.r.choice((0, 1, 2, 3, 4) if high - low > 1.0 else (3, 4))
        text = f"{self.r.uniform(low, high):.{digits}f}"
        return text + "." if digits == 0 and self.r.random() < 0.5 else text

    def tree(self, depth: int) -> str:
        """What may stand between brackets."""
        one = self.leaf() if depth == 0 else self.deep(depth - 1)
        if self.r.random() < 0.3:
            return one
        other = self.leaf() if depth == 0 else self.deep(depth - 1)
        operator = self.r.choice(("+", "-", "*", "+", "-", "mod", "/", "and", "or", "xor"))
        if operator == "mod" or operator == "/":
            other = self.number(1.0, 9.0)
        if self.r.random() < 0.1:
            operator = self.r.choice(("eq", "ne", "gt", "ge", "lt", "le"))
        if self.r.random() < 0.1:
            one, operator, other = f"abs[{one}]", "**", self.r.choice(("2", "0.5", "1", "3"))
        return f"{one} {operator} {other}"

    def leaf(self) -> str:
        if not self.expressions or self.r.random() < 0.6:
            return self.number()
        if self.r.random() < 0.6:
            return f"#{self.r.randint(1, 40)}"
        return f"#<{self.r.choice(self.names)}>"

    def deep(self, depth: int) -> str:
        kind = self.r.random()
        if kind < 0.5:
            return f"[{self.tree(depth)}]"
        if kind < 0.6:
            return f"-[{self.tree(depth)}]"
        if kind < 0.7:
            return self.leaf()
        name = self.r.choice(FUNCTIONS)
        if name == "exists":
            return f"exists[#<{self.r.choice(('never', *self.names))}>]"
        if name == "sqrt":
            return f"sqrt[abs[{self.tree(depth)}]]"
        if name == "acos":
            return f"acos[cos[{self.tree(depth)}]]"
        if name == "atan":
            return f"atan[{self.tree(depth)}]/[{self.tree(depth)}]"
        if name == "tan":
            return f"tan[{self.number(-60.0, 60.0)}]"
        return f"{name}[{self.tree(depth)}]"

    def value(self, low: float = -20.0, high: float = 20.0) -> str:
        """A number of a word: a literal, or an expression brought between the bounds."""
        if not self.expressions or self.r.random() < 0.7:
            return self.number(low, high)
        span = high - low
        if self.r.random() < 0.3:
            return f"[{self.number(low, low + span / 2)} + {self.number(0.0, span / 2)}]"
        inner = self.tree(self.r.randint(0, 2))
        return f"[{low:g} + [[{inner}] mod {span:g}]]"
