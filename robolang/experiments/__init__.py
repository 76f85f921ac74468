"""Experiments on controller and arm: step response, comparison, identification, weighing, inertia, the wrist."""
