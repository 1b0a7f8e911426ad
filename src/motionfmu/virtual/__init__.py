"""Controllers without FMUs: the motion library on its card, the robot's controller with its arm."""
