"""Inputs, outputs, waiting, control, data, functions and values in the words of other languages. Data alone."""

from robolang.syntax.foreign.entry import (
    AS,
    BEGINS,
    CALLS,
    CONDITION,
    ENDS,
    G_CODE,
    GOTO,
    INFORM,
    INPUT,
    KAREL,
    KRL,
    LABEL,
    MELFA,
    OTHERS,
    OUTPUT,
    PAC,
    PYTHON,
    RAPID,
    RESET,
    SHOWS,
    TIME,
    TP,
    UR,
    VAL3,
    VPLUS,
    C,
    Entry,
)

_ON = "OUT(1) = 1"
_OFF = "OUT(1) = 0"
_READ = "x = IN(1)"
_UNTIL = "WAIT IN(1) = 1"
_POLL = "IF IN(1) = 1 THEN GOTO *STOPPED"
_POLLED = "an input is read between moves, not during one"
_NO_LEAVE = "GOTO *AFTER"
_AFTER = "the label is after the end of the loop"
_FROM_1 = "numbers begin at 1 here"
_ALONE = "a program runs alone"

# SET stands twice: the same word gives a variable a value in INFORM
SIGNALS = (
    Entry("SET", (RAPID, PAC), OUTPUT, _ON),
    Entry("SET", (INFORM,), "gives a variable a value", "x = 5"),
    Entry("RESET", (RAPID, PAC), RESET, _OFF),
    Entry("RESET", (AS, VPLUS), "resets all outputs", _OFF, note="each output has a line of its own"),
    Entry("SETDO SETGO SETAO", (RAPID,), OUTPUT, _ON),
    Entry("PULSEDO", (RAPID,), "sets an output for a time", "PULSE 1, 0.5"),
    Entry("INVERTDO", (RAPID,), "changes the state of an output", _ON, missing=True),
    Entry("DO RO GO AO SDO", (TP,), OUTPUT, _ON),
    Entry("DI RI GI AI SDI", (TP,), INPUT, _READ),
    Entry("DOUT", (INFORM, KAREL), OUTPUT, _ON),
    Entry("DIN", (INFORM, KAREL), INPUT, _READ),
    Entry("AOUT", (INFORM, KAREL), OUTPUT, _ON),
    Entry("SIGNAL", (AS, VPLUS), OUTPUT, _ON, note="-1 resets it: OUT(1) = 0"),
    Entry("SIGNAL", (KRL,), "names an input or an output", "OUT(1) = 1", note="inputs and outputs have numbers"),
    Entry("SIGNAL", (KAREL,), "signals an event", missing=True),
    Entry("SIG", (AS, VPLUS), INPUT, _READ, note="1001 there is input 1"),
    Entry("M_OUT M_OUTB M_OUTW", (MELFA,), OUTPUT, _ON),
    Entry("M_IN M_INB M_INW", (MELFA,), INPUT, _READ),
    Entry("IO", (PAC,), "is an input or an output", _ON, note="IN(1) is an input"),
    Entry("SET_DIGITAL_OUT SET_STANDARD_DIGITAL_OUT SET_ANALOG_OUT", (UR,), OUTPUT, _ON, _FROM_1),
    Entry(
        "SET_TOOL_DIGITAL_OUT",
        (UR,),
        "sets an output at the flange",
        _ON,
        f"{_FROM_1}; HAND ON and HAND OFF move the hand",
    ),
    Entry("GET_DIGITAL_IN GET_STANDARD_DIGITAL_IN GET_TOOL_DIGITAL_IN GET_ANALOG_IN", (UR,), INPUT, _READ, _FROM_1),
    Entry("WAITTIME", (RAPID,), TIME, "DELAY 0.5"),
    Entry("WAITDI WAITGI WAITUNTIL", (RAPID,), CONDITION, _UNTIL),
    Entry("WAITDO", (RAPID,), "waits for an output", note="an output is set when its OUT has run"),
    Entry("WAITROB", (RAPID,), "waits for the end of motion", note="what reads or acts waits for it here"),
    Entry("DLY", (MELFA,), TIME, "DELAY 0.5"),
    Entry("TWAIT", (AS,), TIME, "DELAY 0.5"),
    Entry("SWAIT", (AS,), CONDITION, _UNTIL, note="1001 there is input 1"),
    Entry("SLEEP", (UR, PYTHON), TIME, "DELAY 0.5"),
    Entry("DWELL G4 G04", (G_CODE,), TIME, "DELAY 0.5"),
    Entry("SYNC", (UR,), "waits for a cycle", note="WAIT lets time pass"),
    Entry("WAITSIG", (OTHERS,), CONDITION, _UNTIL),
    Entry(
        "CLKRESET CLKSTART CLKSTOP", (RAPID,), "is a stopwatch", "t0 = TIMER", note="TIMER - t0 are the seconds since"
    ),
    Entry("CLKREAD", (RAPID,), "reads a stopwatch", "t = TIMER"),
    Entry("TPWRITE", (RAPID,), SHOWS, 'PRINT "count "; n'),
    Entry("TPERASE CLS", (RAPID, KAREL), "clears the screen", note="PRINT adds a line"),
    Entry("WRITE", (KAREL, RAPID), SHOWS, 'PRINT "count "; n'),
    Entry("TYPE", (AS, VPLUS), SHOWS, 'PRINT "count "; n'),
    Entry("MSG", (INFORM,), SHOWS, 'PRINT "count "; n'),
    Entry("MESSAGE", (TP,), SHOWS, 'PRINT "count "; n'),
    Entry("TEXTMSG POPUP", (UR,), SHOWS, 'PRINT "count "; n'),
    Entry("PRINTMSG PRINTDBG", (PAC,), SHOWS, 'PRINT "count "; n'),
    Entry("PUT PUTLN", (VAL3,), SHOWS, 'PRINT "count "; n'),
    Entry("PRINTF", (C,), SHOWS, 'PRINT "count "; n'),
    Entry("DISPLAY ECHO", (OTHERS,), SHOWS, 'PRINT "count "; n'),
    Entry("TPREADNUM TPREADFK TPREADDNUM", (RAPID,), "reads a key", "CONST n = 5", missing=True),
)

