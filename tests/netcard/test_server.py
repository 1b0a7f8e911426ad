"""The server of cards on real connections: commands, jobs, links that cut."""

import asyncio
import errno
import hashlib
import logging
import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from card_links import (
    HOST,
    PATIENCE,
    WAIT,
    ChaosLink,
    Puppet,
    bench,
    job_of,
    numbers,
    run,
    until,
)
from soft_card import SoftCard, serve_card

from motionfmu.base.errors import InputError
from motionfmu.cards import messages as m
from motionfmu.cards.connection import ConnectionLimits
from motionfmu.cards.control import Control, ask
from motionfmu.cards.keys import new_key, read_keys
from motionfmu.cards.server import Cards
from motionfmu.cards.views import Code

KEY = bytes(range(32))


def test_a_job_and_commands_reach_their_card_and_no_other() -> None:
    async def main() -> None:
        async with bench() as b:
            soft = [SoftCard(i) for i in (1, 2)]
            b.serve(*soft)
            await b.online([1, 2])
            queue = b.cards.subscribe()
            assert (await b.cards.command(1, "start")).code == Code.NO_JOB
            assert (await b.cards.upload(1, job_of(50))).ok
            assert soft[0].job == job_of(50) and soft[1].job == b""
            ends = [await b.cards.command(1, n) for n in ("start", "pause", "start", "stop")]
            assert [(r.code, r.state) for r in ends] == [
                (0, "RUNNING"),
                (0, "PAUSED"),
                (0, "RUNNING"),
                (0, "READY"),
            ]
            assert (await b.cards.command(1, "home", axes=5)).ok
            assert soft[0].orders[-1] == m.Home(soft[0].done, 5)
            values = {"pins": 3, "mode": 1, "level": 1, "width": 500}
            assert (await b.cards.command(1, "output", **values)).ok
            assert soft[0].orders[-1] == m.Output(soft[0].done, 3, 1, 1, 500)
            assert soft[1].orders == []
            assert b.view(1).job == hashlib.sha256(job_of(50)).hexdigest()
            assert soft[0].written == 50
            assert (await b.cards.upload(1, job_of(50))).ok and soft[0].written == 50
            kinds = [queue.get_nowait().kind for _ in range(queue.qsize())]
            assert {"command", "result", "upload"} <= set(kinds)

    run(main())


