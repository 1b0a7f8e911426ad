"""Programs and drawings before they run: their pages and pictures."""
