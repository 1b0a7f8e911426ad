within MotionControl;
model SixAxisArm
  "Arm of six joints with a spherical wrist: motors, strain wave gears, rigid links, pen on paper"
  parameter Real a1(unit = "m") = 0.15 "Axis 1 to axis 2, along x";
  parameter Real a2(unit = "m") = -0.115 "Elbow to the axis of the forearm, along x";
  parameter Real b(unit = "m") = 0 "Axis 1 to axis 2, along y";
  parameter Real c1(unit = "m") = 0.445 "Base to axis 2, along z";
  parameter Real c2(unit = "m") = 0.7 "Upper arm";
  parameter Real c3(unit = "m") = 0.795 "Elbow to the centre of the wrist, along z";
  parameter Real c4(unit = "m") = 0.085 "Centre of the wrist to the flange";
  extends GearedArm(
    final origin = origin_error + {{0, 0, c1}, {a1, b, 0}, {0, 0, c2}, {a2, 0, 0}, {0, 0, c3},
      {0, 0, c4}},
    final axis = {{0, 0, 1}, {0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 1}},
    final slides = {0, 0, 0, 0, 0, 0},
    final stands = {0, 0, 0, 0, 0, 0},
    final level = {0, 0, 0, 0, 0, 0},
    final hand_way = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
      {0, 0, 0}},
    final hand_weight = {0, 0, 0, 0, 0, 0},
    final hand_middle = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
      {0, 0, 0}},
    final hand_tensor = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
      {0, 0, 0}},
    final hand_aside = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
      {0, 0, 0}});
protected
  final parameter Real own[6,6](each unit = "1") = {{1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0},
    {0, 0, 1, 0, 0, 0}, {0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1}}
    "Which joint is whose";
  TurningLink link[6](axis = axis, own = own, origin = origin, mass = link_mass,
    center = link_center, inertia = link_inertia, product = link_product, viscous = link_viscous,
    start_angle = hanging.start,
    next_origin = {origin[2,:], origin[3,:], origin[4,:], origin[5,:], origin[6,:], {0, 0, 0}},
    next_mass = {link[2].all_mass, link[3].all_mass, link[4].all_mass, link[5].all_mass,
      link[6].all_mass, 0},
    next_axial = {link[2].axial, link[3].axial, link[4].axial, link[5].axial, link[6].axial,
      {0, 0, 0}},
    next_spread = {link[2].spread, link[3].spread, link[4].spread, link[5].spread, link[6].spread,
      {0, 0, 0}}) "Links";
  Real half[6](each unit = "rad") "Half of the joint angles; those of axes 2 and 3 together";
  Real arm[4](each unit = "1") "Orientation of the forearm: w, x, y, z";
  Real wrist[4](each unit = "1") "Joints 4 and 5";
  Real both[4](each unit = "1") "Joints 1 to 5";
equation
  for k in 1:3 loop
    link[1].rate[k] = 0;
    link[1].change[k] = 0;
    link[1].drift[k] = if k == 3 then gravity else 0;
    for i in 1:3 loop
      link[1].whirl[k,i] = 0;
    end for;
    link[6].next_push[k] = -link[6].own_pull[k];
    link[6].next_moment[k] = 0;
    link[6].next_square[k] = 0;
    link[6].next_mixed[k] = 0;
    for j in 1:6 loop
      link[6].next_force[j,k] = 0;
      link[6].next_torque[j,k] = 0;
    end for;
  end for;
  link[6].next_twist[1] = pen.arm[3]*link[6].own_pull[2] - pen.arm[2]*link[6].own_pull[3];
  link[6].next_twist[2] = pen.arm[1]*link[6].own_pull[3] - pen.arm[3]*link[6].own_pull[1];
  link[6].next_twist[3] = pen.arm[2]*link[6].own_pull[1] - pen.arm[1]*link[6].own_pull[2];
  link[6].tip = pen.arm;
  pen.tip = link[1].tip_before;
  link[1].pull = pen.push;
  for i in 1:5 loop
    link[i + 1].rate = link[i].own_rate;
    link[i + 1].change = link[i].own_change;
    link[i + 1].whirl = link[i].own_whirl;
    link[i + 1].drift = link[i].own_drift;
    link[i + 1].pull = link[i].own_pull;
    link[i].tip = link[i + 1].tip_before;
    link[i].next_push = link[i + 1].push;
    link[i].next_twist = link[i + 1].twist;
    link[i].next_moment = link[i + 1].whole_moment;
    link[i].next_square = link[i + 1].whole_square;
    link[i].next_mixed = link[i + 1].whole_mixed;
    link[i].next_force = link[i + 1].force;
    link[i].next_torque = link[i + 1].torque;
  end for;
  for i in 1:6 loop
    connect(gear[i].link, link[i].drive);
    inner_angle[i] = link[i].angle;
    inner_speed[i] = link[i].speed;
    link[i].coupling = (if i > 1 then link[1].coupled[i] else link[i].coupled[1])*der(link[1].speed)
      + (if i > 2 then link[2].coupled[i] else link[i].coupled[2])*der(link[2].speed)
      + (if i > 3 then link[3].coupled[i] else link[i].coupled[3])*der(link[3].speed)
      + (if i > 4 then link[4].coupled[i] else link[i].coupled[4])*der(link[4].speed)
      + (if i > 5 then link[5].coupled[i] else link[i].coupled[5])*der(link[5].speed)
      + link[i].coupled[6]*der(link[6].speed);
  end for;
  for i in 1:6 loop
    half[i] = if i == 2 then (link[2].angle + link[3].angle)/2 else link[i].angle/2;
  end for;
  arm[1] = cos(half[1])*cos(half[2]);
  arm[2] = -sin(half[1])*sin(half[2]);
  arm[3] = cos(half[1])*sin(half[2]);
  arm[4] = sin(half[1])*cos(half[2]);
  wrist[1] = cos(half[4])*cos(half[5]);
  wrist[2] = -sin(half[4])*sin(half[5]);
  wrist[3] = cos(half[4])*sin(half[5]);
  wrist[4] = sin(half[4])*cos(half[5]);
  both[1] = arm[1]*wrist[1] - arm[2]*wrist[2] - arm[3]*wrist[3] - arm[4]*wrist[4];
  both[2] = arm[1]*wrist[2] + arm[2]*wrist[1] + arm[3]*wrist[4] - arm[4]*wrist[3];
  both[3] = arm[1]*wrist[3] - arm[2]*wrist[4] + arm[3]*wrist[1] + arm[4]*wrist[2];
  both[4] = arm[1]*wrist[4] + arm[2]*wrist[3] - arm[3]*wrist[2] + arm[4]*wrist[1];
  hand[1] = both[1]*cos(half[6]) - both[4]*sin(half[6]);
  hand[2] = both[2]*cos(half[6]) + both[3]*sin(half[6]);
  hand[3] = both[3]*cos(half[6]) - both[2]*sin(half[6]);
  hand[4] = both[4]*cos(half[6]) + both[1]*sin(half[6]);
end SixAxisArm;
