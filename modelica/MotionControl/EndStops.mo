within MotionControl;
model EndStops "Stop at either end of a stroke: spring whose damping grows with the dent"
  parameter Real lower(unit = "m") = -0.1 "Position at which the lower stop is touched";
  parameter Real upper(unit = "m") = 0.1 "Position at which the upper stop is touched";
  parameter Real stiffness(unit = "N/m", min = 0) = 1e8 "Force per dent";
  parameter Real damping(unit = "s/m", min = 0) = 5 "Share of the force that 1 m/s of speed adds";
  TranslationalFlange flange "What is stopped";
  Real force(unit = "N") "Force on what is stopped";
protected
  Real speed(unit = "m/s") "Speed of the flange";
  Real dent(unit = "m") "How far the flange is beyond a stop, with the sign of that side";
  Real share(unit = "1") "Speed into the stop as a share of the force";
equation
  speed = der(flange.s);
  dent = max(flange.s - upper, 0) + min(flange.s - lower, 0);
  share = if dent > 0 then damping*speed else -damping*speed;
  force = -stiffness*dent*max(1 + share, 0);
  flange.f = -force;
  annotation(Documentation(info = "<html>
<p>The contact law of Hunt and Crossley (1975) with exponent 1: the force is continuous when the
stop is touched and left, and never pulls.</p>
</html>"));
end EndStops;
