within MotionControl;
model BallScrewAxis
  "Ball-screw axis: motor, compliant screw with backlash, table, friction on both sides"
  parameter Real current_time(unit = "s", min = 0) = 5e-4
    "Time constant of the current loop; 0 makes it ideal";
  parameter Real motor_inertia(unit = "kg.m2", min = 1e-9) = 2e-3
    "Moment of inertia of motor and screw";
  parameter Real motor_coulomb(unit = "N.m", min = 0) = 0.15
    "Motor side: friction while turning fast";
  parameter Real motor_static(unit = "N.m", min = 0) = 0.2 "Motor side: friction at break-away";
  parameter Real motor_stribeck_speed(unit = "rad/s", min = 1e-9) = 1
    "Motor side: speed at which half of static - coulomb is left";
  parameter Real motor_viscous(unit = "N.m.s/rad", min = 0) = 2e-3 "Motor side: friction per speed";
  parameter Real motor_rest_speed(unit = "rad/s", min = 1e-9) = 5e-3
    "Motor side: speed that counts as rest";
  parameter Real lead(unit = "m", min = 1e-9) = 0.01 "Travel of the nut per turn";
  parameter Real lead_error_slope(unit = "1") = 0 "Error of the travel per travel";
  parameter Real lead_error_amplitude(unit = "m") = 0 "Amplitude of a wave of the error";
  parameter Real lead_error_period(unit = "m", min = 1e-9) = 0.01 "Period of the wave";
  parameter Real lead_error_phase(unit = "rad") = 0 "Phase of the wave at position 0";
  parameter Real screw_stiffness(unit = "N/m", min = 0) = 1e8 "Axial stiffness from motor to table";
  parameter Real screw_damping(unit = "N.s/m", min = 0) = 1e4 "Axial damping from motor to table";
  parameter Real backlash(unit = "m", min = 0) = 0 "Lost motion between nut and table";
  parameter Real table_mass(unit = "kg", min = 1e-9) = 100 "Mass of the table with its load";
  parameter Real table_coulomb(unit = "N", min = 0) = 50 "Table side: friction while sliding fast";
  parameter Real table_static(unit = "N", min = 0) = 70 "Table side: friction at break-away";
  parameter Real table_stribeck_speed(unit = "m/s", min = 1e-9) = 2e-3
    "Table side: speed at which half of static - coulomb is left";
  parameter Real table_viscous(unit = "N.s/m", min = 0) = 200 "Table side: friction per speed";
  parameter Real table_coulomb_asymmetry(unit = "1", min = -1, max = 1) = 0
    "Table side: share of coulomb and static more forwards, less backwards";
  parameter Real table_viscous_asymmetry(unit = "1", min = -1, max = 1) = 0
    "Table side: share of viscous more forwards, less backwards";
  parameter Real table_rest_speed(unit = "m/s", min = 1e-9) = 2e-5
    "Table side: speed that counts as rest";
  parameter Integer encoder_lines(min = 1) = 2500 "Line periods of the motor encoder per turn";
  parameter Real scale_pitch(unit = "m", min = 1e-9) = 2e-5 "Line period of the linear scale";
  parameter Real home_position(unit = "m") = -0.45 "The home switch is on from here downwards";
  parameter Real lower_limit_position(unit = "m") = -0.5
    "The lower limit switch is on from here downwards";
  parameter Real upper_limit_position(unit = "m") = 0.5
    "The upper limit switch is on from here upwards";
  parameter Real start_position(unit = "m") = 0
    "Table position at the start but for the lead error, the backlash centred";
  input Real torque_command(unit = "N.m", start = 0) "Torque asked of the current loop";
  input Real force(unit = "N", start = 0) "External force on the table";
  output Real motor_torque(unit = "N.m") "Torque of the motor";
  output Real motor_angle(unit = "rad") "Motor angle";
  output Real motor_speed(unit = "rad/s") "Motor speed";
  output Real motor_phase(unit = "1") "Motor encoder [line periods]";
  output Boolean index "Motor encoder is at its index mark";
  output Real table_position(unit = "m") "Table position";
  output Real table_speed(unit = "m/s") "Table speed";
  output Real table_phase(unit = "1") "Linear scale [line periods]";
  output Real screw_force(unit = "N") "Force of the nut on the table";
  output Boolean home_switch "Table is at or below the home position";
  output Boolean lower_limit "Table is at or below the lower limit";
  output Boolean upper_limit "Table is at or above the upper limit";
protected
  Lag current_loop(tau = current_time) "Current loop of the drive";
  Rotor rotor(inertia = motor_inertia, coulomb = motor_coulomb, static = motor_static,
    stribeck_speed = motor_stribeck_speed, viscous = motor_viscous, rest_speed = motor_rest_speed,
    start_angle = 2*pi*start_position/lead) "Motor and screw";
  Screw screw(lead = lead) "Screw and nut";
  BacklashSpring spring(stiffness = screw_stiffness, damping = screw_damping, backlash = backlash)
    "Compliance of screw, bearings and nut";
  Slide table(mass = table_mass, coulomb = table_coulomb, static = table_static,
    stribeck_speed = table_stribeck_speed, viscous = table_viscous, rest_speed = table_rest_speed,
    coulomb_asymmetry = table_coulomb_asymmetry, viscous_asymmetry = table_viscous_asymmetry,
    start_position = start_position) "Table";
  LeadError error(slope = lead_error_slope, amplitude = lead_error_amplitude,
    period = lead_error_period, start_phase = lead_error_phase) "Error of the screw";
  RotaryEncoder encoder(lines = encoder_lines) "On the motor shaft";
  LinearScale scale(pitch = scale_pitch) "On the table";
equation
  assert(motor_static >= motor_coulomb, "motor_static must not be below motor_coulomb");
  assert(table_static >= table_coulomb, "table_static must not be below table_coulomb");
  assert(upper_limit_position > lower_limit_position,
    "upper_limit_position must be above lower_limit_position");
  connect(rotor.flange, screw.shaft);
  connect(screw.nut, spring.a);
  connect(spring.b, table.flange);
  current_loop.u = torque_command;
  rotor.drive = current_loop.y;
  table.load = force;
  encoder.angle = rotor.angle;
  error.nominal = table.position;
  error.nominal_speed = table.speed;
  scale.position = error.position;
  motor_torque = current_loop.y;
  motor_angle = rotor.angle;
  motor_speed = rotor.speed;
  motor_phase = encoder.phase;
  index = encoder.index;
  table_position = error.position;
  table_speed = error.speed;
  table_phase = scale.phase;
  screw_force = spring.force;
  home_switch = error.position <= home_position;
  lower_limit = error.position <= lower_limit_position;
  upper_limit = error.position >= upper_limit_position;
end BallScrewAxis;
