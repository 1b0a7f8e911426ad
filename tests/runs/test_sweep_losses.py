"""Studies whose runs diverge, whose workers are killed or that lose a cluster: others are whole."""

import os
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from conftest import ROOT

from motionfmu.study import cluster, worker
from motionfmu.sweep import Outcome, Study, Ways, conduct, study

THEORY, CIRCLE = ROOT / "scenarios/circle_theory", ROOT / "scenarios/circle"
GAIN, FORCE = "mcc.p_gain", "machine.force[2]"
RESULTS = ["card.err_count.absmax", "machine.table_position[1].final"]
PUSHED = ["card.err_count.absmax", "machine.table_position[2].final"]
DEADLY = 300  # run that ends its process
# A LocalCluster gives up a worker that is not back after 15 s, which a busy machine may need.
PATIENT = {"distributed.deploy.lost-worker-timeout": "600s"}


def gains(n: int = 48, least: int = 101) -> Study:
    """Runs of 30 ms."""
    axis = {GAIN: {"from": least, "to": least + n - 1, "n": n}}
    return study(THEORY, {"stop": 0.03, "results": RESULTS, "axis": axis})


def table(outcome: Outcome) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = pq.read_table(outcome.folder / "sweep.parquet").to_pylist()
    return rows


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    return table(conduct(gains(), tmp_path_factory.mktemp("whole") / "s", Ways(workers=1)))


@pytest.fixture
def workers() -> Iterator[Any]:
    distributed, dask = pytest.importorskip("distributed"), pytest.importorskip("dask")
    given: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with dask.config.set(PATIENT), distributed.LocalCluster(host="127.0.0.1", **given) as made:
        yield made


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_lane_that_diverges_is_a_row_with_its_message(tmp_path: Path) -> None:
    """A force of 1.7e308 makes a light table's state no number in the first step."""
    light = {"machine.table_mass[2]": 0.9, "machine.screw_stiffness[2]": 1e6}
    light |= {f"machine.table_{kind}[2]": 0.0 for kind in ("coulomb", "static", "viscous")}
    light |= {"machine.screw_damping[2]": 10.0}
    demo = tmp_path / "demo"
    shutil.copytree(CIRCLE, demo, ignore=shutil.ignore_patterns("sweep.toml"))
    forces = [0.0, 1.0, 1.7e308, 2.0, 3.0, -1.7e308, 4.0, 5.0, 6.0]

    def found(values: list[float], folder: str) -> list[dict[str, Any]]:
        given = {"axis": {FORCE: values}, "results": PUSHED, "cost": PUSHED[0]}
        given |= {"stop": 0.3, "set": light}
        return table(conduct(study(demo, given), tmp_path / folder, Ways(workers=1)))

    rows = found(forces, "all")
    assert [row["status"] for row in rows] == [
        "ok" if abs(force) < 10 else "error" for force in forces
    ]
    for row in (rows[2], rows[5]):
        assert "machine: axis 2: rotor.angle is nan at 0.0001" in row["message"]
        assert [row[name] for name in PUSHED] == [None, None] and row["checks"] is None
    good = [row for row in rows if row["status"] == "ok"]
    assert len({row[PUSHED[1]] for row in good}) == len(good), (
        "rows that do not differ show no mixing"
    )
    others = found([force for force in forces if abs(force) < 10], "others")
    assert [{**row, "run": 0} for row in good] == [{**row, "run": 0} for row in others]


def killing(at: set[int], processes: Callable[[], list[int]]) -> Callable[[int, int], None]:
    """A report of progress that kills the first process when so many rows are there."""

    def progress(done: int, errors: int) -> None:
        if done in at:
            os.kill(processes()[0], signal.SIGKILL)

    return progress


def workers_here() -> list[int]:
    """Processes of the study's workers on this machine."""
    found = []
    for task in Path(f"/proc/{os.getpid()}/task").iterdir():
        for child in (task / "children").read_text().split():
            with suppress(OSError):  # it has just ended
                if b"motionfmu.study.worker" in Path(f"/proc/{child}/cmdline").read_bytes():
                    found.append(int(child))
    return found


def is_undisturbed(rows: list[dict[str, Any]], undisturbed: list[dict[str, Any]]) -> int:
    """How many rows have a message in place of numbers; all others must be the same."""
    assert [row["run"] for row in rows] == list(range(len(undisturbed)))
    lost = [row for row in rows if row["status"] != "ok"]
    for row in lost:
        assert row["status"] == worker.CRASH and "(signal 9)" in row["message"]
    assert [row for row in rows if row["status"] == "ok"] == [
        own for row, own in zip(rows, undisturbed, strict=True) if row["status"] == "ok"
    ]
    return len(lost)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_worker_that_is_killed_is_replaced(
    workers: int, tmp_path: Path, undisturbed: list[dict[str, Any]]
) -> None:
    ways = Ways(workers=workers, progress=killing({1, 17, 33}, workers_here))
    rows = table(conduct(gains(), tmp_path / "s", ways))
    assert is_undisturbed(rows, undisturbed) <= 3


