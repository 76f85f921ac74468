"""Codes of programs that run and of what checking them finds: expressions, control, flow, motion, inputs and outputs.

Registered at import, as those of ``robolang.core.codes``, which imports this module.
"""

from runtime.core.faults import Code, Stage, register

register(
    Code(
        code="RBL202",
        name="target-undefined",
        meaning="A jump leads to a line number or a label that there is not.",
        remedy="Correct it, or write the label *NAME at the start of a line.",
    ),
    Code(
        code="RBL203",
        name="defined-twice",
        meaning="A label or a SUB is defined twice.",
        remedy="Rename one of them.",
    ),
    Code(
        code="RBL204",
        name="jump-into-block",
        meaning="A jump leads into a loop, a branch or a SUB that it is not in.",
        remedy="Jump to the head of the block, or use GOSUB or CALL.",
    ),
    Code(
        code="RBL205",
        name="step-zero",
        meaning="FOR has STEP 0 and would never end.",
        remedy="Give another STEP.",
    ),
    Code(
        code="RBL206",
        name="step-fraction",
        meaning="FOR has a STEP that is no whole number: its variable gathers rounding errors, the number of rounds "
        "does not.",
        remedy="Count with whole numbers and multiply inside.",
    ),
    Code(
        code="RBL209",
        name="no-value-at-all",
        meaning="A calculation of numbers alone has no result, such as 1 / 0.",
        remedy="Correct the numbers.",
    ),
    Code(
        code="RBL211",
        name="block-not-closed",
        meaning="An IF, FOR, WHILE, SELECT or SUB has no end.",
        remedy="Write ENDIF, NEXT, WEND, ENDSELECT or ENDSUB below it.",
    ),
    Code(
        code="RBL212",
        name="block-without-head",
        meaning="A line that divides or ends a block has no head above it.",
        remedy="Write the head, or remove the line; blocks are closed in the order in which they were opened.",
    ),
    Code(
        code="RBL213",
        name="sub-undefined",
        meaning="CALL names a SUB that there is not.",
        remedy="Correct the name, or write the SUB.",
    ),
    Code(
        code="RBL214",
        name="argument-count",
        meaning="A CALL or a function has another number of arguments than it takes.",
        remedy="Give as many as the message says.",
    ),
    Code(
        code="RBL215",
        name="name-undefined",
        meaning="A name is used that nothing assigns and that is no taught point.",
        remedy="Correct the name, assign a value, or teach the point.",
    ),
    Code(
        code="RBL216",
        name="constant-assigned",
        meaning="A value is assigned to a name that CONST fixed.",
        remedy="Use another name.",
    ),
    Code(
        code="RBL217",
        name="kind-mismatch",
        meaning="A number, a text or a pose stands where another is needed.",
        remedy="Use STR$ and VAL between numbers and texts; P.X and its like are the numbers of a pose.",
    ),
    Code(
        code="RBL218",
        name="component-unknown",
        meaning="A pose has no component of that name.",
        remedy="They are X, Y, Z, RX, RY and RZ.",
    ),
    Code(
        code="RBL219",
        name="sub-inside-block",
        meaning="A SUB stands inside a block.",
        remedy="Put it after the main program.",
    ),
    Code(
        code="RBL220",
        name="value-count",
        meaning="Parentheses hold another number of values than is needed there.",
        remedy="A position has three values, an offset with rotation or an inertia six.",
    ),
    Code(
        code="RBL224",
        name="point-unused",
        meaning="A taught point is not named in the program.",
        remedy="Remove it from the points file, or use it.",
    ),
    Code(
        code="RBL231",
        name="mod-beside-product",
        meaning="MOD stands beside * or / without parentheses.",
        remedy="Put parentheses around what belongs together, as in (a * b) MOD c.",
    ),
    Code(
        code="RBL232",
        name="rounded-comparison",
        meaning="A comparison by = or <> of a number that may be rounded.",
        remedy="Compare the difference with a small number, as in ABS(x - 0.3) < 1E-6.",
    ),
    Code(
        code="RBL414",
        name="blends-overlap",
        meaning="A ZONE takes more than half of a move at its corner: the blend is smaller than asked for.",
        remedy="Make the zone smaller, or leave out a point between.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL415",
        name="blend-radius-negative",
        meaning="The radius of a blend is below 0, not finite or beyond every robot.",
        remedy="Give 0 to 100000 mm, or FINE to stop.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL419",
        name="ends-otherwise",
        meaning="A move that keeps the wrist ends in other joint angles than the point was taught with.",
        remedy="Say WRIST AUTO to end as taught, or teach the point in the wrist's configuration of the start.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL421",
        name="collision-ahead",
        meaning="A move would lead the arm or the hand into an obstacle of the cell or into the ground.",
        remedy="Go there over a via point, from another side, or move the obstacle in the cell file to where it is.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL422",
        name="near-joint-limit",
        meaning="A move brings a joint close to the end of its range.",
        remedy="Teach the point in another configuration, or a little further off.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL423",
        name="cycle-too-long",
        meaning="A program takes longer than it was allowed to.",
        remedy="Look where the time goes in the table of robolang check --motion: speeds, zones, dwells.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL424",
        name="arm-in-itself",
        meaning="A move would lead the arm or the hand into one of its own links.",
        remedy="Go there over a via point or in another configuration.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL425",
        name="wrist-moment",
        meaning="The weight of the payload has a moment about a wrist axis over what that may carry.",
        remedy="Carry it nearer to the flange, carry less, hold it in another posture, or correct LOAD.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL426",
        name="wrist-inertia",
        meaning="The payload has an inertia about a wrist axis over what that may carry.",
        remedy="Carry it nearer to the axis, carry less, or correct LOAD.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL427",
        name="near-singularity",
        meaning="A path comes near a singular posture, where joints must turn fast for small motions of the tool.",
        remedy="Move the path or the work piece a little, tilt the tool, or go there with MOVEJ.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL428",
        name="wrist-leaves-posture",
        meaning="On a straight move or an arc the tool leaves its posture for a while, to change the wrist.",
        remedy="Say WRIST AUTO or WRIST HOLD if that is meant; WRIST KEEP refuses or slows the move instead.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL429",
        name="slower-than-asked",
        meaning="A move does not keep its TIME, or does not reach its SPEED and takes more than 1.2 times as long as "
        "SPEED alone needs: the turning of the tool, an arc or a joint rules it.",
        remedy="Lower its SPEED or give it more TIME, or change what the message names.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL434",
        name="configuration-changes",
        meaning="A MOVEJ to a pose changes the configuration of the arm: RIGHTY and LEFTY, ABOVE and BELOW, or NOFLIP "
        "and FLIP. The configuration that the arm is in does not reach the pose within the ranges of the joints.",
        remedy="Teach the point with its configuration or as joint angles if the change is meant; otherwise go there "
        "over a point between, or move the work piece.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL435",
        name="turns-the-long-way",
        meaning="A MOVEJ to a pose turns a joint by more than half a turn, since the nearer angle is beyond its range.",
        remedy="Turn the joint back on an earlier move, where there is room for it; teach the point as joint angles if "
        "this turn is meant.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL440",
        name="part-ahead",
        meaning="A move would lead the arm or the hand into a part that lies in the cell, or a carried part into "
        "another part, an obstacle, the floor or the arm.",
        remedy="Go there over a via point, from another side, or lift the part before it is moved; the cell file "
        "has where parts lie at the start.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL441",
        name="nothing-to-grip",
        meaning="HAND ON closes where no part of the cell is between the fingers.",
        remedy="Check the point, the tool and the frame against where the part lies, and the size of the part against "
        "the stroke of the hand.",
        found=Stage.MOTION,
    ),
    Code(
        code="RBL501",
        name="division-by-zero",
        meaning="A program divided by zero.",
        remedy="Test the divisor first, or catch it with ON ERROR.",
    ),
    Code(
        code="RBL502",
        name="no-number",
        meaning="A calculation has no finite result: a root or a power of what has none, or a number that grew too "
        "large.",
        remedy="Test the value first, or catch it with ON ERROR.",
    ),
    Code(
        code="RBL506",
        name="too-much-text",
        meaning="A text that a program made, all texts that it keeps, or all that it has printed, is too long.",
        remedy="Print less or in a shorter loop, and keep no more than is used.",
    ),
    Code(
        code="RBL507",
        name="no-such-element",
        meaning="An array has no element of that number, or it or all arrays and names together are too large.",
        remedy="Give DIM the largest number that is used, at most 99999; elements count from 0.",
        found=Stage.CELL,
        computed=True,
    ),
    Code(
        code="RBL531",
        name="value-of-other-kind",
        meaning="A number, a text or a pose stands where another is needed.",
        remedy="Use STR$ and VAL between numbers and texts; P.X and its like are the numbers of a pose.",
    ),
    Code(
        code="RBL532",
        name="name-without-value",
        meaning="A name is used before anything was assigned to it.",
        remedy="Assign a value first, teach the point, or correct the name.",
    ),
    Code(
        code="RBL503",
        name="wait-timed-out",
        meaning="A WAIT had not come true when its TIMEOUT ended.",
        remedy="Check the input, give more time, or state with GOTO or ON ERROR where to go on.",
    ),
    Code(
        code="RBL504",
        name="calls-too-deep",
        meaning="Subroutines call one another too deeply, or too many FORs have been left and not ended.",
        remedy="A GOSUB must come back with RETURN; a SUB that calls itself must come to an end.",
    ),
    Code(
        code="RBL505",
        name="too-many-statements",
        meaning="A run has carried out more statements than is allowed.",
        remedy="Look for a loop that does not end.",
        endless=True,
    ),
    Code(
        code="RBL508",
        name="idle-loop",
        meaning="A loop goes round without a statement that takes time.",
        remedy="Put a DELAY, a WAIT or a move into it, or end it.",
        endless=True,
    ),
    Code(
        code="RBL533",
        name="nowhere-to-return",
        meaning="RETURN, RESUME or NEXT has nothing that it belongs to.",
        remedy="RETURN ends a GOSUB, RESUME an error handler, NEXT a FOR; keep GOTO from leading there.",
    ),
    Code(
        code="RBL534",
        name="no-such-signal",
        meaning="The cell has no input of that number, or the number of an input or output is not from 1 to 1024.",
        remedy="Give an input that the cell file has, or write [inputs.N] into it; give a whole number from 1 to 1024 "
        "for an output.",
        found=Stage.CELL,
        computed=True,
    ),
)
