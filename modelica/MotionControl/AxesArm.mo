within MotionControl;
model AxesArm
  "Arm of up to six joints by their axes: motors, strain wave gears, rigid links, pen on paper"
  extends ArmByAxes(
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
end AxesArm;
