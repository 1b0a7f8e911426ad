"""Pages and pictures of studies."""
