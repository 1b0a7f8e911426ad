within MotionControl;
model Pen "Pen over a level sheet of paper"
  parameter Real length(unit = "m") = 0.15 "From its foot to its tip";
  parameter Real foot[3](each unit = "m") = {0, 0, 0} "Its foot on the flange";
  parameter Real along[3](each unit = "1") = {0, 0, 1} "Its direction";
  parameter Real paper(unit = "m") = 0 "Height of the paper over the base";
  parameter Real stiffness(unit = "N/m", min = 0) = 1e3 "Of the pen's spring";
  final parameter Real arm[3](each unit = "m") = foot + length*along "Tip, in axes of the flange";
  input Real force[3](each unit = "N") "Force on the tip from outside, in base axes";
  input Real tip[3](each unit = "m") "Tip with the spring relaxed, in base axes";
  output Real push[3](each unit = "N") "All force on the tip, in base axes";
  Real press(unit = "N") "Force of the paper on the pen";
equation
  for i in 1:3 loop
    push[i] = if i == 3 then force[i] + press else force[i];
  end for;
  press = stiffness*max(paper - tip[3], 0);
end Pen;
