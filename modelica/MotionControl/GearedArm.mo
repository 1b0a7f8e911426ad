within MotionControl;
partial model GearedArm
  "Arm of six joints: motors, gears, payload, pen; a class that extends it places and links them"
  parameter Integer joint_sign[6](each min = -1, each max = 1) = {1, 1, 1, 1, 1, 1}
    "Inner angle = sign * joint angle - offset: 1 or -1";
  parameter Real joint_offset[6](each unit = "deg") = {0, 0, -90, 0, 0, 0}
    "Inner angle = sign * joint angle - offset; at inner 0 the arm points up";
  parameter Real mass[6](each unit = "kg", each min = 0) = {40, 22, 26, 9, 3, 0.6}
    "Masses of the links";
  parameter Real center[6,3](each unit = "m") = {{0.06, 0, -0.12}, {0, 0, 0.32}, {-0.1, 0, 0.02},
    {0, 0, 0.4}, {0, 0, 0.02}, {0, 0, -0.02}}
    "Centres of mass from the joint; axes are those of the base at inner 0";
  parameter Real inertia[6,3](each unit = "kg.m2", each min = 0) = {{0.8223, 0.8223, 0.578},
    {0.9429, 0.9429, 0.0891}, {0.3441, 0.3441, 0.1872}, {0.2781, 0.2781, 0.0162},
    {0.005475, 0.00375, 0.005475}, {0.00032, 0.00032, 0.00048}}
    "Moments of inertia xx, yy, zz about the centres";
  parameter Real product[6,3](each unit = "kg.m2") = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
    {0, 0, 0}, {0, 0, 0}} "The other elements of their tensors: xy, yz, zx";
  parameter Real link_viscous[6](each unit = "N.m.s/rad", each min = 0) =
    {9, 12.5, 6.5, 1.55, 1.55, 0.8} "Friction of the joints per speed";
  parameter Real payload_mass(unit = "kg", min = 0) = 6 "Mass of the payload";
  parameter Real payload_center[3](each unit = "m") = {0, 0, 0.1}
    "Centre of the payload from the flange";
  parameter Real payload_inertia[3](each unit = "kg.m2", each min = 0) = {0.0104, 0.0104, 0.0108}
    "Moments of inertia of the payload xx, yy, zz about its centre";
  parameter Real gravity(unit = "m/s2") = 9.81 "Acceleration of free fall";
  parameter Real gear_ratio[6](each unit = "1", each min = 1) = {100, 120, 120, 100, 100, 80}
    "Turns of the motor per turn of the joint";
  parameter Real stiffness_1[6](each unit = "N.m/rad", each min = 1) =
    {18e4, 25e4, 13e4, 3.1e4, 3.1e4, 1.6e4} "Gear stiffness up to knee_1";
  parameter Real stiffness_2[6](each unit = "N.m/rad", each min = 1) =
    {29e4, 40e4, 20e4, 5e4, 5e4, 2.5e4} "Gear stiffness from knee_1 to knee_2";
  parameter Real stiffness_3[6](each unit = "N.m/rad", each min = 1) =
    {33e4, 44e4, 23e4, 5.7e4, 5.7e4, 2.9e4} "Gear stiffness beyond knee_2";
  parameter Real knee_1[6](each unit = "N.m", each min = 0) = {76, 108, 54, 14, 14, 7}
    "Torque at which a gear gets stiffer";
  parameter Real knee_2[6](each unit = "N.m", each min = 0) = {275, 382, 196, 48, 48, 25}
    "Torque at which a gear gets stiffer again";
  parameter Real gear_damping[6](each unit = "N.m.s/rad", each min = 0) =
    {360, 500, 260, 62, 62, 32} "Torque of a gear per speed of its wind-up";
  parameter Real lost_motion[6](each unit = "rad", each min = 0) =
    {8.727e-4, 8.727e-4, 8.727e-4, 8.727e-4, 8.727e-4, 8.727e-4}
    "Wind-up without torque, both ways together; 3 arcmin";
  parameter Real transmission_error_1[6](each unit = "rad", each min = 0) =
    {5.82e-5, 5.82e-5, 5.82e-5, 5.82e-5, 5.82e-5, 5.82e-5}
    "Amplitude of the gear's error once per motor turn, at the joint; 0.2 arcmin";
  parameter Real transmission_error_2[6](each unit = "rad", each min = 0) =
    {8.73e-5, 8.73e-5, 8.73e-5, 8.73e-5, 8.73e-5, 8.73e-5}
    "Amplitude of the gear's error twice per motor turn, at the joint; 0.3 arcmin";
  parameter Real transmission_phase_1[6](each unit = "rad") =
    {0.5381, 1.488, 5.035, 3.658, 0.5914, 2.721} "Phase of the error once per motor turn";
  parameter Real transmission_phase_2[6](each unit = "rad") =
    {3.01, 1.004, 4.615, 0.7142, 2.458, 3.247} "Phase of the error twice per motor turn";
  parameter Real zero_error[6](each unit = "rad") =
    {-2.02e-4, -6.6e-5, 2.01e-4, 1.32e-4, 2.1e-5, 1.53e-4}
    "How far the joints are ahead of where their motors say; 0.5 arcmin rms";
  parameter Real origin_error[6,3](each unit = "m") = {{-7.1e-5, -1.69e-4, -2.68e-4},
    {-9.9e-5, 1.22e-4, -6.1e-5}, {2.43e-4, -5.1e-5, 6e-6}, {3.92e-4, 1.38e-4, -1.28e-4},
    {-4.6e-5, 1.37e-4, 4.91e-4}, {-6.8e-5, -6.2e-5, 2.54e-4}}
    "How far each joint is beside its place in the link before; 0.2 mm rms";
  parameter Real motor_inertia[6](each unit = "kg.m2", each min = 1e-9) =
    {6e-4, 6e-4, 3.5e-4, 0.6e-4, 0.6e-4, 0.3e-4} "Motor and wave generator";
  parameter Real motor_coulomb[6](each unit = "N.m", each min = 0) =
    {0.1, 0.1, 0.067, 0.028, 0.028, 0.024} "Friction at the motor while turning fast";
  parameter Real motor_static[6](each unit = "N.m", each min = 0) =
    {0.13, 0.13, 0.088, 0.04, 0.04, 0.035} "Friction at the motor at break-away";
  parameter Real motor_stribeck_speed[6](each unit = "rad/s", each min = 1e-9) = {2, 2, 2, 2, 2, 2}
    "Speed of the motor at which half of static - coulomb is left";
  parameter Real motor_viscous[6](each unit = "N.m.s/rad", each min = 0) =
    {1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4} "Friction at the motor per speed";
  parameter Real motor_rest_speed[6](each unit = "rad/s", each min = 1e-9) =
    {0.1, 0.1, 0.1, 0.1, 0.1, 0.1} "Speed of the motor that counts as rest";
  parameter Real current_time[6](each unit = "s", each min = 0) =
    {5e-4, 5e-4, 5e-4, 5e-4, 5e-4, 5e-4} "Time constant of the current loop; 0 makes it ideal";
  parameter Integer encoder_lines[6](each min = 1) = {2500, 2500, 2500, 2500, 2500, 2500}
    "Line periods of the motor encoder per turn";
  parameter Real tool_place[3](each unit = "m") = {0, 0, 0} "Foot of the tool on the flange";
  parameter Real tool_turn[3](each unit = "deg") = {0, 0, 0}
    "How the tool is turned on it: A, B, C about x, y, z, that about x first";
  parameter Real tool_length(unit = "m") = 0.15 "From its foot to the tip of the pen, along its z";
  parameter Real pen_stiffness(unit = "N/m", min = 0) = 1e3 "Of the pen's spring";
  parameter Real paper_height(unit = "m") = -10
    "Height of the sheet of paper over the base; by default below all reach";
  parameter Real start_joint[6](each unit = "deg") = {0, 0, 0, 0, 90, 0}
    "Joint angles at the start";
  input Real torque[6](each unit = "N.m", each start = 0) "Torque asked of the current loops";
  input Real force[3](each unit = "N", each start = 0) "Force on the tip of the tool, in base axes";
  output Real motor_phase[6](each unit = "1") "Motor encoders [line periods]";
  output Real motor_angle[6](each unit = "rad") "Motor angles; 0 with the joint at 0";
  output Real motor_speed[6](each unit = "rad/s") "Motor speeds";
  output Real link_angle[6](each unit = "rad") "Joint angles behind the gears";
  output Real link_speed[6](each unit = "rad/s") "Joint speeds behind the gears";
  output Real gear_torque[6](each unit = "N.m") "Torques of the gears on the links";
  output Real tool_position[3](each unit = "m") "Tip of the pen in base axes, not pressed in";
  output Real tool_quaternion[4](each unit = "1") "Orientation of the tool: w, x, y, z";
  output Real pen_force(unit = "N") "Force of the paper on the pen";
