"""A machine as a Grbl 1.1 controller: the protocol, without I/O."""
