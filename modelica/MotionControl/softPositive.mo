within MotionControl;
function softPositive "Positive part, its corner rounded"
  input Real u(unit = "1") "Input";
  input Real width(unit = "1") "Width of the corner, in the unit of u";
  output Real y(unit = "1") "About max(u, 0); width/2 at the corner";
algorithm
  y := 0.5*(u + sqrt(u^2 + width^2));
  annotation(Inline = true, Documentation(info = "<html>
<p>Too large by width^2/(4 |u|) far from the corner. No branch: its slope is known everywhere.</p>
</html>"));
end softPositive;
