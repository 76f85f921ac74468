"""Codes of programs that run and of what checking them finds: expressions, control, flow, motion, inputs and outputs.

Registered at import, as those of ``robolang.core.codes``, which imports this module.
"""

from runtime.core.faults import Code, Stage, register

register(
    Code(
        code="RBL540",
        name="arm-displaced",
        meaning="A motion that was interrupted is to go on, and the arm is not where it has left its path.",
        remedy="Let the arm return to its path first (continue), or begin the statement again from where the arm is.",
    ),
    Code(
        code="RBL541",
        name="too-far-to-return",
        meaning="The arm is too far from the path that it has left, or from where the program stood between two "
        "statements, so that it does not return by itself.",
        remedy="Jog the arm closer to that place, the message states how far it is; or put the program before its "
        "first statement (restart).",
    ),
    Code(
        code="RBL542",
        name="nothing-to-begin-again",
        meaning="No statement of the program is interrupted, so that none can be begun again.",
        remedy="Acknowledge the alarm first; after the end of a program, start it anew.",
    ),
    Code(
        code="RBL543",
        name="line-in-use",
        meaning="An edit of a program that stands removes or changes a line that the program is inside of.",
        remedy="Keep the line, or let the program leave it first; the message names the line.",
    ),
    Code(
        code="RBL544",
        name="seam-followed",
        meaning="The arm follows a seam sensor, and cannot be moved by hand meanwhile.",
        remedy="Switch the sensor off with SEAM OFF; SEAM ON follows it again.",
    ),
    Code(
        code="RBL545",
        name="no-earlier-place",
        meaning="The program is to be taken back by more places than are known.",
        remedy="Go back by fewer; places are known from the start of the session on, and the oldest are forgotten.",
    ),
    Code(
        code="RBL202",
        name="target-undefined",
        meaning="A jump leads to a line number or a label that does not exist.",
        remedy="Correct the target, or write its number or *LABEL at the start of a line.",
    ),
    Code(
        code="RBL203",
        name="defined-twice",
        meaning="A label or a SUB is defined twice.",
        remedy="Rename one of the two.",
    ),
    Code(
        code="RBL204",
        name="jump-into-block",
        meaning="A jump leads into a loop, a branch or a SUB from outside, or out of a SUB.",
        remedy="Jump to the first line of the block; enter a SUB with CALL and leave it at its ENDSUB.",
    ),
    Code(
        code="RBL205",
        name="step-zero",
        meaning="FOR has STEP 0, so the loop would never end.",
        remedy="Give a STEP other than 0.",
    ),
    Code(
        code="RBL206",
        name="step-fraction",
        meaning="FOR has a STEP that is not a whole number: its variable accumulates rounding errors, the number of "
        "rounds does not.",
        remedy="Count with whole numbers, and divide or multiply inside the loop.",
    ),
    Code(
        code="RBL209",
        name="no-value-at-all",
        meaning="An expression of constant numbers has no result, such as 1 / 0.",
        remedy="Correct the numbers of the expression.",
    ),
    Code(
        code="RBL211",
        name="block-not-closed",
        meaning="An IF, FOR, WHILE, SELECT or SUB has no end.",
        remedy="Close the block with ENDIF, NEXT, WEND, ENDSELECT or ENDSUB.",
    ),
    Code(
        code="RBL212",
        name="block-without-head",
        meaning="A line that continues or ends a block has no first line of that block above it.",
        remedy="Write the first line of the block, or remove this line; close an inner block before the outer one.",
    ),
    Code(
        code="RBL213",
        name="sub-undefined",
        meaning="CALL names a SUB that does not exist.",
        remedy="Correct the name, or write the SUB.",
    ),
    Code(
        code="RBL214",
        name="argument-count",
        meaning="A CALL or a function has the wrong number of arguments.",
        remedy="Give the number of arguments that the message states.",
    ),
    Code(
        code="RBL215",
        name="name-undefined",
        meaning="A name is used that has no value: nothing assigns one, and no taught point has the name.",
        remedy="Correct the name, assign a value, or teach the point.",
    ),
    Code(
        code="RBL216",
        name="constant-assigned",
        meaning="A value is assigned to a name that CONST has defined.",
        remedy="Change the value in the CONST line, or use another name.",
    ),
    Code(
        code="RBL217",
        name="kind-mismatch",
        meaning="A number, a text or a pose stands where another kind of value is needed.",
        remedy="Convert between numbers and texts with STR$ and VAL; read the numbers of a pose with P.X to P.RZ.",
    ),
    Code(
        code="RBL218",
        name="component-unknown",
        meaning="A pose has no component of this name.",
        remedy="Use X, Y, Z, RX, RY or RZ.",
    ),
    Code(
        code="RBL219",
        name="sub-inside-block",
        meaning="A SUB is inside a block.",
        remedy="Move the SUB to the end of the file, after the main program.",
    ),
    Code(
        code="RBL220",
        name="value-count",
        meaning="Parentheses hold the wrong number of values.",
        remedy="Give a position three values (x, y, z), an offset with rotation and an inertia six, SPLINE two or more "
        "points.",
    ),
    Code(
        code="RBL224",
        name="point-unused",
        meaning="A taught point is not used in the program.",
        remedy="Use the point, or remove it from the points file.",
    ),
    Code(
        code="RBL231",
        name="mod-beside-product",
        meaning="MOD stands next to * or / without parentheses.",
        remedy="Write parentheses that show the order, as in (a * b) MOD c.",
    ),
    Code(
        code="RBL232",
        name="rounded-comparison",
        meaning="A number that may be rounded is compared with = or <>.",
        remedy="Compare the difference with a small number, as in ABS(x - 0.3) < 1E-6.",
    ),
    Code(
        code="RBL236",
        name="point-twice",
        meaning="A SPLINE has the same point twice in a row.",
        remedy="Remove one of the two.",
    ),
    Code(
        code="RBL414",
        name="blends-overlap",
        meaning="A blend is smaller than its ZONE or does not take place: a move at the corner is too short, has no "
        "length, or follows a seam sensor; or the next move goes back, so that the tool turns round before the point.",
        remedy="Make the ZONE smaller or the moves at the corner longer, or write FINE where the arm shall stop.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL415",
        name="blend-radius-negative",
        meaning="The ZONE of a blend is below 0, not finite or larger than any robot.",
        remedy="Give a ZONE of 0 to 100000 mm, or FINE to stop.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL419",
        name="ends-otherwise",
        meaning="A move with WRIST KEEP ends in other joint angles than the point was taught with.",
        remedy="Write WRIST AUTO to end as taught, or teach the point in the wrist configuration of the start.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL421",
        name="collision-ahead",
        meaning="A move would bring the arm or the hand into an obstacle of the cell or into the ground.",
        remedy="Move over a via point or from another side, or correct the place of the obstacle in the cell file.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL422",
        name="near-joint-limit",
        meaning="A move brings a joint close to the end of its range.",
        remedy="Teach the point in another configuration, or farther from the end of the range.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL423",
        name="cycle-too-long",
        meaning="The program takes longer than --max-cycle allows.",
        remedy="Find the slow lines in the table of robolang check --motion; change their speeds, zones or waiting "
        "times.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL424",
        name="arm-in-itself",
        meaning="A move would bring the arm or the hand into a link of the arm.",
        remedy="Move over a via point or in another configuration.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL425",
        name="wrist-moment",
        meaning="The weight of the payload causes a moment about a wrist axis above the limit of that axis.",
        remedy="Carry the payload closer to the flange, carry less, hold it in another posture, or correct LOAD.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL426",
        name="wrist-inertia",
        meaning="The inertia of the payload about a wrist axis is above the limit of that axis.",
        remedy="Carry the payload closer to the axis, carry less, or correct LOAD.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL427",
        name="near-singularity",
        meaning="A path comes close to a singular posture, where the joints turn fast for small motions of the tool.",
        remedy="Move the path or the work piece a little, tilt the tool, or use MOVEJ.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL428",
        name="wrist-leaves-posture",
        meaning="On a straight move or an arc the tool leaves its posture for a part of the path, so that the wrist "
        "can change.",
        remedy="Write WRIST AUTO or WRIST HOLD if this is intended; with WRIST KEEP the move is slowed or refused "
        "instead.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL429",
        name="slower-than-asked",
        meaning="A move takes longer than its TIME, or does not reach its SPEED and takes more than 1.2 times as long "
        "as SPEED and the acceleration of the path need: a joint, the turning of the tool, an arc or a corner limits "
        "it.",
        remedy="Give a lower SPEED or a longer TIME, or change what the message names: a larger ZONE, another posture.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL434",
        name="configuration-changes",
        meaning="A MOVEJ to a pose changes the configuration of the arm: RIGHTY and LEFTY, ABOVE and BELOW, or NOFLIP "
        "and FLIP. The present configuration does not reach the pose within the ranges of the joints.",
        remedy="If the change is intended, teach the point with its configuration or as joint angles; otherwise move "
        "over a point between, or move the work piece.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL435",
        name="turns-the-long-way",
        meaning="A MOVEJ to a pose turns a joint by more than half a turn, because the nearer angle is outside its "
        "range.",
        remedy="Turn the joint back in an earlier move, where there is space for it; teach the point as joint angles "
        "if this turn is intended.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL436",
        name="spline-swings",
        meaning="The curve of a SPLINE leaves the straight line between two of its points by more than half of their "
        "distance, or of that of the points beside them.",
        remedy="Teach a point between the two, or points at distances that are more alike.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL437",
        name="spline-doubles-back",
        meaning="The curve of a SPLINE turns back at a point, so that the tool nearly stops there.",
        remedy="Teach points that lead round the turn, or write two moves.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL440",
        name="part-ahead",
        meaning="A move would bring the arm or the hand into a part that lies in the cell, or a carried part into "
        "another part, an obstacle, the floor or the arm.",
        remedy="Move over a via point or from another side, or lift the part before it is moved; the cell file states "
        "where parts lie at the start.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL441",
        name="nothing-to-grip",
        meaning="HAND ON closes where no part of the cell is between the fingers or seals the suction cup.",
        remedy="Compare the point, the tool and the frame with the place of the part, and the size of the part with "
        "the stroke of the hand; a cup needs a flat face under its whole rim.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL501",
        name="division-by-zero",
        meaning="The program divides by zero.",
        remedy="Check the divisor before the division, or handle the error with ON ERROR.",
    ),
    Code(
        code="RBL502",
        name="no-number",
        meaning="A calculation has no finite result, such as the root of a negative number, VAL of a text that is not "
        "a number, or a number that becomes too large.",
        remedy="Check the value before the calculation, or handle the error with ON ERROR.",
    ),
    Code(
        code="RBL506",
        name="too-much-text",
        meaning="A text, all texts that the program keeps, or all that it has printed, is longer than allowed.",
        remedy="Print less or in a shorter loop, and keep only texts that are used.",
    ),
    Code(
        code="RBL507",
        name="no-such-element",
        meaning="An array has no element with this number, or the array, or all arrays and names together, are too "
        "large.",
        remedy="Give DIM the largest number that is used, at most 99999; elements count from 0.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL531",
        name="value-of-other-kind",
        meaning="A number, a text or a pose stands where another kind of value is needed.",
        remedy="Convert between numbers and texts with STR$ and VAL; read the numbers of a pose with P.X to P.RZ.",
    ),
    Code(
        code="RBL532",
        name="name-without-value",
        meaning="A name is used before it has a value.",
        remedy="Assign a value first, teach the point, or correct the name.",
    ),
    Code(
        code="RBL503",
        name="wait-timed-out",
        meaning="The condition of a WAIT did not become true within its TIMEOUT.",
        remedy="Check the input, give a longer TIMEOUT, or state with GOTO or ON ERROR where the program continues.",
    ),
    Code(
        code="RBL504",
        name="calls-too-deep",
        meaning="Too many subroutines have called one another, or too many FORs were left before their end.",
        remedy="End each GOSUB with RETURN, let a SUB that calls itself come to an end, and do not leave a FOR again "
        "and again with GOTO.",
    ),
    Code(
        code="RBL505",
        name="too-many-statements",
        meaning="The run has executed more statements than allowed.",
        remedy="Find the loop that does not end.",
        endless=True,
    ),
    Code(
        code="RBL508",
        name="idle-loop",
        meaning="A loop repeats without a statement that takes time.",
        remedy="Put a DELAY, a WAIT or a move into the loop, or let it end.",
        endless=True,
    ),
    Code(
        code="RBL533",
        name="nowhere-to-return",
        meaning="RETURN, RESUME or NEXT runs without a GOSUB, an error or a FOR before it.",
        remedy="End the main program with END before its subroutines and handlers, and let no GOTO lead there.",
    ),
    Code(
        code="RBL534",
        name="no-such-signal",
        meaning="The cell has no input of that number, or the number of an input or output is not from 1 to 1024.",
        remedy="Use an input of the cell file, or add one: [inputs.1] changes = [[0, 0], [1, 1]]; give a whole number "
        "from 1 to 1024 for an output.",
        found=Stage.CELL,
        computed=True,
    ),
)
