"""A child process that opens and plans files, because a plan takes seconds and commands must not
wait for it.

The file is sent to it behind a line of JSON; the job comes back behind another line.
"""

import asyncio
import contextlib
import json
import os
import sys
from subprocess import PIPE
from typing import Any, BinaryIO

from motionfmu.base.children import child
from motionfmu.base.errors import InputError
from motionfmu.cards.config import CardConfig
from motionfmu.cards.server_page.job_pictures import OpenedJob, opened


async def opened_apart(data: bytes, name: str, config: CardConfig | None, page: int) -> OpenedJob:
    """As `opened`, in a child process, which ends if the caller cancels."""
    asked = {"name": name, "page": page, "config": config.model_dump() if config else None}
    command, options = child(f"from {__name__} import main; main()")
    process = await asyncio.create_subprocess_exec(*command, stdin=PIPE, stdout=PIPE, **options)
    try:
        said, _ = await process.communicate(json.dumps(asked).encode() + b"\n" + data)
    finally:
        with contextlib.suppress(ProcessLookupError):
            process.kill()
    if not said:
        raise InputError(f"{name}: it could not be opened, the server's log says why")
    line, _, job = said.partition(b"\n")
    answer: dict[str, Any] = json.loads(line)
    if "errors" in answer:
        raise InputError(*answer["errors"])
    return OpenedJob(job, answer["picture"])


def answered(request: BinaryIO, answer: BinaryIO) -> None:
    """Answer one request in the child process."""
    asked = json.loads(request.readline())
    config = CardConfig.model_validate(asked["config"]) if asked["config"] else None
    try:
        found = opened(request.read(), asked["name"], config, asked["page"])
    except InputError as error:
        answer.write(json.dumps({"errors": error.args}).encode())
        return
    answer.write(json.dumps({"picture": found.picture}).encode() + b"\n" + found.job)


def main() -> None:
    """Answer the request on stdin, with less priority."""
    if hasattr(os, "nice"):
        os.nice(5)
    with contextlib.suppress(BrokenPipeError):
        answered(sys.stdin.buffer, sys.stdout.buffer)
        sys.stdout.flush()
