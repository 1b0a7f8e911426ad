within MotionControl;
function directedFriction "Friction that differs by direction, smooth at rest"
  input Real v(unit = "1") "Speed, in the unit of v_rest";
  input Real coulomb(unit = "1") "Friction while sliding fast, mean of both directions";
  input Real static(unit = "1") "Friction at break-away, mean of both directions";
  input Real v_stribeck(unit = "1") "Speed at which half of the excess static - coulomb is left";
  input Real viscous(unit = "1") "Friction per speed, mean of both directions";
  input Real v_rest(unit = "1") "Speed below which the part counts as at rest";
  input Real level_more(unit = "1") "Share of coulomb and static more forwards, less backwards";
  input Real viscous_more(unit = "1") "Share of viscous more forwards, less backwards";
  output Real f(unit = "1") "Friction, against the motion where it is subtracted";
protected
  Real s(unit = "1") "Direction: the sign of v, smooth at rest";
algorithm
  s := v/sqrt(v^2 + v_rest^2);
  f := s*(coulomb + (static - coulomb)/(1 + (v/v_stribeck)^2))*(1 + level_more*s)
    + viscous*v*(1 + viscous_more*s);
  annotation(Inline = true, Documentation(info = "<html>
<p>That of friction, to the bit where both shares are 0. What the direction adds is even in v and
vanishes at rest with v_rest, so neither the slope there nor the choice of v_rest changes.</p>
</html>"));
end directedFriction;
