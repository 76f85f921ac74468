"""Lines of other languages on speeds, tools, frames, loads, the hand, inputs, outputs and waiting. Data alone."""

from robolang.syntax.foreign.entry import AS, INFORM, KAREL, KRL, MELFA, PAC, RAPID, TP, UR, VAL3, VPLUS
from robolang.syntax.foreign.shape import ANY, Shape

_TOOLS = "the cell file names its tools: [tools.tool{n}]"
_FRAMES = "the cell file names its frames: [frames.frame{n}]"
_LOADS = "the cell file names its loads: [loads.load{n}]"
_NUMBERED = "n is the number of the signal"
_ALL = "OVERRIDE is a percentage of every speed"
_EACH_AXIS = "SPEEDJ is that of all joints"
_ONE_VALUE = "one percentage is for both acceleration and deceleration"
_HOLDS = "it holds for the moves that follow"
_OF_ROBOT = "n is the number of the signal; HAND ON and HAND OFF move the hand"
_STATE = r" <n>(?: :[^\])]*)?"

# of AS, V+ and PacScript a speed is a share of the fastest one, and what scales every speed here is OVERRIDE
_SETTINGS = (
    Shape((KRL,), "$VEL.CP=0.2", r" \. CP = <speed>", "SPEED {speed}"),
    Shape((KRL,), "$VEL_AXIS[1]=50", r" \[ \w+ \] = <num>", "SPEEDJ {num}", _EACH_AXIS),
    Shape((KRL,), "$OV_PRO=50", r" = <num>", "OVERRIDE {num}"),
    Shape((KRL,), "$APO.CDIS=5", r" \. CDIS = <num>", "ZONE {num}"),
    Shape((KRL,), "BAS(#VEL_PTP,50)", r" \( #VEL_PTP , <num> \)", "SPEEDJ {num}"),
    Shape((KRL,), "BAS(#VEL_CP,0.2)", r" \( #VEL_CP , <speed> \)", "SPEED {speed}"),
    Shape((RAPID,), "VelSet 50, 800;", r" <num> , <lost>", "OVERRIDE {num}"),
    Shape((RAPID,), "AccSet 50, 100;", r" <num> , <lost><more>", "ACCEL {num}"),
    Shape((MELFA,), "Spd 200", r" <num>", "SPEED {num}"),
    Shape((MELFA,), "Ovrd 50", r" <num>(?: , <lost>)?", "OVERRIDE {num}"),
    Shape((MELFA,), "JOvrd 50", r" <num>", "SPEEDJ {num}"),
    Shape((MELFA, PAC), "Accel 50,50", r" <num> , <lost><more>", "ACCEL {num}", _ONE_VALUE),
    Shape((MELFA,), "Cnt 0", r" 0", "ZONE 0"),
    Shape(
        (MELFA,), "Cnt 1,50,100", r" 1 , <num> , <lost>", "ZONE {num}", "one radius is for the end and the beginning"
    ),
    Shape((PAC,), "DRAW L, P(0,0,50)", r" L , P? \( <mm> \)", "MOVE HERE + ({mm})"),
    Shape((PAC,), "ExtSpeed 50", r" <num>", "OVERRIDE {num}"),
    Shape((VAL3,), "setMonitorSpeed(50)", r" \( <num> \)", "OVERRIDE {num}"),
    Shape((VAL3,), "mFast.leave=10", r" \. (?:leave|reach) = <num>", "ZONE {num}", _HOLDS, ANY),
    Shape((VAL3,), "mFast.vel=50", r" \. vel = <num>", "SPEEDJ {num}", _HOLDS, ANY),
    Shape((VAL3,), "mFast.tvel=250", r" \. tvel = <num>", "SPEED {num}", _HOLDS, ANY),
    Shape((VAL3,), "mFast.accel=80", r" \. accel = <num>", "ACCEL {num}", _HOLDS, ANY),
    Shape((KAREL,), "$MOTYPE = LINEAR", r" = \w+", "", "MOVE moves straight, MOVEJ all joints, MOVEC on an arc"),
    Shape((TP,), "OVERRIDE=50%", r" = <num> %", "OVERRIDE {num}"),
    Shape((KAREL,), "$SPEED = 250", r" = <num>", "SPEED {num}"),
    Shape((AS, VPLUS), "SPEED 50 ALWAYS", r" <num> %? ALWAYS", "OVERRIDE {num}", _ALL),
    Shape((AS, VPLUS), "SPEED 200 MM/S ALWAYS", r" <num> (?:MM/S|MMPS)(?: ALWAYS)?", "SPEED {num}"),
    Shape((AS,), "ACCEL 80 ALWAYS", r" <num> ALWAYS", "ACCEL {num}", _ONE_VALUE),
    Shape((AS,), "ACCURACY 10 ALWAYS", r" <num>(?: ALWAYS)?", "ZONE {num}"),
    Shape((PAC,), "Speed 50,50", r" <num> , <lost><more>", "OVERRIDE {num}", _ALL),
    Shape((INFORM,), "SPEED VJ=50.00", r" VJ = <num>", "SPEEDJ {num}"),
    Shape((INFORM,), "SPEED V=200.0", r" V = <num>", "SPEED {num}", "if V is in mm/s"),
)
# numbers of tools, frames and loads become names: a cell has no numbered ones
_TOOLS_AND_LOADS = (
    Shape((KRL,), "$TOOL=TOOL_DATA[1]", r" = TOOL_DATA \[ <n> \]", "TOOL tool{n}", _TOOLS),
    Shape(
        (KRL,),
        "$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}",
        r" = \{ X <num1> , Y <num2> , Z <num3> , A <num4> , B <num5> , C <num6> \}",
        "TOOL POSE({num1}, {num2}, {num3}, {num6}, {num5}, {num4})",
    ),
    Shape(
        (KRL,),
        "$BASE={X 400,Y 0,Z 0,A 90,B 0,C 0}",
        r" = \{ X <num1> , Y <num2> , Z <num3> , A <num4> , B <num5> , C <num6> \}",
        "FRAME POSE({num1}, {num2}, {num3}, {num6}, {num5}, {num4})",
    ),
    Shape((KRL,), "$BASE=BASE_DATA[2]", r" = BASE_DATA \[ <n> \]", "FRAME frame{n}", _FRAMES),
    Shape((AS, VPLUS), "BASE NULL", r" NULL", "FRAME WORLD"),
    Shape((KRL,), "$BASE=$NULLFRAME", r" = \$(?:NULLFRAME|WORLD)", "FRAME WORLD"),
    Shape((TP,), "UFRAME_NUM=0", r" = 0", "FRAME WORLD"),
    Shape((TP,), "UTOOL_NUM=1", r" = <n>", "TOOL tool{n}", _TOOLS),
    Shape((TP,), "UFRAME_NUM=1", r" = <n>", "FRAME frame{n}", _FRAMES),
    Shape((TP,), "PAYLOAD[1]", r" \[ <n> \]", "LOAD load{n}", _LOADS),
    Shape((RAPID,), "GripLoad load1;", r" <name>", "LOAD {name}", "the cell file names its loads: [loads.{name}]"),
    Shape((MELFA,), "LoadSet 1,2", r" <n1> , <n2>", "LOAD load{n1}_{n2}", "a name of a load in the cell file"),
    Shape((KRL,), "$LOAD=LOAD_DATA[1]", r" = LOAD_DATA \[ <n> \]", "LOAD load{n}", _LOADS),
    Shape((INFORM,), "SETTOOL TL#(1)", r" TL# \( <n> \)<more>", "TOOL tool{n}", _TOOLS),
    Shape((PAC,), "ChangeTool 1", r" <n>", "TOOL tool{n}", _TOOLS),
    Shape((PAC,), "ChangeWork 2", r" <n>", "FRAME frame{n}", _FRAMES),
    Shape((AS,), "WEIGHT 5,0,0,100", r" <num1> , <mm>", "LOAD ({mm}), {num1}"),
    Shape(
        (UR,),
        "set_payload(1.5, [0,0,0.05])",
        r" \( <num> , \[ <m> \](?: , <among>)? \)",
        "LOAD ({m}), {num}",
        words="SET_PAYLOAD SET_TARGET_PAYLOAD",
    ),
    Shape(
        (UR,), "set_payload(1.5)", r" \( <num> \)", "LOAD (0, 0, 0), {num}", "the centre of gravity (x, y, z) is in mm"
    ),
    Shape(
        (UR,),
        "set_tcp(p[0,0,0.12,0,0,0])",
        r" \( (?:<vector>)?<posed> \)",
        "TOOL {posed}",
        "{vector}",
    ),
    Shape((MELFA,), "HOpen 1", r"(?:[ \t]<among>)?", "HAND OFF"),
    Shape((MELFA,), "HClose 1", r"(?:[ \t]<among>)?", "HAND ON"),
    Shape((VAL3,), "open(tGripper)", r" \( <item> \)", "HAND OFF"),
    Shape((VAL3,), "close(tGripper)", r" \( <item> \)", "HAND ON"),
    Shape((KAREL,), "OPEN HAND 1", r" HAND <digit>", "HAND OFF"),
    Shape((KAREL,), "CLOSE HAND 1", r" HAND <digit>", "HAND ON"),
    Shape((INFORM,), "HAND 1 ON", r" <digit> ON", "HAND ON"),
    Shape((INFORM,), "HAND 1 OFF", r" <digit> OFF", "HAND OFF"),
)
# a signal of RAPID has a name; which output it is, its line does not say
_OUTPUTS = (
    Shape((KRL,), "OUT 5 'grip' State=TRUE", r" <n> <quoted> State = <state><more>", "OUT({n}) = {state}"),
    Shape(
        (KRL,),
        "PULSE 3 '' State=TRUE Time=0.5 sec",
        r" <n> <quoted> State = TRUE(?: <item>)? Time = <s> sec",
        "PULSE {n}, {s}",
    ),
    Shape((INFORM,), "PULSE OT#(3)", r" OT# \( <n> \)", "PULSE {n}, 0.3"),
    Shape((INFORM,), "DIN B000 IN#(1)", r" <name>[ \t]+<in>", "{name} = {in}"),
    Shape((KRL,), "PULSE($OUT[1],TRUE,0.5)", r" \( \$OUT \[ <n> \] , TRUE , <s> \)", "PULSE {n}, {s}"),
    Shape((KRL,), "$OUT[3]=TRUE", rf" \[{_STATE} \] = <state>", "OUT({n}) = {state}"),
    Shape((TP,), "DO[1]=PULSE,0.5sec", rf" \[{_STATE} \] = PULSE , <s> sec", "PULSE {n}, {s}", words="DO SDO"),
    Shape((TP,), "RO[1]=ON", rf" \[{_STATE} \] = <state>", "OUT(n) = {state}", _OF_ROBOT),
    Shape((TP, KAREL), "DO[1]=ON", rf" \[{_STATE} \] = \(? <state> \)?", "OUT({n}) = {state}", words="DO SDO DOUT"),
    Shape((TP, KAREL), "GO[1]=5", rf" \[{_STATE} \] = <num>", "OUT({n}) = {num}", words="GO AO AOUT"),
    Shape((INFORM,), "DOUT OT#(1) ON", r" OG?T# \( <n> \) <state>", "OUT({n}) = {state}"),
    Shape((INFORM,), "PULSE OT#(3) T=0.5", r" OT# \( <n> \) T = <s>", "PULSE {n}, {s}"),
    Shape((INFORM,), "AOUT AO#(1) 5.0", r" AO# \( <n> \) <num>", "OUT({n}) = {num}"),
    Shape((MELFA,), "M_Out(1)=1", r" \( <n> \) = <state>", "OUT({n}) = {state}"),
    Shape((MELFA,), "M_OutB(1)=5", r" \( <n> \) = <num>", "OUT({n}) = {num}", words="M_OUTB M_OUTW"),
    Shape((PAC,), "Set IO[1]", r" IO \[ <n> \]", "OUT({n}) = 1"),
    Shape((PAC,), "Reset IO[24]", r" IO \[ <n> \]", "OUT({n}) = 0"),
    Shape((PAC,), "IO[1] = ON", r" \[ <n> \] = <state>", "OUT({n}) = {state}"),
    Shape((RAPID,), "Set do5;", r" <name>", "OUT(n) = 1", _NUMBERED),
    Shape((RAPID,), "Reset do5;", r" <name>", "OUT(n) = 0", _NUMBERED),
    Shape((RAPID,), "SetDO doGripper, 1;", r" (?:<switch> ,)? <name> , <state>", "OUT(n) = {state}", _NUMBERED),
    Shape((RAPID,), "SetGO goType, 5;", r" <name> , <num>", "OUT(n) = {num}", _NUMBERED, "SETGO SETAO"),
    Shape((RAPID,), "PulseDO do5;", r" <name>", "PULSE n, 0.2", _NUMBERED),
    Shape((RAPID,), "PulseDO \\PLength:=0.5, do5;", r" \\PLength := <s> , <name>", "PULSE n, {s}", _NUMBERED),
    Shape(
        (UR,),
        "set_digital_out(1,True)",
        r" \( <n> , <state> \)",
        "OUT({n}) = {state}",
        words="SET_DIGITAL_OUT SET_STANDARD_DIGITAL_OUT",
    ),
    Shape(
        (UR,),
        "set_digital_out(0,True)",
        r" \( 0 , <state> \)",
        "OUT(n) = {state}",
        f"{_NUMBERED}, from 1 on",
        "SET_DIGITAL_OUT SET_STANDARD_DIGITAL_OUT",
    ),
    Shape((UR,), "set_tool_digital_out(0,True)", r" \( \d+ , <state> \)", "OUT(n) = {state}", _OF_ROBOT),
    Shape((KAREL,), "PULSE DOUT[4] FOR 300", r" DOUT \[ <n> \] FOR <ms>", "PULSE {n}, {ms}", "times are in s"),
    Shape((AS, VPLUS), "SIGNAL 1", r" <signal>", "{signal}"),
    Shape((AS, VPLUS), "SIGNAL 1,-2", r" <signal1> , <signal2>", "{signal1}\n{signal2}"),
    Shape((AS, VPLUS), "SIGNAL 1,-2,3", r" <signal1> , <signal2> , <signal3>", "{signal1}\n{signal2}\n{signal3}"),
)
# the exact forms first: the last pattern takes any condition
_WAITS = (
    Shape((VAL3,), "wait(diPart==true)", r" \( <name> == <state> \)", "WAIT IN(n) = {state}", _NUMBERED),
    Shape((KRL,), "WAIT FOR ( IN 1 'part' )", r" FOR \( IN <n> <quoted> \)", "WAIT IN({n}) = 1"),
    Shape((KRL,), "WAIT SEC 0.5", r" SEC <s>", "DELAY {s}"),
    Shape((TP,), "WAIT 0.50(sec)", r" <s> \(? sec \)?", "DELAY {s}"),
    Shape((KAREL,), "WAIT FOR DIN[1]", r" FOR <condition>", "WAIT {condition}"),
    Shape(
        (TP,),
        "WAIT DI[1]=ON TIMEOUT,LBL[2]",
        r" <condition> TIMEOUT , LBL \[ <n> \]",
        "WAIT {condition}, TIMEOUT 30, GOTO *L{n}",
        "$WAITTMOUT says how many s",
    ),
    Shape((INFORM,), "WAIT IN#(1)=ON T=5.0", r" <condition> T = <s>", "WAIT {condition}, TIMEOUT {s}"),
    Shape(
        (PAC,),
        "Wait IO[1] = On, 3000",
        r" (?=IO )<condition> , <ms>",
        "WAIT {condition}, TIMEOUT {ms}",
        "TIMEOUT is in s",
    ),
    Shape((INFORM, TP, PAC, MELFA), "WAIT IN#(1)=ON", r" <condition>", "WAIT {condition}"),
    Shape((RAPID,), "WaitTime 0.5;", r"(?: <switch> ,)? <s>", "DELAY {s}"),
    Shape(
        (RAPID,),
        "WaitDI diPart, 1\\MaxTime:=10;",
        r" <name> , <state> \\MaxTime := <s>(?: <switch>)?",
        "WAIT IN(n) = {state}, TIMEOUT {s}",
        _NUMBERED,
    ),
    Shape((RAPID,), "WaitDI diPart, 1;", r" <name> , <state>(?: <switch>)?", "WAIT IN(n) = {state}", _NUMBERED),
    Shape((RAPID,), "WaitUntil diPart=1;", r"(?: <switch> ,)? <name> = <state>", "WAIT IN(n) = {state}", _NUMBERED),
    Shape(
        (RAPID,),
        "WaitUntil count>3\\MaxTime:=5;",
        r"(?: <switch1> ,)? <condition> \\MaxTime := <s>(?: <switch2>)?",
        "WAIT {condition}, TIMEOUT {s}",
        "a signal is IN(n)",
    ),
    Shape((RAPID,), "WaitUntil count>3;", r"(?: <switch> ,)? <condition>", "WAIT {condition}", "a signal is IN(n)"),
    Shape(
        (VAL3,),
        "watch(diPart==true,5)",
        r" \( <name> == <state> , <s> \)",
        "WAIT IN(n) = {state}, TIMEOUT {s}",
        _NUMBERED,
    ),
    Shape(
        (VAL3,), "watch(count>3,5)", r" \( <condition> , <s> \)", "WAIT {condition}, TIMEOUT {s}", "a signal is IN(n)"
    ),
    Shape((MELFA,), "Dly 0.5", r" <s>", "DELAY {s}"),
    Shape((INFORM,), "TIMER T=0.5", r" T = <s>", "DELAY {s}"),
    Shape((UR,), "sleep(0.5)", r" \( <s> \)", "DELAY {s}"),
    Shape((AS,), "TWAIT 0.5", r" <s>", "DELAY {s}"),
    Shape((AS,), "SWAIT 1003", r" <input>", "WAIT {input}"),
    Shape((AS,), "SWAIT 1003,-1004", r" <input1> , <input2>", "WAIT {input1} AND {input2}"),
)
CELL = (*_SETTINGS, *_TOOLS_AND_LOADS, *_OUTPUTS, *_WAITS)
