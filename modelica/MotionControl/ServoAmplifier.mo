within MotionControl;
block ServoAmplifier "Amplifier of a servo valve: voltage to coil current"
  parameter Real gain(unit = "A/V") = 4e-3 "Current per volt";
  parameter Real limit(unit = "A", min = 0) = 0.04 "Largest current, both ways";
  parameter Real tau(unit = "s", min = 0) = 2e-4 "Time constant of the current";
  input Real voltage(unit = "V") "Command";
  output Real current(unit = "A") "Current of the coil";
protected
  Lag coil(tau = tau) "Current loop";
equation
  coil.u = min(max(gain*voltage, -limit), limit);
  current = coil.y;
end ServoAmplifier;