protected
  final parameter Real offset[6](each unit = "rad") = joint_offset*pi/180 "Offsets of the joints";
  final parameter Real inner_start[6](each unit = "rad") =
    {joint_sign[1]*start_joint[1]*(1 - slides[1]), joint_sign[2]*start_joint[2]*(1 - slides[2]),
    joint_sign[3]*start_joint[3]*(1 - slides[3]), joint_sign[4]*start_joint[4]*(1 - slides[4]),
    joint_sign[5]*start_joint[5]*(1 - slides[5]), joint_sign[6]*start_joint[6]*(1 - slides[6])}
    *pi/180 + {slides[1]*start_joint[1], slides[2]*start_joint[2], slides[3]*start_joint[3],
    slides[4]*start_joint[4], slides[5]*start_joint[5], slides[6]*start_joint[6]}/1000
    - offset "Start as inner angles";
  final parameter Real motor_start[6](each unit = "rad") =
    {gear_ratio[1]*inner_start[1], gear_ratio[2]*inner_start[2], gear_ratio[3]*inner_start[3],
    gear_ratio[4]*inner_start[4], gear_ratio[5]*inner_start[5], gear_ratio[6]*inner_start[6]}
    "Motors at the start";
  final parameter Real ideal_start[6](each unit = "rad") = inner_start + zero_error
    "Links at the start behind ideal gears";
  final parameter Real end_mass(unit = "kg") = mass[6] + payload_mass "Flange and payload";
  final parameter Real end_share(unit = "1") = if end_mass > 0 then payload_mass/end_mass else 0
    "Share of the payload";
  final parameter Real apart[3](each unit = "m") = payload_center - center[6,:]
    "Centre of the payload from that of the flange";
  final parameter Real paired(unit = "kg") = mass[6]*end_share "Reduced mass of the two";
  final parameter Real link_mass[6](each unit = "kg") =
    {mass[1], mass[2], mass[3], mass[4], mass[5], end_mass} "Masses, the last with the payload";
  final parameter Real link_center[6,3](each unit = "m") = {center[1,:], center[2,:], center[3,:],
    center[4,:], center[5,:], center[6,:] + end_share*apart} "Their centres";
  final parameter Real link_inertia[6,3](each unit = "kg.m2") = {inertia[1,:], inertia[2,:],
    inertia[3,:], inertia[4,:], inertia[5,:], inertia[6,:] + payload_inertia
    + paired*{apart[2]^2 + apart[3]^2, apart[3]^2 + apart[1]^2, apart[1]^2 + apart[2]^2}}
    "Their moments of inertia";
  final parameter Real link_product[6,3](each unit = "kg.m2") = {product[1,:], product[2,:],
    product[3,:], product[4,:], product[5,:], product[6,:]
    - paired*{apart[1]*apart[2], apart[2]*apart[3], apart[3]*apart[1]}}
    "The other elements of their tensors: xy, yz, zx";
  final parameter Real lean[3](each unit = "rad") = tool_turn*pi/360 "Halves of A, B, C";
  final parameter Real held[4](each unit = "1") = {
    cos(lean[3])*cos(lean[2])*cos(lean[1]) + sin(lean[3])*sin(lean[2])*sin(lean[1]),
    cos(lean[3])*cos(lean[2])*sin(lean[1]) - sin(lean[3])*sin(lean[2])*cos(lean[1]),
    cos(lean[3])*sin(lean[2])*cos(lean[1]) + sin(lean[3])*cos(lean[2])*sin(lean[1]),
    sin(lean[3])*cos(lean[2])*cos(lean[1]) - cos(lean[3])*sin(lean[2])*sin(lean[1])}
    "Orientation of the tool on the flange: w, x, y, z";
  parameter Real origin[6,3](each unit = "m") "Joints in the links before";
  parameter Real axis[6,3](each unit = "1") "Axes of the joints";
  parameter Real slides[6](each unit = "1") "1 of a joint that slides, in m for rad, N for N.m";
  parameter Real stands[6](each unit = "1") "1 of a joint that is none";
  parameter Real hand_way[6,3](each unit = "m") "Joints on the hands of their pivots";
  parameter Real hand_weight[6](each unit = "kg") "Masses of these hands";
  parameter Real hand_middle[6,3](each unit = "m") "Their centres from the pivots";
  parameter Real hand_tensor[6,3](each unit = "kg.m2") "Their moments of inertia xx, yy, zz";
  parameter Real hand_aside[6,3](each unit = "kg.m2") "The other elements: xy, yz, zx";
  parameter Real level[6](each unit = "1")
    "So many joints before it do not tilt its link: of joint 3 up to 1, of joint 4 up to 2";
  final parameter Real one[6](each unit = "1") = {0, 0, level[3], min(level[4], 1), 0, 0}
    "1 of a link that the joint before it does not tilt";
  final parameter Real two(unit = "1") = max(level[4] - 1, 0)
    "1 if joint 2 does not tilt link 4 either";
  final parameter Real along(unit = "1") = axis[2,1]*axis[3,1] + axis[2,2]*axis[3,2]
    + axis[2,3]*axis[3,3] "Axis 2 along axis 3: 1 or -1 where a link is kept level";
  HangingJoint hanging[6](axis = axis, slides = slides, stands = stands, each gravity = gravity,
    hand = hand_way, hand_mass = hand_weight, hand_center = hand_middle, mass = link_mass,
    center = link_center, angle = ideal_start, motor = motor_start,
    up_before = {{0, 0, 1}, hanging[1].up, (1 - one[3])*hanging[2].up + one[3]*hanging[1].up,
      (1 - one[4])*hanging[3].up + (one[4] - two)*hanging[2].up + two*hanging[1].up,
      hanging[4].up, hanging[5].up},
    next_origin = {origin[2,:], origin[3,:], origin[4,:], origin[5,:], origin[6,:], {0, 0, 0}},
    next_weight = {hanging[2].weight_before, hanging[3].weight_before, hanging[4].weight_before,
    hanging[5].weight_before,
      hanging[6].weight_before, 0},
    next_moment = {hanging[2].moment_before + one[3]*hanging[3].moment_before
      + two*hanging[4].moment_before, (1 - one[3])*hanging[3].moment_before
      + (one[4] - two)*hanging[4].moment_before, (1 - one[4])*hanging[4].moment_before,
      hanging[5].moment_before, hanging[6].moment_before, {0, 0, 0}},
    stiffness_1 = stiffness_1, stiffness_2 = stiffness_2, stiffness_3 = stiffness_3,
    knee_1 = knee_1, knee_2 = knee_2, lost_motion = lost_motion, error_1 = transmission_error_1,
    error_2 = transmission_error_2, phase_1 = transmission_phase_1,
    phase_2 = transmission_phase_2) "Start under gravity";
  Lag current_loop[6](tau = current_time) "Current loops of the drives";
  Rotor rotor[6](inertia = motor_inertia, coulomb = motor_coulomb, static = motor_static,
    stribeck_speed = motor_stribeck_speed, viscous = motor_viscous, rest_speed = motor_rest_speed,
    start_angle = motor_start) "Motors and wave generators";
  StrainWaveGear gear[6](ratio = gear_ratio, stiffness_1 = stiffness_1, stiffness_2 = stiffness_2,
    stiffness_3 = stiffness_3, knee_1 = knee_1, knee_2 = knee_2, damping = gear_damping,
    lost_motion = lost_motion, error_1 = transmission_error_1, error_2 = transmission_error_2,
    phase_1 = transmission_phase_1, phase_2 = transmission_phase_2, zero_error = zero_error)
    "Gears";
  Pen pen(length = tool_length, paper = paper_height, stiffness = pen_stiffness,
    foot = tool_place, along = 2*{held[2]*held[4] + held[1]*held[3],
    held[3]*held[4] - held[1]*held[2], 0.5 - held[2]*held[2] - held[3]*held[3]}) "Tool";
  Real hand[4](each unit = "1") "All joints: orientation of the flange";
  Real inner_angle[6](each unit = "rad") "Angles of the links";
  Real inner_speed[6](each unit = "rad/s") "Speeds of the links";
