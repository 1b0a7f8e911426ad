within MotionControl;
model ArmLink
  "Rigid link that turns on the one before it or on its hand, slides along it, or is fixed to it"
  parameter Real axis[3](each unit = "1") = {0, 0, 1} "Axis of the joint, alike in both frames";
  parameter Real origin[3](each unit = "m") = {0, 0, 0} "Joint in the frame before";
  parameter Real mass(unit = "kg", min = 0) = 1 "Mass";
  parameter Real center[3](each unit = "m") = {0, 0, 0} "Centre of mass in the own frame";
  parameter Real inertia[3](each unit = "kg.m2", each min = 0) = {0, 0, 0}
    "Moments of inertia about the centre: xx, yy, zz";
  parameter Real product[3](each unit = "kg.m2") = {0, 0, 0}
    "Elements xy, yz, zx of the tensor of inertia about the centre";
  parameter Real viscous(unit = "N.m.s/rad", min = 0) = 0 "Friction torque per speed";
  parameter Real start_angle(unit = "rad") = 0 "Angle at the start";
  parameter Real slides(unit = "1") = 0 "1 of a joint that slides along its axis, in m for rad";
  parameter Real stands(unit = "1") = 0 "1 of a joint that is none: nothing moves it";
  parameter Real held(unit = "kg.m2") = 1e12 "Inertia that keeps a joint that is none where it is";
  parameter Real level(unit = "1") = 0 "1 of a joint on a hand, on a pivot that a linkage turns";
  parameter Real pivot[3](each unit = "1") = {0, 1, 0} "Axis of that pivot in the frame before";
  parameter Real hand[3](each unit = "m") = {0, 0, 0} "Joint in the frame of the hand";
  parameter Real hand_mass(unit = "kg", min = 0) = 0 "Mass of the hand";
  parameter Real hand_center[3](each unit = "m") = {0, 0, 0} "Its centre from the pivot";
  parameter Real hand_inertia[3](each unit = "kg.m2", each min = 0) = {0, 0, 0}
    "Its moments of inertia about the centre: xx, yy, zz";
  parameter Real hand_product[3](each unit = "kg.m2") = {0, 0, 0}
    "Elements xy, yz, zx of its tensor about the centre";
  Frame a "Of the link before";
  Frame b "Own frame: its origin is on the joint";
  RotationalFlange drive "What turns the joint";
  input Real rate[3](each unit = "rad/s") "Angular velocity of the link before, in its axes";
  input Real place[3](each unit = "m") "Origin of the frame before, in base axes";
  input Real turn[3,3](each unit = "1") "From axes of the frame before to base axes";
  input Real tilt(unit = "rad") "Angle of the pivot";
  input Real tilt_rate(unit = "rad/s") "Its speed";
  input Real tilt_change(unit = "rad/s2") "Its acceleration";
  input Real linkage(unit = "N.m") "What pivots behind ask of the joint by their linkages";
  output Real tilt_torque(unit = "N.m") "What hand and link ask of the pivot";
  output Real own_rate[3](each unit = "rad/s") "Own angular velocity, in own axes";
  output Real own_place[3](each unit = "m") "Own origin, in base axes";
  output Real own_turn[3,3](each unit = "1") "From own axes to base axes";
  Real angle(unit = "rad", start = start_angle, fixed = true) "Angle of the joint";
  Real speed(unit = "rad/s", start = 0, fixed = true) "Speed of the joint";
