"""EMPS by pysindy, which is not ours, by hand: `pip install pysindy` and tests/helpers on the path.

dv/dt = F/m - Coulomb/m sign(v) - viscous/m v - offset/m, by sparse regression without a threshold.
"""

import numpy as np
import pysindy
from emps import DRIVE, INERTIA, RECORD, SHARE, columns, emps
from scipy.signal import butter, filtfilt

import motionfmu
from motionfmu.identify import IdentifyOptions, identify
from motionfmu.identify.axis_record import of_record

CUTOFF, EDGE = 30.0, 300  # [Hz], samples

record = of_record(motionfmu.record(RECORD))
b, a = butter(4, 2.0 * CUTOFF * record.interval)
position = filtfilt(b, a, record.columns["position"])
force = filtfilt(b, a, DRIVE * record.columns["voltage"])
speed = np.gradient(position, record.interval)
inputs = np.column_stack([force, filtfilt(b, a, np.sign(speed))])[EDGE:-EDGE]
model = pysindy.SINDy(
    optimizer=pysindy.STLSQ(threshold=0.0, alpha=0.0),
    feature_library=pysindy.PolynomialLibrary(degree=1),
    differentiation_method=pysindy.FiniteDifference(order=2),
)
model.fit(speed[EDGE:-EDGE].reshape(-1, 1), t=record.interval, u=inputs)
_, of_speed, of_force, of_sign = model.coefficients()[0]
found = identify(emps(), record, IdentifyOptions(columns(), laws=["offset"]))
ours = (
    found.value("table_mass").value + INERTIA / SHARE**2,
    found.value("table_coulomb").value,
    found.value("table_viscous").value,
)
for name, mine, other in zip(
    ("mass [kg]", "Coulomb [N]", "viscous [N.s/m]"),
    ours,
    (1.0 / of_force, -of_sign / of_force, -of_speed / of_force),
    strict=True,
):
    print(f"{name:16} {mine:8.2f}, pysindy {other:8.2f}: {100 * (mine / other - 1):+.2f} %")
