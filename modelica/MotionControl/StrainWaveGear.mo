within MotionControl;
model StrainWaveGear
  "Strain wave gear: three stiffnesses, lost motion, damping, and an error twice per motor turn"
  parameter Real ratio(unit = "1", min = 1) = 100 "Turns of the motor per turn of the link";
  parameter Real stiffness_1(unit = "N.m/rad", min = 0) = 1e5 "Up to knee_1";
  parameter Real stiffness_2(unit = "N.m/rad", min = 0) = 1.6e5 "From there to knee_2";
  parameter Real stiffness_3(unit = "N.m/rad", min = 0) = 1.8e5 "Beyond";
  parameter Real knee_1(unit = "N.m", min = 0) = 50 "Torque at which the gear gets stiffer";
  parameter Real knee_2(unit = "N.m", min = 0) = 180 "Torque at which it does so again";
  parameter Real damping(unit = "N.m.s/rad", min = 0) = 200 "Torque per speed of wind-up";
  parameter Real lost_motion(unit = "rad", min = 0) = 0
    "Wind-up without torque, both ways together";
  parameter Real error_1(unit = "rad", min = 0) = 0 "Amplitude of the error once per motor turn";
  parameter Real error_2(unit = "rad", min = 0) = 0 "Amplitude of the error twice per motor turn";
  parameter Real phase_1(unit = "rad") = 0 "Its phase with the motor at 0, once per turn";
  parameter Real phase_2(unit = "rad") = 0 "Its phase with the motor at 0, twice per turn";
  parameter Real zero_error(unit = "rad") = 0
    "How far the link is ahead with motor and wind-up at 0";
  RotationalFlange motor "Motor side";
  RotationalFlange link "Slow side";
  Real windup(unit = "rad") "How far the motor side is ahead of the link";
  Real torque(unit = "N.m") "Torque on the link";
protected
  Real c(unit = "1") "Cosine of the motor's angle";
  Real s(unit = "1") "Sine of the motor's angle";
  Real error(unit = "rad") "Error of transmission";
  Real slope(unit = "1") "Its change per motor angle";
  Real wound(unit = "rad") "Wind-up beyond the lost motion, without its sign";
  Real spring(unit = "N.m") "Torque of the spring, without its sign";
  final parameter Real bend_1(unit = "rad") = knee_1/stiffness_1 "Wind-up at knee_1";
  final parameter Real bend_2(unit = "rad") = bend_1 + (knee_2 - knee_1)/stiffness_2
    "Wind-up at knee_2";
equation
  c = cos(motor.phi);
  s = sin(motor.phi);
  error = (error_1*cos(phase_1))*s + (error_1*sin(phase_1))*c
    + (error_2*cos(phase_2))*(2*s*c) + (error_2*sin(phase_2))*(1 - 2*s^2);
  slope = (error_1*cos(phase_1))*c - (error_1*sin(phase_1))*s
    + (2*error_2*cos(phase_2))*(1 - 2*s^2) - (2*error_2*sin(phase_2))*(2*s*c);
  windup = motor.phi/ratio + zero_error + error - link.phi;
  wound = max(abs(windup) - lost_motion/2, 0);
  spring = stiffness_1*wound + (stiffness_2 - stiffness_1)*max(wound - bend_1, 0)
    + (stiffness_3 - stiffness_2)*max(wound - bend_2, 0);
  torque = sign(windup)*spring + damping*der(windup);
  link.tau = -torque;
  motor.tau = torque*(1/ratio + slope) "Power in is power out, but for spring and damping";
  annotation(Documentation(info = "<html>
<p>Such gears have no backlash in the strict sense: teeth stay in mesh, and what is lost at a
reversal is friction and hysteresis, here a gap of the spring within which the damping acts on. The
error of transmission is mostly once and twice per turn of the wave generator, which has two
lobes.</p>
</html>"));
end StrainWaveGear;
