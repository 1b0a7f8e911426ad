"""Names of files and folders that an FMU's archive holds beside those of the standard."""

from motionfmu.fmu.describe import DOMAIN

# Folder of the files of which linear models are made.
EXTRA = f"extra/{DOMAIN}"
# Folder of files that travel with an FMU; a parameter names one as resource:NAME.
RESOURCES = "resources"
# File in EXTRA that names the parameter that is the FMU's grid.
GRID = "grid.json"
# File in EXTRA with the quantities that parameters and outputs share with those of other FMUs.
AGREE = "agree.json"
# The model without FMI: its C text, and the path of its object for each machine.
PART_UNIT = "fmu_part.c"
MAIN_UNIT = "fmu_main.c"
PARTS = f"{EXTRA}/part"
