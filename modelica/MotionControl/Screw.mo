within MotionControl;
model Screw "Ideal screw: one turn moves the nut by the lead"
  parameter Real lead(unit = "m") = 0.01 "Travel per turn";
  RotationalFlange shaft "Shaft";
  TranslationalFlange nut "Nut";
equation
  nut.s = lead/(2*pi)*shaft.phi;
  shaft.tau = -lead/(2*pi)*nut.f "Power in is power out";
end Screw;
