"""Lines of other languages as somebody types them by mistake, and the advice that is right for each.

Written by hand from the languages, before the table that gives the advice: the expected statements are what a
programmer who knows both languages would write. ``LINES`` is the figure of 60 lines; ``MORE`` has other forms of the
same words and others, to see whether the table knows more than the 60.
"""

from typing import NamedTuple


class Line(NamedTuple):
    """``text`` of a language; its one finding begins at ``at``, empty: at its end. The hint has all of ``advice``.

    A part is a statement, or a word of the sentence where no statement says it. ``never``: what would be wrong.
    """

    language: str
    text: str
    at: str
    advice: tuple[str, ...]
    never: tuple[str, ...] = ()


_KRL = (
    Line("KRL", "PTP HOME Vel=100 % DEFAULT", "PTP", ("MOVEJ HOME, SPEED 100",), ("MOVE HOME",)),
    Line("KRL", "LIN P2 CONT Vel=0.25 m/s CPDAT1 Tool[1] Base[2]", "LIN", ("MOVE P2, SPEED 250",), ("MOVEJ",)),
    Line("KRL", "$OUT[3]=TRUE", "$", ("OUT(3) = 1",)),
    Line("KRL", "WAIT SEC 0.5", "0.5", ("DELAY 0.5",)),
    Line("KRL", "IF $IN[1]==TRUE THEN", "$", ("IF IN(1) = 1 THEN",)),
    Line("KRL", "$TOOL=TOOL_DATA[1]", "$", ("TOOL tool1", "cell")),
)
_RAPID = (
    Line("RAPID", "MoveL p10, v1000, z50, tool0;", "MoveL", ("MOVE p10, SPEED 1000, ZONE 50",), ("MOVEJ",)),
    Line(
        "RAPID",
        "MoveJ [[600,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, fine, tool1;",
        "[",
        ("MOVEJ POSE(600, 0, 500, rx, ry, rz)",),
        ("SPEED 500", "JOINT("),
    ),
    Line("RAPID", "WaitTime 0.5;", "WaitTime", ("DELAY 0.5",)),
    Line("RAPID", "SetDO doGripper, 1;", "SetDO", ("OUT(n) = 1",)),
    Line("RAPID", "WaitDI diPart, 1;", "WaitDI", ("WAIT IN(n) = 1",)),
    Line("RAPID", "PROC main()", "PROC", ("remove",), ("SUB main",)),
)
_MELFA = (
    Line("MELFA", "Mov P1", "Mov", ("MOVEJ P1",), ("MOVE P1",)),
    Line("MELFA", "Mvs P1,-50", "Mvs", ("APPROACH P1, 50",), ("MOVEJ",)),
    Line("MELFA", "Dly 0.5", "Dly", ("DELAY 0.5",)),
    Line("MELFA", "M_Out(1)=1", "M_Out", ("OUT(1) = 1",)),
    Line("MELFA", "HOpen 1", "HOpen", ("HAND OFF",), ("HAND ON",)),
    Line("MELFA", "Spd 200", "Spd", ("SPEED 200",)),
)
_INFORM = (
    Line("INFORM", "MOVJ C00001 VJ=50.00", "MOVJ", ("MOVEJ C00001, SPEED 50",), ("MOVE C00001",)),
    Line("INFORM", "MOVL P002 V=138.0 PL=1", "MOVL", ("MOVE P002, SPEED 138", "PL"), ("MOVEJ", "ZONE 1")),
    Line("INFORM", "DOUT OT#(1) ON", "DOUT", ("OUT(1) = 1",)),
    Line("INFORM", "WAIT IN#(1)=ON", "#", ("WAIT IN(1) = 1",)),
    Line("INFORM", "TIMER T=0.5", "TIMER", ("DELAY 0.5",)),
    Line("INFORM", "CALL JOB:SUB1", ":", ("CALL SUB1",)),
)
_TP = (
    Line("TP", "J P[1] 100% FINE", "J", ("MOVEJ P1, SPEED 100, FINE",), ("MOVE P1",)),
    Line("TP", "L P[2] 250mm/sec CNT50", "L", ("MOVE P2, SPEED 250", "CNT50"), ("MOVEJ", "ZONE 50")),
    Line("TP", "DO[1]=ON", "DO", ("OUT(1) = 1",)),
    Line("TP", "WAIT DI[1]=ON", "[", ("WAIT IN(1) = 1",)),
    Line("TP", "JMP LBL[1]", "JMP", ("GOTO *L1",)),
    Line("TP", "UTOOL_NUM=1", "UTOOL_NUM", ("TOOL tool1",)),
)
_KAREL = (
    Line("KAREL", "-- pick the part", "-", ("' pick the part",)),
    Line("KAREL", "$SPEED = 250", "$", ("SPEED 250",)),
    Line("KAREL", "DOUT[1] = TRUE", "DOUT", ("OUT(1) = 1",)),
    Line("KAREL", "WAIT FOR DIN[1]", "FOR", ("WAIT IN(1) = 1",)),
    Line("KAREL", "WRITE('part ', n, CR)", "WRITE", ('PRINT "part "; n',)),
    Line("KAREL", "ROUTINE pick", "ROUTINE", ("SUB pick",)),
)
_URSCRIPT = (
    Line(
        "URScript",
        "movej([0,-1.57,1.57,0,1.57,0], a=1.4, v=1.05)",
        "[",
        ("MOVEJ JOINT(0, -89.954, 89.954, 0, 89.954, 0)",),
        ("SPEED 1.05", "ACCEL 1.4"),
    ),
    Line(
        "URScript",
        "movel(p[0.4,0.1,0.3,0,3.14,0], a=1.2, v=0.25)",
        "movel",
        ("MOVE POSE(400, 100, 300, rx, ry, rz), SPEED 250",),
        ("ACCEL 1.2", "MOVEJ"),
    ),
    Line("URScript", "set_digital_out(1,True)", "set_digital_out", ("OUT(1) = 1",)),
    Line("URScript", "sleep(0.5)", "sleep", ("DELAY 0.5",)),
    Line("URScript", "set_payload(1.5, [0,0,0.05])", "set_payload", ("LOAD (0, 0, 50), 1.5",)),
    Line("URScript", "def pick():", "def", ("SUB pick",)),
)
_AS = (
    Line("AS", "JMOVE #p1", "JMOVE", ("MOVEJ p1",), ("MOVE p1",)),
    Line("AS", "LMOVE p2", "LMOVE", ("MOVE p2",), ("MOVEJ",)),
    Line("AS", "LAPPRO p1,50", "LAPPRO", ("APPROACH p1, 50",)),
    Line("AS", "SIGNAL 1,-2", "SIGNAL", ("OUT(1) = 1", "OUT(2) = 0")),
    Line("AS", "TWAIT 0.5", "TWAIT", ("DELAY 0.5",)),
    Line("AS", "SPEED 50 ALWAYS", "ALWAYS", ("OVERRIDE 50",)),
)
_PACSCRIPT = (
    Line("PacScript", "Move P, @P P1", "@", ("MOVEJ P1",), ("MOVE P1",)),
    Line("PacScript", "Move L, @E P2, S=50", "@", ("MOVE P2",), ("MOVEJ", "SPEED 50")),
    Line("PacScript", "Approach L, P1, 50", "50", ("APPROACH P1, 50",)),
    Line("PacScript", "Set IO[1]", "Set", ("OUT(1) = 1",)),
    Line("PacScript", "Wait IO[1] = ON", "[", ("WAIT IN(1) = 1",)),
    Line("PacScript", "ChangeTool 1", "ChangeTool", ("TOOL tool1",)),
)
_VAL = (
    Line("VAL3", "movej(jHome, tFlange, mFast)", "(", ("MOVEJ jHome",), ("MOVE jHome",)),
    Line("VAL3", "movel(pPick, tGripper, mSlow)", "movel", ("MOVE pPick",), ("MOVEJ",)),
    Line("VAL3", "waitEndMove()", "waitEndMove", ("remove",)),
    Line("V+", "APPROS p1, 50", "APPROS", ("APPROACH p1, 50",)),
    Line("V+", "MOVES p1", "MOVES", ("MOVE p1",), ("MOVEJ",)),
    Line("V+", "DEPARTS 50", "DEPARTS", ("DEPART 50",)),
)
LINES = (*_KRL, *_RAPID, *_MELFA, *_INFORM, *_TP, *_KAREL, *_URSCRIPT, *_AS, *_PACSCRIPT, *_VAL)