protected
  Real c(unit = "1") "Cosine of the angle";
  Real s(unit = "1") "Sine of the angle";
  Real p[3,3](each unit = "1") "From axes of the hand to those before";
  Real r[3,3](each unit = "1") "From own axes to those of the hand";
  Real lever[3](each unit = "m") "Pivot in the frame before";
  Real swept[3](each unit = "m/s") "Velocity of the pivot by the rate before";
  Real joint_a[3](each unit = "m/s2") "Acceleration of the pivot, in axes before";
  Real brought[3](each unit = "rad/s") "Rate before, in axes of the hand, as all of the hand";
  Real hand_turn[3,3](each unit = "1") "From axes of the hand to base axes";
  Real hand_rate[3](each unit = "rad/s") "Angular velocity of the hand";
  Real hand_z[3](each unit = "rad/s2") "Its angular acceleration";
  Real hand_a[3](each unit = "m/s2") "Acceleration of the pivot";
  Real held_a[3](each unit = "m/s2") "Acceleration of the joint";
  Real hand_whirl[3](each unit = "m/s") "Velocity of the hand's centre against the pivot";
  Real hand_swept[3](each unit = "m/s") "Velocity of the joint against the pivot";
  Real hand_force[3](each unit = "N") "What the acceleration of the hand's centre asks for";
  Real hand_spin[3](each unit = "kg.m2/s") "Its angular momentum about the centre";
  Real joint_f[3](each unit = "N") "Force on the joint";
  Real hand_f[3](each unit = "N") "Force on the pivot";
  Real hand_t[3](each unit = "N.m") "Torque about the pivot";
  Real carried[3](each unit = "rad/s") "Rate of the hand, in own axes";
  Real whirl[3](each unit = "m/s") "Velocity of the centre against the joint";
  Real force[3](each unit = "N") "What the acceleration of the centre asks for";
  Real spin[3](each unit = "kg.m2/s") "Angular momentum about the centre";
  Real moment[3](each unit = "N.m") "What the motion asks for, about the joint";
  Real push[3](each unit = "N") "Force of the link before, in own axes";
  Real twist[3](each unit = "N.m") "Torque of the link before, in own axes";
