within MotionControl;
model Pen "Pen on a flange, over a level sheet of paper"
  parameter Real length(unit = "m") = 0.15 "From flange to tip, along z";
  parameter Real paper(unit = "m") = 0 "Height of the paper over the base";
  parameter Real stiffness(unit = "N/m", min = 0) = 1e3 "Of the pen's spring";
  input Real force[3](each unit = "N") "Force on the tip from outside, in base axes";
  input Real place[3](each unit = "m") "Origin of the flange, in base axes";
  input Real turn[3,3](each unit = "1") "From axes of the flange to base axes";
  Frame a "Flange";
  Real tip[3](each unit = "m") "Tip with the spring relaxed, in base axes";
  Real press(unit = "N") "Force of the paper on the pen";
protected
  Real push[3](each unit = "N") "All force on the tip, in base axes";
  Real own[3](each unit = "N") "The same in axes of the flange";
equation
  for i in 1:3 loop
    tip[i] = place[i] + turn[i,3]*length;
    push[i] = if i == 3 then force[i] + press else force[i];
    own[i] = turn[1,i]*push[1] + turn[2,i]*push[2] + turn[3,i]*push[3];
    a.f[i] = -own[i];
  end for;
  press = stiffness*max(paper - tip[3], 0);
  a.t[1] = length*own[2];
  a.t[2] = -length*own[1];
  a.t[3] = 0;
end Pen;
