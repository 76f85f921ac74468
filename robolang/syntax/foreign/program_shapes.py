"""Lines of other languages on control, data, texts and comments. Data alone."""

from robolang.syntax.foreign.entry import AS, INFORM, KAREL, KRL, MELFA, PAC, PYTHON, RAPID, TP, UR, VAL3, VPLUS, C
from robolang.syntax.foreign.shape import ANY, Shape

_MAIN = "the main program has no head, it is what stands in no SUB"
_HEAD = "or remove the line: a main program has no head"
_NAME = "a register is a name; DIM a(n) makes an array"
_ENDED = "ENDSELECT ends it"
_PLACES = "a program is a file, and taught points are in another one beside it"

# which DEF of KRL begins the main program the line does not say: it has the name of its file
_SUBS = (
    Shape((RAPID,), "PROC main()", r" main \( \)", "", _MAIN, "PROC DEF"),
    Shape((RAPID,), "PROC pick()", r" <name> \( \)", "SUB {name}"),
    Shape((RAPID,), "PROC pick(num a, num b)", r" <name> \( <typed> \)", "SUB {name}({typed})"),
    Shape((KRL,), "GLOBAL DEF pick(a:IN, b:IN)", r" DEF <name> \( <taken> \)", "SUB {name}({taken})"),
    Shape((KRL,), "DEF pick(a:IN)", r" <name> \( <taken> \)", "SUB {name}({taken})"),
    Shape((KRL,), "GLOBAL DEF pick( )", r" DEF <name> \( \)", "SUB {name}"),
    Shape((KRL,), "DEF prog( )", r" <name> \( \)", "SUB {name}", _HEAD),
    Shape(
        (MELFA,),
        "Def Plt 1,P1,P2,P3,P4,3,4,1",
        r" Plt <among>",
        "P10 = P1 + (50 * i, 40 * j, 0)",
        "50 and 40 are the distances of its places, two FOR loops count i and j",
    ),
    Shape(
        (MELFA,),
        "Def Act 1,M_In(1)=1 GoSub *L1",
        r" Act <among>",
        "",
        "there is no interrupt: an input is read between moves, as in IF IN(1) = 1 THEN GOTO *STOPPED",
    ),
    Shape(
        (MELFA,),
        "Def Inte M1",
        r" (?:Inte|Long|Float|Double|Pos|Jnt|Char|Io) <item><more>",
        "",
        "names need no declaration",
    ),
    Shape((UR,), "def program():", r" (?:main|prog|program) \( \) :", "", f"{_MAIN}; remove its end, too"),
    Shape((UR,), "def pick():", r" <name> \( \) :", "SUB {name}", _HEAD),
    Shape((UR,), "def pick(a, b):", r" <name> \( <names> \) :", "SUB {name}({names})"),
    Shape((KAREL,), "ROUTINE pick", r" <name>", "SUB {name}"),
    Shape((INFORM,), "CALL JOB:SUB1", r" JOB : <name>", "CALL {name}"),
    Shape((INFORM,), "CALL JOB:SUB1 IF IN#(2)=ON", r" JOB : <name> IF <condition>", "IF {condition} THEN CALL {name}"),
    Shape((MELFA,), 'CallP "SUB1"', r' "<name>"', "CALL {name}"),
    Shape((MELFA,), 'CallP "SUB1",M1', r' "<name>" , <arguments>', "CALL {name}({arguments})"),
    Shape((TP,), "CALL PICK_PART;", r" <name>", "CALL {name}", "no ; ends a line"),
    Shape((TP,), "CALL PICK_PART(1,2);", r" <name> \( <arguments> \)", "CALL {name}({arguments})"),
    Shape((KAREL,), "CALL_PROG('PICK', status)", r" \( '<name>' (?:, <among> )?\)", "CALL {name}"),
    Shape((INFORM,), "CALL JOB:SUB1 ARGF1", r" JOB : <name> ARGF <arguments>", "CALL {name}({arguments})"),
)
_JUMPS = (
    Shape((TP,), "JMP LBL[1]", r" LBL \[ <n>(?: :.*)? \]", "GOTO *L{n}"),
    Shape((TP,), "LBL[3:retry]", r" \[ <n> : <rest> \]", "*L{n} ' {rest}"),
    Shape((TP,), "LBL[1]", r" \[ <n> \]", "*L{n}"),
    Shape((INFORM,), "JUMP *LOOP", r" \* <name>", "GOTO *{name}"),
    Shape((INFORM,), "JUMP *LOOP IF IN#(2)=ON", r" \* <name> IF <condition>", "IF {condition} THEN GOTO *{name}"),
    Shape((KAREL,), "GO TO again", r" TO <name>", "GOTO *{name}"),
    Shape((KAREL,), "again::", r" ::", "*{word}", words=ANY),
    Shape((INFORM,), "RET IF IN#(2)=ON", r" IF <condition>", "IF {condition} THEN RETURN"),
    Shape(
        (TP,),
        "SELECT R[1]=1,CALL A",
        r" <point> = <num> , CALL <name>",
        "SELECT {point}\nCASE {num}\nCALL {name}",
        _ENDED,
    ),
    Shape(
        (TP,),
        "SELECT R[1]=1,JMP LBL[2]",
        r" <point> = <num> , JMP LBL \[ <n>(?: :.*)? \]",
        "SELECT {point}\nCASE {num}\nGOTO *L{n}",
        _ENDED,
    ),
    Shape((TP,), "=2,CALL B", r" <num> , CALL <name>", "CASE {num}\nCALL {name}"),
    Shape((TP,), "=2,JMP LBL[3]", r" <num> , JMP LBL \[ <n>(?: :.*)? \]", "CASE {num}\nGOTO *L{n}"),
    Shape((TP,), "ELSE,CALL C", r" , CALL <name>", "CASE ELSE\nCALL {name}"),
    Shape((TP,), "ELSE,JMP LBL[9]", r" , JMP LBL \[ <n>(?: :.*)? \]", "CASE ELSE\nGOTO *L{n}"),
    Shape(
        (TP,), "IF DI[1]=ON,JMP LBL[2]", r" <condition> , JMP LBL \[ <n>(?: :.*)? \]", "IF {condition} THEN GOTO *L{n}"
    ),
    Shape((TP,), "IF DI[1]=ON,CALL PICK", r" <condition> , CALL <name>", "IF {condition} THEN CALL {name}"),
)
# patterns with a sign or a word at their end first: a condition would take the sign
_BLOCKS = (
    Shape((KRL, RAPID, AS, VPLUS), "IF $IN[1]==TRUE THEN", r" <condition> THEN", "IF {condition} THEN"),
    Shape((MELFA,), "If M_In(1)=1 Then *L1", r" <condition> THEN \* <name>", "IF {condition} THEN GOTO *{name}"),
    Shape(
        (MELFA,),
        "If M_In(1)=1 Then *L1 Else *L2",
        r" <condition> THEN \* <name1> ELSE \* <name2>",
        "IF {condition} THEN GOTO *{name1} ELSE GOTO *{name2}",
    ),
    Shape((MELFA,), "If M_In(1)=1 Then GOTO *L1", r" <condition> THEN <rest>", "IF {condition} THEN {rest}"),
    Shape(
        (RAPID, AS, VPLUS), "IF n>=10 GOTO finish;", r" <condition> GOTO <target>", "IF {condition} THEN GOTO {target}"
    ),
    Shape((RAPID,), "IF ready RETURN;", r" <condition> RETURN", "IF {condition} THEN RETURN"),
    Shape((UR, PYTHON), "if get_digital_in(1) == True:", r" <condition> :", "IF {condition} THEN"),
    Shape((INFORM,), "IFTHEN IN#(1)=ON", r" <condition>", "IF {condition} THEN"),
    Shape((C, VAL3), "if (x == 1) {", r" <condition> \{?", "IF {condition} THEN"),
    Shape((UR, PYTHON), "elif x == 2:", r" <condition> :", "ELSEIF {condition} THEN", words="ELIF ELSIF"),
    Shape((RAPID, KRL), "ELSEIF x == 2 THEN", r" <condition> THEN", "ELSEIF {condition} THEN", words="ELSEIF ELSIF"),
    Shape((UR, PYTHON), "else:", r" :", "ELSE"),
    Shape((UR, PYTHON), "while (get_digital_in(1) == False):", r" \( <condition> \) :", "WHILE {condition}"),
    Shape((UR, PYTHON), "while x < 3:", r" <condition> :", "WHILE {condition}"),
    Shape((RAPID, KAREL, AS), "WHILE x == 1 DO", r" <condition> DO", "WHILE {condition}"),
    Shape((KRL, C), "WHILE $IN[1]==FALSE", r" <condition>", "WHILE {condition}"),
    Shape((PAC,), "Do While IO[1] = OFF", r" While <condition>", "WHILE {condition}"),
    Shape((UR, PYTHON), "for i in range(5):", r" <name> in range \( <rounds> \) :", "FOR {name} = 0 TO {rounds}"),
    Shape(
        (UR, PYTHON),
        "for i in range(1, 5):",
        r" <name> in range \( <num> , <rounds> \) :",
        "FOR {name} = {num} TO {rounds}",
    ),
    Shape(
        (RAPID,),
        "FOR i FROM 1 TO 9 STEP 2 DO",
        r" <name> FROM <num1> TO <num2> STEP <num3> DO",
        "FOR {name} = {num1} TO {num2} STEP {num3}",
    ),
    Shape((AS, VPLUS), "VALUE 1:", r" <values> :", "CASE {values}"),
    Shape(
        (RAPID,), "FOR i FROM 1 TO 10 DO", r" <name> FROM <bound1> TO <bound2> DO", "FOR {name} = {bound1} TO {bound2}"
    ),
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
    Shape(
        (RAPID,),
        "CONST jointtarget jHome := [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];",
        r" jointtarget <name> := \[ \[ <values> \] .*",
        "{name} = JOINT({values})",
        "or teach the point",
        "CONST PERS VAR",
    ),
    Shape(
        (RAPID,),
        "CONST speeddata vSlow := [200,500,5000,1000];",
        r" speeddata <name> := \[ <num> , <among> \]",
        "CONST {name} = {num}",
        "it is the v of SPEED v, in mm/s",
        "CONST PERS VAR",
    ),
    Shape(
        (RAPID,),
        "PERS tooldata tGrip := [TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];",
        r" tooldata <name>(?: := <among>)?",
        "",
        "the cell file has the tools: [tools.{name}] with pose_mm_deg",
        "CONST PERS VAR",
    ),
    Shape(
        (RAPID,),
        'PERS wobjdata wTray := [FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];',
        r" wobjdata <name>(?: := <among>)?",
        "",
        "the cell file has the frames: [frames.{name}] with pose_mm_deg",
        "CONST PERS VAR",
    ),
    Shape(
        (RAPID,),
        "PERS loaddata lPart := [1.5,[0,0,60],[1,0,0,0],0,0,0];",
        r" loaddata <name>(?: := <among>)?",
        "",
        "the cell file has the loads: [loads.{name}] with mass_kg and cog_mm",
        "CONST PERS VAR",
    ),
    Shape((RAPID,), "VAR num x;", r" \w+ <name>", "", "names need no declaration", "VAR PERS"),
    Shape((KRL,), "DECL E6POS XP5", r" (?:E6POS|POS|FRAME) <name>", "", "teach the point {name}: its file has it"),
    Shape((KRL,), "DECL E6AXIS XP5", r" (?:E6AXIS|AXIS) <name>", "", "teach the point {name}: its file has it"),
    Shape((RAPID,), "p20 := RelTool(p10,0,0,50);", r" := <shifted>", "{word} = {shifted}", words=ANY),
    Shape((RAPID,), "p10 := CRobT(\\Tool:=tool0);", r" := CRobT \( <among> \)", "{word} = HERE", words=ANY),
    Shape((RAPID,), "p10.trans.z := p10.trans.z + 50;", r" <trans>", "{trans}", words=ANY),
    Shape((MELFA, PAC), "P10 = P_Curr", r" = (?:P_Curr|CurPos)", "{word} = HERE", words=ANY),
    Shape((VAL3,), "p = here(tGrip, world)", r" = here \( <item1> , <item2> \)", "{word} = HERE", words=ANY),
    Shape(
        (UR,),
        "q = get_actual_joint_positions()",
        r" = get_actual_joint_positions \( \)",
        "{word} = HERE",
        "HERE is the pose; a taught point may hold joint angles",
        ANY,
    ),
    Shape(
        (KAREL,),
        "count : INTEGER",
        r" : (?:INTEGER|REAL|BOOLEAN|STRING \[ \d+ \]|POSITION|XYZWPR|JOINTPOS|VECTOR|FILE)",
        "",
        "names need no declaration",
        ANY,
    ),
    Shape((PAC,), "Dim I As Integer", r" <item> As <rest>", "", "names need no declaration"),
    Shape((TP,), "PR[1,3]=PR[1,3]+100", r" <element>", "{element}"),
    Shape((TP,), "PR[1]=LPOS", r" \[ <n>(?: :[^\]]*)? \] = LPOS", "PR{n} = HERE"),
    Shape((TP,), "PR[1]=P[2]", r" \[ <n>(?: :[^\]]*)? \] = <point>", "PR{n} = {point}"),
    Shape((RAPID,), "VAR num x := 5;", r" \w+ <name> := <rest>", "{name} = {rest}", words="VAR PERS CONST LOCAL"),
    Shape((KRL,), "DECL INT x = 5", r" \w+ <name> = <num>", "{name} = {num}"),
    Shape((UR,), "global x = 5", r" <name> = <rest>", "{name} = {rest}", words="GLOBAL LOCAL LET INT NUM"),
    Shape((TP,), "F[1]=(ON)", r" \[ <n>(?: :[^\]]*)? \] = \(? <state> \)?", "F{n} = {state}", _NAME),
    Shape((PAC,), "I[1] = I[1] + 1", r" \[ <n> \] = <registers>", "{word}{n} = {registers}", _NAME, "I F D"),
    Shape((TP,), "TIMER[1]=START", r" \[ <n> \] = START", "t{n} = TIMER", "TIMER - t{n} are the seconds since"),
    Shape((TP,), "R[1]=R[1]+1", r" \[ <n>(?: :[^\]]*)? \] = <registers>", "R{n} = {registers}"),
    Shape((INFORM,), "SET B000 5", r" <name1>[ \t]+<num>", "{name1} = {num}"),
    Shape((INFORM,), "SET B001 IN#(2)", r" <name>[ \t]+<in>", "{name} = {in}"),
    Shape((INFORM,), "SET B000 B001", r" <name1>[ \t]+<name2>", "{name1} = {name2}"),
    Shape((INFORM,), "INC B000", r" <name>", "{name} = {name} + 1"),
    Shape((INFORM,), "DEC B000", r" <name>", "{name} = {name} - 1"),
    Shape((INFORM,), "ADD I000 5", r" <name1>[ \t]+<num>", "{name1} = {name1} + {num}"),
    Shape((INFORM,), "SUB I000 5", r" <name1>[ \t]+<num>", "{name1} = {name1} - {num}"),
    Shape((INFORM,), "MUL I000 5", r" <name1>[ \t]+<num>", "{name1} = {name1} * {num}"),
    Shape((INFORM,), "DIV D000 5", r" <name1>[ \t]+<num>", "{name1} = {name1} / {num}"),
    Shape((INFORM,), "GETS PX001 $PX000", r" <name>[ \t]+\$PX000", "{name} = HERE"),
    Shape((RAPID,), "Incr count;", r" <name>", "{name} = {name} + 1"),
    Shape((RAPID,), "Decr count;", r" <name>", "{name} = {name} - 1"),
    Shape((RAPID,), "Add count, 5;", r" <name> , <num>", "{name} = {name} + {num}"),
    Shape((AS,), "HERE p1", r" <point>", "{point} = HERE"),
    Shape(
        (AS,), "POINT p1 = SHIFT(p2 BY 0,0,50)", r" <name1> = SHIFT \( <point> BY <mm> \)", "{name1} = {point} + ({mm})"
    ),
    Shape((AS,), "POINT p1 = p2", r" <name1> = <name2>", "{name1} = {name2}"),
    Shape((RAPID, KAREL), "reg1 := reg1 + 1;", r" := <rest>", "{word} = {rest}", words=ANY),
)
_TEXTS = (
    Shape((RAPID,), 'TPWrite "part " \\Num:=n;', r" <texts> \\(?:Num|Bool) := <name>", "PRINT {texts}; {name}"),
    Shape((RAPID,), 'TPWrite "n " + NumToStr(n,0);', r" <joined>", "PRINT {joined}"),
    Shape((RAPID,), 'TPWrite "ready";', r" <texts>", "PRINT {texts}"),
    Shape((AS, VPLUS), 'TYPE "part ", n', r" <texts>", "PRINT {texts}"),
    Shape((INFORM,), 'MSG "ready"', r" <texts>", "PRINT {texts}", words="MSG PRINTMSG PRINTDBG"),
    Shape(
        (UR,),
        'textmsg("x ", x)',
        r" \( <texts>(?: , <option>)? \)",
        "PRINT {texts}",
        words="TEXTMSG POPUP PUTLN PUT PRINTF",
    ),
    Shape((KAREL,), "WRITE('part ', n, CR)", r" \( <texts> \)", "PRINT {texts}"),
    Shape((TP,), "MESSAGE[ready]", r" \[ <rest> \]", 'PRINT "{rest}"'),
    Shape((AS, C), 'PRINT "x ", x', r" <texts>", "PRINT {texts}"),
)
_COMMENTS = (
    Shape((TP,), "/PROG PICK", r" (?:PROG|ATTR|APPL|MN|POS|END)\b<more>", "", _PLACES),
    Shape((KRL,), "&ACCESS RVP", r" [A-Z]\w*<more>", "", _PLACES),
    Shape((RAPID, TP), "! go home", r" <rest>", "' {rest}"),
    Shape((KRL, AS, VPLUS), ";FOLD PTP HOME", r" <rest>", "' {rest}"),
    Shape((VAL3, C), "// go home", r" <rest>", "' {rest}"),
    Shape((KAREL,), "-- pick the part", r" <rest>", "' {rest}"),
    Shape((TP,), "--eg:pick the part", r" eg : <rest>", "' {rest}"),
    Shape((UR, PYTHON), "# go home", r" <rest>", "' {rest}"),
)
_VALUES = (
    Shape((TP, KAREL), "OUT(1) = ON", r" \( <n> \) = <state>", "OUT({n}) = {state}"),
    Shape((KRL, RAPID), "ready = TRUE", r" = <state>", "{word} = {state}", words=ANY),
)
PROGRAM = (*_SUBS, *_JUMPS, *_BLOCKS, *_DATA, *_VALUES, *_TEXTS, *reversed(_COMMENTS))
