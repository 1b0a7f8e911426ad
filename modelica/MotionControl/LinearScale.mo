within MotionControl;
block LinearScale "Incremental scale along the guide"
  parameter Real pitch(unit = "m") = 2e-5 "Length of one line period";
  input Real position(unit = "m") "Position of the reading head";
  output Real phase(unit = "1") "Line periods passed";
equation
  phase = position/pitch;
end LinearScale;
