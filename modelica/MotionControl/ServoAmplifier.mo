within MotionControl;
block ServoAmplifier "Amplifier of a servo valve: voltage to coil current"
  parameter Real gain(unit = "A/V") = 4e-3 "Current per volt";
  parameter Real limit(unit = "A", min = 1e-9) = 0.04 "Largest current, both ways";
  parameter Real tau(unit = "s", min = 0) = 2e-4 "Time constant of the current";
  input Real voltage(unit = "V") "Command";
  output Real current(unit = "A") "Current of the coil";
protected
  Lag coil(tau = tau) "Current loop, of the limit";
equation
  coil.u = min(max(gain/limit*voltage, -1), 1);
  current = limit*coil.y;
end ServoAmplifier;