equation
  der(angle) = speed;
  drive.phi = angle;
  c = cos((1 - slides)*angle);
  s = sin((1 - slides)*angle);
  r[1,1] = axis[1]^2 + (1 - axis[1]^2)*c;
  r[1,2] = axis[1]*axis[2]*(1 - c) - axis[3]*s;
  r[1,3] = axis[1]*axis[3]*(1 - c) + axis[2]*s;
  r[2,1] = axis[1]*axis[2]*(1 - c) + axis[3]*s;
  r[2,2] = axis[2]^2 + (1 - axis[2]^2)*c;
  r[2,3] = axis[2]*axis[3]*(1 - c) - axis[1]*s;
  r[3,1] = axis[1]*axis[3]*(1 - c) - axis[2]*s;
  r[3,2] = axis[2]*axis[3]*(1 - c) + axis[1]*s;
  r[3,3] = axis[3]^2 + (1 - axis[3]^2)*c;
  p[1,1] = 1 - level*(1 - pivot[1]^2)*(1 - cos(tilt));
  p[1,2] = level*(pivot[1]*pivot[2]*(1 - cos(tilt)) - pivot[3]*sin(tilt));
  p[1,3] = level*(pivot[1]*pivot[3]*(1 - cos(tilt)) + pivot[2]*sin(tilt));
  p[2,1] = level*(pivot[1]*pivot[2]*(1 - cos(tilt)) + pivot[3]*sin(tilt));
  p[2,2] = 1 - level*(1 - pivot[2]^2)*(1 - cos(tilt));
  p[2,3] = level*(pivot[2]*pivot[3]*(1 - cos(tilt)) - pivot[1]*sin(tilt));
  p[3,1] = level*(pivot[1]*pivot[3]*(1 - cos(tilt)) - pivot[2]*sin(tilt));
  p[3,2] = level*(pivot[2]*pivot[3]*(1 - cos(tilt)) + pivot[1]*sin(tilt));
  p[3,3] = 1 - level*(1 - pivot[3]^2)*(1 - cos(tilt));
  lever[1] = origin[1] + slides*axis[1]*angle;
  lever[2] = origin[2] + slides*axis[2]*angle;
  lever[3] = origin[3] + slides*axis[3]*angle;
  swept[1] = rate[2]*lever[3] - rate[3]*lever[2];
  swept[2] = rate[3]*lever[1] - rate[1]*lever[3];
  swept[3] = rate[1]*lever[2] - rate[2]*lever[1];
  joint_a[1] = a.a[1] + a.z[2]*lever[3] - a.z[3]*lever[2] + rate[2]*swept[3] - rate[3]*swept[2]
    + slides*(axis[1]*der(speed) + 2*(rate[2]*axis[3] - rate[3]*axis[2])*speed);
  joint_a[2] = a.a[2] + a.z[3]*lever[1] - a.z[1]*lever[3] + rate[3]*swept[1] - rate[1]*swept[3]
    + slides*(axis[2]*der(speed) + 2*(rate[3]*axis[1] - rate[1]*axis[3])*speed);
  joint_a[3] = a.a[3] + a.z[1]*lever[2] - a.z[2]*lever[1] + rate[1]*swept[2] - rate[2]*swept[1]
    + slides*(axis[3]*der(speed) + 2*(rate[1]*axis[2] - rate[2]*axis[1])*speed);
  brought[1] = p[1,1]*rate[1] + p[2,1]*rate[2] + p[3,1]*rate[3];
  brought[2] = p[1,2]*rate[1] + p[2,2]*rate[2] + p[3,2]*rate[3];
  brought[3] = p[1,3]*rate[1] + p[2,3]*rate[2] + p[3,3]*rate[3];
  hand_rate[1] = brought[1] + level*pivot[1]*tilt_rate;
  hand_rate[2] = brought[2] + level*pivot[2]*tilt_rate;
  hand_rate[3] = brought[3] + level*pivot[3]*tilt_rate;
  hand_z[1] = p[1,1]*a.z[1] + p[2,1]*a.z[2] + p[3,1]*a.z[3] + level*(pivot[1]*tilt_change
    + (brought[2]*pivot[3] - brought[3]*pivot[2])*tilt_rate);
  hand_z[2] = p[1,2]*a.z[1] + p[2,2]*a.z[2] + p[3,2]*a.z[3] + level*(pivot[2]*tilt_change
    + (brought[3]*pivot[1] - brought[1]*pivot[3])*tilt_rate);
  hand_z[3] = p[1,3]*a.z[1] + p[2,3]*a.z[2] + p[3,3]*a.z[3] + level*(pivot[3]*tilt_change
    + (brought[1]*pivot[2] - brought[2]*pivot[1])*tilt_rate);
  hand_a[1] = p[1,1]*joint_a[1] + p[2,1]*joint_a[2] + p[3,1]*joint_a[3];
  hand_a[2] = p[1,2]*joint_a[1] + p[2,2]*joint_a[2] + p[3,2]*joint_a[3];
  hand_a[3] = p[1,3]*joint_a[1] + p[2,3]*joint_a[2] + p[3,3]*joint_a[3];
  hand_swept[1] = hand_rate[2]*hand[3] - hand_rate[3]*hand[2];
  hand_swept[2] = hand_rate[3]*hand[1] - hand_rate[1]*hand[3];
  hand_swept[3] = hand_rate[1]*hand[2] - hand_rate[2]*hand[1];
  hand_whirl[1] = hand_rate[2]*hand_center[3] - hand_rate[3]*hand_center[2];
  hand_whirl[2] = hand_rate[3]*hand_center[1] - hand_rate[1]*hand_center[3];
  hand_whirl[3] = hand_rate[1]*hand_center[2] - hand_rate[2]*hand_center[1];
  held_a[1] = hand_a[1] + hand_z[2]*hand[3] - hand_z[3]*hand[2]
    + hand_rate[2]*hand_swept[3] - hand_rate[3]*hand_swept[2];
  held_a[2] = hand_a[2] + hand_z[3]*hand[1] - hand_z[1]*hand[3]
    + hand_rate[3]*hand_swept[1] - hand_rate[1]*hand_swept[3];
  held_a[3] = hand_a[3] + hand_z[1]*hand[2] - hand_z[2]*hand[1]
    + hand_rate[1]*hand_swept[2] - hand_rate[2]*hand_swept[1];
  hand_force[1] = hand_mass*(hand_a[1] + hand_z[2]*hand_center[3] - hand_z[3]*hand_center[2]
    + hand_rate[2]*hand_whirl[3] - hand_rate[3]*hand_whirl[2]);
  hand_force[2] = hand_mass*(hand_a[2] + hand_z[3]*hand_center[1] - hand_z[1]*hand_center[3]
    + hand_rate[3]*hand_whirl[1] - hand_rate[1]*hand_whirl[3]);
  hand_force[3] = hand_mass*(hand_a[3] + hand_z[1]*hand_center[2] - hand_z[2]*hand_center[1]
    + hand_rate[1]*hand_whirl[2] - hand_rate[2]*hand_whirl[1]);
  hand_spin[1] = hand_inertia[1]*hand_rate[1] + hand_product[1]*hand_rate[2]
    + hand_product[3]*hand_rate[3];
  hand_spin[2] = hand_inertia[2]*hand_rate[2] + hand_product[1]*hand_rate[1]
    + hand_product[2]*hand_rate[3];
  hand_spin[3] = hand_inertia[3]*hand_rate[3] + hand_product[3]*hand_rate[1]
    + hand_product[2]*hand_rate[2];
  carried[1] = r[1,1]*hand_rate[1] + r[2,1]*hand_rate[2] + r[3,1]*hand_rate[3];
  carried[2] = r[1,2]*hand_rate[1] + r[2,2]*hand_rate[2] + r[3,2]*hand_rate[3];
  carried[3] = r[1,3]*hand_rate[1] + r[2,3]*hand_rate[2] + r[3,3]*hand_rate[3];
  own_rate[1] = carried[1] + (1 - slides)*axis[1]*speed;
  own_rate[2] = carried[2] + (1 - slides)*axis[2]*speed;
  own_rate[3] = carried[3] + (1 - slides)*axis[3]*speed;
  b.z[1] = r[1,1]*hand_z[1] + r[2,1]*hand_z[2] + r[3,1]*hand_z[3] + (1 - slides)*(axis[1]*der(speed)
    + (carried[2]*axis[3] - carried[3]*axis[2])*speed);
  b.z[2] = r[1,2]*hand_z[1] + r[2,2]*hand_z[2] + r[3,2]*hand_z[3] + (1 - slides)*(axis[2]*der(speed)
    + (carried[3]*axis[1] - carried[1]*axis[3])*speed);
  b.z[3] = r[1,3]*hand_z[1] + r[2,3]*hand_z[2] + r[3,3]*hand_z[3] + (1 - slides)*(axis[3]*der(speed)
    + (carried[1]*axis[2] - carried[2]*axis[1])*speed);
  b.a[1] = r[1,1]*held_a[1] + r[2,1]*held_a[2] + r[3,1]*held_a[3];
  b.a[2] = r[1,2]*held_a[1] + r[2,2]*held_a[2] + r[3,2]*held_a[3];
  b.a[3] = r[1,3]*held_a[1] + r[2,3]*held_a[2] + r[3,3]*held_a[3];
  whirl[1] = own_rate[2]*center[3] - own_rate[3]*center[2];
  whirl[2] = own_rate[3]*center[1] - own_rate[1]*center[3];
  whirl[3] = own_rate[1]*center[2] - own_rate[2]*center[1];
  force[1] = mass*(b.a[1] + b.z[2]*center[3] - b.z[3]*center[2]
    + own_rate[2]*whirl[3] - own_rate[3]*whirl[2]);
  force[2] = mass*(b.a[2] + b.z[3]*center[1] - b.z[1]*center[3]
    + own_rate[3]*whirl[1] - own_rate[1]*whirl[3]);
  force[3] = mass*(b.a[3] + b.z[1]*center[2] - b.z[2]*center[1]
    + own_rate[1]*whirl[2] - own_rate[2]*whirl[1]);
  spin[1] = inertia[1]*own_rate[1] + product[1]*own_rate[2] + product[3]*own_rate[3];
  spin[2] = inertia[2]*own_rate[2] + product[1]*own_rate[1] + product[2]*own_rate[3];
  spin[3] = inertia[3]*own_rate[3] + product[3]*own_rate[1] + product[2]*own_rate[2];
  moment[1] = inertia[1]*b.z[1] + product[1]*b.z[2] + product[3]*b.z[3]
    + own_rate[2]*spin[3] - own_rate[3]*spin[2] + center[2]*force[3] - center[3]*force[2];
  moment[2] = inertia[2]*b.z[2] + product[1]*b.z[1] + product[2]*b.z[3]
    + own_rate[3]*spin[1] - own_rate[1]*spin[3] + center[3]*force[1] - center[1]*force[3];
  moment[3] = inertia[3]*b.z[3] + product[3]*b.z[1] + product[2]*b.z[2]
    + own_rate[1]*spin[2] - own_rate[2]*spin[1] + center[1]*force[2] - center[2]*force[1];
  push[1] + b.f[1] = force[1];
  push[2] + b.f[2] = force[2];
  push[3] + b.f[3] = force[3];
  twist[1] + b.t[1] = moment[1];
  twist[2] + b.t[2] = moment[2];
  twist[3] + b.t[3] = moment[3];
  joint_f[1] = r[1,1]*push[1] + r[1,2]*push[2] + r[1,3]*push[3];
  joint_f[2] = r[2,1]*push[1] + r[2,2]*push[2] + r[2,3]*push[3];
  joint_f[3] = r[3,1]*push[1] + r[3,2]*push[2] + r[3,3]*push[3];
  hand_f[1] = joint_f[1] + hand_force[1];
  hand_f[2] = joint_f[2] + hand_force[2];
  hand_f[3] = joint_f[3] + hand_force[3];
  hand_t[1] = r[1,1]*twist[1] + r[1,2]*twist[2] + r[1,3]*twist[3] + hand[2]*joint_f[3]
    - hand[3]*joint_f[2]
    + hand_inertia[1]*hand_z[1] + hand_product[1]*hand_z[2] + hand_product[3]*hand_z[3]
    + hand_rate[2]*hand_spin[3] - hand_rate[3]*hand_spin[2] + hand_center[2]*hand_force[3]
    - hand_center[3]*hand_force[2];
  hand_t[2] = r[2,1]*twist[1] + r[2,2]*twist[2] + r[2,3]*twist[3] + hand[3]*joint_f[1]
    - hand[1]*joint_f[3]
    + hand_inertia[2]*hand_z[2] + hand_product[1]*hand_z[1] + hand_product[2]*hand_z[3]
    + hand_rate[3]*hand_spin[1] - hand_rate[1]*hand_spin[3] + hand_center[3]*hand_force[1]
    - hand_center[1]*hand_force[3];
  hand_t[3] = r[3,1]*twist[1] + r[3,2]*twist[2] + r[3,3]*twist[3] + hand[1]*joint_f[2]
    - hand[2]*joint_f[1]
    + hand_inertia[3]*hand_z[3] + hand_product[3]*hand_z[1] + hand_product[2]*hand_z[2]
    + hand_rate[1]*hand_spin[2] - hand_rate[2]*hand_spin[1] + hand_center[1]*hand_force[2]
    - hand_center[2]*hand_force[1];
  a.f[1] = p[1,1]*hand_f[1] + p[1,2]*hand_f[2] + p[1,3]*hand_f[3];
  a.f[2] = p[2,1]*hand_f[1] + p[2,2]*hand_f[2] + p[2,3]*hand_f[3];
  a.f[3] = p[3,1]*hand_f[1] + p[3,2]*hand_f[2] + p[3,3]*hand_f[3];
  a.t[1] = p[1,1]*hand_t[1] + p[1,2]*hand_t[2] + p[1,3]*hand_t[3]
    + lever[2]*a.f[3] - lever[3]*a.f[2];
  a.t[2] = p[2,1]*hand_t[1] + p[2,2]*hand_t[2] + p[2,3]*hand_t[3]
    + lever[3]*a.f[1] - lever[1]*a.f[3];
  a.t[3] = p[3,1]*hand_t[1] + p[3,2]*hand_t[2] + p[3,3]*hand_t[3]
    + lever[1]*a.f[2] - lever[2]*a.f[1];
  tilt_torque = level*(pivot[1]*hand_t[1] + pivot[2]*hand_t[2] + pivot[3]*hand_t[3]);
  (1 - slides)*(axis[1]*twist[1] + axis[2]*twist[2] + axis[3]*twist[3])
    + slides*(axis[1]*push[1] + axis[2]*push[2] + axis[3]*push[3]) + linkage = drive.tau
    - viscous*speed - stands*held*der(speed);
  hand_turn[1,1] = turn[1,1]*p[1,1] + turn[1,2]*p[2,1] + turn[1,3]*p[3,1];
  hand_turn[1,2] = turn[1,1]*p[1,2] + turn[1,2]*p[2,2] + turn[1,3]*p[3,2];
  hand_turn[1,3] = turn[1,1]*p[1,3] + turn[1,2]*p[2,3] + turn[1,3]*p[3,3];
  hand_turn[2,1] = turn[2,1]*p[1,1] + turn[2,2]*p[2,1] + turn[2,3]*p[3,1];
  hand_turn[2,2] = turn[2,1]*p[1,2] + turn[2,2]*p[2,2] + turn[2,3]*p[3,2];
  hand_turn[2,3] = turn[2,1]*p[1,3] + turn[2,2]*p[2,3] + turn[2,3]*p[3,3];
  hand_turn[3,1] = turn[3,1]*p[1,1] + turn[3,2]*p[2,1] + turn[3,3]*p[3,1];
  hand_turn[3,2] = turn[3,1]*p[1,2] + turn[3,2]*p[2,2] + turn[3,3]*p[3,2];
  hand_turn[3,3] = turn[3,1]*p[1,3] + turn[3,2]*p[2,3] + turn[3,3]*p[3,3];
  own_place[1] = place[1] + turn[1,1]*lever[1] + turn[1,2]*lever[2] + turn[1,3]*lever[3]
    + hand_turn[1,1]*hand[1] + hand_turn[1,2]*hand[2] + hand_turn[1,3]*hand[3];
  own_place[2] = place[2] + turn[2,1]*lever[1] + turn[2,2]*lever[2] + turn[2,3]*lever[3]
    + hand_turn[2,1]*hand[1] + hand_turn[2,2]*hand[2] + hand_turn[2,3]*hand[3];
  own_place[3] = place[3] + turn[3,1]*lever[1] + turn[3,2]*lever[2] + turn[3,3]*lever[3]
    + hand_turn[3,1]*hand[1] + hand_turn[3,2]*hand[2] + hand_turn[3,3]*hand[3];
  own_turn[1,1] = hand_turn[1,1]*r[1,1] + hand_turn[1,2]*r[2,1] + hand_turn[1,3]*r[3,1];
  own_turn[1,2] = hand_turn[1,1]*r[1,2] + hand_turn[1,2]*r[2,2] + hand_turn[1,3]*r[3,2];
  own_turn[1,3] = hand_turn[1,1]*r[1,3] + hand_turn[1,2]*r[2,3] + hand_turn[1,3]*r[3,3];
  own_turn[2,1] = hand_turn[2,1]*r[1,1] + hand_turn[2,2]*r[2,1] + hand_turn[2,3]*r[3,1];
  own_turn[2,2] = hand_turn[2,1]*r[1,2] + hand_turn[2,2]*r[2,2] + hand_turn[2,3]*r[3,2];
  own_turn[2,3] = hand_turn[2,1]*r[1,3] + hand_turn[2,2]*r[2,3] + hand_turn[2,3]*r[3,3];
  own_turn[3,1] = hand_turn[3,1]*r[1,1] + hand_turn[3,2]*r[2,1] + hand_turn[3,3]*r[3,1];
  own_turn[3,2] = hand_turn[3,1]*r[1,2] + hand_turn[3,2]*r[2,2] + hand_turn[3,3]*r[3,2];
  own_turn[3,3] = hand_turn[3,1]*r[1,3] + hand_turn[3,2]*r[2,3] + hand_turn[3,3]*r[3,3];
  annotation(Documentation(info = "<html>
<p>Newton and Euler, each in the axes of the link: rates and accelerations go out along the arm,
forces and torques come back. The frames before and after are parallel at angle 0. Of a joint that
slides, angle is the way, torque the force of its drive. Rates, place and
turn are signals and no part of the connector, which has as many flows as accelerations.</p>
<p>The joint of a palletizer's tool is on a hand that turns on a pivot of the link before, by a sum
of the angles of other joints. The pivot's torque is asked of these in the same proportion, for the
rods of a linkage do no work. Elsewhere the hand is nothing and the pivot is the joint.</p>
</html>"));
end ArmLink;
