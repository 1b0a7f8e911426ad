within MotionControl;
model PenMount "Flange with a pen: where the tip is, and what a force on it asks for"
  parameter Real arm[3](each unit = "m") = {0, 0, 0.15} "Tip, in axes of the flange";
  input Real place[3](each unit = "m") "Origin of the flange, in base axes";
  input Real turn[3,3](each unit = "1") "From axes of the flange to base axes";
  input Real push[3](each unit = "N") "Force on the tip, in base axes";
  output Real tip[3](each unit = "m") "Tip, in base axes";
  Frame a "Flange";
protected
  Real own[3](each unit = "N") "Force on the tip, in axes of the flange";
equation
  for i in 1:3 loop
    tip[i] = place[i] + turn[i,1]*arm[1] + turn[i,2]*arm[2] + turn[i,3]*arm[3];
    own[i] = turn[1,i]*push[1] + turn[2,i]*push[2] + turn[3,i]*push[3];
    a.f[i] = -own[i];
  end for;
  a.t[1] = arm[3]*own[2] - arm[2]*own[3];
  a.t[2] = arm[1]*own[3] - arm[3]*own[1];
  a.t[3] = arm[2]*own[1] - arm[1]*own[2];
end PenMount;
