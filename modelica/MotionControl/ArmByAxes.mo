within MotionControl;
partial model ArmByAxes
  "Arm of up to six joints by their axes; the class that extends it says which links are level"
  parameter Integer joints(min = 1, max = 6) = 6
    "Number of joints; of the others axis, links and motors are there, but nothing moves";
  parameter Integer joint_slides[6](each min = 0, each max = 1) = {0, 0, 0, 0, 0, 0}
    "1 of a joint that slides along its axis: its numbers are in m for rad, mm for deg, N for N.m";
  parameter Real axis_origin[6,3](each unit = "m") = {{0, 0, 0.445}, {0.15, 0, 0}, {0, 0, 0.7},
    {0, 0, 0.115}, {0.795, 0, 0}, {0.085, 0, 0}}
    "Origin of a joint from that of the one before it, of the base for joint 1, at zero";
  parameter Real axis_direction[6,3](each unit = "1") = {{0, 0, 1}, {0, 1, 0}, {0, 1, 0},
    {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}
    "Axis of a joint there, of any length; all frames are parallel to the base";
  extends GearedArm(
    final joint_sign = {1, 1, 1, 1, 1, 1},
    final joint_offset = {0, 0, 0, 0, 0, 0},
    center = {{0.06, 0, -0.12}, {0, 0, 0.32}, {0.02, 0, 0.1}, {0.4, 0, 0}, {0.02, 0, 0},
      {-0.02, 0, 0}},
    inertia = {{0.8223, 0.8223, 0.578}, {0.9429, 0.9429, 0.0891}, {0.1872, 0.3441, 0.3441},
      {0.0162, 0.2781, 0.2781}, {0.005475, 0.00375, 0.005475}, {0.00048, 0.00032, 0.00032}},
    payload_center = {0.1, 0, 0},
    payload_inertia = {0.0108, 0.0104, 0.0104},
    origin_error = {{-7.1e-5, -1.69e-4, -2.68e-4}, {-9.9e-5, 1.22e-4, -6.1e-5},
      {2.43e-4, -5.1e-5, 6e-6}, {-1.28e-4, 1.38e-4, -3.92e-4}, {4.91e-4, 1.37e-4, 4.6e-5},
      {2.54e-4, -6.2e-5, 6.8e-5}},
    tool_turn = {0, 90, 0},
    final origin = origin_error + axis_origin,
    final axis = {axis_direction[1,:]/reach[1], axis_direction[2,:]/reach[2],
      axis_direction[3,:]/reach[3], axis_direction[4,:]/reach[4], axis_direction[5,:]/reach[5],
      axis_direction[6,:]/reach[6]},
    final slides = {joint_slides[1], joint_slides[2], joint_slides[3], joint_slides[4],
      joint_slides[5], joint_slides[6]},
    final stands = {max(min(1 - joints, 1), 0), max(min(2 - joints, 1), 0),
      max(min(3 - joints, 1), 0), max(min(4 - joints, 1), 0), max(min(5 - joints, 1), 0),
      max(min(6 - joints, 1), 0)});
protected
  final parameter Real reach[6](each unit = "1") = {
    sqrt(axis_direction[1,1]^2 + axis_direction[1,2]^2 + axis_direction[1,3]^2),
    sqrt(axis_direction[2,1]^2 + axis_direction[2,2]^2 + axis_direction[2,3]^2),
    sqrt(axis_direction[3,1]^2 + axis_direction[3,2]^2 + axis_direction[3,3]^2),
    sqrt(axis_direction[4,1]^2 + axis_direction[4,2]^2 + axis_direction[4,3]^2),
    sqrt(axis_direction[5,1]^2 + axis_direction[5,2]^2 + axis_direction[5,3]^2),
    sqrt(axis_direction[6,1]^2 + axis_direction[6,2]^2 + axis_direction[6,3]^2)}
    "Lengths of the axes as given";
  ArmBase base(gravity = gravity) "Ground";
  ArmLink link[6](
    axis = axis, slides = slides, stands = stands, level = one, each pivot = axis[3,:],
    hand = hand_way, hand_mass = hand_weight, hand_center = hand_middle, hand_inertia = hand_tensor,
    hand_product = hand_aside,
    origin = origin, mass = link_mass, center = link_center, inertia = link_inertia,
    product = link_product, viscous = link_viscous, start_angle = hanging.start) "Links";
  PenMount flange(arm = pen.arm) "Where the pen is";
  Real c[6](each unit = "1") "Cosines of half the joint angles";
  Real s[6](each unit = "1") "Sines of half the joint angles";
  Real turned[7,4](each unit = "1") "Orientation of the links, first that of the base: w, x, y, z";
  Real before[6,4](each unit = "1") "Of the link from which a joint turns its own";
equation
  connect(base.b, link[1].a);
  link[1].rate = base.rate;
  link[1].place = base.place;
  link[1].turn = base.turn;
  for i in 1:5 loop
    connect(link[i].b, link[i + 1].a);
    link[i + 1].rate = link[i].own_rate;
    link[i + 1].place = link[i].own_place;
    link[i + 1].turn = link[i].own_turn;
  end for;
  for i in 1:6 loop
    link[i].tilt = if i == 3 then -one[3]*along*link[2].angle
      elseif i == 4 then -one[4]*(link[3].angle + link[3].tilt) - two*along*link[2].angle else 0;
    link[i].tilt_rate = if i == 3 then -one[3]*along*link[2].speed
      elseif i == 4 then -one[4]*(link[3].speed + link[3].tilt_rate) - two*along*link[2].speed
      else 0;
    link[i].tilt_change = if i == 3 then -one[3]*along*der(link[2].speed)
      elseif i == 4 then -one[4]*(der(link[3].speed) + link[3].tilt_change)
      - two*along*der(link[2].speed) else 0;
    link[i].linkage = if i == 2 then (one[4]*one[3] - two)*along*link[4].tilt_torque
      - one[3]*along*link[3].tilt_torque elseif i == 3 then -one[4]*link[4].tilt_torque else 0;
  end for;
  connect(link[6].b, flange.a);
  flange.place = link[6].own_place;
  flange.turn = link[6].own_turn;
  flange.push = pen.push;
  pen.tip = flange.tip;
  for i in 1:6 loop
    connect(gear[i].link, link[i].drive);
    inner_angle[i] = link[i].angle;
    inner_speed[i] = link[i].speed;
  end for;
  turned[1,1] = 1;
  turned[1,2] = 0;
  turned[1,3] = 0;
  turned[1,4] = 0;
  for i in 1:6 loop
    c[i] = cos((1 - slides[i])*link[i].angle/2);
    s[i] = sin((1 - slides[i])*link[i].angle/2);
    for k in 1:4 loop
      before[i,k] = if i == 3 then (1 - one[3])*turned[3,k] + one[3]*turned[2,k]
        elseif i == 4 then (1 - one[4])*turned[4,k] + (one[4] - two)*turned[3,k] + two*turned[2,k]
        else turned[i,k];
    end for;
    turned[i + 1,1] = before[i,1]*c[i]
      - (before[i,2]*axis[i,1] + before[i,3]*axis[i,2] + before[i,4]*axis[i,3])*s[i];
    turned[i + 1,2] = before[i,2]*c[i]
      + (before[i,1]*axis[i,1] + before[i,3]*axis[i,3] - before[i,4]*axis[i,2])*s[i];
    turned[i + 1,3] = before[i,3]*c[i]
      + (before[i,1]*axis[i,2] + before[i,4]*axis[i,1] - before[i,2]*axis[i,3])*s[i];
    turned[i + 1,4] = before[i,4]*c[i]
      + (before[i,1]*axis[i,3] + before[i,2]*axis[i,2] - before[i,3]*axis[i,1])*s[i];
  end for;
  hand[1] = turned[7,1];
  hand[2] = turned[7,2];
  hand[3] = turned[7,3];
  hand[4] = turned[7,4];
end ArmByAxes;
