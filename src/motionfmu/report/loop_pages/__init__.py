"""Margins and tuned gains: their pages and pictures."""
