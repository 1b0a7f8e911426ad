within MotionControl;
block HangingJoint "Where a joint stands still under gravity: of parameters alone"
  parameter Real axis[3](each unit = "1") = {0, 0, 1} "Axis of the joint";
  parameter Real gravity(unit = "m/s2") = 9.81 "Acceleration of free fall";
  parameter Real mass(unit = "kg") = 1 "Mass of the link";
  parameter Real center[3](each unit = "m") = {0, 0, 0} "Its centre in its frame";
  parameter Real slides(unit = "1") = 0 "1 of a joint that slides, in m for rad and N for N.m";
  parameter Real stands(unit = "1") = 0 "1 of a joint that is none: it has no gear";
  parameter Real angle(unit = "rad") = 0 "Angle of the joint behind an ideal gear";
  parameter Real motor(unit = "rad") = 0 "Angle of the motor";
  parameter Real hand[3](each unit = "m") = {0, 0, 0} "Joint in the frame of a hand before it";
  parameter Real hand_mass(unit = "kg") = 0 "Mass of the hand";
  parameter Real hand_center[3](each unit = "m") = {0, 0, 0} "Its centre";
  parameter Real up_before[3](each unit = "1") = {0, 0, 1} "Upwards in the axes before";
  parameter Real next_origin[3](each unit = "m") = {0, 0, 0} "Next joint in the frame of the link";
  parameter Real next_weight(unit = "N") = 0 "Weight of all that comes after";
  parameter Real next_moment[3](each unit = "N.m") = {0, 0, 0} "Its moment about the next joint";
  parameter Real stiffness_1(unit = "N.m/rad") = 1e5 "Of the gear: see StrainWaveGear";
  parameter Real stiffness_2(unit = "N.m/rad") = 1.6e5 "Of the gear";
  parameter Real stiffness_3(unit = "N.m/rad") = 1.8e5 "Of the gear";
  parameter Real knee_1(unit = "N.m") = 50 "Of the gear";
  parameter Real knee_2(unit = "N.m") = 180 "Of the gear";
  parameter Real lost_motion(unit = "rad") = 0 "Of the gear";
  parameter Real error_1(unit = "rad") = 0 "Of the gear";
  parameter Real error_2(unit = "rad") = 0 "Of the gear";
  parameter Real phase_1(unit = "rad") = 0 "Of the gear";
  parameter Real phase_2(unit = "rad") = 0 "Of the gear";
  parameter Real sided(unit = "N.m") = 0.01
    "Torque that takes the link to a side of the lost motion";
  final parameter Real c(unit = "1") = cos((1 - slides)*angle) "Cosine of the angle";
  final parameter Real s(unit = "1") = sin((1 - slides)*angle) "Sine of the angle";
  final parameter Real r[3,3](each unit = "1") = {
    {axis[1]^2 + (1 - axis[1]^2)*c, axis[1]*axis[2]*(1 - c) - axis[3]*s,
      axis[1]*axis[3]*(1 - c) + axis[2]*s},
    {axis[1]*axis[2]*(1 - c) + axis[3]*s, axis[2]^2 + (1 - axis[2]^2)*c,
      axis[2]*axis[3]*(1 - c) - axis[1]*s},
    {axis[1]*axis[3]*(1 - c) - axis[2]*s, axis[2]*axis[3]*(1 - c) + axis[1]*s,
      axis[3]^2 + (1 - axis[3]^2)*c}} "From own axes to those before";
  final parameter Real up[3](each unit = "1") = {
    r[1,1]*up_before[1] + r[2,1]*up_before[2] + r[3,1]*up_before[3],
    r[1,2]*up_before[1] + r[2,2]*up_before[2] + r[3,2]*up_before[3],
    r[1,3]*up_before[1] + r[2,3]*up_before[2] + r[3,3]*up_before[3]} "Upwards in own axes";
  final parameter Real weight(unit = "N") = gravity*mass + next_weight "With all that comes after";
  final parameter Real arm[3](each unit = "N.m") = gravity*mass*center + next_weight*next_origin
    + (slides*angle*weight)*axis "Weights times their places from the joint";
  final parameter Real moment[3](each unit = "N.m") = next_moment + {
    arm[2]*up[3] - arm[3]*up[2], arm[3]*up[1] - arm[1]*up[3], arm[1]*up[2] - arm[2]*up[1]}
    "What holds it, about the joint";
  final parameter Real weight_before(unit = "N") = weight + gravity*hand_mass "With the hand";
  final parameter Real hanging[3](each unit = "N.m") = weight*hand + gravity*hand_mass*hand_center
    "Weights times their places from the hand's pivot";
  final parameter Real moment_before[3](each unit = "N.m") = {
    hanging[2]*up_before[3] - hanging[3]*up_before[2],
    hanging[3]*up_before[1] - hanging[1]*up_before[3],
    hanging[1]*up_before[2] - hanging[2]*up_before[1]} + {
    r[1,1]*moment[1] + r[1,2]*moment[2] + r[1,3]*moment[3],
    r[2,1]*moment[1] + r[2,2]*moment[2] + r[2,3]*moment[3],
    r[3,1]*moment[1] + r[3,2]*moment[2] + r[3,3]*moment[3]} "The same before the hand";
  final parameter Real torque(unit = "N.m") = (1 - slides)*(axis[1]*moment[1] + axis[2]*moment[2]
    + axis[3]*moment[3]) + slides*weight*(axis[1]*up[1] + axis[2]*up[2] + axis[3]*up[3])
    "What the gear holds";
  final parameter Real size(unit = "N.m") = abs(torque) "Without its sign";
  final parameter Real windup(unit = "rad") = lost_motion/2*min(max(torque/sided, -1), 1)
    + sign(torque)*(min(size, knee_1)/stiffness_1 + max(min(size, knee_2) - knee_1, 0)/stiffness_2
    + max(size - knee_2, 0)/stiffness_3) "Of the gear";
  final parameter Real start(unit = "rad") = angle + (1 - stands)*error_1*sin(motor + phase_1)
    + (1 - stands)*error_2*sin(2*motor + phase_2) - (1 - stands)*windup "Angle of the joint";
  annotation(Documentation(info = "<html>
<p>Torques are those of the angles behind ideal gears; that they change with the wind-up itself
leaves out 2e-3 of it for the stiffness of such an arm.</p>
</html>"));
end HangingJoint;