# a word that many programs use for subroutines of their own belongs to other languages in general
CONTROL = (
    Entry("PROC", (RAPID,), BEGINS, "SUB pick"),
    Entry("DEF", (KRL, UR, PYTHON), BEGINS, "SUB pick"),
    Entry("DEF", (MELFA,), "declares a variable", "x = 5", note="names need no declaration"),
    Entry("DEFFCT", (KRL,), "begins a function", "SUB pick", note="a SUB returns no value"),
    Entry("FUNC", (RAPID,), "begins a function", "SUB pick", note="a SUB returns no value"),
    Entry("FUNCTION", (PAC, OTHERS), "begins a function", "SUB pick", note="a SUB returns no value"),
    Entry("ROUTINE", (KAREL,), BEGINS, "SUB pick"),
    Entry("PROCEDURE", (OTHERS,), BEGINS, "SUB pick"),
    # a main program has no head here, so what begins one is left out and not replaced
    Entry(
        "PROGRAM",
        (KAREL, AS, VPLUS, VAL3),
        "begins a program",
        note="a program is a file, and begins at its first line",
    ),
    Entry("MODULE", (RAPID,), "begins a module", note="a program is a file"),
    Entry("ENDMODULE", (RAPID,), "ends a module", note="a program is a file"),
    Entry("ENDPROC", (RAPID,), ENDS, "ENDSUB", note="the main program has no head, so that of PROC main is left out"),
    Entry("ENDFUNC", (RAPID,), ENDS, "ENDSUB"),
    Entry("ENDFCT", (KRL,), ENDS, "ENDSUB"),
    Entry("ENDFUNCTION ENDROUTINE", (OTHERS,), ENDS, "ENDSUB"),
    Entry("CALLP", (MELFA,), CALLS, "CALL pick"),
    Entry("CALLPROG CALL_PROG", (KAREL,), CALLS, "CALL pick"),
    Entry(
        "RUN",
        (TP, KAREL, PAC),
        "starts another program beside this one",
        missing=True,
        note=f"{_ALONE}; CALL runs a SUB",
    ),
    Entry("XRUN XLOAD XSTP", (MELFA,), "starts or stops another program", missing=True, note=_ALONE),
    Entry("PCEXECUTE", (AS,), "starts another program", missing=True, note=_ALONE),
    Entry("TASKCREATE TASKKILL", (VAL3,), "starts or ends a task", missing=True, note=_ALONE),
    Entry("THREAD", (UR,), "begins a thread", missing=True, note=_ALONE),
    Entry("TASK", (RAPID, PAC), "is a program beside this one", missing=True, note=_ALONE),
    Entry("HALT", (KRL, VPLUS, AS), "stops the program", "STOP", note="PAUSE notes a pause and goes on"),
    Entry("HLT", (MELFA,), "stops the program", "STOP", note="PAUSE notes a pause and goes on"),
    Entry("ABORT", (TP, KAREL, PAC), "ends the program", "STOP"),
    Entry("EXITPROG", (OTHERS,), "ends the program", "STOP"),
    Entry("QUIT", (OTHERS,), "ends the program", "STOP"),
    Entry("RET", (INFORM,), "ends a subroutine", "RETURN"),
    Entry("EXITCYCLE", (RAPID,), "begins the program again", "GOTO *BEGIN", note="the label is at its beginning"),
    Entry("LBL", (TP,), LABEL, "*L1"),
    Entry("LABEL", (OTHERS,), LABEL, "*L1"),
    Entry("JMP", (TP,), GOTO, "GOTO *L1"),
    Entry("JUMP", (INFORM,), GOTO, "GOTO *L1"),
    # no statement leaves a loop here: a jump does, and its label is what the reader has to add
    Entry("EXIT", (KRL, VPLUS), "leaves a loop", _NO_LEAVE, note=_AFTER),
    Entry("EXIT", (RAPID,), "ends the program", "STOP"),
    Entry("BREAK", (UR, MELFA, VAL3, C), "leaves a loop", _NO_LEAVE, note=_AFTER),
    Entry("BREAK", (AS, VPLUS), "waits for the end of motion", note="what reads or acts waits for it here"),
    Entry("BREAK", (RAPID,), "ends the program", "STOP"),
    Entry("LEAVE", (OTHERS,), "leaves a loop", _NO_LEAVE, note=_AFTER),
    Entry(
        "CONTINUE", (UR, C), "begins the next round of a loop", "GOTO *NEXTROUND", note="the label is before its end"
    ),
    Entry("CONTINUE", (KRL,), "lets the next line run ahead of motion", note="computing runs ahead here"),
    Entry(
        "CYCLE", (OTHERS,), "begins the next round", "GOTO *NEXTROUND", note="the label is before the end of the loop"
    ),
    Entry(
        "REPEAT",
        (KRL, KAREL),
        "begins a loop with its condition at the end",
        "WHILE IN(1) = 0",
        note="WHILE has the condition to go on, WEND is the end",
    ),
    Entry(
        "UNTIL",
        (KRL, KAREL, VAL3, AS, VPLUS),
        "ends a loop",
        "WEND",
        note="the condition to go on, here its opposite, is at the WHILE",
    ),
    Entry("DO", (AS, VPLUS, VAL3, PAC), "begins a loop", "WHILE IN(1) = 0", note="WHILE has the condition to go on"),
    Entry("LOOP", (PAC,), "ends a loop", "WEND"),
    Entry("LOOP", (KRL, OTHERS), "begins a loop without end", "WHILE 1", note="WEND ends it"),
    Entry("DOWHILE", (OTHERS,), "begins a loop", "WHILE IN(1) = 0", note="WEND ends it"),
    Entry("ENDLOOP", (KRL,), "ends a loop", "WEND"),
    Entry("ENDWHILE", (KRL, RAPID, KAREL, VAL3), "ends a WHILE", "WEND"),
    Entry("ENDFOR", (KRL, RAPID, KAREL, VAL3), "ends a FOR", "NEXT"),
    Entry("ENDSWITCH", (KRL, VAL3), "ends a SELECT", "ENDSELECT"),
    Entry("ENDCASE", (OTHERS,), "ends a SELECT", "ENDSELECT"),
    Entry("ENDTEST", (RAPID,), "ends a SELECT", "ENDSELECT"),
    Entry("DEFAULT", (KRL, RAPID, MELFA, VAL3, C), "is the CASE of all other values", "CASE ELSE"),
    Entry("OTHERWISE", (OTHERS,), "is the CASE of all other values", "CASE ELSE"),
    Entry("ANY", (AS, VPLUS), "is the CASE of all other values", "CASE ELSE"),
    Entry("SWITCH", (KRL, VAL3, C), "chooses by a value", "SELECT n"),
    Entry("VALUE", (AS, VPLUS), "is a CASE", "CASE 1"),
    Entry("TEST", (RAPID,), "chooses by a value", "SELECT n"),
    Entry("IFTHEN IFTHENEXP", (INFORM,), "begins a condition", "IF IN(1) = 1 THEN"),
    Entry("ELIF", (UR, PYTHON), "is another condition of an IF", "ELSEIF IN(1) = 1 THEN"),
    Entry("ELSIF", (OTHERS,), "is another condition of an IF", "ELSEIF IN(1) = 1 THEN"),
    Entry("COMMENT REMARK NOTE", (OTHERS,), "begins a comment", "' text"),
    Entry("TRY CATCH", (C, PYTHON), "handles errors", "ON ERROR GOTO *FAILED"),
    Entry("ENDTRY", (OTHERS,), "ends what handles errors", "RESUME NEXT"),
    Entry("ONERROR", (OTHERS,), "handles errors", "ON ERROR GOTO *FAILED"),
    Entry("RETRY", (RAPID,), "repeats what failed", "RESUME"),
    Entry("TRYNEXT", (RAPID,), "goes on after what failed", "RESUME NEXT"),
    Entry("RAISE", (RAPID, PYTHON), "makes an error", "STOP", missing=True),
    Entry("UALM", (TP,), "makes an alarm", "STOP", missing=True),
    Entry("BEGIN", (KAREL, VAL3), "begins the statements", note="a program begins at its first line"),
    Entry("WITH", (KAREL,), "sets values for one move", "MOVE P1, SPEED 200", note="they are options of the move"),
    Entry("OFFSET", (TP,), "shifts points", "MOVE P1 + (0, 0, 50)"),
    Entry("SKIP", (TP,), "ends a move by an input", "MOVE P1, SPEED 20", missing=True),
    Entry("NOP", (INFORM,), "does nothing", note="a program begins at its first line"),
    Entry("INI BAS", (KRL,), "sets the robot up", note="SPEED, ACCEL and ZONE set what holds from there on"),
    Entry("SERVO", (MELFA,), "switches the drives on", note="they are on when a run begins"),
    Entry("ENABLEPOWER DISABLEPOWER", (VAL3,), "switches the drives", note="they are on when a run begins"),
    Entry("GETM RELM", (MELFA,), "takes or gives the arm", note=_ALONE),
    Entry("TAKEARM GIVEARM", (PAC,), "takes or gives the arm", note=_ALONE),
    Entry("ATTACH DETACH", (VPLUS, KAREL), "takes or gives the arm", note=_ALONE),
    # what reacts at once elsewhere is read between moves: a motion is planned whole before it begins
    Entry("TRAP CONNECT ISIGNALDI IWATCH ISLEEP", (RAPID,), "is an interrupt", _POLL, _POLLED, missing=True),
    Entry("INTERRUPT", (KRL,), "is an interrupt", _POLL, _POLLED, missing=True),
    Entry("ACT", (MELFA,), "is an interrupt", _POLL, _POLLED, missing=True),
    Entry("REACT REACTI", (VPLUS,), "is an interrupt", _POLL, _POLLED, missing=True),
    Entry("REACTE", (VPLUS,), "handles errors", "ON ERROR GOTO *FAILED"),
    Entry("ONI IGNORE", (AS,), "is an interrupt", _POLL, _POLLED, missing=True),
    Entry("MONITOR", (TP,), "is an interrupt", _POLL, _POLLED, missing=True),
    Entry("CONDITION", (KAREL,), "is an interrupt", _POLL, _POLLED, missing=True),
    Entry("BRAKE", (KRL,), "brakes in an interrupt", "STOP", missing=True),
    # a cell has no moving belt, and its parts lie where they are until the hand takes them
    Entry(
        "ACTUNIT WAITWOBJ DROPWOBJ",
        (RAPID,),
        "follows a conveyor",
        _UNTIL,
        "take the part where the belt stands",
        missing=True,
    ),
    Entry("TRK", (MELFA,), "follows a conveyor", _UNTIL, "take the part where the belt stands", missing=True),
    Entry(
        "SYSTART SYMOVL SYMOVJ",
        (INFORM,),
        "follows a conveyor",
        _UNTIL,
        "take the part where the belt stands",
        missing=True,
    ),
    Entry(
        "TRACK_CONVEYOR_LINEAR",
        (UR,),
        "follows a conveyor",
        _UNTIL,
        "take the part where the belt stands",
        missing=True,
    ),
    Entry("FORCE_MODE END_FORCE_MODE", (UR,), "controls the force of the tool", missing=True),
    Entry("CMP", (MELFA,), "makes the arm compliant", missing=True),
    Entry("SOFTACT SOFTDEACT", (RAPID,), "makes the arm compliant", missing=True),
    # places of a pallet are computed: a pose may be shifted by expressions
    Entry(
        "PLT", (MELFA,), "is a place of a pallet", "P10 = P1 + (50 * i, 40 * j, 0)", note="two FOR loops count i and j"
    ),
)

