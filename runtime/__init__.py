"""The controller: robot models, interpolation, background dynamics, servo and plant. SI units throughout."""
