"""A page on which a robot's program is written, judged before it moves, and saved."""

from motionfmu.job_editor.edited_job import EditedJob, JobTexts
from motionfmu.job_editor.editor_app import application

__all__ = ["EditedJob", "JobTexts", "application"]
