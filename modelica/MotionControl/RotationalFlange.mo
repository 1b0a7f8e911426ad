within MotionControl;
connector RotationalFlange "Flange of a shaft"
  Real phi(unit = "rad") "Angle of the flange";
  flow Real tau(unit = "N.m") "Torque into the component";
end RotationalFlange;
