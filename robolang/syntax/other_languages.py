"""Words and signs of other languages, and what replaces them in this one: KRL, RAPID, KAREL, INFORM, MELFA, V+, C.

Data alone. A message names the word of this language; nothing is ever read as if it stood there.
"""

import re

_MOVEJ = "MOVEJ moves all joints together: MOVEJ P1, SPEED 50"
_MOVE = "MOVE is a straight move: MOVE P1, SPEED 200"
_MOVEC = "MOVEC is an arc over a point: MOVEC P1, P2"
_DELAY = "DELAY s waits for a time: DELAY 0.5"
_WAIT = "WAIT waits for a condition: WAIT IN(1) = 1, TIMEOUT 5"
_OUT = "OUT(n) = 1 sets an output, OUT(n) = 0 resets it"
_IN = "IN(n) reads an input: IF IN(1) = 1 THEN"
_CLOSE = "HAND ON closes the hand"
_OPEN = "HAND OFF opens the hand"
_HAND = "HAND ON closes the hand, HAND OFF opens it"
_LOAD = "LOAD (x, y, z), mass declares the payload"
_SPEED = "SPEED mm/s sets the speed of straight moves, SPEEDJ % that of joint moves"
_ACCEL = "ACCEL % sets the acceleration"
_ZONE = "ZONE mm blends a move into the next one"
_TOOL = "TOOL name selects a tool of the cell"
_FRAME = "FRAME name selects a frame of the cell, FRAME WORLD the world"
_PRINT = 'PRINT shows values: PRINT "count "; n'
_SUB = "SUB name begins a subroutine, ENDSUB ends it, CALL name runs it"
_STOP = "STOP ends the program, PAUSE reports a halt and continues"
_VALUE = "a variable needs no declaration: write name = value; DIM a(n) makes an array"
_LABEL = "*NAME at the start of a line is a label"
_GOTO = "GOTO *NAME goes to a label"
_LEAVE = "to leave a loop, write GOTO and a label that is after its end"
_WHILE = "WHILE condition begins a loop, WEND ends it"
_SELECT = "SELECT value, CASE value and ENDSELECT choose between values"
_COMMENT = "a comment begins with ' or REM"
_ERROR = "ON ERROR GOTO *LABEL handles errors"

_HINTS = {
    _MOVEJ: "PTP SPTP MOVJ MOVABSJ JMOVE J G0 G00 PMOVE DRIVE",
    _MOVE: "LIN SLIN MOVEL MOVL MOVS MVS LMOVE L G1 G01",
    _MOVEC: "CIRC SCIRC MOVC MVC MVR CMOVE C G2 G3 G02 G03",
    _DELAY: "SLEEP DLY TWAIT WAITTIME DWELL G4 G04",
    _WAIT: "SWAIT WAITDI WAITDO WAITUNTIL WAITSIG",
    _OUT: "SET RESET SETDO SETAO PULSEDO DO RO GO AO SDO DOUT SIGNAL SET_DIGITAL_OUT M_OUT",
    _IN: "DI RI GI AI DIN M_IN SIG",
    _CLOSE: "CLOSE CLOSEI GRASP GRIP HCLOSE HCLOS",
    _OPEN: "OPEN OPENI RELEASE HOPEN",
    _HAND: "GRIPPER CLAMP VACUUM",
    _LOAD: "PAYLOAD GRIPLOAD SETLOAD LOADSET SET_PAYLOAD WEIGHT LOADDATA",
    _SPEED: "VEL SPD VELSET VJ V FEED F JSPEED",
    _ACCEL: "ACC ACCSET DECEL",
    "OVERRIDE % scales every speed that follows": "OVRD OV JOVRD",
    _ZONE: "CNT BLEND ACCURACY PL",
    _TOOL: "UTOOL UTOOL_NUM SET_TCP TCP TOOLSET",
    _FRAME: "BASE UFRAME UFRAME_NUM WORK WOBJ",
    _PRINT: "TPWRITE WRITE TYPE MSG TEXTMSG POPUP DISPLAY ECHO PRINTF",
    _SUB: "PROC DEF DEFFCT FUNC FUNCTION PROCEDURE PROGRAM ROUTINE MODULE",
    "ENDSUB ends a SUB": "ENDPROC ENDFUNC ENDFUNCTION ENDFCT ENDROUTINE",
    "CALL name runs a SUB": "RUN CALLP CALLPROG",
    _STOP: "HALT HLT ABORT EXITPROG BRK QUIT",
    _VALUE: "VAR DECL REAL NUM DOUBLE FLOAT BOOL STRING PERS LOCAL GLOBAL SHARED E6POS POS ROBTARGET TASK",
    "a name holds a number, a text or a pose: x = 5; DIM a(n) makes an array": "R PR SR",
    "write name = value without LET": "LET",
    _LABEL: "LBL LABEL",
    _GOTO: "JMP JUMP",
    _LEAVE: "EXIT BREAK LEAVE CONTINUE CYCLE",
    _WHILE: "REPEAT UNTIL LOOP DOWHILE",
    "WEND ends a WHILE": "ENDWHILE",
    "NEXT ends a FOR": "ENDFOR",
    "ENDSELECT ends a SELECT": "ENDSWITCH ENDCASE",
    "CASE ELSE takes all other values": "DEFAULT OTHERWISE",
    "ELSEIF condition is the next branch of an IF": "ELIF ELSIF",
    _SELECT: "SWITCH TEST",
    _COMMENT: "COMMENT REMARK NOTE",
    _ERROR: "TRY CATCH TRAP ONERROR ENDTRY",
    "MOVEJ JOINT(j1, ..., j6) goes to joint angles; teach them as a point": "HOME",
}
WORDS = {word: hint for hint, words in _HINTS.items() for word in words.split()}
"""What stands for an instruction of another language, by the word in capitals."""

