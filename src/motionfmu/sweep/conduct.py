"""Run a study to its end: resume, hand out, keep, report."""

from collections.abc import Iterator
from pathlib import Path

from motionfmu.study import processes
from motionfmu.study.book import Book
from motionfmu.study.study_definition import Study
from motionfmu.study.study_outcome import Outcome, Ways
from motionfmu.study.worker import ERROR, OK, Row


def _rows(study: Study, ways: Ways, done: set[int]) -> Iterator[Row]:
    tasks = [(run, point) for run, point in enumerate(study.points) if run not in done]
    if not tasks:
        return iter(())
    if ways.scheduler:
        from motionfmu.study import cluster

        return cluster.rows(study.job, tasks, ways.scheduler)
    return processes.rows(study.job, tasks, ways.workers or processes.cores())


def conduct(study: Study, folder: str | Path, ways: Ways | None = None) -> Outcome:
    """Run what is not done yet, write the table and the report.

    Parameters
    ----------
    study : Study
    folder : str or Path
        New, empty, or with this study, done in part or whole.
    ways : Ways, optional

    Returns
    -------
    Outcome

    Raises
    ------
    InputError
        The folder holds something else, or no worker can begin.
    """
    asked = ways or Ways()
    with Book(Path(folder), study, asked.fresh) as book:
        resumed = len(book.done)
        done, errors = resumed, sum(r.status == ERROR for r in book.done.values())
        asked.progress(done, errors)
        for row in _rows(study, asked, set(book.done)):
            book.add(row)
            done, errors = done + 1, errors + (row.status != OK)
            asked.progress(done, errors)
        outcome = Outcome(study, book.finish(), book.folder, resumed)
    from motionfmu.report.studies.sweep_page import write_sweep

    write_sweep(outcome, outcome.folder)
    return outcome
