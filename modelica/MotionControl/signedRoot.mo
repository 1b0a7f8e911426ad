within MotionControl;
function signedRoot "Square root with the sign of its argument, straight near zero"
  input Real u(unit = "1") "Input";
  input Real straight(unit = "1") "Below this |u| the root is straight, in the unit of u";
  output Real y(unit = "1") "sign(u) sqrt(|u|) for |u| far above straight";
algorithm
  y := u/sqrt(sqrt(u^2 + straight^2));
  annotation(Inline = true, Documentation(info = "<html>
<p>The flow through an orifice is laminar at small pressure drops, so its slope at zero is finite:
1/sqrt(straight). Short of the root by (straight/u)^2/4, so by 0.25 % at ten times straight.</p>
</html>"));
end signedRoot;
