"""Lines of other languages on speeds, tools, frames, loads, the hand, inputs, outputs and waiting. Data alone."""

from robolang.syntax.foreign.entry import AS, INFORM, KAREL, KRL, MELFA, PAC, RAPID, TP, UR, VAL3, VPLUS
from robolang.syntax.foreign.shape import Shape

_TOOLS = "the cell file names its tools: [tools.tool1]"
_FRAMES = "the cell file names its frames: [frames.frame1]"
_LOADS = "the cell file names its loads: [loads.load1]"
_NUMBERED = "n is the number of the signal"
_ALL = "OVERRIDE is a percentage of every speed"
_EACH_AXIS = "SPEEDJ is that of all joints"
_ONE_VALUE = "one percentage is for both acceleration and deceleration"
_STATE = r" <n>(?: :[^\])]*)?"

# of AS, V+ and PacScript a speed is a share of the fastest one, and what scales every speed here is OVERRIDE
_SETTINGS = (
    Shape((KRL,), "$VEL.CP=0.2", r" \. CP = <speed>", "SPEED {speed}"),
    Shape((KRL,), "$VEL_AXIS[1]=50", r" \[ \w+ \] = <num>", "SPEEDJ {num}", _EACH_AXIS),
    Shape((KRL,), "$OV_PRO=50", r" = <num>", "OVERRIDE {num}"),
    Shape((KRL,), "$APO.CDIS=5", r" \. CDIS = <num>", "ZONE {num}"),
    Shape((KRL,), "BAS(#VEL_PTP,50)", r" \( #VEL_PTP , <num> \)", "SPEEDJ {num}"),
    Shape((KRL,), "BAS(#VEL_CP,0.2)", r" \( #VEL_CP , <speed> \)", "SPEED {speed}"),
    Shape((RAPID,), "VelSet 50, 800;", r" <num> , .*", "OVERRIDE {num}"),
    Shape((RAPID,), "AccSet 50, 100;", r" <num> , .*", "ACCEL {num}"),
    Shape((MELFA,), "Spd 200", r" <num>", "SPEED {num}"),
    Shape((MELFA,), "Ovrd 50", r" <num>(?: ,.*)?", "OVERRIDE {num}"),
    Shape((MELFA,), "JOvrd 50", r" <num>", "SPEEDJ {num}"),
    Shape((MELFA, PAC), "Accel 50,50", r" <num> , .*", "ACCEL {num}", _ONE_VALUE),
    Shape((MELFA,), "Cnt 0", r" 0", "ZONE 0"),
    Shape((TP,), "OVERRIDE=50%", r" = <num> %", "OVERRIDE {num}"),
    Shape((KAREL,), "$SPEED = 250", r" = <num>", "SPEED {num}"),
    Shape((AS, VPLUS), "SPEED 50 ALWAYS", r" <num> %? ALWAYS", "OVERRIDE {num}", _ALL),
    Shape((AS, VPLUS), "SPEED 200 MM/S ALWAYS", r" <num> (?:MM/S|MMPS)(?: ALWAYS)?", "SPEED {num}"),
    Shape((AS,), "ACCEL 80 ALWAYS", r" <num> ALWAYS", "ACCEL {num}", _ONE_VALUE),
    Shape((AS,), "ACCURACY 10 ALWAYS", r" <num>(?: ALWAYS)?", "ZONE {num}"),
    Shape((PAC,), "Speed 50,50", r" <num> , .*", "OVERRIDE {num}", _ALL),
    Shape((INFORM,), "SPEED VJ=50.00", r" VJ = <num>", "SPEEDJ {num}"),
    Shape((INFORM,), "SPEED V=200.0", r" V = <num>", "SPEED {num}", "if V is in mm/s"),
)
# numbers of tools, frames and loads become names: a cell has no numbered ones
_TOOLS_AND_LOADS = (
    Shape((KRL,), "$TOOL=TOOL_DATA[1]", r" = TOOL_DATA \[ <n> \]", "TOOL tool{n}", _TOOLS),
    Shape((KRL,), "$BASE=BASE_DATA[2]", r" = BASE_DATA \[ <n> \]", "FRAME frame{n}", _FRAMES),
    Shape((KRL,), "$BASE=$NULLFRAME", r" = \$(?:NULLFRAME|WORLD)", "FRAME WORLD"),
    Shape((TP,), "UFRAME_NUM=0", r" = 0", "FRAME WORLD"),
    Shape((TP,), "UTOOL_NUM=1", r" = <n>", "TOOL tool{n}", _TOOLS),
    Shape((TP,), "UFRAME_NUM=1", r" = <n>", "FRAME frame{n}", _FRAMES),
    Shape((TP,), "PAYLOAD[1]", r" \[ <n> \]", "LOAD load{n}", _LOADS),
    Shape((RAPID,), "GripLoad load1;", r" <name>", "LOAD {name}", _LOADS),
    Shape((MELFA,), "LoadSet 1,2", r" <n1> , <n2>", "LOAD load{n1}_{n2}", "a name of a load in the cell file"),
    Shape((KRL,), "$LOAD=LOAD_DATA[1]", r" = LOAD_DATA \[ <n> \]", "LOAD load{n}", _LOADS),
    Shape((INFORM,), "SETTOOL TL#(1)", r" TL# \( <n> \).*", "TOOL tool{n}", _TOOLS),
    Shape((PAC,), "ChangeTool 1", r" <n>", "TOOL tool{n}", _TOOLS),
    Shape((PAC,), "ChangeWork 2", r" <n>", "FRAME frame{n}", _FRAMES),
    Shape((AS,), "WEIGHT 5,0,0,100", r" <num1> , <mm>", "LOAD ({mm}), {num1}"),
    Shape(
        (UR,),
        "set_payload(1.5, [0,0,0.05])",
        r" \( <num> , \[ <m> \].*",
        "LOAD ({m}), {num}",
        words="SET_PAYLOAD SET_TARGET_PAYLOAD",
    ),
    Shape(
        (UR,), "set_payload(1.5)", r" \( <num> \)", "LOAD (0, 0, 0), {num}", "the centre of gravity (x, y, z) is in mm"
    ),
    Shape(
        (UR,),
        "set_tcp(p[0,0,0.12,0,0,0])",
        r" \( p \[ <m> \] \)",
        "TOOL POSE({m}, rx, ry, rz)",
        "rx, ry and rz are angles in degrees, not a rotation vector",
    ),
    Shape((MELFA,), "HOpen 1", r"(?: <n>(?: ,.*)?)?", "HAND OFF"),
    Shape((MELFA,), "HClose 1", r"(?: <n>(?: ,.*)?)?", "HAND ON"),
    Shape((VAL3,), "open(tGripper)", r" \( \w+ \)", "HAND OFF"),
    Shape((VAL3,), "close(tGripper)", r" \( \w+ \)", "HAND ON"),
    Shape((KAREL,), "OPEN HAND 1", r" HAND \d", "HAND OFF"),
    Shape((KAREL,), "CLOSE HAND 1", r" HAND \d", "HAND ON"),
    Shape((INFORM,), "HAND 1 ON", r" \d ON", "HAND ON"),
    Shape((INFORM,), "HAND 1 OFF", r" \d OFF", "HAND OFF"),
)
# a signal of RAPID has a name; which output it is, its line does not say
_OUTPUTS = (
    Shape((KRL,), "OUT 5 'grip' State=TRUE", r" <n> '[^']*' State = <state><more>", "OUT({n}) = {state}"),
    Shape(
        (KRL,),
        "PULSE 3 '' State=TRUE Time=0.5 sec",
        r" <n> '[^']*' State = TRUE(?: CONT)? Time = <s> sec",
        "PULSE {n}, {s}",
    ),
    Shape((INFORM,), "PULSE OT#(3)", r" OT# \( <n> \)", "PULSE {n}, 0.3"),
    Shape((INFORM,), "DIN B000 IN#(1)", r" <name>[ \t]+<in>", "{name} = {in}"),
    Shape((KRL,), "PULSE($OUT[1],TRUE,0.5)", r" \( \$OUT \[ <n> \] , TRUE , <s> \)", "PULSE {n}, {s}"),
    Shape((KRL,), "$OUT[3]=TRUE", rf" \[{_STATE} \] = <state>", "OUT({n}) = {state}"),
    Shape((TP,), "DO[1]=PULSE,0.5sec", rf" \[{_STATE} \] = PULSE , <s> sec", "PULSE {n}, {s}", words="DO RO"),
    Shape((TP, KAREL), "DO[1]=ON", rf" \[{_STATE} \] = \(? <state> \)?", "OUT({n}) = {state}", words="DO RO SDO DOUT"),
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
    Shape((RAPID,), "SetDO doGripper, 1;", r"[^,;]* <name> , <state>", "OUT(n) = {state}", _NUMBERED),
    Shape((RAPID,), "SetGO goType, 5;", r" <name> , <num>", "OUT(n) = {num}", _NUMBERED, "SETGO SETAO"),
    Shape((RAPID,), "PulseDO \\PLength:=0.5, do5;", r" \\PLength := <s> , <name>", "PULSE n, {s}", _NUMBERED),
    Shape(
        (UR,),
        "set_digital_out(1,True)",
        r" \( <n> , <state> \)",
        "OUT({n}) = {state}",
        words="SET_DIGITAL_OUT SET_STANDARD_DIGITAL_OUT SET_TOOL_DIGITAL_OUT",
    ),
    Shape((AS, VPLUS), "SIGNAL 1", r" <signal>", "{signal}"),
    Shape((AS, VPLUS), "SIGNAL 1,-2", r" <signal1> , <signal2>", "{signal1}\n{signal2}"),
    Shape((AS, VPLUS), "SIGNAL 1,-2,3", r" <signal1> , <signal2> , <signal3>", "{signal1}\n{signal2}\n{signal3}"),
)
# the exact forms first: the last pattern takes any condition
_WAITS = (
    Shape((KRL,), "WAIT FOR ( IN 1 'part' )", r" FOR \( IN <n> '[^']*' \)", "WAIT IN({n}) = 1"),
    Shape((KRL,), "WAIT SEC 0.5", r" SEC <s>", "DELAY {s}"),
    Shape((TP,), "WAIT 0.50(sec)", r" <s> \(? sec \)?", "DELAY {s}"),
    Shape((KAREL,), "WAIT FOR DIN[1]", r" FOR <condition>", "WAIT {condition}"),
    Shape(
        (TP,),
        "WAIT DI[1]=ON TIMEOUT,LBL[2]",
        r" <condition> TIMEOUT , LBL \[ <n> \]",
        "WAIT {condition}, TIMEOUT 30, GOTO *L{n}",
        "TIMEOUT is in s",
    ),
    Shape((INFORM,), "WAIT IN#(1)=ON T=5.0", r" <condition> T = <s>", "WAIT {condition}, TIMEOUT {s}"),
    Shape((INFORM, TP, PAC, MELFA), "WAIT IN#(1)=ON", r" <condition>", "WAIT {condition}"),
    Shape((RAPID,), "WaitTime 0.5;", r"(?: \\InPos ,)? <s>", "DELAY {s}"),
    Shape((RAPID,), "WaitDI diPart, 1;", r" <name> , <state>(?: .*)?", "WAIT IN(n) = {state}", _NUMBERED),
    Shape((RAPID,), "WaitUntil diPart=1;", r" [A-Za-z_]\w* = <state>", "WAIT IN(n) = {state}", _NUMBERED),
    Shape((RAPID,), "WaitUntil count>3;", r" <condition>", "WAIT {condition}", "a signal is IN(n)"),
    Shape((MELFA,), "Dly 0.5", r" <s>", "DELAY {s}"),
    Shape((INFORM,), "TIMER T=0.5", r" T = <s>", "DELAY {s}"),
    Shape((UR,), "sleep(0.5)", r" \( <s> \)", "DELAY {s}"),
    Shape((AS,), "TWAIT 0.5", r" <s>", "DELAY {s}"),
    Shape((AS,), "SWAIT 1003", r" <input>", "WAIT {input}"),
    Shape((AS,), "SWAIT 1003,-1004", r" <input1> , <input2>", "WAIT {input1} AND {input2}"),
)
CELL = (*_SETTINGS, *_TOOLS_AND_LOADS, *_OUTPUTS, *_WAITS)
