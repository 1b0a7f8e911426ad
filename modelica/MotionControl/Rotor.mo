within MotionControl;
model Rotor "Motor rotor and screw as one inertia with friction"
  parameter Real inertia(unit = "kg.m2", min = 0) = 2e-3 "Moment of inertia";
  parameter Real coulomb(unit = "N.m", min = 0) = 0 "Friction torque while turning fast";
  parameter Real static(unit = "N.m", min = 0) = coulomb "Friction torque at break-away";
  parameter Real stribeck_speed(unit = "rad/s", min = 0) = 1
    "Speed at which half of the excess is left";
  parameter Real viscous(unit = "N.m.s/rad", min = 0) = 0 "Friction torque per speed";
  parameter Real rest_speed(unit = "rad/s", min = 0) = 5e-3
    "Speed that counts as rest, see friction";
  parameter Real start_angle(unit = "rad") = 0 "Angle at the start";
  input Real drive(unit = "N.m") "Torque of the motor";
  RotationalFlange flange "Where the load is";
  Real angle(unit = "rad", start = start_angle, fixed = true) "Angle";
  Real speed(unit = "rad/s", start = 0, fixed = true) "Speed";
equation
  flange.phi = angle;
  der(angle) = speed;
  inertia*der(speed) = drive + flange.tau
    - friction(speed, coulomb, static, stribeck_speed, viscous, rest_speed);
end Rotor;
