within MotionControl;
function friction "Coulomb, Stribeck and viscous friction, smooth at rest"
  input Real v(unit = "1") "Speed, in the unit of v_rest";
  input Real coulomb(unit = "1") "Friction while sliding fast";
  input Real static(unit = "1") "Friction at break-away";
  input Real v_stribeck(unit = "1") "Speed at which half of the excess static - coulomb is left";
  input Real viscous(unit = "1") "Friction per speed";
  input Real v_rest(unit = "1") "Speed below which the part counts as at rest";
  output Real f(unit = "1") "Friction, against the motion where it is subtracted";
algorithm
  f := v/sqrt(v^2 + v_rest^2)*(coulomb + (static - coulomb)/(1 + (v/v_stribeck)^2)) + viscous*v;
  annotation(Inline = true, Documentation(info = "<html>
<p>The level between break-away and sliding is that of Hess and Soom (1990), a rational function.
The sign of the speed is replaced by v/sqrt(v^2 + v_rest^2): it costs one root and no library call,
and is short of 1 by (v_rest/v)^2/2, so by 0.5 % at ten times v_rest.</p>
<p>Choice of v_rest for a mass m. The slope at rest is static/v_rest, so the part has a mode of
-static/(m v_rest). The classic Runge-Kutta method with step h is stable to h lambda = -2.785 and
shrinks the mode to 1/3 per step at -2; so v_rest should be h static/(2 m) or more. For 70 N, 100 kg
and 25 us that is 8.75 um/s. A smaller value is integrated with smaller steps. Under a load F below
static the part does not stand still: it creeps at v_rest F/sqrt(static^2 - F^2).</p>
</html>"));
end friction;
