within MotionControl;
model Cylinder "Double-acting cylinder with compressible oil"
  parameter Real area_a(unit = "m2", min = 0) = 1e-3 "Piston area on side a, which pushes forwards";
  parameter Real area_b(unit = "m2", min = 0) = 1e-3 "Piston area on side b";
  parameter Real lower_end(unit = "m") = -0.1 "Piston position at which chamber a is empty";
  parameter Real upper_end(unit = "m") = 0.1 "Piston position at which chamber b is empty";
  parameter Real dead_volume_a(unit = "m3", min = 0) = 5e-5 "Oil from valve to chamber a";
  parameter Real dead_volume_b(unit = "m3", min = 0) = 5e-5 "Oil from valve to chamber b";
  parameter Real bulk_modulus(unit = "Pa", min = 0) = 1.2e9 "Of the oil with its lines";
  parameter Real leakage(unit = "m3.s-1.Pa-1", min = 0) = 1e-12
    "From chamber to chamber per pressure";
  parameter Real start_pressure_a(unit = "Pa") = 0 "Pressure in chamber a at the start";
  parameter Real start_pressure_b(unit = "Pa") = 0 "Pressure in chamber b at the start";
  parameter Real large_pressure(unit = "Pa", min = 1) = 1e7
    "What is large for a pressure: for the error of the integrator";
  HydraulicPort a "Chamber a";
  HydraulicPort b "Chamber b";
  TranslationalFlange rod "Where the load is";
  Real pressure_a(unit = "Pa", start = start_pressure_a, fixed = true, nominal = large_pressure)
    "Pressure in chamber a";
  Real pressure_b(unit = "Pa", start = start_pressure_b, fixed = true, nominal = large_pressure)
    "Pressure in chamber b";
protected
  Real speed(unit = "m/s") "Speed of the piston";
  Real volume_a(unit = "m3") "Oil in chamber a";
  Real volume_b(unit = "m3") "Oil in chamber b";
  Real leak(unit = "m3/s") "Flow from a to b past the piston";
equation
  speed = der(rod.s);
  a.p = pressure_a;
  b.p = pressure_b;
  volume_a = dead_volume_a + area_a*(rod.s - lower_end);
  volume_b = dead_volume_b + area_b*(upper_end - rod.s);
  leak = leakage*(pressure_a - pressure_b);
  volume_a*der(pressure_a) = bulk_modulus*(a.q - area_a*speed - leak);
  volume_b*der(pressure_b) = bulk_modulus*(b.q + area_b*speed + leak);
  rod.f = area_b*pressure_b - area_a*pressure_a;
end Cylinder;
