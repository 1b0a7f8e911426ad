within MotionControl;
block LinearScale "Incremental scale along the guide"
  parameter Real pitch(unit = "m") = 2e-5 "Length of one line period";
  parameter Real offset(unit = "m") = 0 "Position at which the phase is 0";
  input Real position(unit = "m") "Position of the reading head";
  output Real phase(unit = "1") "Line periods passed";
equation
  phase = (position - offset)/pitch;
end LinearScale;
