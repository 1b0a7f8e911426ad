"""Endings of programs by their language, in small letters."""

ROBOT_JOBS = (".job", ".jbi")  # the robot language
CARD_JOBS = (".mcj",)  # a network card's own
