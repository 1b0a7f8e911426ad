within MotionControl;
block Lag "First-order lag; without a time constant the signal passes"
  parameter Real tau(unit = "s", min = 0) = 1e-3 "Time constant";
  input Real u(unit = "1") "Input";
  output Real y(unit = "1") "Output";
protected
  Real state(unit = "1", start = 0, fixed = true) "What the lag remembers";
  final parameter Real rate(unit = "1/s") = if tau > 0 then 1/tau else 0 "Inverse of tau";
equation
  der(state) = rate*(u - state);
  y = if tau > 0 then state else u;
end Lag;
