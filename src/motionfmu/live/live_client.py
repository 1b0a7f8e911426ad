"""A program that works a live machine: an operator's script is a test."""

import json
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any
from urllib.parse import parse_qs, urlsplit

import numpy as np

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.extras import needed

_SIGN = 0.04  # [s] between two signs of who holds a key
_LOOK = 0.01  # [s] between two looks at what is waited for
_PATIENCE = 60.0  # [s] for an answer


class LiveClient:
    """A live machine that another process runs.

    Parameters
    ----------
    url : str
        The address of its page, with the token: ``http://127.0.0.1:8770/?token=...``.
    name : str
        Who has the machine in hand, for those who watch.

    Attributes
    ----------
    about : dict
        The machine: its components with their variables and panels, axes, signals, program.

    Raises
    ------
    InputError
        There is no such machine, or the token is wrong.
    """

    def __init__(self, url: str, name: str = "a program") -> None:
        needed("live")
        from websockets.exceptions import WebSocketException
        from websockets.sync.client import connect

        parts = urlsplit(url)
        token = parse_qs(parts.query).get("token", [""])[0]
        if parts.scheme not in ("http", "ws") or not parts.hostname or not token:
            raise InputError(f"{url}: the address that motionfmu live prints is wanted")
        self._number, self._failed = 0, WebSocketException
        try:
            opening = connect(
                f"ws://{parts.netloc}/live", max_size=None, compression=None, proxy=None
            )
            self._socket = opening.__enter__()  # before websockets 17 it was open already
            self._socket.send(token)
            self.about: dict[str, Any] = json.loads(self._socket.recv(_PATIENCE))["about"]
        except (OSError, WebSocketException) as error:
            raise InputError(f"{parts.netloc}: no live machine answers: {error}") from None
        self.ask("watch", names=None)
        self.ask("name", name=name)

    def ask(self, request: str, /, **arguments: Any) -> Any:
        """Ask for anything that the machine's /openapi.json lists.

        Parameters
        ----------
        request : str
            Its name.
        **arguments
            As they are listed.

        Returns
        -------
        object
            The value of the answer.

        Raises
        ------
        InputError
            The machine does not do it, or has ended.
        """
        self._number += 1
        given = {"id": self._number, "do": request, "with": arguments}
        try:
            self._socket.send(json.dumps(given))
            while True:
                got = self._socket.recv()
                answer = json.loads(got) if isinstance(got, str) else {}
                if answer.get("id") == self._number:
                    break
        except (OSError, self._failed) as error:
            raise InputError(f"{request}: the machine has gone: {error}") from None
        if "error" in answer:
            raise InputError(answer["error"])
        return answer["value"]

    def take(self) -> None:
        """Take the machine in hand, from whoever has it."""
        self.ask("take")

    def drop(self) -> None:
        """Give the machine out of hand."""
        self.ask("drop")

    def __getitem__(self, name: str) -> Any:
        """The present value of a signal: a number, or an array; ``name[i]`` of one element."""
        whole, bracket, rest = name.partition("[")
        values = self.ask("values", names=[whole])[whole]
        if not bracket:
            return values[0] if len(values) == 1 else np.array(values)
        index = rest.removesuffix("]")
        if not (index.isascii() and index.isdigit() and 1 <= int(index[:9]) <= len(values)):
            raise InputError(f"{name}: {whole} has the elements 1 to {len(values)}")
        return values[int(index) - 1]

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return float(self.ask("frame")["time"])

    def set(self, name: str, value: Any) -> float:
        """Give an input or a tunable parameter a value.

        Parameters
        ----------
        name : str
            ``component.variable``, or ``component.variable[i]``.
        value : number, bool, str, list or array
            One for all elements, or one for each.

        Returns
        -------
        float
            Time from which it acts [s].
        """
        plain = value.tolist() if hasattr(value, "tolist") else value
        return float(self.ask("set", name=name, value=plain))

    def press(self, name: str) -> float:
        """Press a key for 10 ms of simulated time, or its panel's.

        Parameters
        ----------
        name : str
            ``component.variable`` of an input that is true or false.

        Returns
        -------
        float
            Time from which it acts [s].
        """
        return float(self.ask("press", name=name))

    def jog(
        self,
        axis: int | str,
        direction: float,
        seconds: float,
        component: str | None = None,
    ) -> float:
        """Move an axis by hand.

        Parameters
        ----------
        axis : int or str
            Number from 1, or the name of an axis of the machine.
        direction : float
            -1 or 1, or a share of the speed where the controller has such.
        seconds : float
            For so long the key is held [s], simulated.
        component : str, optional
            The controller; the only one that can be moved by hand if not given.

        Returns
        -------
        float
            Time at which it was let go [s].
        """
        given = {
            "component": component or self._component("jog"),
            "axis": self._row(axis),
        }
        begun = float(self.ask("jog", direction=direction, **given))
        while (left := begun + seconds - self.time) > 0.0:
            pace = self.ask("frame")["pace"]
            time.sleep(min(_SIGN, left / pace) if pace else 0.0)
            self.ask("jog", direction=direction, **given)
        return float(self.ask("jog", direction=0, **given))

    def mdi(self, line: str, component: str | None = None) -> int:
        """Give a controller a line to run, behind those before.

        Parameters
        ----------
        line : str
        component : str, optional
            The controller; the only one that takes lines if not given.

        Returns
        -------
        int
            Number of the line.
        """
        return int(self.ask("mdi", line=line, component=component)["number"])

    def wait(self, name: str, value: Any, seconds: float = 60.0) -> float:
        """Wait until a signal has a value.

        Parameters
        ----------
        name : str
            A signal, or an element of it.
        value : number or bool
        seconds : float
            The longest wait [s], simulated.

        Returns
        -------
        float
            Time at which it was seen [s].

        Raises
        ------
        InputError
            It has not come, or the machine stands.
        """
        return self._until(lambda: self[name] == value, f"{name} = {value}", seconds)

    def wait_idle(self, component: str | None = None, seconds: float = 600.0) -> float:
        """Wait until every line given by `mdi` has been run.

        Parameters
        ----------
        component : str, optional
            As of `mdi`.
        seconds : float
            The longest wait [s], simulated.

        Returns
        -------
        float
            Time at which it was seen [s].

        Raises
        ------
        InputError
            A line was refused, the machine stands, or it takes longer.
        """
        component = component or self._component("mdi")
        mdi = self.about["components"][component]["panel"]["mdi"]
        keys = ("number", "taken", "lines", "done", "refused")
        names = {key: f"{component}.{mdi[key]}" for key in keys if key in mdi}
        refused = self._values(names).get("refused", 0)

        def idle() -> bool:
            now = self._values(names)
            if now.get("refused", refused) != refused:
                raise InputError(f"{component}: line {now['refused']} of mdi was refused")
            waits = self.ask("frame")["lines"]
            read = now["number"] == now["taken"] and not waits
            return bool(read and now.get("lines", 0) <= now.get("done", 0))

        return self._until(idle, f"{component}: the lines of mdi", seconds)

    def _values(self, names: Mapping[str, str]) -> dict[str, Any]:
        values = self.ask("values", names=list(names.values()))
        return {key: values[name][0] for key, name in names.items()}

    def _until(self, there: Any, what: str, seconds: float) -> float:
        begun = self.time
        while not there():
            frame = self.ask("frame")
            if not frame["running"]:
                raise InputError(f"{what}: the machine stands. {frame['error']}".rstrip(". "))
            if frame["time"] - begun > seconds:
                raise InputError(f"{what}: has not come within {seconds:g} s")
            time.sleep(_LOOK)
        return self.time

    def pace(self, factor: float | None) -> None:
        """Go at another pace.

        Parameters
        ----------
        factor : float, optional
            Simulated seconds for each on the wall; None or infinite: as fast as it goes.
        """
        self.ask("pace", factor=None if factor in (None, float("inf")) else factor)

    def go(self) -> None:
        """Go on behind a pause."""
        self.ask("go")

    def pause(self) -> None:
        """Let simulated time stand."""
        self.ask("pause")

    def step(self, count: int = 1) -> float:
        """Make communication steps while the machine stands.

        Parameters
        ----------
        count : int

        Returns
        -------
        float
            Time behind them [s].
        """
        return float(self.ask("step", count=count))

    def stop(self) -> list[str]:
        """Press the emergency stop, or abort where there is none.

        Returns
        -------
        list of str
            What was set.
        """
        return list(self.ask("stop"))

    def back(self, time: float) -> float:
        """Go back to a state that was kept, and stand there.

        Parameters
        ----------
        time : float
            The latest at or before it is taken [s].

        Returns
        -------
        float
            Time of the state [s].
        """
        return float(self.ask("back", time=time))

    def channels(self, names: Iterable[str]) -> None:
        """Choose the channels of the scope.

        Parameters
        ----------
        names : iterable of str
            Scalars, or elements of arrays.
        """
        self.ask("channels", names=list(names))

    def record(self, file: str | Path) -> int:
        """Write the channels into a file from now on.

        Parameters
        ----------
        file : str or Path
            ``.csv`` or ``.npz``; not there yet.

        Returns
        -------
        int
            Its first communication step.
        """
        return int(self.ask("record", file=str(Path(file).absolute())))

    def end_record(self) -> list[str]:
        """End all records in files.

        Returns
        -------
        list of str
            The files, which are whole.
        """
        return list(self.ask("record"))

    def save(
        self,
        folder: str | Path,
        check: Mapping[str, Any] | None = None,
        begin: float | None = None,
        ends: Mapping[str, float] | None = None,
    ) -> Path:
        """Write what was done as a scenario.

        Parameters
        ----------
        folder : str or Path
        check : mapping, optional
        begin : float, optional
        ends : mapping, optional
            All as of `LiveMachine.save`.

        Returns
        -------
        Path
            The scenario.toml.
        """
        given: dict[str, Any] = {} if check is None else {"check": dict(check)}
        given |= {} if begin is None else {"begin": begin}
        given |= {} if ends is None else {"ends": dict(ends)}
        return Path(self.ask("save", folder=str(Path(folder).absolute()), **given))

    def _component(self, table: str) -> str:
        """The only component whose panel has a table."""
        panels = {name: c["panel"] or {} for name, c in self.about["components"].items()}
        found = [name for name, panel in panels.items() if panel.get(table)]
        if len(found) != 1:
            told = ", ".join(found) or "none"
            raise InputError(f"{table}: a component is wanted; those that have it: {told}")
        return found[0]

    def _row(self, axis: int | str) -> int:
        if isinstance(axis, int):
            return axis
        axes = self.about["axes"]
        for place, known in enumerate(axes, 1):
            if known["name"] == axis:
                return int(known["row"] or place)
        told = suggestion(axis, [a["name"] for a in axes])
        raise InputError(f"{axis}: the machine has no such axis{told}")

    def close(self) -> None:
        """Let go whatever is held, and leave the machine alone."""
        self._socket.close()

    def __enter__(self) -> "LiveClient":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<LiveClient of {self.about['name']}>"


def connect(url: str, name: str = "a program") -> LiveClient:
    """Work a live machine that another process runs.

    Parameters
    ----------
    url : str
        The address that ``motionfmu live`` prints, with its token.
    name : str
        Who has the machine in hand, for those who watch.

    Returns
    -------
    LiveClient
        It has the machine in hand if nobody else has; else `LiveClient.take` takes it.

    Raises
    ------
    InputError
        There is no such machine, or the token is wrong.
    """
    return LiveClient(url, name)