equation
  pen.force = force;
  for i in 1:6 loop
    connect(rotor[i].flange, gear[i].motor);
    current_loop[i].u = joint_sign[i]*torque[i];
    rotor[i].drive = current_loop[i].y;
    motor_angle[i] = joint_sign[i]*(rotor[i].angle + gear_ratio[i]*offset[i]);
    motor_phase[i] = encoder_lines[i]/(2*pi)*motor_angle[i];
    motor_speed[i] = joint_sign[i]*rotor[i].speed;
    link_angle[i] = joint_sign[i]*(inner_angle[i] + offset[i]);
    link_speed[i] = joint_sign[i]*inner_speed[i];
    gear_torque[i] = joint_sign[i]*gear[i].torque;
  end for;
  tool_position = pen.tip;
  pen_force = pen.press;
  tool_quaternion[1] = hand[1]*held[1] - hand[2]*held[2] - hand[3]*held[3] - hand[4]*held[4];
  tool_quaternion[2] = hand[2]*held[1] + hand[1]*held[2] + hand[3]*held[4] - hand[4]*held[3];
  tool_quaternion[3] = hand[3]*held[1] + hand[1]*held[3] + hand[4]*held[2] - hand[2]*held[4];
  tool_quaternion[4] = hand[4]*held[1] + hand[1]*held[4] + hand[2]*held[3] - hand[3]*held[2];
end GearedArm;
