within MotionControl;
block SteppingMotor "Two-phase stepping motor at a drive that gives each winding its current"
  parameter Integer rotor_teeth(min = 1) = 50
    "Periods of the torque per turn, of four full steps each";
  parameter Real holding_torque(unit = "N.m", min = 0) = 1.2 "Largest torque at rest";
  parameter Real detent_torque(unit = "N.m", min = 0) = 0
    "Torque without current, four periods in one of the field";
  parameter Real winding_time(unit = "s", min = 1e-6) = 2e-4
    "Time constant of the current: inductance times holding current over voltage of the drive";
  parameter Real emf_speed(unit = "rad/s", min = 1e-9) = 110
    "Speed at which the back EMF is the voltage of the drive";
  input Real field(unit = "rad") "Electric angle of the command";
  input Real angle(unit = "rad") "Angle of the rotor, 0 where the field is 0";
  input Real speed(unit = "rad/s") "Speed of the rotor";
  input Real on(unit = "1") "1 with current, 0 without";
  output Real torque(unit = "N.m") "Torque";
  output Real pull_out(unit = "N.m") "Largest torque at this speed, were it kept";
protected
  Real phase(unit = "rad") "Electric angle of the rotor";
  Real emf(unit = "1") "Back EMF over the voltage of the drive";
  Real lag(unit = "1") "Electric speed times winding time";
  Real a(unit = "1", start = 1, fixed = true) "Current of winding A over the holding current";
  Real b(unit = "1", start = 0, fixed = true) "Current of winding B over the holding current";
equation
  phase = rotor_teeth*angle;
  emf = speed/emf_speed;
  winding_time*der(a) = on*(cos(field) + emf*sin(phase)) - a;
  winding_time*der(b) = on*(sin(field) - emf*cos(phase)) - b;
  torque = holding_torque*(b*cos(phase) - a*sin(phase)) - detent_torque*sin(4*phase);
  lag = rotor_teeth*winding_time*speed;
  pull_out = on*holding_torque*(sqrt(1 + lag^2) - abs(emf))/(1 + lag^2);
  annotation(Documentation(info = "<html>
<p>With the flux of the rotor on winding A at angle 0 the back EMF is -sin(phase) on A and
cos(phase) on B. At a constant speed both currents are sines; in the frame of the rotor, the field
ahead by d, the current across its flux is (sin d - emf - lag cos d)/(1 + lag^2), largest
(sqrt(1 + lag^2) - emf)/(1 + lag^2).</p>
</html>"));
end SteppingMotor;
