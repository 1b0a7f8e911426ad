within MotionControl;
model VelocityAxis "Velocity-controlled axis: a voltage sets the speed after a first-order lag"
  parameter Real speed_per_volt(unit = "rpm/V") = 300 "Motor speed per volt";
  parameter Real tau(unit = "s", min = 0) = 0
    "Time constant of the speed; 0 makes the axis a pure integrator";
  parameter Real lead(unit = "m", min = 1e-9) = 0.01 "Travel of the table per motor turn";
  parameter Integer encoder_lines(min = 1) = 2500 "Line periods of the motor encoder per turn";
  parameter Real scale_pitch(unit = "m", min = 1e-9) = 2e-5 "Line period of the linear scale";
  parameter Real start_position(unit = "m") = 0 "Table position at the start";
  input Real voltage(unit = "V", start = 0) "Velocity command";
  output Real motor_angle(unit = "rad", start = 2*pi*start_position/lead, fixed = true)
    "Motor angle";
  output Real motor_speed(unit = "rad/s") "Motor speed";
  output Real motor_phase(unit = "1") "Motor encoder [line periods]";
  output Real table_position(unit = "m") "Table position";
  output Real table_speed(unit = "m/s") "Table speed";
  output Real table_phase(unit = "1") "Linear scale [line periods]";
protected
  Lag speed_loop(tau = tau) "Velocity loop of the drive";
  RotaryEncoder encoder(lines = encoder_lines) "On the motor shaft";
  LinearScale scale(pitch = scale_pitch) "On the table";
equation
  speed_loop.u = speed_per_volt*(2*pi/60)*voltage;
  motor_speed = speed_loop.y;
  der(motor_angle) = motor_speed;
  table_position = lead/(2*pi)*motor_angle;
  table_speed = lead/(2*pi)*motor_speed;
  encoder.angle = motor_angle;
  motor_phase = encoder.phase;
  scale.position = table_position;
  table_phase = scale.phase;
end VelocityAxis;
