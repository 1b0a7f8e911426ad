"""What runs and models tell: contour, tool paths, loops, causes of errors, part programs."""
