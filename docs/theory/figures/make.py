"""Write the figures of the theory's pages, the same bytes each time.

Each module `*_figures.py` beside this file has those of one page. After `make build`:

    PYTHONPATH=tests/helpers .venv/bin/python docs/theory/figures/make.py [speed ...]
"""

import importlib
import sys
from pathlib import Path

import matplotlib as mpl
from matplotlib import pyplot as plt
from plots import FIGURES

HERE = Path(__file__).parent


def main() -> None:
    """Write every figure, or those whose names are given."""
    mpl.use("svg")
    mpl.rcParams.update({"svg.hashsalt": "motionfmu", "font.size": 9})
    for module in sorted(HERE.glob("*_figures.py")):
        importlib.import_module(module.stem)
    for made in FIGURES:
        if made.__name__ in sys.argv[1:] or not sys.argv[1:]:
            fig = made()
            fig.savefig(HERE.parent / f"{made.__name__}.svg", metadata={"Date": None})
            plt.close(fig)
            print(made.__name__)


if __name__ == "__main__":
    main()
