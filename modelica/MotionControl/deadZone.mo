within MotionControl;
function deadZone "Zero within a band, beside it the distance from the band"
  input Real u(unit = "1") "Input";
  input Real band(unit = "1") "Half the width of the band, >= 0";
  output Real y(unit = "1") "u beyond the band";
algorithm
  y := u - min(max(u, -band), band);
  annotation(Inline = true);
end deadZone;
