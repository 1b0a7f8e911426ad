within MotionControl;
connector Frame "Frame of a body, all along its own axes"
  Real a[3](each unit = "m/s2") "Acceleration of the origin, less that of gravity";
  Real z[3](each unit = "rad/s2") "Angular acceleration";
  flow Real f[3](each unit = "N") "Force into the component";
  flow Real t[3](each unit = "N.m") "Torque into the component, about the origin";
end Frame;
