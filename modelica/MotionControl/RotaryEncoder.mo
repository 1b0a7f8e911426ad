within MotionControl;
block RotaryEncoder "Incremental encoder on a shaft, with one index mark per turn"
  parameter Integer lines(min = 1) = 2500 "Line periods per turn";
  input Real angle(unit = "rad") "Angle of the shaft";
  output Real phase(unit = "1") "Line periods passed";
  output Boolean index "Within half a line period of the index mark";
protected
  Real turns(unit = "1") "Turns passed";
equation
  turns = angle/(2*pi);
  phase = lines*turns;
  index = abs(turns - floor(turns + 0.5))*lines <= 0.5;
end RotaryEncoder;
