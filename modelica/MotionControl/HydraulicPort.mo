within MotionControl;
connector HydraulicPort "Opening for oil"
  Real p(unit = "Pa") "Gauge pressure at the port";
  flow Real q(unit = "m3/s") "Oil flow into the component";
end HydraulicPort;
