within MotionControl;
model LevelArm
  "Arm of up to six joints by their axes, of which a linkage keeps links and a hand level"
  parameter Integer joint_level[6](each min = 0, each max = 2) = {0, 0, 0, 0, 0, 0}
    "So many joints before it do not tilt its link, by a linkage: of joint 3 up to 1, of 4 up to 2";
  parameter Real hand_offset[3](each unit = "m") = {0, 0, 0}
    "Origin of joint 4 from the end of axis_origin, on the hand that is kept level there";
  parameter Real hand_mass(unit = "kg", min = 0) = 0 "Mass of the level hand";
  parameter Real hand_center[3](each unit = "m") = {0, 0, 0}
    "Centre of the level hand from the origin of joint 4";
  parameter Real hand_inertia[3](each unit = "kg.m2", each min = 0) = {0, 0, 0}
    "Moments of inertia xx, yy, zz of the level hand about its centre";
  parameter Real hand_product[3](each unit = "kg.m2") = {0, 0, 0}
    "Elements xy, yz, zx of the level hand's tensor about its centre";
  extends ArmByAxes(
    final level = {0, 0, min(joint_level[3], 1), joint_level[4], 0, 0},
    final hand_way = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, hand_offset, {0, 0, 0}, {0, 0, 0}},
    final hand_weight = {0, 0, 0, hand_mass, 0, 0},
    final hand_middle = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, hand_center, {0, 0, 0}, {0, 0, 0}},
    final hand_tensor = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, hand_inertia, {0, 0, 0}, {0, 0, 0}},
    final hand_aside = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, hand_product, {0, 0, 0}, {0, 0, 0}});
end LevelArm;
