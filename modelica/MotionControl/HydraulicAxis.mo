within MotionControl;
model HydraulicAxis
  "Hydraulic axis: servo amplifier and valve, double-acting cylinder, mass, end stops, scale"
  parameter Real amplifier_gain(unit = "A/V") = 4e-3 "Valve current per volt of command";
  parameter Real current_limit(unit = "A", min = 1e-9) = 0.04 "Largest valve current, both ways";
  parameter Real current_time(unit = "s", min = 0) = 2e-4 "Time constant of the valve current";
  parameter Real rated_current(unit = "A", min = 1e-9) = 0.04 "Current for the full spool stroke";
  parameter Real valve_frequency(unit = "rad/s", min = 1e-9) = 500
    "Natural frequency of the spool";
  parameter Real valve_damping(unit = "1", min = 0) = 0.8 "Damping ratio of the spool";
  parameter Real valve_overlap(unit = "1", min = 0, max = 0.5) = 0.03
    "Deadband: stroke at which an edge opens, as a share of the full stroke";
  parameter Real valve_rounding(unit = "1", min = 1e-9, max = 0.5) = 2e-3
    "Width of the corner of the deadband, as a share of the full stroke";
  parameter Real rated_flow(unit = "m3/s", min = 1e-15) = 1.667e-4
    "Flow through one edge at the full stroke and the rated drop";
  parameter Real rated_drop(unit = "Pa", min = 1) = 35e5 "Rated pressure drop over one edge";
  parameter Real laminar_drop(unit = "Pa", min = 1) = 1e5
    "Pressure drop below which the flow through an edge is laminar";
  parameter Real valve_leakage(unit = "m3.s-1.Pa-1", min = 0) = 3e-13
    "Leakage of each edge per pressure drop";
  parameter Real supply_pressure(unit = "Pa", min = 0) = 140e5 "Gauge pressure of the pump";
  parameter Real tank_pressure(unit = "Pa", min = 0) = 2e5 "Gauge pressure of the return line";
  parameter Real area_a(unit = "m2", min = 1e-9) = 9.46e-4 "Piston area that pushes forwards";
  parameter Real area_b(unit = "m2", min = 1e-9) = 9.46e-4 "Piston area that pushes backwards";
  parameter Real dead_volume_a(unit = "m3", min = 1e-9) = 5e-5 "Oil in the line to chamber a";
  parameter Real dead_volume_b(unit = "m3", min = 1e-9) = 5e-5 "Oil in the line to chamber b";
  parameter Real bulk_modulus(unit = "Pa", min = 1) = 1.2e9 "Stiffness of the oil with its lines";
  parameter Real cylinder_leakage(unit = "m3.s-1.Pa-1", min = 0) = 1e-12
    "Leakage past the piston per pressure difference";
  parameter Real table_mass(unit = "kg", min = 1e-9) = 100 "Mass of piston, table and load";
  parameter Real clearance(unit = "m", min = 0) = 0
    "Lost motion between rod and table; 0: they are one body";
  parameter Real rod_mass(unit = "kg", min = 1e-9) = 5 "Part of the mass on the rod's side of it";
  parameter Real joint_stiffness(unit = "N/m", min = 1) = 1e8
    "Stiffness of rod and table in contact";
  parameter Real joint_damping(unit = "N.s/m", min = 0) = 1e4
    "Damping of rod and table in contact";
  parameter Real table_coulomb(unit = "N", min = 0) = 200 "Friction while sliding fast";
  parameter Real table_static(unit = "N", min = 0) = 300 "Friction at break-away";
  parameter Real table_stribeck_speed(unit = "m/s", min = 1e-9) = 1e-2
    "Speed at which half of static - coulomb is left";
  parameter Real table_viscous(unit = "N.s/m", min = 0) = 1000 "Friction per speed";
  parameter Real table_rest_speed(unit = "m/s", min = 1e-9) = 2e-4 "Speed that counts as rest";
  parameter Real lower_stop(unit = "m") = -0.1 "Lower end of the stroke";
  parameter Real upper_stop(unit = "m") = 0.1 "Upper end of the stroke";
  parameter Real stop_stiffness(unit = "N/m", min = 0) = 1e8 "Stiffness of the end stops";
  parameter Real stop_damping(unit = "s/m", min = 0) = 5
    "Share of the stop's force that 1 m/s of speed adds";
  parameter Real scale_pitch(unit = "m", min = 1e-9) = 2e-5 "Line period of the linear scale";
  parameter Real scale_offset(unit = "m") = 0 "Position at which the scale's phase is 0";
  parameter Real home_position(unit = "m") = -0.08 "The home switch is on from here downwards";
  parameter Real start_position(unit = "m") = 0 "Position at the start";
  input Real voltage(unit = "V", start = 0) "Command to the amplifier";
  input Real force(unit = "N", start = 0) "External force on the table";
  output Real table_phase(unit = "1") "Linear scale on the table [line periods]";
  output Real table_position(unit = "m") "Table position";
  output Real table_speed(unit = "m/s") "Table speed";
  output Real current(unit = "A") "Valve current";
  output Real spool(unit = "1") "Spool position as a share of the full stroke";
  output Real pressure_a(unit = "Pa") "Pressure in chamber a";
  output Real pressure_b(unit = "Pa") "Pressure in chamber b";
  output Real flow_a(unit = "m3/s") "Oil from the valve into chamber a";
  output Real flow_b(unit = "m3/s") "Oil from the valve into chamber b";
  output Real supply_flow(unit = "m3/s") "Oil taken from the pump";
  output Real stop_force(unit = "N") "Force of the end stops on the piston";
  output Boolean home_switch "Home switch: the table is at or below the home position";
  output Real rod_position(unit = "m") "Position of piston and rod";
  output Real rod_phase(unit = "1") "A scale like that of the table, on the rod [line periods]";