_IN_CELL = "the cell file has them: [tools.tool1], [frames.frame1]"

DATA = (
    Entry("VAR", (KAREL, VAL3), "declares variables", "x = 5", note="names need no declaration"),
    Entry("NUM", (VAL3,), "declares a variable", "x = 5", note="names need no declaration"),
    Entry("VAR PERS NUM ROBTARGET LOCAL", (RAPID,), "declares a variable", "x = 5", note="names need no declaration"),
    Entry("DECL REAL E6POS POS GLOBAL", (KRL,), "declares a variable", "x = 5", note="names need no declaration"),
    Entry("BOOL STRING", (RAPID, VAL3), "declares a variable", "x = 5", note="names need no declaration"),
    Entry("DOUBLE FLOAT SHARED", (OTHERS,), "declares a variable", "x = 5", note="names need no declaration"),
    Entry("GLOBAL LOCAL", (UR,), "declares a variable", "x = 5", note="names need no declaration"),
    Entry("DEFPOS DEFJNT", (PAC,), "declares a variable", "x = 5", note="names need no declaration"),
    # a register becomes a name of its own: an array would need its DIM and its size
    Entry("R", (TP,), "is a register", "R1 = 5", note="a register is a name; DIM a(n) makes an array"),
    Entry("PR", (TP,), "is a register of a position", "PR1 = P1", note="a register is a name, as P1 is"),
    Entry("SR", (TP,), "is a register of a text", 's$ = "part"', note="names of texts end in $"),
    Entry("LET", (PAC, OTHERS), "assigns a value", "x = 5"),
    Entry("INCR DECR", (RAPID,), "counts a variable", "x = x + 1"),
    Entry("INC DEC", (INFORM,), "counts a variable", "x = x + 1"),
    Entry("ADD", (RAPID, INFORM), "adds to a variable", "x = x + 5"),
    Entry("MUL DIV", (INFORM,), "computes with a variable", "x = x * 5"),
    Entry("GETS GETE SETE", (INFORM,), "copies a value", "x = P1.X"),
    Entry("DECOMPOSE", (AS, VPLUS), "takes a point apart", "x = P1.X"),
    Entry("POINT", (AS,), "defines a point", "P10 = P1"),
    Entry("TOOLDATA WOBJDATA", (RAPID,), "declares a tool or a frame", note=_IN_CELL),
)
ASSIGNED = frozenset(
    word
    for entry in (*SIGNALS, *DATA)
    if entry.means in (OUTPUT, INPUT) or entry.words in ("R", "PR", "SR", "IO")
    for word in entry.words.split()
)
"""What other languages assign to with a number; all other words are ordinary names there too."""
NAMES = frozenset(("UFRAME", "UFRAME_NUM", "UTOOL", "UTOOL_NUM"))
"""What other languages assign to by name alone."""

