within MotionControl;
model TurningLink
  "Rigid link that turns about the x, y or z axis, with its share of the arm's mass matrix"
  parameter Real axis[3](each unit = "1") = {0, 0, 1} "Axis of the joint: one element is 1";
  parameter Real own[6](each unit = "1") = {1, 0, 0, 0, 0, 0} "1 at the number of the joint";
  parameter Real origin[3](each unit = "m") = {0, 0, 0} "Joint in the frame before";
  parameter Real mass(unit = "kg", min = 0) = 1 "Mass";
  parameter Real center[3](each unit = "m") = {0, 0, 0} "Centre of mass in the own frame";
  parameter Real inertia[3](each unit = "kg.m2", each min = 0) = {0, 0, 0}
    "Moments of inertia about the centre: xx, yy, zz";
  parameter Real product[3](each unit = "kg.m2") = {0, 0, 0}
    "Elements xy, yz, zx of the tensor of inertia about the centre";
  parameter Real viscous(unit = "N.m.s/rad", min = 0) = 0 "Friction torque per speed";
  parameter Real start_angle(unit = "rad") = 0 "Angle at the start";
  parameter Real next_origin[3](each unit = "m") = {0, 0, 0} "Next joint in the own frame";
  parameter Real next_mass(unit = "kg") = 0 "Mass of all links behind the next joint";
  parameter Real next_axial[3](each unit = "kg.m") = {0, 0, 0} "Moment along the next joint's axis";
  parameter Real next_spread[3](each unit = "kg.m2") = {0, 0, 0}
    "Second moment xx, yy, zz along the next joint's axis";
  final parameter Real all_mass(unit = "kg") = mass + next_mass "With all links behind";
  final parameter Real all_moment[3](each unit = "kg.m") = mass*center + next_mass*next_origin
    + next_axial "First moment about the joint, with what stands still in this frame";
  final parameter Real all_square[3](each unit = "kg.m2") = {
    (inertia[2] + inertia[3] - inertia[1])/2, (inertia[3] + inertia[1] - inertia[2])/2,
    (inertia[1] + inertia[2] - inertia[3])/2} + {
    mass*center[1]^2 + next_mass*next_origin[1]^2 + 2*next_axial[1]*next_origin[1],
    mass*center[2]^2 + next_mass*next_origin[2]^2 + 2*next_axial[2]*next_origin[2],
    mass*center[3]^2 + next_mass*next_origin[3]^2 + 2*next_axial[3]*next_origin[3]} + next_spread
    "Second moments xx, yy, zz about the joint";
  final parameter Real all_mixed[3](each unit = "kg.m2") = {
    mass*center[1]*center[2] + next_mass*next_origin[1]*next_origin[2]
    + next_axial[1]*next_origin[2] + next_axial[2]*next_origin[1],
    mass*center[2]*center[3] + next_mass*next_origin[2]*next_origin[3]
    + next_axial[2]*next_origin[3] + next_axial[3]*next_origin[2],
    mass*center[3]*center[1] + next_mass*next_origin[3]*next_origin[1]
    + next_axial[3]*next_origin[1] + next_axial[1]*next_origin[3]} - product
    "Second moments xy, yz, zx";
  final parameter Real axial[3](each unit = "kg.m") = {axis[1]*all_moment[1],
    axis[2]*all_moment[2], axis[3]*all_moment[3]} "First moment along the axis";
  final parameter Real spread[3](each unit = "kg.m2") = {axis[1]*all_square[1],
    axis[2]*all_square[2], axis[3]*all_square[3]} "Second moment along the axis";
  final parameter Real moment[3](each unit = "kg.m") = {(1 - axis[1])*all_moment[1],
    (1 - axis[2])*all_moment[2], (1 - axis[3])*all_moment[3]} "First moment that turns";
  final parameter Real square[3](each unit = "kg.m2") = {(1 - axis[1])*all_square[1],
    (1 - axis[2])*all_square[2], (1
    - axis[3])*all_square[3]} "Second moments that turn: xx, yy, zz";
  RotationalFlange drive "What turns the joint";
  input Real rate[3](each unit = "rad/s") "Angular velocity of the link before, in its axes";
  input Real change[3](each unit = "rad/s2")
    "Its angular acceleration while no joint is accelerated";
  input Real whirl[3,3](each unit = "1/s2") "Its acceleration field: of a point per place";
  input Real drift[3](each unit = "m/s2")
    "Acceleration of its origin while no joint is accelerated, less that of gravity";
  input Real tip[3](each unit = "m") "Tip of the tool, in own axes";
  input Real pull[3](each unit = "N") "Force on it, in axes before";
  input Real next_push[3](each unit = "N") "What the next link asks for: force";
  input Real next_twist[3](each unit = "N.m") "Torque about the own origin";
  input Real next_moment[3](each unit = "kg.m") "First moment of the links behind, about there";
  input Real next_square[3](each unit = "kg.m2") "Their second moments xx, yy, zz";
  input Real next_mixed[3](each unit = "kg.m2") "Their second moments xy, yz, zx";
  input Real next_force[6,3](each unit = "kg.m") "Force per acceleration of each joint behind";
  input Real next_torque[6,3](each unit = "kg.m2") "Torque per acceleration of each joint behind";
  input Real coupling(unit = "N.m") "Torque that the accelerations of all joints ask for";
  output Real own_rate[3](each unit = "rad/s") "Own angular velocity, in own axes";
  output Real own_change[3](each unit = "rad/s2") "See change";
  output Real own_whirl[3,3](each unit = "1/s2") "See whirl";
  output Real own_drift[3](each unit = "m/s2") "See drift";
  output Real tip_before[3](each unit = "m") "Tip of the tool, in axes before";
  output Real own_pull[3](each unit = "N") "Force on it, in own axes";
  output Real push[3](each unit = "N") "What motion without accelerations asks of the link before";
  output Real twist[3](each unit = "N.m") "Torque about its origin";
  output Real whole_moment[3](each unit = "kg.m") "First moment of this link and those behind";
  output Real whole_square[3](each unit = "kg.m2") "Second moments xx, yy, zz";
  output Real whole_mixed[3](each unit = "kg.m2") "Second moments xy, yz, zx";
  output Real force[6,3](each unit = "kg.m") "Force per acceleration of each joint from this on";
  output Real torque[6,3](each unit = "kg.m2") "Torque per acceleration of each joint from this on";
  output Real coupled[6](each unit = "kg.m2") "Torque of this joint per acceleration of each";
  Real angle(unit = "rad", start = start_angle, fixed = true) "Angle of the joint";
  Real speed(unit = "rad/s", start = 0, fixed = true) "Speed of the joint";
