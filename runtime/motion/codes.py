"""Codes of motion, registered at import; the module imports nothing heavy, so that they are known without numerics."""

from runtime.core.faults import Code, Stage, register

register(
    Code(
        code="RBL416",
        name="arc-undefined",
        meaning="Start, via point and end of an arc do not define a circle: two of them coincide, or all are on one "
        "line.",
        remedy="Teach the via point well off the straight line from start to end, or use MOVE.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL417",
        name="spline-undefined",
        meaning="No curve passes two points of a SPLINE in a row: the tool would turn at one place, or make half a "
        "turn, which has two directions.",
        remedy="Turn the tool in a MOVE of its own, or teach a point between the two.",
        found=Stage.MOTION,
    ),
)