_NAMES = frozenset({"UFRAME", "UFRAME_NUM", "UTOOL", "UTOOL_NUM"})
_ELEMENTS = _NAMES | {word for word, hint in WORDS.items() if hint in (_IN, _OUT) or word in ("R", "PR", "SR")}
"""What other languages assign to, by its name alone or with a number; all other words are ordinary names there too."""

ENDS = {
    "ENDWHILE": "WEND",
    "ENDFOR": "NEXT",
    "ENDSWITCH": "ENDSELECT",
    "ENDCASE": "ENDSELECT",
    **dict.fromkeys(("ENDPROC", "ENDFUNC", "ENDFUNCTION", "ENDFCT", "ENDROUTINE"), "ENDSUB"),
}
"""Words of other languages that end a block, and the one that does here."""

VALUES = {
    **dict.fromkeys(("TRUE", "ON", "HIGH", "YES"), "write 1: what is not 0 is true"),
    **dict.fromkeys(("FALSE", "OFF", "LOW", "NO"), "write 0"),
    **dict.fromkeys(("PI", "M_PI"), "angles are in degrees: SIN(30) is 0.5; pi is RAD(180)"),
    **dict.fromkeys(("NULL", "NONE", "NIL"), "write a number, a text in double quotes, or a pose"),
}
"""What stands for a value of another language, by its word in capitals."""

_FUNCTIONS = {
    "SQRT": "SQR",
    "ATAN2": "ATN2",
    "ATN": "ATN2",
    "ATAN": "ATN2",
    "FLOOR": "INT",
    "TRUNC": "INT",
    "SIGN": "SGN",
    "STR": "STR$",
    "CHR": "STR$",
    "STRLEN": "LEN",
    "DISTANCE": "DIST",
    "DIN": "IN",
    "DI": "IN",
    "TRANS": "POSE",
    "P_CURR": "HERE",
    "CROBT": "HERE",
}

_SIGNS = (
    ("==", "one = compares: IF x = 1 THEN"),
    (":=", "= assigns: x = 5"),
    ("!=", "<> is not equal: IF x <> 1 THEN"),
    ("&&", "AND joins conditions"),
    ("||", "OR joins conditions"),
    ("//", _COMMENT),
    ("/*", _COMMENT),
    ("--", _COMMENT),
    ("!", "NOT negates a condition; a comment begins with ' or REM"),
    ("&", "AND joins conditions, + joins texts"),
    ("|", "OR joins conditions"),
    ("%", "MOD is the remainder; a per cent value is a plain number"),
    ("[", "write ( ) around the number of an element, input or output, as in OUT(1)"),
    ("{", "write (x, y, z), or POSE(x, y, z, rx, ry, rz)"),
    ("#", _COMMENT),
    ("\\", "/ divides; INT(a / b) is the whole part"),
    ("~", "NOT negates a condition"),
    (":", "write one statement on each line"),
)
"""Signs of other languages by how they begin, the longer ones first."""
_FOLLOWING = {
    "IN": _IN,
    "OUT": _OUT,
    "VEL": _SPEED,
    "ACC": _ACCEL,
    "OV_PRO": "OVERRIDE % scales every speed",
    "TOOL": _TOOL,
    "BASE": _FRAME,
    "LOAD": _LOAD,
    "APO": _ZONE,
    "POS_ACT": "HERE is where the tool is",
}


def instruction(word: str) -> str:
    """Return what stands for an instruction of another language, or ``""``."""
    return WORDS.get(word.upper(), "")


def assigned(word: str, *, element: bool = False) -> str:
    """Return what stands for a name, or for an ``element``, that another language assigns values to, or ``""``."""
    return instruction(word) if word.upper() in (_ELEMENTS if element else _NAMES) else ""


def function(word: str) -> str:
    """Return the function of this language for one of another, or ``""``."""
    return _FUNCTIONS.get(word.upper(), "")


def sign(text: str) -> str:
    """Return what stands for the sign that a text begins with, or ``""``."""
    if text[:1] == "$":
        word = re.match(r"\w*", text[1:])
        name = word[0].upper() if word else ""
        return _FOLLOWING.get(name) or "write $ at the end of the name of a text, as in s$"
    return next((hint for begin, hint in _SIGNS if text.startswith(begin)), "")


def setting(word: str) -> str:
    """Return what stands for a speed or zone of RAPID such as v100 or z10, or ``""``."""
    found = re.fullmatch(r"([vz])([0-9]{1,5})", word, re.IGNORECASE)
    if found is None:
        return "write FINE, or no option: without ZONE a move stops at its end" if word.upper() == "CNT0" else ""
    return f"write SPEED {found[2]}" if found[1] in "vV" else f"write ZONE {found[2]}"
