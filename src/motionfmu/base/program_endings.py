"""Endings of the names of program files by language, in lower case."""

ROBOT_JOBS = (".job", ".jbi")  # the robot language
CARD_JOBS = (".mcj",)  # a network card's own
