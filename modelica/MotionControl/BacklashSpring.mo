within MotionControl;
model BacklashSpring "Spring and damper that act across a gap"
  parameter Real stiffness(unit = "N/m", min = 0) = 1e8 "Force per extension";
  parameter Real damping(unit = "N.s/m", min = 0) = 1e4 "Force per speed of extension";
  parameter Real backlash(unit = "m", min = 0) = 0 "Width of the gap: the lost motion";
  TranslationalFlange a "Driving side";
  TranslationalFlange b "Driven side";
  Real extension(unit = "m") "How far a is ahead of b";
  Real rate(unit = "m/s") "Speed of the extension";
  Real force(unit = "N") "Force of a on b";
equation
  extension = a.s - b.s;
  rate = der(extension);
  force = deadZone(stiffness*extension + damping*rate, stiffness*backlash/2);
  a.f = force;
  b.f = -force;
  annotation(Documentation(info = "<html>
<p>The dead zone is taken of the force and not of the extension: the force is continuous, never
pulls the sides together, and without backlash it is the linear spring and damper. As oil in the gap
would, it begins damping/stiffness*rate before the sides touch (1 um at 10 mm/s and 100 us).</p>
</html>"));
end BacklashSpring;
