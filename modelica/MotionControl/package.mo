within;
package MotionControl "Axes of machines as a drive sees them; self-contained"
  constant Real pi(unit = "1") = 3.14159265358979323846 "Half the circumference of the unit circle";
  annotation(Documentation(info = "<html>
<p>One class per file. Positive angles move the table in its positive direction. A flow variable is
positive into the component, as in the Standard Library.</p>
</html>"));
end MotionControl;