# URScript and KAREL have their angles in rad, RAPID and AS in degrees as this language
FUNCTIONS = (
    Entry("SQRT", (KRL, RAPID, KAREL, UR, AS, VPLUS, VAL3), "is the square root", "x = SQR(2)"),
    Entry("ATAN2", (KRL, RAPID, KAREL, UR, AS, VPLUS), "is an angle by its sides", "a = ATN2(1, 2)"),
    Entry("ATN ATAN", (RAPID, MELFA, UR, PAC), "is an angle by its tangent", "a = ATN2(0.5, 1)"),
    Entry("FLOOR", (UR, OTHERS), "rounds down", "n = INT(2.5)"),
    Entry("TRUNC", (RAPID, KAREL, VAL3), "cuts a number", "n = INT(2.5)", note="INT rounds down"),
    Entry("SIGN", (VAL3, OTHERS), "is the sign", "n = SGN(-2)"),
    Entry("POW", (RAPID, UR), "is a power", "x = 2 ^ 3"),
    # this language has one inverse function, that of two sides, which has no gaps
    Entry("ACOS", (KRL, RAPID, KAREL, UR, PAC), "is an angle by its cosine", "a = ATN2(SQR(1 - c ^ 2), c)"),
    Entry("ASIN", (RAPID, KAREL, UR, PAC), "is an angle by its sine", "a = ATN2(s, SQR(1 - s ^ 2))"),
    Entry("D2R", (UR,), "gives radians", "x = RAD(90)", note="angles are in degrees here"),
    Entry("R2D", (UR,), "gives degrees", "x = DEG(1.57)"),
    Entry("STR", (OTHERS,), "writes a number", "s$ = STR$(5)"),
    Entry("CHR", (KAREL, OTHERS), "makes a text", "s$ = STR$(5)"),
    Entry("NUMTOSTR VALTOSTR", (RAPID,), "writes a number", "s$ = STR$(5)"),
    Entry("STRTOVAL", (RAPID,), "reads a number", 'x = VAL("5")'),
    Entry("TO_STR", (UR,), "writes a number", "s$ = STR$(5)"),
    Entry("TO_NUM", (UR,), "reads a number", 'x = VAL("5")'),
    Entry("STRLEN STRDIM STR_LEN", (RAPID, OTHERS), "is the length of a text", 'n = LEN("part")'),
    Entry("DISTANCE", (RAPID, AS, VPLUS, VAL3), "is a distance", "d = DIST(P1, P2)"),
    Entry("POINT_DIST", (UR,), "is a distance", "d = DIST(P1, P2)"),
    Entry("TRANS", (AS, VPLUS), "makes a pose", "P10 = POSE(400, 150, 800, 180, 0, 180)"),
    Entry("OFFS", (RAPID,), "shifts a point", "P10 = P1 + (0, 0, 50)"),
    Entry("RELTOOL", (RAPID,), "shifts a point in the tool", "P10 = P1 * (0, 0, 50)"),
    Entry("SHIFT", (AS, VPLUS), "shifts a point", "P10 = P1 + (0, 0, 50)"),
    Entry("POSE_TRANS", (UR,), "moves a pose in another one", "P10 = P1 * (0, 0, 50)"),
    Entry("POSE_ADD", (UR,), "shifts a pose", "P10 = P1 + (0, 0, 50)"),
    Entry("P_CURR", (MELFA,), "is where the tool is", "P10 = HERE"),
    Entry("CROBT CPOS", (RAPID,), "is where the tool is", "P10 = HERE"),
    Entry("CURPOS", (KAREL, PAC), "is where the tool is", "P10 = HERE"),
    Entry("LPOS", (TP,), "is where the tool is", "P10 = HERE"),
    Entry("GET_ACTUAL_TCP_POSE", (UR,), "is where the tool is", "P10 = HERE"),
    Entry("CLOCK", (VAL3, OTHERS), "is the time", "t = TIMER"),
)

