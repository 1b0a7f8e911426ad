within MotionControl;
model Slide "Table on its guide: a mass with friction"
  parameter Real mass(unit = "kg", min = 0) = 100 "Mass";
  parameter Real coulomb(unit = "N", min = 0) = 0 "Friction while sliding fast";
  parameter Real static(unit = "N", min = 0) = coulomb "Friction at break-away";
  parameter Real stribeck_speed(unit = "m/s", min = 0) = 1e-3
    "Speed at which half of the excess is left";
  parameter Real viscous(unit = "N.s/m", min = 0) = 0 "Friction per speed";
  parameter Real coulomb_asymmetry(unit = "1", min = -1, max = 1) = 0
    "Friction but the viscous one: share more forwards, less backwards";
  parameter Real viscous_asymmetry(unit = "1", min = -1, max = 1) = 0
    "Friction per speed: share more forwards, less backwards";
  parameter Real rest_speed(unit = "m/s", min = 0) = 2e-5 "Speed that counts as rest, see friction";
  parameter Real start_position(unit = "m") = 0 "Position at the start";
  input Real load(unit = "N") "Force on the table from outside";
  TranslationalFlange flange "Where the table is driven";
  Real position(unit = "m", start = start_position, fixed = true) "Position";
  Real speed(unit = "m/s", start = 0, fixed = true) "Speed";
equation
  flange.s = position;
  der(position) = speed;
  mass*der(speed) = load + flange.f
    - directedFriction(speed, coulomb, static, stribeck_speed, viscous, rest_speed,
      coulomb_asymmetry, viscous_asymmetry);
end Slide;
