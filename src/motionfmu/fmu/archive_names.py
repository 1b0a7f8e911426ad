"""Names of what an FMU's archive holds beside what the standard asks for."""

from motionfmu.fmu.describe import DOMAIN

# What the linear models are made of goes into the FMU beside what the standard asks for.
EXTRA = f"extra/{DOMAIN}"
# Files that travel with an FMU, resource:NAME in a parameter.
RESOURCES = "resources"
# Which parameter is the FMU's grid; carried in EXTRA.
GRID = "grid.json"
# Parameters and outputs that agree with those of other FMUs; carried in EXTRA.
AGREE = "agree.json"
# The model without FMI: its C text, and where an FMU carries its object, by the machine.
PART_UNIT = "fmu_part.c"
MAIN_UNIT = "fmu_main.c"
PARTS = f"{EXTRA}/part"