@pytest.mark.more
def test_a_worker_that_is_killed_before_its_first_run_is_replaced(
    tmp_path: Path, undisturbed: list[dict[str, Any]]
) -> None:
    """The last process is the one that has been started in place of the first."""
    killed: list[int] = []

    def progress(done: int, errors: int) -> None:
        here = workers_here()
        if done == 1 or (len(killed) == 1 and here and here[-1] not in killed and done > 8):
            killed.append(here[0] if done == 1 else here[-1])
            os.kill(killed[-1], signal.SIGKILL)

    rows = table(conduct(gains(), tmp_path / "s", Ways(workers=2, progress=progress)))
    assert len(killed) == 2 and is_undisturbed(rows, undisturbed) <= 2


@pytest.mark.more
def test_a_worker_of_a_cluster_that_is_killed_is_replaced(
    workers: Any, tmp_path: Path, undisturbed: list[dict[str, Any]]
) -> None:
    def processes() -> list[int]:
        return [one.pid for one in workers.workers.values()]

    ways = Ways(scheduler=workers.scheduler_address, progress=killing({2, 20}, processes))
    before = processes()
    rows = table(conduct(gains(), tmp_path / "s", ways))
    assert is_undisturbed(rows, undisturbed) == 0
    assert set(before) != set(processes())


@pytest.mark.long
def test_a_run_that_ends_its_process_on_a_cluster_is_a_row_with_its_message(
    tmp_path: Path, undisturbed: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """One gain ends the process that runs it, as often as it is tried; a worker is killed, too."""
    distributed = pytest.importorskip("distributed")
    dask = pytest.importorskip("dask")
    site, deadly = tmp_path / "site", 20
    site.mkdir()
    (site / "sitecustomize.py").write_text(
        "import os, sys\n"
        "if any('multiprocessing' in word for word in sys.orig_argv):\n"
        "    import motionfmu.run.session as s\n"
        "    made = s.Session._execution_of\n"
        "    def deadly(self, given, folder):\n"
        f"        if given.get('{GAIN}') == {101 + deadly}: os.kill(os.getpid(), 11)\n"
        "        return made(self, given, folder)\n"
        "    s.Session._execution_of = deadly\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(site))
    monkeypatch.setattr(cluster, "CHUNK_MAX", 4)
    given: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with (
        dask.config.set(PATIENT | {"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(host="127.0.0.1", **given) as workers,
    ):
        ways = Ways(
            scheduler=workers.scheduler_address,
            progress=killing({8}, lambda: [one.pid for one in workers.workers.values()]),
        )
        rows = table(conduct(gains(), tmp_path / "s", ways))
    assert [row["run"] for row in rows] == list(range(len(undisturbed)))
    assert [row["run"] for row in rows if row["status"] != "ok"] == [deadly]
    lost = rows.pop(deadly)
    assert lost["status"] == worker.CRASH and lost["message"].startswith(
        "the run ended its process"
    )
    assert [lost[name] for name in RESULTS] == [None, None] and lost["checks"] is None
    assert rows == [row for row in undisturbed if row["run"] != deadly]


class Scheduled:
    """A future of a cluster on which all that is in flight beside a deadly run is lost with it."""

    def __init__(self, runs: list[int], flying: "list[Scheduled]") -> None:
        self.runs, self._flying = runs, flying
        flying.append(self)

    def add_done_callback(self, told: Callable[[Any], None]) -> None:
        told(self)

    def exception(self, timeout: float) -> Exception | None:
        distributed = pytest.importorskip("distributed")
        lost = any(DEADLY in one.runs for one in self._flying)
        return distributed.KilledWorker("run", None, 3) if lost else None

    def result(self, timeout: float) -> cluster.Ran:
        rows = [worker.Row(n, worker.OK, "", None, ()) for n in self.runs]
        return cluster.Ran(0.01, 8, rows)

    def release(self) -> None:
        self._flying.remove(self)


class Scheduler:
    """Two workers with a thread each."""

    def __init__(self) -> None:
        self.flying: list[Scheduled] = []

    def nthreads(self) -> dict[str, int]:
        return {"a": 1, "b": 1}

    def submit(self, run: Any, job: Any, part: list[Any], pure: bool) -> Scheduled:
        return Scheduled([n for n, _ in part], self.flying)


def test_what_was_beside_a_run_that_ends_its_process_keeps_its_row() -> None:
    rows = list(cluster._chunks(Scheduler(), gains().job, [(n, ()) for n in range(2 * DEADLY)]))
    assert sorted(row.run for row in rows) == list(range(2 * DEADLY))
    assert [row.run for row in rows if row.status != worker.OK] == [DEADLY]


def test_a_cluster_that_has_lost_its_workers_ends_the_study(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Scheduler, "nthreads", lambda _: {})
    monkeypatch.setattr(Scheduled, "add_done_callback", lambda *_: None)
    monkeypatch.setattr(cluster, "LOOK", 0.01)
    monkeypatch.setattr(cluster, "LOST", 0.1)
    with pytest.raises(TimeoutError):
        list(cluster._chunks(Scheduler(), gains().job, [(0, ())]))
