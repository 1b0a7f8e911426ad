"""What the moving picture of a run shows: frames of the machine, its path, its deviations."""
