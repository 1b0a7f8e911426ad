"""What can be asked of a live machine: each request with its arguments, in one table.

A page asks by WebSocket, a program also by HTTP; the table is what checks them and what
/openapi.json shows.
"""

import json
import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, WithJsonSchema

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.strange_json import strange_json
from motionfmu.base.toml_lines import shown
from motionfmu.live.pace import QUICKEST, SLOWEST
from motionfmu.live.scope_trigger import LONGEST, Kind, Mode

# Bounds of what a page may send; a step is a whole number of 64 bits.
_LARGEST = 2**63 - 1
_NAMES = 4096
Name = Annotated[str, Field(max_length=256)]
Names = Annotated[list[Name], Field(max_length=_NAMES)]
Whole = Annotated[int, Field(ge=-_LARGEST, le=_LARGEST)]
Number = Annotated[float, Field(allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Text = Annotated[str, Field(max_length=4096)]


def _single(value: Any) -> Any:
    """A value of one element."""
    if isinstance(value, str) and len(value) <= 4096:
        return value
    if isinstance(value, int) and abs(value) <= _LARGEST:
        return value
    if isinstance(value, float) and math.isfinite(value):
        return value
    raise ValueError("a finite number, true, false or a text")


def _value(value: Any) -> Any:
    """A value of all elements, or a list of them."""
    if not isinstance(value, list):
        return _single(value)
    if len(value) > _NAMES:
        raise ValueError(f"{_NAMES} elements at most")
    return [_single(x) for x in value]


_SINGLE = {"type": ["boolean", "number", "string"]}
_SEVERAL = {"type": "array", "items": _SINGLE, "maxItems": _NAMES}
Single = Annotated[Any, AfterValidator(_single), WithJsonSchema(_SINGLE)]
Value = Annotated[Any, AfterValidator(_value), WithJsonSchema({"anyOf": [_SINGLE, _SEVERAL]})]
Step = Annotated[int, Field(ge=0, le=_LARGEST)]
Path = Annotated[str, Field(min_length=1, max_length=1024)]


class Request(BaseModel):
    """A request: its docstring is what the documentation says, its fields are the arguments."""

    model_config = ConfigDict(extra="forbid", strict=True, defer_build=True)
    hand: ClassVar[bool] = True  # whether one must have the machine in hand
    server: ClassVar[bool] = False  # whether the server itself answers
    socket: ClassVar[bool] = False  # whether it is for a WebSocket only
    gives: ClassVar[str] = "null"  # what the value of the answer is

    @classmethod
    def word(cls) -> str:
        """The request's name."""
        return cls.__name__.removeprefix("Ask").lower()


class AskSet(Request):
    """Give an input or a tunable parameter a value from the next communication step on."""

    gives: ClassVar[str] = "time from which it acts [s]"
    name: Name = Field(description="component.variable, or component.variable[i], i from 1")
    value: Value = Field(description="one value for all elements, or a list")


class AskUndo(Request):
    """Give a variable the value that it had when the machine began."""

    gives: ClassVar[str] = "time from which it acts [s]"
    name: Name


class AskPress(Request):
    """Press a key for 10 ms of simulated time, or as long as its panel says."""

    gives: ClassVar[str] = "time from which it acts [s]"
    name: Name
    value: Single = True
    rest: Single = False


class AskHold(Request):
    """Hold a key: it goes to rest unless this is asked again within 0.1 s on the wall."""

    gives: ClassVar[str] = "time from which it acts [s]"
    name: Name
    value: Single
    rest: Single = 0


class AskJog(Request):
    """Move an axis by hand: it stops unless this is asked again within 0.1 s on the wall."""

    gives: ClassVar[str] = "time from which it acts [s]"
    component: Name
    axis: Step = Field(description="from 1")
    direction: Number = Field(description="-1, 0, 1, or a share of the speed; 0 lets go")


class AskRelease(Request):
    """Let go whatever is held."""


class AskMdi(Request):
    """Give a controller a line of a program to run, behind those given before."""

    gives: ClassVar[str] = '{"number": of the line, which the controller tells as taken}'
    line: Text
    component: Name | None = Field(None, description="none: the only one that takes lines")


class AskCommand(Request):
    """Give a command that the component's panel has."""

    gives: ClassVar[str] = "time from which it acts [s]"
    component: Name
    name: Name = Field(description="its name in the panel")


class AskStop(Request):
    """Press the machine's emergency stop, or abort where there is none; anybody may."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "names of what was set"


class AskPace(Request):
    """Go at another pace."""

    factor: Number | None = Field(
        description=f"simulated seconds for each on the wall, {SLOWEST:g} to {QUICKEST:g}; "
        "null: as fast as it goes"
    )


class AskGo(Request):
    """Go on behind a pause."""


class AskPause(Request):
    """Let simulated time stand."""


class AskStep(Request):
    """Make communication steps while the machine stands; answers when they are made."""

    gives: ClassVar[str] = "time [s]"
    count: Step = 1


class AskBack(Request):
    """Go back to the latest state that was kept at a time or before, and stand there."""

    gives: ClassVar[str] = "time of that state [s]"
    time: Number = Field(description="[s]")


class AskKept(Request):
    """Tell the states that one can go back to."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "their times [s]"


class AskLateness(Request):
    """Tell how late the machine was woken since it began."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = (
        "wake-ups by the end of their class [s], the last open; and the worst [s]"
    )


class AskSave(Request):
    """Write what was done as a scenario."""

    gives: ClassVar[str] = "path of the scenario.toml"
    folder: Path = Field(description="not there yet")
    check: dict[Name, Any] | None = Field(None, description="the scenario's [check]")
    begin: float | None = Field(
        None,
        description="the scenario begins in the latest state kept from then [s] or before, else at"
        " the beginning",
    )
    ends: dict[Name, NotNegative] | None = Field(
        None,
        description="signals that must end as they are now: by how much a real number may differ",
    )


class AskChecks(Request):
    """Give figures of which checks are made."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "values at present, least and largest ones in the scope, time [s]"
    names: Names = []


class AskValues(Request):
    """Give present values of whole signals."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "lists by name"
    names: Names


class AskChanged(Request):
    """Tell what has another value than when the machine began."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "by name, the values at the beginning and at present"


class AskJournal(Request):
    """Tell the latest actions."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "a list of time [s], name, values"
    last: Annotated[int, Field(ge=0, le=100_000)] = 40


class AskChannels(Request):
    """Choose the channels of the scope."""

    names: Annotated[list[Name], Field(max_length=_NAMES)]


class AskTrigger(Request):
    """Wait for an event in a channel of the scope; without a channel, for none."""

    channel: Name | None = None
    kind: Kind = "rise"
    level: Number = 0.0
    high: Number = Field(0.0, description="upper end of a window")
    pre: Annotated[float, Field(ge=0.0, le=1.0)] = Field(0.5, description="share before the event")
    length: Annotated[int, Field(ge=2, le=LONGEST)] = Field(4096, description="steps")
    mode: Mode = "single"


class AskRecordings(Request):
    """Tell the latest triggered recordings."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "a list of begin, at, rows, channels, step [s]"


class AskRecording(Request):
    """Give a triggered recording again: a message, then a binary one."""

    hand: ClassVar[bool] = False
    server: ClassVar[bool] = True
    socket: ClassVar[bool] = True
    number: Whole = Field(-1, description="its place in the list of recordings")


class AskRecord(Request):
    """Write the scope's channels into a file; without one, end it: answers when it is whole."""

    gives: ClassVar[str] = "the first step of the record, or the files"
    file: Path | None = Field(None, description=".csv or .npz, not there yet")
    begin: Step | None = Field(None, description="step; none: the present one")
    end: Step | None = Field(None, description="step before which it ends; none: when told")


class AskFrame(Request):
    """Give the present state and values of signals, once."""

    hand: ClassVar[bool] = False
    gives: ClassVar[str] = "as a WebSocket gets it 60 times a second"
    names: Names = []


class AskWatch(Request):
    """Get frames with these signals 60 times a second; null: no frames."""

    hand: ClassVar[bool] = False
    server: ClassVar[bool] = True
    socket: ClassVar[bool] = True
    names: Names | None


class AskSamples(Request):
    """Get the samples of the scope's channels from a step on as they come; null: none."""

    hand: ClassVar[bool] = False
    server: ClassVar[bool] = True
    socket: ClassVar[bool] = True
    since: Step | None = None


class AskName(Request):
    """Say who one is: those who watch see who has the machine in hand."""

    hand: ClassVar[bool] = False
    server: ClassVar[bool] = True
    socket: ClassVar[bool] = True
    name: Annotated[str, Field(max_length=64)]


class AskTake(Request):
    """Take the machine in hand, from whoever has it; what he held is let go."""

    hand: ClassVar[bool] = False
    server: ClassVar[bool] = True
    gives: ClassVar[str] = '{"hand": by HTTP the key for the header Motionfmu-Hand, else null}'


class AskDrop(Request):
    """Give the machine out of hand."""

    hand: ClassVar[bool] = False
    server: ClassVar[bool] = True


REQUESTS = {kind.word(): kind for kind in Request.__subclasses__()}


@dataclass(frozen=True)
class CheckedRequest:
    """A request that is known, with arguments that are right in themselves."""

    name: str
    kind: type[Request]
    arguments: dict[str, Any]


def checked(name: Any, arguments: Any) -> CheckedRequest:
    """What is asked; an InputError says what is wrong with it."""
    if not isinstance(name, str) or name not in REQUESTS:
        raise InputError(f"{shown(name)[:80]}: no such request{suggestion(str(name), REQUESTS)}")
    if not isinstance(arguments, dict):
        raise InputError(f"{name}: arguments are a JSON object")
    kind = REQUESTS[name]
    try:
        given = kind.model_validate(arguments)
    except ValidationError as error:
        raise InputError(f"{name}: {_told(error, kind)}") from None
    return CheckedRequest(name, kind, given.model_dump(exclude_unset=True))


def parsed(text: str | bytes) -> Any:
    """A JSON text; an InputError if it is none, or is nested too deeply."""
    try:
        return strange_json(text)
    except ValueError:
        raise InputError("no JSON") from None


def _told(error: ValidationError, kind: type[Request]) -> str:
    """The first thing that is wrong."""
    first = error.errors(include_url=False)[0]
    name = str(first["loc"][0]) if first["loc"] else ""
    if first["type"] == "missing":
        return f"{name} is missing"
    if first["type"] == "extra_forbidden":
        return f"there is no argument {name[:80]}{suggestion(name, kind.model_fields)}"
    what = first["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
    return f"{name} = {_short(first['input'])}: {what} wanted"


def _short(value: Any) -> str:
    try:
        text = json.dumps(value)
    except ValueError:  # a number of more digits than Python writes
        return "such a number"
    return text if len(text) <= 60 else f"{text[:57]}..."


def openapi(version: str) -> dict[str, Any]:
    """The table as an OpenAPI document."""
    schemas = {name: kind.model_json_schema() for name, kind in REQUESTS.items()}
    by_http = {n: k for n, k in REQUESTS.items() if not k.socket}
    about = (
        "Requests of a live machine. By WebSocket (/live): the first message is the token, then "
        '{"id": any, "do": name, "with": {arguments}}; the answer is {"id", "value"} or '
        '{"id", "error"}. By HTTP: POST /do/NAME with the arguments. x-websocket has the '
        "requests that only a WebSocket takes."
    )
    return {
        "openapi": "3.1.0",
        "info": {"title": "motionfmu live", "version": version, "description": about},
        "paths": {f"/do/{name}": {"post": _operation(k)} for name, k in by_http.items()}
        | {"/samples.csv": {"get": _SAMPLES}},
        "components": {
            "schemas": {n: _plain(schemas[n]) for n in by_http},
            "securitySchemes": {"token": {"type": "http", "scheme": "bearer"}},
        },
        "security": [{"token": []}],
        "x-websocket": {
            name: {"description": kind.__doc__, "with": _plain(schemas[name])}
            for name, kind in REQUESTS.items()
            if kind.socket
        },
    }


def _plain(schema: dict[str, Any]) -> dict[str, Any]:
    return {k: v for k, v in schema.items() if k not in ("title", "description")}


def _operation(kind: type[Request]) -> dict[str, Any]:
    word = kind.word()
    json_of = {"schema": {"$ref": f"#/components/schemas/{word}"}}
    answer = {"type": "object", "properties": {"value": {"description": kind.gives}}}
    error = {"type": "object", "properties": {"error": {"type": "string"}}}
    key = {
        "name": "Motionfmu-Hand",
        "in": "header",
        "required": False,
        "description": "what take gave",
        "schema": {"type": "string"},
    }
    return {
        "operationId": word,
        "description": kind.__doc__,
        "parameters": [key] if kind.hand or word in ("take", "drop") else [],
        "requestBody": {"content": {"application/json": json_of}},
        "responses": {
            "200": {"description": kind.gives, "content": {"application/json": {"schema": answer}}},
            "403": {"description": "the token is wrong, or another page asks"},
            "422": {
                "description": "the machine does not do it",
                "content": {"application/json": {"schema": error}},
            },
        },
    }


def _step(name: str) -> dict[str, Any]:
    return {"name": name, "in": "query", "schema": {"type": "integer", "minimum": 0}}


_SAMPLES = {
    "operationId": "samples.csv",
    "description": "The samples of the scope's channels, all that there are or between two steps.",
    "parameters": [_step("begin"), _step("end")],
    "responses": {"200": {"description": "a record", "content": {"text/csv": {}}}},
}