def test_a_full_disk_keeps_no_command_back(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Numbers stay new, a server that comes after it included; the log says what is wrong, once."""
    asked: list[str] = []

    def full(file: Path, *_: object, **__: object) -> None:
        asked.append(file.name)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    async def main() -> None:
        async with bench() as b:
            card = SoftCard(1)
            b.serve(card)
            await b.online([1])
            assert (await b.cards.upload(1, job_of(3))).ok
            assert (await b.cards.command(1, "start")).ok  # takes 256 numbers
            monkeypatch.setattr("motionfmu.cards.outbox.BLOCK", 0)
            b.cards._cards[1]._outbox.load()
            with monkeypatch.context() as disk:
                disk.setattr(Path, "write_text", full)
                disk.setattr(Path, "mkdir", full)
                disk.setattr("motionfmu.cards.keys.os.open", full_open)
                for name in ("stop", "home", "start", "pause", "stop"):
                    assert (await b.cards.command(1, name)).ok, name
                with pytest.raises(InputError, match="No space left"):
                    await b.cards.upload(1, job_of(4))
            told = [e.text for e in b.view(1).events if e.kind == "disk"]
            assert len(told) == 1 and "number: No space left on device" in told[0]
            last = card.done
            assert last > 2**30 and len({o.number for o in card.orders}) == len(card.orders)
            b.cards._cards[1]._outbox.load()  # as another server would
            assert (await b.cards.command(1, "home")).ok and card.done > last

    def full_open(*_: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    caplog.set_level(logging.INFO, "motionfmu.cards")
    run(main())
    assert asked and caplog.text.count("No space left on device") == 1


def test_a_request_that_fails_is_answered(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """What no one thought of, too: who asks for a stop shall not wait for an answer in vain."""

    class Broken:
        async def command(self, *_: object, **__: object) -> None:
            raise OSError(errno.EIO, "the disk is gone")

    async def main() -> None:
        control = Control(Broken(), tmp_path)  # type: ignore[arg-type]
        await control.listen()
        wish = {"do": "command", "card": 1, "name": "stop"}
        with pytest.raises(InputError, match=r"its log says more: .*the disk is gone"):
            await asyncio.to_thread(ask, tmp_path, wish)
        await control.close()

    run(main())
    assert "a request was not done" in caplog.text


def test_wrong_input_is_told_before_anything_is_sent(tmp_path: Path) -> None:
    async def main() -> None:
        async with bench() as b:
            for values, told in (
                ((1, "fly"), "no command 'fly'"),
                ((-1, "start"), "-1 is no id"),
                ((1, "home", {"axes": 16}), "axes = 16: 0 to 15"),
                ((1, "output"), "level, mode, pins, width wanted"),
                ((1, "start", {"card": 5}), "start has no 'card'"),
                ((1, "stop", {"self": 1, "name": "x"}), "stop has no 'self'"),
            ):
                given = values[2] if len(values) > 2 else {}
                with pytest.raises(InputError, match=told):
                    await b.cards.command(values[0], values[1], **given)
            for job in (b"", b"MCJ1" + bytes(252), b"MCJ1" + bytes(1000), bytes(512)):
                with pytest.raises(InputError, match="no job file"):
                    await b.cards.upload(1, job)
            assert (await b.cards.command(9, "start")).code == Code.OFFLINE
            assert b.cards.list() == []
        with pytest.raises(InputError, match="need keys"):
            await Cards(tmp_path).listen("0.0.0.0", 0)

    run(main())


def test_keys_are_private_and_said_once(tmp_path: Path) -> None:
    file = tmp_path / "keys.toml"
    key = new_key(file, 7)
    assert len(key) == 32 and file.stat().st_mode & 0o777 == 0o600
    with pytest.raises(InputError, match="card 7 has a key"):
        new_key(file, 7)
    new_key(file, 5)
    assert sorted(read_keys(file)) == [5, 7] and read_keys(file)[7] == key
    with ThreadPoolExecutor(8) as pool:
        made = list(pool.map(lambda i: new_key(file, i), range(10, 40)))
    assert [read_keys(file)[i] for i in range(10, 40)] == made
    for text, told in (
        ('x = "00"', "keys.toml:1: 'x' is no id"),
        ('1 = "00"', "keys.toml:1: key of card 1: 64"),
        (f'\n1 = "{bytes(32).hex()}"', "keys.toml:2: key of card 1: zeros"),
        ("1 = 5", "keys.toml:1: key of card 1: 64"),
    ):
        file.write_text(text)
        with pytest.raises(InputError, match=told):
            read_keys(file)
    file.chmod(0o640)
    with pytest.raises(InputError, match="others may read it"):
        read_keys(file)


def test_only_the_card_with_the_key_takes_the_place_of_the_old_connection(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO", "motionfmu.cards")
    key = new_key(tmp_path / "keys.toml", 7)

    async def main() -> None:
        async with bench(folder=tmp_path) as b:
            thief, first, second = SoftCard(7, KEY), SoftCard(7, key), SoftCard(7, key)
            b.serve(thief)
            await until(lambda: "card 7 does not know this server's key" in caplog.text)
            b.serve(first)
            await b.online([7])
            address = b.view(7).address
            await asyncio.sleep(0.05)
            assert b.view(7).address == address
            await b.unplug()
            await until(lambda: not b.view(7).connected)
            talk = asyncio.create_task(serve_card(first, HOST, b.port, PATIENCE))
            await b.online([7])
            address = b.view(7).address
            b.serve(second)
            await until(lambda: b.view(7).address not in ("", address))
            await until(lambda: any("came again" in t for t in b.texts(7, "closed")))
            assert (await b.cards.command(7, "reset")).ok
            assert len(second.orders) == 1 and first.orders == []
            talk.cancel()

    run(main())


@pytest.mark.parametrize(("seed", "twice"), [(0, False), (1, False), (2, True), (3, True)])
def test_chaos_leaves_the_job_that_was_sent_and_commands_done_once(seed: int, twice: bool) -> None:
    """Cuts every few kB in both directions; if `twice`, more connections of the same card."""

    async def main() -> tuple[int, int]:
        async with bench(ConnectionLimits(answer=PATIENCE)) as b:
            link = ChaosLink(b.port, seed, 3000)
            soft, job = SoftCard(3), job_of(300, seed)
            port = await link.listen()
            b.serve(soft, port=port)
            await b.online([3])
            sent = asyncio.create_task(b.cards.upload(3, job))
            results = []
            while not sent.done():
                results.append(await b.cards.command(3, "reset"))
                if twice and len(results) % 25 == 0:
                    b.serve(soft, port=port, wait=2 * PATIENCE)  # which comes once
                if results[-1].code == Code.OFFLINE:
                    await asyncio.sleep(WAIT)
            assert (await sent).ok
            assert soft.job == job
            # Only what an older connection still carries can come behind the answer of a newer one.
            assert soft.written == 300 or twice
            assert numbers(soft) == sorted(set(numbers(soft)))
            done = sum(r.ok for r in results)
            lost = sum(r.code in (Code.NO_ANSWER, Code.STATE) for r in results)
            assert done <= len(numbers(soft)) <= done + lost
            await link.close()
            return link.cuts, done

    cuts, done = run(main())
    print(f"{cuts} cuts, {done} commands")
    assert cuts >= 5 and done >= 1


@pytest.mark.parametrize("power", [False, True], ids=["cut", "power cut"])
def test_a_command_whose_answer_was_lost_is_not_done_again(power: bool) -> None:
    async def main() -> None:
        async with bench(ConnectionLimits(answer=PATIENCE)) as b:
            reply = Puppet(SoftCard(3))
            end, sock = await reply.connect(b.port)
            await b.online([3])
            order = asyncio.create_task(b.cards.command(3, "reset"))
            first = await reply.hear(end, sock)
            sock.close()
            if power:
                reply.card.life ^= 1
                reply.card.done = 0
            end, sock = await reply.connect(b.port)
            if power:
                assert (await order).code == Code.NO_ANSWER
                again = asyncio.create_task(b.cards.command(3, "reset"))
                assert (await reply.hear(end, sock)).number == first.number + 1
                again.cancel()
            else:
                assert await reply.hear(end, sock) == first
                end.send(reply.answers[0])
                await asyncio.get_running_loop().sock_sendall(sock, end.take())
                assert (await order).ok
                assert len(reply.card.orders) == 1
            sock.close()

    run(main())


def test_a_refused_page_is_asked_for_and_a_damaged_job_is_told() -> None:
    class Forgetful(SoftCard):
        """Has no room for page 40 at first, and loses a byte of the second job."""

        refused = 0

        def _take(self, message: m.Message) -> int:
            if isinstance(message, m.JobData) and message.page == 40 and not self.refused:
                self.refused += 1
                return Code.PAGE
            if isinstance(message, m.JobEnd) and self.job:
                self.pages[3] = bytes(256)
            return super()._take(message)

    async def main() -> None:
        async with bench() as b:
            soft = Forgetful(3)
            b.serve(soft)
            await b.online([3])
            assert (await b.cards.upload(3, job_of(100))).ok
            assert soft.job == job_of(100) and soft.refused == 1
            result = await b.cards.upload(3, job_of(100, 2))
            assert (result.code, result.text) == (Code.BAD_JOB, "the job is damaged, or no job")
            assert soft.job == job_of(100)
            assert (await b.cards.command(3, "start")).ok
            assert (await b.cards.upload(3, job_of(20, 3))).code == Code.BUSY
            assert b.view(3).upload is None

    run(main())


def test_a_job_waits_on_disk_for_its_card_and_a_newer_one_takes_its_place(tmp_path: Path) -> None:
    async def main() -> None:
        async with bench(folder=tmp_path) as b:
            first = asyncio.create_task(b.cards.upload(3, job_of(30)))
            await until(lambda: b.cards.list() and b.view(3).upload)
            second = asyncio.create_task(b.cards.upload(3, job_of(40)))
            assert (await first).code == Code.REPLACED
            await until(lambda: b.view(3).upload)
            second.cancel()
        async with bench(ConnectionLimits(retry=0.05), tmp_path) as b:
            assert b.view(3).upload.pages == 40
            soft = SoftCard(3)
            soft.state = m.State.RUNNING
            b.serve(soft)
            await until(lambda: b.view(3).upload.waits)
            soft.state = m.State.READY
            await until(lambda: soft.job)
            await until(lambda: b.view(3).upload is None)
            assert soft.job == job_of(40) and not (tmp_path / "3" / "job.mcj").exists()
            assert (await b.cards.command(3, "reset")).ok
            number, soft.done = soft.done, 0  # a command that the card has, but has not done yet
        async with bench(folder=tmp_path) as b:
            b.serve(soft)
            await b.online([3])
            assert (await b.cards.command(3, "reset")).ok and soft.done > number

    run(main())


def test_uploads_share_the_server() -> None:
    async def main() -> None:
        async with bench() as b:
            soft = [SoftCard(i) for i in range(8)]
            tasks = [asyncio.create_task(b.cards.upload(i, job_of(400, i))) for i in range(8)]
            await until(lambda: sum(v.upload is not None for v in b.cards.list()) == 8)
            b.serve(*soft)  # all jobs are on the disk: the cards begin together
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            shares = [len(s.job) // 256 or len(s.pages) for s in soft]
            print("pages when the first has all:", shares)
            assert min(shares) > 40
            assert all(r.ok for r in await asyncio.gather(*tasks))

    run(main())
