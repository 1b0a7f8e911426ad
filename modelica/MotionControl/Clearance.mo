within MotionControl;
model Clearance
  "Mass that drives another across a clearance; without clearance the two are one body"
  parameter Real mass(unit = "kg", min = 0) = 5 "Mass on the driving side";
  parameter Real stiffness(unit = "N/m", min = 0) = 1e8 "Of the contact";
  parameter Real damping(unit = "N.s/m", min = 0) = 1e4 "Of the contact";
  parameter Real clearance(unit = "m", min = 0) = 0 "Lost motion; 0 makes the joint rigid";
  input Real acceleration(unit = "m/s2") "Of the driven side";
  TranslationalFlange a "Driving side";
  TranslationalFlange b "Driven side";
  Real ahead(unit = "m", start = 0, fixed = true) "How far a is ahead of b: 0 in the middle";
  Real rate(unit = "m/s", start = 0, fixed = true) "Its change";
  Real push(unit = "N") "Force of a on b as if there were no clearance";
  Real contact(unit = "N") "Force of a on b across it";
equation
  a.s = b.s + ahead;
  der(ahead) = rate;
  push = stiffness*ahead + damping*rate;
  contact = deadZone(push, stiffness*clearance/2);
  der(rate) = if clearance > 0 then (a.f - contact)/mass - acceleration else -push/mass;
  b.f = if clearance > 0 then -contact else -a.f;
  annotation(Documentation(info = "<html>
<p>The contact is that of BacklashSpring: it never pulls. The place of a is told by that of b and
how far a is ahead. So a rigid joint leaves the equation of b as it is without a joint, to the bit.
All force goes to b, whose mass then is that of both. What is left here is a damped oscillator that
nothing moves.</p>
</html>"));
end Clearance;