protected
  ServoAmplifier amplifier(gain = amplifier_gain, limit = current_limit, tau = current_time)
    "Amplifier of the valve";
  PressureSource pump(pressure = supply_pressure) "Pump";
  PressureSource tank(pressure = tank_pressure) "Return line";
  ServoValve valve(rated_current = rated_current, frequency = valve_frequency,
    damping = valve_damping, overlap = valve_overlap, rounding = valve_rounding,
    rated_flow = rated_flow, rated_drop = rated_drop, laminar_drop = laminar_drop,
    leakage = valve_leakage) "Four-way valve";
  Cylinder cylinder(area_a = area_a, area_b = area_b, lower_end = lower_stop,
    upper_end = upper_stop, dead_volume_a = dead_volume_a, dead_volume_b = dead_volume_b,
    bulk_modulus = bulk_modulus, leakage = cylinder_leakage,
    large_pressure = supply_pressure,
    start_pressure_a = (supply_pressure + tank_pressure)*area_b/(area_a + area_b),
    start_pressure_b = (supply_pressure + tank_pressure)*area_a/(area_a + area_b)) "Cylinder";
  Slide table(mass = if clearance > 0 then table_mass - rod_mass else table_mass,
    coulomb = table_coulomb, static = table_static, stribeck_speed = table_stribeck_speed,
    viscous = table_viscous, rest_speed = table_rest_speed,
    start_position = start_position, position(nominal = upper_stop - lower_stop),
    speed(nominal = rated_flow/area_a*sqrt((supply_pressure - tank_pressure)/(2*rated_drop))))
    "Table";
  Clearance joint(mass = rod_mass, stiffness = joint_stiffness, damping = joint_damping,
    clearance = clearance, ahead(nominal = upper_stop - lower_stop),
    rate(nominal = rated_flow/area_a*sqrt((supply_pressure - tank_pressure)/(2*rated_drop))))
    "Between rod and table";
  EndStops stops(lower = lower_stop, upper = upper_stop, stiffness = stop_stiffness,
    damping = stop_damping) "Both ends";
  LinearScale scale(pitch = scale_pitch, offset = scale_offset) "On the table";
  LinearScale rod_scale(pitch = scale_pitch, offset = scale_offset) "On the rod";
equation
  assert(table_static >= table_coulomb, "table_static must not be below table_coulomb");
  assert(upper_stop > lower_stop, "upper_stop must be above lower_stop");
  assert(start_position >= lower_stop and start_position <= upper_stop,
    "start_position must be between lower_stop and upper_stop");
  assert(clearance <= 0 or rod_mass < table_mass, "rod_mass must be below table_mass");
  assert(supply_pressure > tank_pressure, "supply_pressure must be above tank_pressure");
  connect(pump.port, valve.supply);
  connect(tank.port, valve.tank);
  connect(valve.a, cylinder.a);
  connect(valve.b, cylinder.b);
  connect(cylinder.rod, joint.a);
  connect(stops.flange, joint.a);
  connect(joint.b, table.flange);
  amplifier.voltage = voltage;
  valve.current = amplifier.current;
  table.load = force;
  joint.acceleration = der(table.speed);
  scale.position = table.position;
  rod_scale.position = joint.a.s;
  table_phase = scale.phase;
  table_position = table.position;
  table_speed = table.speed;
  current = amplifier.current;
  spool = valve.stroke;
  pressure_a = cylinder.pressure_a;
  pressure_b = cylinder.pressure_b;
  flow_a = cylinder.a.q;
  flow_b = cylinder.b.q;
  supply_flow = valve.supply.q;
  stop_force = stops.force;
  home_switch = table.position <= home_position;
  rod_position = joint.a.s;
  rod_phase = rod_scale.phase;
end HydraulicAxis;
