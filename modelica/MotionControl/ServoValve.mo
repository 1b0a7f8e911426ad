within MotionControl;
model ServoValve "Four-way servo valve: spool of second order, four rounded edges, leakage"
  parameter Real rated_current(unit = "A", min = 0) = 0.04 "Current for the full stroke";
  parameter Real frequency(unit = "rad/s", min = 0) = 500 "Natural frequency of the spool";
  parameter Real damping(unit = "1", min = 0) = 0.8 "Damping ratio of the spool";
  parameter Real overlap(unit = "1", min = 0) = 0.03
    "Stroke to the opening of an edge, as a share of the full";
  parameter Real rounding(unit = "1", min = 0) = 2e-3 "Stroke over which it begins to open";
  parameter Real rated_flow(unit = "m3/s", min = 0) = 1.7e-4 "Flow per edge at the full stroke";
  parameter Real rated_drop(unit = "Pa", min = 0) = 35e5 "Pressure drop per edge at that flow";
  parameter Real laminar_drop(unit = "Pa", min = 0) = 1e5 "Drop below which an edge is laminar";
  parameter Real leakage(unit = "m3.s-1.Pa-1", min = 0) = 3e-13 "Leakage per edge and pressure";
  input Real current(unit = "A") "Current of the coil";
  HydraulicPort supply "From the pump";
  HydraulicPort tank "To the tank";
  HydraulicPort a "To the chamber that opens with positive current";
  HydraulicPort b "To the other chamber";
  Real stroke(unit = "1") "Spool between its stops, of the full stroke";
protected
  Real spool(unit = "1", start = 0, fixed = true) "Spool as if there were no stops";
  Real rate(unit = "1/s", start = 0, fixed = true, nominal = frequency) "Its speed";
  Real one_way(unit = "1") "Opening of the edges supply to a and b to tank";
  Real other_way(unit = "1") "Opening of the edges supply to b and a to tank";
  Real supply_a(unit = "m3/s") "Flow from supply to a";
  Real supply_b(unit = "m3/s") "Flow from supply to b";
  Real a_tank(unit = "m3/s") "Flow from a to tank";
  Real b_tank(unit = "m3/s") "Flow from b to tank";
  final parameter Real flow_gain(unit = "m3/s") = rated_flow/((1 - overlap)*sqrt(rated_drop))
    "Flow per stroke and root of 1 Pa";
equation
  der(spool) = rate;
  der(rate) = frequency^2*(min(max(current/rated_current, -1), 1) - spool)
    - 2*damping*frequency*rate;
  stroke = min(max(spool, -1), 1);
  one_way = softPositive(stroke - overlap, rounding);
  other_way = softPositive(-stroke - overlap, rounding);
  supply_a = flow_gain*one_way*signedRoot(supply.p - a.p, laminar_drop)
    + leakage*(supply.p - a.p);
  supply_b = flow_gain*other_way*signedRoot(supply.p - b.p, laminar_drop)
    + leakage*(supply.p - b.p);
  a_tank = flow_gain*other_way*signedRoot(a.p - tank.p, laminar_drop) + leakage*(a.p - tank.p);
  b_tank = flow_gain*one_way*signedRoot(b.p - tank.p, laminar_drop) + leakage*(b.p - tank.p);
  supply.q = supply_a + supply_b;
  tank.q = -(a_tank + b_tank);
  a.q = a_tank - supply_a;
  b.q = b_tank - supply_b;
  annotation(Documentation(info = "<html>
<p>All four edges are alike (matched and symmetrical). At the centre a closed edge still passes
flow_gain*rounding^2/(4*overlap) per root of pressure beside the laminar leakage.</p>
</html>"));
end ServoValve;
