"""Modelica classes as FMUs: rumoca flattens, CasADi holds the equations, C is printed from them."""
