"""Studies: a scenario that workers run at many points, and a table with a row for each run."""
