"""Where the contour error comes from: its pages and pictures."""
