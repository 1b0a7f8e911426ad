within MotionControl;
connector TranslationalFlange "Flange of a part that slides"
  Real s(unit = "m") "Position of the flange";
  flow Real f(unit = "N") "Force into the component";
end TranslationalFlange;
