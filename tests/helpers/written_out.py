"""A scenario with everything written out, of which tests change words."""

from pathlib import Path

WHOLE_CIRCLE = Path(__file__).with_name("whole_circle")  # runs as scenarios/circle_theory does
WHOLE_TEXT = (WHOLE_CIRCLE / "scenario.toml").read_text()
