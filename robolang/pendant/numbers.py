"""Numbers as the prompt shows them, in mm and deg."""

from robolang.values.poses import Six


def pose_text(six: Six) -> str:
    """Return a pose (mm, deg) with the names of its values."""
    # adding zero turns a rounded -0.0 into 0.0
    x, y, z, rx, ry, rz = (round(value, 3) + 0.0 for value in six)
    return f"X {x:.3f}  Y {y:.3f}  Z {z:.3f} mm   RX {rx:.3f}  RY {ry:.3f}  RZ {rz:.3f} deg"
