within MotionControl;
model StepperAxis "Stepping motor with a table on a screw: follows its pulses, or loses steps"
  parameter Integer pulses_per_turn(min = 1) = 3200
    "Pulses per motor turn: 200 are full steps of a motor with 50 teeth, 3200 sixteenths";
  parameter Integer rotor_teeth(min = 1) = 50
    "Periods of the torque per turn, of four full steps each";
  parameter Real holding_torque(unit = "N.m", min = 0) = 1.2 "Largest torque at rest";
  parameter Real detent_torque(unit = "N.m", min = 0) = 0
    "Torque without current, four periods in one of the field";
  parameter Real winding_time(unit = "s", min = 1e-6) = 2e-4
    "Time constant of the current: inductance times holding current over voltage of the drive";
  parameter Real emf_speed(unit = "rad/s", min = 1e-9) = 110
    "Speed at which the back EMF is the voltage of the drive";
  parameter Real rotor_inertia(unit = "kg.m2", min = 1e-9) = 3e-5 "Moment of inertia of the rotor";
  parameter Real load_inertia(unit = "kg.m2", min = 0) = 1e-5 "Moment of inertia of the screw";
  parameter Real motor_coulomb(unit = "N.m", min = 0) = 0.02 "Friction torque of motor and screw";
  parameter Real motor_viscous(unit = "N.m.s/rad", min = 0) = 2e-4
    "Friction torque of motor and screw per speed";
  parameter Real motor_rest_speed(unit = "rad/s", min = 1e-9) = 0.05
    "Speed that counts as rest, see friction";
  parameter Real lead(unit = "m", min = 1e-9) = 0.005 "Travel of the table per motor turn";
  parameter Real table_mass(unit = "kg", min = 0) = 5 "Mass of the table with its load";
  parameter Real table_coulomb(unit = "N", min = 0) = 5 "Friction of the table";
  parameter Real table_viscous(unit = "N.s/m", min = 0) = 20 "Friction of the table per speed";
  parameter Real home_position(unit = "m") = -0.45 "The home switch is on from here downwards";
  parameter Real lower_limit_position(unit = "m") = -0.5
    "The lower limit switch is on from here downwards";
  parameter Real upper_limit_position(unit = "m") = 0.5
    "The upper limit switch is on from here upwards";
  parameter Real start_position(unit = "m") = 0 "Table position at the start";
  input Integer pulse_count(start = 0) "Pulses received, forward minus backward";
  input Boolean enable(start = true) "The drive gives the motor current";
  input Real force(unit = "N", start = 0) "External force on the table";
  output Real motor_torque(unit = "N.m") "Torque of the motor";
  output Real torque_margin(unit = "N.m") "Pull-out torque at this speed less the motor's torque";
  output Real motor_angle(unit = "rad") "Motor angle";
  output Real motor_speed(unit = "rad/s") "Motor speed";
  output Real following_error(unit = "1") "Full steps from the motor to its command";
  output Real lost_steps(unit = "1") "Full steps lost: multiples of 4";
  output Real table_position(unit = "m") "Table position";
  output Real table_speed(unit = "m/s") "Table speed";
  output Boolean home_switch "Table is at or below the home position";
  output Boolean lower_limit "Table is at or below the lower limit";
  output Boolean upper_limit "Table is at or above the upper limit";
protected
  final parameter Real ratio(unit = "m") = lead/(2*pi) "Travel of the table per radian";
  Real turned(unit = "rad", start = 0, fixed = true) "Angle from the start";
  Real speed(unit = "rad/s", start = 0, fixed = true) "Speed of the motor";
  Real command(unit = "rad") "Angle that the pulses ask for";
  SteppingMotor motor(rotor_teeth = rotor_teeth, holding_torque = holding_torque,
    detent_torque = detent_torque, winding_time = winding_time, emf_speed = emf_speed) "Motor";
equation
  assert(upper_limit_position > lower_limit_position,
    "upper_limit_position must be above lower_limit_position");
  command = 2*pi*pulse_count/pulses_per_turn;
  motor.field = rotor_teeth*command;
  motor.on = if enable then 1 else 0;
  motor.angle = turned;
  motor.speed = speed;
  der(turned) = speed;
  (rotor_inertia + load_inertia + table_mass*ratio^2)*der(speed) = motor.torque + ratio*force
    - friction(speed, motor_coulomb + ratio*table_coulomb, motor_coulomb + ratio*table_coulomb, 1,
      motor_viscous + ratio^2*table_viscous, motor_rest_speed);
  motor_torque = motor.torque;
  torque_margin = motor.pull_out - abs(motor.torque);
  motor_angle = turned + start_position/ratio;
  motor_speed = speed;
  following_error = 2*rotor_teeth*(command - turned)/pi;
  lost_steps = 4*floor(following_error/4 + 0.5);
  table_position = start_position + ratio*turned;
  table_speed = ratio*speed;
  home_switch = table_position <= home_position;
  lower_limit = table_position <= lower_limit_position;
  upper_limit = table_position >= upper_limit_position;
end StepperAxis;
