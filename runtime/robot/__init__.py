"""Robot descriptions, models and kinematics."""