protected
  Real c(unit = "1") "Cosine of the angle";
  Real s(unit = "1") "Sine of the angle";
  Real r[3,3](each unit = "1") "From own axes to those before";
  Real carried[3](each unit = "rad/s") "Rate before, in own axes";
  Real joint_drift[3](each unit = "m/s2") "Drift of the joint, in axes before";
  Real own_push[3](each unit = "N") "Force on the joint, in own axes";
  Real own_twist[3](each unit = "N.m") "Torque about the joint, in own axes";
  Real h[3](each unit = "kg.m") "First moment of this link and those behind, about the joint";
  Real square_h[3](each unit = "kg.m2") "Their second moments xx, yy, zz";
  Real mixed_h[3](each unit = "kg.m2") "Their second moments xy, yz, zx";
  Real aside[3](each unit = "kg.m2") "What turning them moves from one to the other";
  Real own_force[6,3](each unit = "kg.m") "Force on the joint per acceleration";
  Real own_torque[6,3](each unit = "kg.m2") "Torque about the joint per acceleration";
equation
  der(angle) = speed;
  drive.phi = angle;
  c = cos(angle);
  s = sin(angle);
  r[1,1] = axis[1] + (1 - axis[1])*c;
  r[1,2] = -axis[3]*s;
  r[1,3] = axis[2]*s;
  r[2,1] = axis[3]*s;
  r[2,2] = axis[2] + (1 - axis[2])*c;
  r[2,3] = -axis[1]*s;
  r[3,1] = -axis[2]*s;
  r[3,2] = axis[1]*s;
  r[3,3] = axis[3] + (1 - axis[3])*c;
  carried[1] = r[1,1]*rate[1] + r[2,1]*rate[2] + r[3,1]*rate[3];
  carried[2] = r[1,2]*rate[1] + r[2,2]*rate[2] + r[3,2]*rate[3];
  carried[3] = r[1,3]*rate[1] + r[2,3]*rate[2] + r[3,3]*rate[3];
  for k in 1:3 loop
    own_rate[k] = carried[k] + axis[k]*speed;
  end for;
  own_change[1] = r[1,1]*change[1] + r[2,1]*change[2] + r[3,1]*change[3]
    + (carried[2]*axis[3] - carried[3]*axis[2])*speed;
  own_change[2] = r[1,2]*change[1] + r[2,2]*change[2] + r[3,2]*change[3]
    + (carried[3]*axis[1] - carried[1]*axis[3])*speed;
  own_change[3] = r[1,3]*change[1] + r[2,3]*change[2] + r[3,3]*change[3]
    + (carried[1]*axis[2] - carried[2]*axis[1])*speed;
  own_whirl[1,1] = -(own_rate[2]^2 + own_rate[3]^2);
  own_whirl[1,2] = own_rate[1]*own_rate[2] - own_change[3];
  own_whirl[1,3] = own_rate[1]*own_rate[3] + own_change[2];
  own_whirl[2,1] = own_rate[1]*own_rate[2] + own_change[3];
  own_whirl[2,2] = -(own_rate[3]^2 + own_rate[1]^2);
  own_whirl[2,3] = own_rate[2]*own_rate[3] - own_change[1];
  own_whirl[3,1] = own_rate[1]*own_rate[3] - own_change[2];
  own_whirl[3,2] = own_rate[2]*own_rate[3] + own_change[1];
  own_whirl[3,3] = -(own_rate[1]^2 + own_rate[2]^2);
  joint_drift[1] = drift[1] + whirl[1,1]*origin[1] + whirl[1,2]*origin[2] + whirl[1,3]*origin[3];
  joint_drift[2] = drift[2] + whirl[2,1]*origin[1] + whirl[2,2]*origin[2] + whirl[2,3]*origin[3];
  joint_drift[3] = drift[3] + whirl[3,1]*origin[1] + whirl[3,2]*origin[2] + whirl[3,3]*origin[3];
  own_drift[1] = r[1,1]*joint_drift[1] + r[2,1]*joint_drift[2] + r[3,1]*joint_drift[3];
  own_drift[2] = r[1,2]*joint_drift[1] + r[2,2]*joint_drift[2] + r[3,2]*joint_drift[3];
  own_drift[3] = r[1,3]*joint_drift[1] + r[2,3]*joint_drift[2] + r[3,3]*joint_drift[3];
  own_push[1] = next_push[1] + own_whirl[1,1]*moment[1] + own_whirl[1,2]*moment[2]
    + own_whirl[1,3]*moment[3];
  own_push[2] = next_push[2] + own_whirl[2,1]*moment[1] + own_whirl[2,2]*moment[2]
    + own_whirl[2,3]*moment[3];
  own_push[3] = next_push[3] + own_whirl[3,1]*moment[1] + own_whirl[3,2]*moment[2]
    + own_whirl[3,3]*moment[3];
  own_twist[1] = next_twist[1] + own_whirl[3,1]*all_mixed[1] + own_whirl[3,2]*square[2]
    + own_whirl[3,3]*all_mixed[2]
    - own_whirl[2,1]*all_mixed[3] - own_whirl[2,2]*all_mixed[2] - own_whirl[2,3]*square[3]
    + moment[2]*own_drift[3] - moment[3]*own_drift[2];
  own_twist[2] = next_twist[2] + own_whirl[1,1]*all_mixed[3] + own_whirl[1,2]*all_mixed[2]
    + own_whirl[1,3]*square[3]
    - own_whirl[3,1]*square[1] - own_whirl[3,2]*all_mixed[1] - own_whirl[3,3]*all_mixed[3]
    + moment[3]*own_drift[1] - moment[1]*own_drift[3];
  own_twist[3] = next_twist[3] + own_whirl[2,1]*square[1] + own_whirl[2,2]*all_mixed[1]
    + own_whirl[2,3]*all_mixed[3]
    - own_whirl[1,1]*all_mixed[1] - own_whirl[1,2]*square[2] - own_whirl[1,3]*all_mixed[2]
    + moment[1]*own_drift[2] - moment[2]*own_drift[1];
  push[1] = r[1,1]*own_push[1] + r[1,2]*own_push[2] + r[1,3]*own_push[3];
  push[2] = r[2,1]*own_push[1] + r[2,2]*own_push[2] + r[2,3]*own_push[3];
  push[3] = r[3,1]*own_push[1] + r[3,2]*own_push[2] + r[3,3]*own_push[3];
  twist[1] = r[1,1]*own_twist[1] + r[1,2]*own_twist[2] + r[1,3]*own_twist[3]
    + origin[2]*push[3] - origin[3]*push[2];
  twist[2] = r[2,1]*own_twist[1] + r[2,2]*own_twist[2] + r[2,3]*own_twist[3]
    + origin[3]*push[1] - origin[1]*push[3];
  twist[3] = r[3,1]*own_twist[1] + r[3,2]*own_twist[2] + r[3,3]*own_twist[3]
    + origin[1]*push[2] - origin[2]*push[1];
  for k in 1:3 loop
    h[k] = moment[k] + next_moment[k];
    square_h[k] = square[k] + next_square[k];
    mixed_h[k] = all_mixed[k] + next_mixed[k];
    whole_moment[k] = r[k,1]*h[1] + r[k,2]*h[2] + r[k,3]*h[3];
  end for;
  aside[1] = axis[1]*(c*(square_h[2] - square_h[3]) - 2*s*mixed_h[2]);
  aside[2] = axis[2]*(c*(square_h[3] - square_h[1]) - 2*s*mixed_h[3]);
  aside[3] = axis[3]*(c*(square_h[1] - square_h[2]) - 2*s*mixed_h[1]);
  whole_square[1] = axis[1]*square_h[1] + axis[3]*square_h[2] + axis[2]*square_h[3]
    + c*(aside[3] - aside[2]) + 2*whole_moment[1]*origin[1];
  whole_square[2] = axis[2]*square_h[2] + axis[1]*square_h[3] + axis[3]*square_h[1]
    + c*(aside[1] - aside[3]) + 2*whole_moment[2]*origin[2];
  whole_square[3] = axis[3]*square_h[3] + axis[2]*square_h[1] + axis[1]*square_h[2]
    + c*(aside[2] - aside[1]) + 2*whole_moment[3]*origin[3];
  whole_mixed[1] = axis[3]*(mixed_h[1] + s*aside[3]) + axis[1]*(c*mixed_h[1] - s*mixed_h[3])
    + axis[2]*(c*mixed_h[1] + s*mixed_h[2]) + whole_moment[1]*origin[2] + whole_moment[2]*origin[1];
  whole_mixed[2] = axis[1]*(mixed_h[2] + s*aside[1]) + axis[2]*(c*mixed_h[2] - s*mixed_h[1])
    + axis[3]*(c*mixed_h[2] + s*mixed_h[3]) + whole_moment[2]*origin[3] + whole_moment[3]*origin[2];
  whole_mixed[3] = axis[2]*(mixed_h[3] + s*aside[2]) + axis[3]*(c*mixed_h[3] - s*mixed_h[2])
    + axis[1]*(c*mixed_h[3] + s*mixed_h[1]) + whole_moment[3]*origin[1] + whole_moment[1]*origin[3];
  for j in 1:6 loop
    own_force[j,1] = own[j]*(axis[2]*h[3] - axis[3]*h[2]) + next_force[j,1];
    own_force[j,2] = own[j]*(axis[3]*h[1] - axis[1]*h[3]) + next_force[j,2];
    own_force[j,3] = own[j]*(axis[1]*h[2] - axis[2]*h[1]) + next_force[j,3];
    own_torque[j,1] = own[j]*(axis[1]*(square_h[2] + square_h[3])
      - axis[2]*mixed_h[1] - axis[3]*mixed_h[3]) + next_torque[j,1];
    own_torque[j,2] = own[j]*(axis[2]*(square_h[3] + square_h[1])
      - axis[3]*mixed_h[2] - axis[1]*mixed_h[1]) + next_torque[j,2];
    own_torque[j,3] = own[j]*(axis[3]*(square_h[1] + square_h[2])
      - axis[1]*mixed_h[3] - axis[2]*mixed_h[2]) + next_torque[j,3];
    coupled[j] = axis[1]*own_torque[j,1] + axis[2]*own_torque[j,2] + axis[3]*own_torque[j,3];
    force[j,1] = r[1,1]*own_force[j,1] + r[1,2]*own_force[j,2] + r[1,3]*own_force[j,3];
    force[j,2] = r[2,1]*own_force[j,1] + r[2,2]*own_force[j,2] + r[2,3]*own_force[j,3];
    force[j,3] = r[3,1]*own_force[j,1] + r[3,2]*own_force[j,2] + r[3,3]*own_force[j,3];
    torque[j,1] = r[1,1]*own_torque[j,1] + r[1,2]*own_torque[j,2] + r[1,3]*own_torque[j,3]
      + origin[2]*force[j,3] - origin[3]*force[j,2];
    torque[j,2] = r[2,1]*own_torque[j,1] + r[2,2]*own_torque[j,2] + r[2,3]*own_torque[j,3]
      + origin[3]*force[j,1] - origin[1]*force[j,3];
    torque[j,3] = r[3,1]*own_torque[j,1] + r[3,2]*own_torque[j,2] + r[3,3]*own_torque[j,3]
      + origin[1]*force[j,2] - origin[2]*force[j,1];
  end for;
  axis[1]*own_twist[1] + axis[2]*own_twist[2] + axis[3]*own_twist[3] + coupling = drive.tau
    - viscous*speed;
  tip_before[1] = origin[1] + r[1,1]*tip[1] + r[1,2]*tip[2] + r[1,3]*tip[3];
  tip_before[2] = origin[2] + r[2,1]*tip[1] + r[2,2]*tip[2] + r[2,3]*tip[3];
  tip_before[3] = origin[3] + r[3,1]*tip[1] + r[3,2]*tip[2] + r[3,3]*tip[3];
  own_pull[1] = r[1,1]*pull[1] + r[2,1]*pull[2] + r[3,1]*pull[3];
  own_pull[2] = r[1,2]*pull[1] + r[2,2]*pull[2] + r[3,2]*pull[3];
  own_pull[3] = r[1,3]*pull[1] + r[2,3]*pull[2] + r[3,3]*pull[3];
  annotation(Documentation(info = "<html>
<p>Composite rigid bodies: a link has the moments of itself and of all that it carries, so its
column of the mass matrix is what one unit of acceleration asks for. What motion without
accelerations asks for comes back along the arm by Newton and Euler.</p>
<p>Masses are moved inwards first. The mass of a link stands still in the link before it, as if it
were at the joint; so do first and second moments along the joint's axis. Only seven numbers of a
link are left, and no force needs the acceleration of a joint.</p>
</html>"));
end TurningLink;
