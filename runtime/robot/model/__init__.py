"""The robot as data, its bodies on Pinocchio, and what it may carry."""
