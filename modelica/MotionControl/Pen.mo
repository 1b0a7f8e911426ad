within MotionControl;
model Pen "Pen on a flange, over a level sheet of paper"
  parameter Real length(unit = "m") = 0.15 "From its foot to its tip";
  parameter Real foot[3](each unit = "m") = {0, 0, 0} "Its foot on the flange";
  parameter Real along[3](each unit = "1") = {0, 0, 1} "Its direction";
  parameter Real paper(unit = "m") = 0 "Height of the paper over the base";
  parameter Real stiffness(unit = "N/m", min = 0) = 1e3 "Of the pen's spring";
  input Real force[3](each unit = "N") "Force on the tip from outside, in base axes";
  input Real place[3](each unit = "m") "Origin of the flange, in base axes";
  input Real turn[3,3](each unit = "1") "From axes of the flange to base axes";
  Frame a "Flange";
  Real tip[3](each unit = "m") "Tip with the spring relaxed, in base axes";
  Real press(unit = "N") "Force of the paper on the pen";
protected
  final parameter Real arm[3](each unit = "m") = foot + length*along "Tip, in axes of the flange";
  Real push[3](each unit = "N") "All force on the tip, in base axes";
  Real own[3](each unit = "N") "The same in axes of the flange";
equation
  for i in 1:3 loop
    tip[i] = place[i] + turn[i,1]*arm[1] + turn[i,2]*arm[2] + turn[i,3]*arm[3];
    push[i] = if i == 3 then force[i] + press else force[i];
    own[i] = turn[1,i]*push[1] + turn[2,i]*push[2] + turn[3,i]*push[3];
    a.f[i] = -own[i];
  end for;
  press = stiffness*max(paper - tip[3], 0);
  a.t[1] = arm[3]*own[2] - arm[2]*own[3];
  a.t[2] = arm[1]*own[3] - arm[3]*own[1];
  a.t[3] = arm[2]*own[1] - arm[1]*own[2];
end Pen;
