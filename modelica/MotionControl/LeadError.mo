within MotionControl;
block LeadError "Where a screw whose lead is not exact puts the table"
  parameter Real slope(unit = "1") = 0 "Travel too much per travel";
  parameter Real amplitude(unit = "m") = 0 "Amplitude of the wave on it";
  parameter Real period(unit = "m", min = 1e-9) = 0.01 "Period of the wave";
  parameter Real start_phase(unit = "rad") = 0 "Phase of the wave at position 0";
  input Real nominal(unit = "m") "Position of the table if the lead were exact";
  input Real nominal_speed(unit = "m/s") "Its speed";
  output Real position(unit = "m") "Position";
  output Real speed(unit = "m/s") "Speed";
protected
  Real phase(unit = "rad") "Phase of the wave";
equation
  phase = 2*pi*nominal/period + start_phase;
  position = nominal + (slope*nominal + amplitude*sin(phase));
  speed = nominal_speed*(1 + (slope + amplitude*2*pi/period*cos(phase)));
  annotation(Documentation(info = "<html>
<p>Geometry only: the table moves as if the lead were exact, and is shown where it really stands.
What this leaves out is small. Of the force on the motor that is the slope (1e-4; 6e-3 with a wave
of 10 um and 10 mm). And it is the force that takes the table along the wave, amplitude
(2 pi v/period)^2 mass.</p>
</html>"));
end LeadError;
