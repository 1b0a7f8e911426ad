"""Modelica classes as FMUs.

rumoca flattens a class, CasADi holds its equations, C is printed from them.
"""
