"""What a scenario is: its file, its FMUs, wires, values and recording."""
