"""What all parts of the package share: errors, units, lines of files, the C library."""
