within MotionControl;
model PressureSource "Pump or tank: oil at a constant pressure"
  parameter Real pressure(unit = "Pa") = 0 "Gauge pressure";
  HydraulicPort port "Where the oil is";
equation
  port.p = pressure;
end PressureSource;
