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
  Real half[6](each unit = "rad") "Half of the joint angles; those of axes 2 and 3 together";
  Real arm[4](each unit = "1") "Orientation of the forearm: w, x, y, z";
  Real wrist[4](each unit = "1") "Joints 4 and 5";
  Real both[4](each unit = "1") "Joints 1 to 5";
equation
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