MORE = (
    Line("KRL", "SPTP XP3", "SPTP", ("MOVEJ XP3",)),
    Line("KRL", "CIRC P1, P2", "CIRC", ("MOVEC P1, P2",)),
    Line("KRL", "LIN_REL {X 0, Y 0, Z 50}", "LIN_REL", ("MOVE HERE + (0, 0, 50)",)),
    Line("KRL", "FOR i=1 TO 10 STEP 1\nMOVE P1\nENDFOR", "ENDFOR", ("NEXT",)),
    Line("KRL", "WAIT FOR $IN[4]", "FOR", ("WAIT IN(4) = 1",)),
    Line("KRL", "$VEL.CP=0.2", "$", ("SPEED 200",)),
    Line("KRL", ";FOLD PTP HOME", ";", ("' FOLD PTP HOME",)),
    Line("KRL", "DEF prog( )", "DEF", ("remove",)),
    Line("RAPID", "MoveAbsJ jHome, v200, fine, tool0;", "MoveAbsJ", ("MOVEJ jHome, FINE",), ("SPEED 200",)),
    Line("RAPID", "MoveC p20, p30, v100, z5, tGripper\\WObj:=wobj1;", "v100", ("MOVEC p20, p30, SPEED 100, ZONE 5",)),
    Line("RAPID", "MoveL Offs(p10,0,0,50), v200, fine, tool0;", "MoveL", ("MOVE p10 + (0, 0, 50), SPEED 200, FINE",)),
    Line("RAPID", "Set do5;", "Set", ("OUT(n) = 1",)),
    Line("RAPID", "GripLoad load1;", "GripLoad", ("LOAD load1",)),
    Line("RAPID", "! go home", "!", ("' go home",)),
    Line("RAPID", "reg1 := reg1 + 1;", ":", ("reg1 = reg1 + 1",)),
    Line("RAPID", 'TPWrite "part " \\Num:=n;', "TPWrite", ('PRINT "part "',)),
    Line("MELFA", "Mov P1,-50", "Mov", ("MOVEJ P1 * (0, 0, -50)",)),
    Line("MELFA", "Mvr P1,P2,P3", "Mvr", ("MOVEC P2, P3",)),
    Line("MELFA", "Ovrd 50", "Ovrd", ("OVERRIDE 50",)),
    Line("MELFA", "JOvrd 50", "JOvrd", ("SPEEDJ 50",)),
    Line("MELFA", "HClose 1", "HClose", ("HAND ON",)),
    Line("MELFA", "Def Plt 1,P1,P2,P3,P4,3,4,1", "Def", ("FOR",)),
    Line("INFORM", "SET B000 5", "SET", ("B000 = 5",)),
    Line("INFORM", "MOVC P003 V=50.0", "MOVC", ("MOVEC",)),
    Line("INFORM", "JUMP *LOOP IF IN#(2)=ON", "JUMP", ("IF IN(2) = 1 THEN GOTO *LOOP",)),
    Line("INFORM", "PULSE OT#(3) T=0.5", "#", ("PULSE 3, 0.5",)),
    Line("TP", "R[1]=R[1]+1", "R", ("R1 = R1 + 1",)),
    Line("TP", "WAIT 0.50(sec)", "(", ("DELAY 0.5",)),
    Line("TP", "PAYLOAD[1]", "PAYLOAD", ("LOAD load1",)),
    Line("TP", "CALL PICK_PART;", ";", ("no ;",)),
    Line("TP", "IF DI[1]=ON,JMP LBL[2]", "[", ("IF IN(1) = 1 THEN GOTO *L2",)),
    Line("TP", "LBL[3:retry]", "LBL", ("*L3 ' retry",)),
    Line("KAREL", "ENDWHILE", "ENDWHILE", ("WEND",)),
    Line("KAREL", "SIGNAL EVENT[1]", "SIGNAL", ("there is none",)),
    Line("URScript", "movec(p1, p2, a=1.2, v=0.25)", "", ("MOVEC p1, p2, SPEED 250",)),
    Line("URScript", 'popup("ready")', "popup", ('PRINT "ready"',)),
    Line("URScript", "global x = 5", "global", ("x = 5",)),
    Line("URScript", 'textmsg("x ", x)', "textmsg", ('PRINT "x "; x',)),
    Line("AS", "SWAIT 1003", "SWAIT", ("WAIT IN(3) = 1",)),
    Line("AS", "JAPPRO p1,80", "JAPPRO", ("MOVEJ p1 * (0, 0, -80)",)),
    Line("AS", "CLOSEI", "CLOSEI", ("HAND ON",)),
    Line("AS", "DRAW 0,0,50", "DRAW", ("MOVE HERE + (0, 0, 50)",)),
    Line("PacScript", "Depart L, 50", "50", ("DEPART 50",)),
    Line("PacScript", "Reset IO[24]", "Reset", ("OUT(24) = 0",)),
    Line("PacScript", "ChangeWork 2", "ChangeWork", ("FRAME frame2",)),
    Line("PacScript", "Speed 50,50", ",", ("OVERRIDE 50",)),
    Line("VAL3", "movec(pVia, pEnd, tTool, mNom)", "", ("MOVEC pVia, pEnd",)),
    Line("VAL3", "open(tGripper)", "open", ("HAND OFF",)),
    Line("V+", "APPRO p1, 50", "APPRO", ("MOVEJ p1 * (0, 0, -50)",)),
    Line("V+", "REACT 1001, stop_it", "REACT", ("there is none",)),
)
