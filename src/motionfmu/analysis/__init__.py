"""Analyses of runs, models and part programs: contour, tool paths, loops, causes of errors."""