# ON and OFF are words of this language after HAND and SEAM, and values nowhere
VALUES = (
    Entry("TRUE", (KRL, RAPID, KAREL, UR, AS, VAL3), "is the value 1", "x = 1", note="what is not 0 is true"),
    Entry("FALSE", (KRL, RAPID, KAREL, UR, AS, VAL3), "is the value 0", "x = 0"),
    Entry("ON", (TP, INFORM, KAREL, AS, PAC), "is the value 1", "x = 1", note="what is not 0 is true"),
    Entry("OFF", (TP, INFORM, KAREL, AS, PAC), "is the value 0", "x = 0"),
    Entry("HIGH YES", (OTHERS,), "is the value 1", "x = 1", note="what is not 0 is true"),
    Entry("LOW NO", (OTHERS,), "is the value 0", "x = 0"),
    Entry(
        "PI M_PI",
        (RAPID, MELFA, AS, VPLUS, OTHERS),
        "is half a turn",
        "x = RAD(180)",
        note="angles are in degrees here",
    ),
    Entry("NULL NONE NIL", (OTHERS,), "is no value", "x = 0"),
)

OWN = (
    Entry("MOVE", (VPLUS,), "moves all joints together", "MOVEJ P1, SPEED 50"),
    Entry("MOVE", (PAC,), "moves all joints with P, straight with L", "MOVEJ P1", note="with L: MOVE P1"),
    Entry("MOVE", (KAREL,), "moves as $MOTYPE says", "MOVEJ P1", note="with LINEAR: MOVE P1"),
    Entry("MOVEJ", (RAPID, UR, VAL3), "moves all joints together", "MOVEJ P1, SPEED 50", note="SPEED is a percentage"),
    Entry("DEPART", (VPLUS,), "moves the joints back along the tool", "MOVEJ HERE * (0, 0, -50)"),
    Entry("APPROACH", (PAC,), "moves the joints with P, straight with L", "APPROACH P1, 50"),
    Entry("SPEED", (AS, VPLUS, PAC), "is a percentage", "OVERRIDE 50", note="SPEED here is in mm/s"),
    Entry(
        "SPEEDJ", (UR,), "turns joints at a speed", "SPEEDJ 50", note="SPEEDJ here is the speed of MOVEJ, in per cent"
    ),
    Entry(
        "ACCEL",
        (AS, PAC, MELFA),
        "has two values",
        "ACCEL 50",
        note="ACCEL is a percentage of acceleration and deceleration",
    ),
    Entry("DELAY", (KAREL, PAC), "waits, in ms", "DELAY 0.5", note="DELAY here is in seconds"),
    Entry("PULSE", (INFORM, KRL), "sets an output for a time", "PULSE 1, 0.5"),
    Entry("STOP", (RAPID, AS, VPLUS), "halts; the program can go on", "STOP", note="STOP here ends it"),
    Entry(
        "PAUSE", (TP, KAREL, AS, VPLUS), "halts; the program can go on", "PAUSE", note="PAUSE here goes on by itself"
    ),
    Entry("TOOL", (MELFA, AS, VPLUS), "selects a tool", "TOOL tool1", note="a number is no tool: the cell names them"),
    Entry("FINE", (TP, RAPID), "lets a move end at its point", "MOVE P1, FINE"),
    Entry("FINE", (MELFA,), "is an accuracy in pulses", "MOVE P1, FINE", note="FINE is an option of a move"),
    Entry("TIMER", (INFORM,), "waits for a time", "DELAY 0.5"),
    Entry("TIMER", (TP,), "is a stopwatch", "t0 = TIMER", note="TIMER - t0 are the seconds since"),
    Entry("HAND", (INFORM,), "opens or closes the hand", "HAND ON"),
    Entry("RESUME", (KRL,), "ends an interrupt", "RESUME", note="RESUME here ends the handler of an error"),
    Entry("IN", (KRL, PAC), "is an input", "x = IN(1)"),
    Entry("OUT", (KRL, PAC), "is an output", _ON),
    Entry("SUB", (INFORM,), "subtracts from a variable", "x = x - 5"),
    Entry("SUB", (PAC,), "begins a subroutine", "SUB pick"),
    Entry("HERE", (AS, VPLUS), "keeps where the tool is", "P10 = HERE"),
    Entry("ERROR", (RAPID,), "begins what handles errors", "ON ERROR GOTO *FAILED"),
    Entry("ERROR", (MELFA,), "makes an error", "STOP", note="there is no error of a program's own"),
    Entry("CASE", (AS, VPLUS), "chooses by a value", "SELECT n", note="CASE 1 is what VALUE 1: is there"),
    Entry("INT", (KRL, VAL3, PAC), "declares a variable", "x = 5", note="names need no declaration"),
)
"""Words of this language that mean something else, or have another unit, elsewhere."""
