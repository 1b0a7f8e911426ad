"""What was found for the last few keys is not looked for again."""

from motionfmu.base.memo import Memo


def test_the_key_used_least_recently_is_forgotten_first() -> None:
    made: list[str] = []

    def ask(key: str) -> str:
        return known(key, lambda: made.append(key) or key.upper())

    known: Memo[str] = Memo(2)
    assert [ask(k) for k in "abab"] == ["A", "B", "A", "B"] and made == ["a", "b"]
    assert ask("a") == "A" and ask("c") == "C"  # b goes
    assert "a" in known and "b" not in known
    assert ask("a") == "A" and made == ["a", "b", "c"]
    assert ask("b") == "B" and made == ["a", "b", "c", "b"]
