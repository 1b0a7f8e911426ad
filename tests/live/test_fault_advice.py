"""What to do about a fault: files that are right and wrong."""

from collections.abc import Iterator
from functools import partial

import pytest

from motionfmu.base.errors import InputError
from motionfmu.scenarios import fault_advice
from motionfmu.scenarios.fault_advice import advice


@pytest.fixture(autouse=True)
def _read_anew() -> Iterator[None]:
    yield
    fault_advice._tables.cache_clear()
    advice.cache_clear()


def carried(files: dict[str, str], name: str, file: str) -> str | None:
    assert file == "advice.toml"
    return files.get(name)


def use(monkeypatch: pytest.MonkeyPatch, **files: str) -> None:
    fault_advice._tables.cache_clear()
    advice.cache_clear()
    monkeypatch.setattr(fault_advice.fmus, "extra", partial(carried, files))


def test_a_span_and_another_output_give_their_texts(monkeypatch: pytest.MonkeyPatch) -> None:
    use(
        monkeypatch,
        network_card='[error]\nas = "result"\n7 = "Own."\n[result]\n"7..12" = "Wait."',
        card_host='[card_error]\nas = "network_card.error"',
    )
    assert advice("network_card")["result"] == dict.fromkeys(range(7, 13), "Wait.")
    # Only numbers that the output can tell.
    own = {7: "Own.", **dict.fromkeys((9, 10, 11), "Wait.")}
    assert advice("network_card")["error"] == own
    assert advice("card_host")["card_error"] == {**dict.fromkeys(range(8, 13), "Wait."), 7: "Own."}
    assert advice("scope") == {}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[result]\n99 = "x"', r"card_host/advice\.toml: card_host has no result with a meaning"),
        ('[fault]\n99 = "x"', r"card_host has no fault with a meaning of 99"),
        ('[fault]\nseven = "x"', "seven: neither a number nor a span"),
        ("[fault]\n7 = 7", "valid string"),
        ('[fault]\nas = "code"', r"advice\.toml: no advice on card_host\.code"),
        ('[fault]\nas = "fault"', r"card_host\.fault names itself"),
        ("[fault", r"fmus/card_host/advice\.toml"),
    ],
)
def test_a_wrong_file_is_refused(monkeypatch: pytest.MonkeyPatch, text: str, said: str) -> None:
    use(monkeypatch, card_host=text)
    with pytest.raises(InputError, match=said):
        advice("card_host")
