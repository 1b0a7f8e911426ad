"""Prints where a wheel's files of other packages are: FMPy, plotly, plotly's licence."""

from importlib.metadata import files
from importlib.util import find_spec

for name in ("fmpy", "plotly"):
    print(find_spec(name).submodule_search_locations[0])
print(next(file for file in files("plotly") if file.name == "LICENSE.txt").locate())
