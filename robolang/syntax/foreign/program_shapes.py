"""Lines of other languages on control, data, texts and comments. Data alone."""

from robolang.syntax.foreign.entry import AS, INFORM, KAREL, KRL, MELFA, PAC, PYTHON, RAPID, TP, UR, VAL3, VPLUS, C
from robolang.syntax.foreign.shape import Shape

_MAIN = "the main program has no head, it is what stands in no SUB"
_HEAD = "or remove the line: a main program has no head"
_ANY = "*"

# which DEF of KRL begins the main program the line does not say: it has the name of its file
_SUBS = (
    Shape((RAPID,), "PROC main()", r" main \( \)", "", _MAIN, "PROC DEF"),
    Shape((RAPID,), "PROC pick()", r" <name> \( \)", "SUB {name}"),
    Shape((RAPID,), "PROC pick(num a)", r" <name> \( \w+ <name1> \)", "SUB {name}({name1})"),
    Shape((KRL,), "GLOBAL DEF pick( )", r" DEF <name> \( \)", "SUB {name}"),
    Shape((KRL,), "DEF prog( )", r" <name> \( \)", "SUB {name}", _HEAD),
    Shape(
        (MELFA,),
        "Def Plt 1,P1,P2,P3,P4,3,4,1",
        r" Plt .*",
        "P10 = P1 + (50 * i, 40 * j, 0)",
        "two FOR loops count i and j",
    ),
    Shape((MELFA,), "Def Inte M1", r" (?:Inte|Long|Float|Double|Pos|Jnt|Char|Io) .*", "", "names need no declaration"),
    Shape((UR,), "def pick():", r" <name> \( \) :", "SUB {name}"),
    Shape((UR,), "def pick(a):", r" <name> \( <name1> \) :", "SUB {name}({name1})"),
    Shape((KAREL,), "ROUTINE pick", r" <name>", "SUB {name}"),
    Shape((INFORM,), "CALL JOB:SUB1", r" JOB : <name>", "CALL {name}"),
    Shape((INFORM,), "CALL JOB:SUB1 IF IN#(2)=ON", r" JOB : <name> IF <condition>", "IF {condition} THEN CALL {name}"),
    Shape((MELFA,), 'CallP "SUB1"', r' "<name>"', "CALL {name}"),
    Shape((TP,), "CALL PICK_PART;", r" <name>", "CALL {name}", "no ; ends a line"),
)
_JUMPS = (
    Shape((TP,), "JMP LBL[1]", r" LBL \[ <n>(?: :.*)? \]", "GOTO *L{n}"),
    Shape((TP,), "LBL[3:retry]", r" \[ <n> : <name> \]", "*{name}"),
    Shape((TP,), "LBL[1]", r" \[ <n> \]", "*L{n}"),
    Shape((INFORM,), "JUMP *LOOP", r" \* <name>", "GOTO *{name}"),
    Shape((INFORM,), "JUMP *LOOP IF IN#(2)=ON", r" \* <name> IF <condition>", "IF {condition} THEN GOTO *{name}"),
    Shape(
        (TP,), "IF DI[1]=ON,JMP LBL[2]", r" <condition> , JMP LBL \[ <n>(?: :.*)? \]", "IF {condition} THEN GOTO *L{n}"
    ),
    Shape((TP,), "IF DI[1]=ON,CALL PICK", r" <condition> , CALL <name>", "IF {condition} THEN CALL {name}"),
)
# patterns with a sign or a word at their end first: a condition would take the sign
_BLOCKS = (
    Shape((KRL, RAPID, AS, VPLUS), "IF $IN[1]==TRUE THEN", r" <condition> THEN", "IF {condition} THEN"),
    Shape((KRL, MELFA), "If M_In(1)=1 Then GOTO *L1", r" <condition> THEN <rest>", "IF {condition} THEN {rest}"),
    Shape((UR, PYTHON), "if get_digital_in(1) == True:", r" <condition> :", "IF {condition} THEN"),
    Shape((C, VAL3), "if (x == 1) {", r" <condition> \{?", "IF {condition} THEN"),
    Shape((UR, PYTHON), "elif x == 2:", r" <condition> :", "ELSEIF {condition} THEN", words="ELIF ELSIF"),
    Shape((RAPID, KRL), "ELSEIF x == 2 THEN", r" <condition> THEN", "ELSEIF {condition} THEN", words="ELSEIF ELSIF"),
    Shape((UR, PYTHON), "else:", r" :", "ELSE"),
    Shape((UR, PYTHON), "while (get_digital_in(1) == False):", r" \( <condition> \) :", "WHILE {condition}"),
    Shape((UR, PYTHON), "while x < 3:", r" <condition> :", "WHILE {condition}"),
    Shape((RAPID, KAREL, AS), "WHILE x == 1 DO", r" <condition> DO", "WHILE {condition}"),
    Shape((KRL, C), "WHILE $IN[1]==FALSE", r" <condition>", "WHILE {condition}"),
    Shape((PAC,), "Do While IO[1] = OFF", r" While <condition>", "WHILE {condition}"),
    Shape(
        (RAPID,),
        "FOR i FROM 1 TO 9 STEP 2 DO",
        r" <name> FROM <num1> TO <num2> STEP <num3> DO",
        "FOR {name} = {num1} TO {num2} STEP {num3}",
    ),
    Shape((AS, VPLUS), "VALUE 1:", r" <values> :", "CASE {values}"),
    Shape((RAPID,), "FOR i FROM 1 TO 10 DO", r" <name> FROM <num1> TO <num2> DO", "FOR {name} = {num1} TO {num2}"),
    Shape((KAREL, AS), "FOR i = 1 TO 10 DO", r" <name> = <num1> TO <num2> DO", "FOR {name} = {num1} TO {num2}"),
    Shape((TP,), "FOR R[1]=1 TO 10", r" <point> = <num1> TO <num2>", "FOR {point} = {num1} TO {num2}"),
    Shape((KRL, VAL3), "SWITCH n", r" \(? <name> \)?", "SELECT {name}"),
    Shape((RAPID,), "TEST n", r" <name>", "SELECT {name}"),
    Shape((RAPID, VAL3, C), "CASE 1:", r" <values> :", "CASE {values}"),
    Shape((AS, VPLUS), "CASE n OF", r" <name> OF", "SELECT {name}"),
    Shape((RAPID, C), "DEFAULT:", r" :", "CASE ELSE"),
)
# a line with := may begin with any word, so this shape is compared with every line with an error
_DATA = (
    Shape(
        (RAPID,),
        "CONST robtarget p10 := [[600,0,500],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];",
        r" robtarget <name> := \[ \[ <mm> \].*",
        "{name} = POSE({mm}, rx, ry, rz)",
        "or teach the point; rx, ry and rz are angles in degrees, not a quaternion",
        "CONST PERS VAR",
    ),
    Shape((PAC,), "Dim I As Integer", r" \w+ As .*", "", "names need no declaration"),
    Shape((TP,), "PR[1]=LPOS", r" \[ <n>(?: :[^\]]*)? \] = LPOS", "PR{n} = HERE"),
    Shape((TP,), "PR[1]=P[2]", r" \[ <n>(?: :[^\]]*)? \] = <point>", "PR{n} = {point}"),
    Shape((RAPID,), "VAR num x := 5;", r" \w+ <name> := <rest>", "{name} = {rest}", words="VAR PERS CONST LOCAL"),
    Shape((KRL,), "DECL INT x = 5", r" \w+ <name> = <num>", "{name} = {num}"),
    Shape((UR,), "global x = 5", r" <name> = <rest>", "{name} = {rest}", words="GLOBAL LOCAL LET INT NUM"),
    Shape((TP,), "R[1]=R[1]+1", r" \[ <n>(?: :[^\]]*)? \] = <registers>", "R{n} = {registers}"),
    Shape((INFORM,), "SET B000 5", r" <name1>[ \t]+<num>", "{name1} = {num}"),
    Shape((INFORM,), "SET B001 IN#(2)", r" <name>[ \t]+<in>", "{name} = {in}"),
    Shape((INFORM,), "SET B000 B001", r" <name1>[ \t]+<name2>", "{name1} = {name2}"),
    Shape((INFORM,), "INC B000", r" <name>", "{name} = {name} + 1"),
    Shape((INFORM,), "DEC B000", r" <name>", "{name} = {name} - 1"),
    Shape((INFORM,), "ADD I000 5", r" <name1>[ \t]+<num>", "{name1} = {name1} + {num}"),
    Shape((RAPID,), "Incr count;", r" <name>", "{name} = {name} + 1"),
    Shape((RAPID,), "Decr count;", r" <name>", "{name} = {name} - 1"),
    Shape((RAPID,), "Add count, 5;", r" <name> , <num>", "{name} = {name} + {num}"),
    Shape((AS,), "POINT p1 = p2", r" <name1> = <name2>", "{name1} = {name2}"),
    Shape((RAPID, KAREL), "reg1 := reg1 + 1;", r" := <rest>", "{word} = {rest}", words=_ANY),
)
_TEXTS = (
    Shape((RAPID,), 'TPWrite "part " \\Num:=n;', r" <texts> \\(?:Num|Bool) := <name>", "PRINT {texts}; {name}"),
    Shape((RAPID,), 'TPWrite "ready";', r" <texts>", "PRINT {texts}"),
    Shape((AS, VPLUS), 'TYPE "part ", n', r" <texts>", "PRINT {texts}"),
    Shape((INFORM,), 'MSG "ready"', r" <texts>", "PRINT {texts}", words="MSG PRINTMSG PRINTDBG"),
    Shape(
        (UR,),
        'textmsg("x ", x)',
        r" \( <texts>(?: , \w+ = .*)? \)",
        "PRINT {texts}",
        words="TEXTMSG POPUP PUTLN PUT PRINTF",
    ),
    Shape((KAREL,), "WRITE('part ', n, CR)", r" \( <texts> \)", "PRINT {texts}"),
    Shape((TP,), "MESSAGE[ready]", r" \[ <rest> \]", 'PRINT "{rest}"'),
    Shape((AS, C), 'PRINT "x ", x', r" <texts>", "PRINT {texts}"),
)
_COMMENTS = (
    Shape((RAPID, TP), "! go home", r" <rest>", "' {rest}"),
    Shape((KRL, AS, VPLUS), ";FOLD PTP HOME", r" <rest>", "' {rest}"),
    Shape((VAL3, C), "// go home", r" <rest>", "' {rest}"),
    Shape((KAREL,), "-- pick the part", r" <rest>", "' {rest}"),
    Shape((TP,), "--eg:pick the part", r" eg : <rest>", "' {rest}"),
    Shape((UR, PYTHON), "# go home", r" <rest>", "' {rest}"),
)
_VALUES = (
    Shape((TP, KAREL), "OUT(1) = ON", r" \( <n> \) = <state>", "OUT({n}) = {state}"),
    Shape((KRL, RAPID), "ready = TRUE", r" = <state>", "{word} = {state}", words=_ANY),
)
PROGRAM = (*_SUBS, *_JUMPS, *_BLOCKS, *_DATA, *_VALUES, *_TEXTS, *reversed(_COMMENTS))
