"""What describes an FMU, and how it is made of C cores or a Modelica class."""
