"""A hash of every signal of every scenario in both FMI versions, to show that no bit has moved.

    python tests/signal_hashes.py before.json             # on the commit before
    python tests/signal_hashes.py after.json before.json  # on the change: what differs

Exit status 1 if a signal that both have differs.
"""

import hashlib
import json
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import motionfmu

ROOT = Path(__file__).parent.parent


def hashes(case: tuple[str, int]) -> dict[str, str]:
    """Of each signal of one run, and of the path the library planned."""
    name, fmi = case
    try:
        result = motionfmu.load(ROOT / "scenarios" / name).run(fmi=fmi)
    except motionfmu.InputError as error:
        return {f"refused: {error}": ""}
    found = {
        k: f"{x.dtype} {x.shape} " + hashlib.sha256(x.tobytes()).hexdigest()
        for k, x in result.signals.items()
    }
    if result.geometry is not None:
        found["geometry"] = hashlib.sha256(result.geometry.encode()).hexdigest()
    return found


def main(target: Path, earlier: Path | None) -> int:
    """Write the table; hold it against an earlier one."""
    names = sorted(p.parent.name for p in ROOT.glob("scenarios/*/scenario.toml"))
    cases = [(name, fmi) for name in names for fmi in (2, 3)]
    with ProcessPoolExecutor() as pool:
        table = {f"{n} fmi{f}": h for (n, f), h in zip(cases, pool.map(hashes, cases), strict=True)}
    target.write_text(json.dumps(table, indent=1))
    print(f"{len(table)} runs, {sum(map(len, table.values()))} signals")
    if earlier is None:
        return 0
    before = json.loads(earlier.read_text())
    moved = 0
    for run in sorted({*table, *before}):
        new, old = table.get(run, {}), before.get(run, {})
        both = new.keys() & old.keys()
        other = sorted(k for k in both if new[k] != old[k])
        moved += len(other)
        for word, rows in (
            ("differs", other),
            ("is new", sorted(new.keys() - both)),
            ("is gone", sorted(old.keys() - both)),
        ):
            if rows:
                print(f"{run}: {word}: {', '.join(rows)}")
    print(f"{moved} signals differ" if moved else "every signal of both is the same to the bit")
    return int(bool(moved))


if __name__ == "__main__":
    files = [Path(a) for a in sys.argv[1:]]
    if len(files) not in (1, 2):
        sys.exit(__doc__)
    sys.exit(main(files[0], files[1] if len(files) == 2 else None))
