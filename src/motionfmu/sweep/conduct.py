"""Run a study to its end: resume, hand out, keep, report."""

from collections.abc import Iterator
from pathlib import Path

from motionfmu.study import processes
from motionfmu.study.book import Book
from motionfmu.study.open_runs import OpenRuns
from motionfmu.study.study_definition import Study
from motionfmu.study.study_outcome import Outcome, Ways
from motionfmu.study.worker import OK, Row


def _rows(study: Study, ways: Ways, tasks: OpenRuns) -> Iterator[Row]:
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
        resumed, errors = book.count, book.errors
        done = resumed
        asked.progress(done, errors)
        for row in _rows(study, asked, OpenRuns(study.points, book.done)):
            book.add(row)
            done, errors = done + 1, errors + (row.status != OK)
            asked.progress(done, errors)
        outcome = Outcome(study, book.finish(), book.folder, resumed)
    from motionfmu.report.studies.sweep_page import write_sweep

    write_sweep(outcome, outcome.folder)
    return outcome
