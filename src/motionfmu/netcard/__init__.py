"""Network motion cards on the PC: configuration, plan, job file, protocol, server and page."""
