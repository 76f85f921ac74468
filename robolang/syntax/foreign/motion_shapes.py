"""Lines that move, of other languages. Data alone."""

from robolang.syntax.foreign.entry import AS, INFORM, KAREL, KRL, MELFA, PAC, RAPID, TP, UR, VAL3, VPLUS
from robolang.syntax.foreign.shape import Shape

_CONT = "ZONE is a radius in mm, write one to blend"
_PCT = "SPEED of MOVEJ is a percentage, the speed of this line is none"
_SPEED = "SPEED of MOVE is in mm/s, the speed of this line is not"
_QUATERNION = "rx, ry and rz are angles in degrees, not a quaternion"
_VECTOR = "rx, ry and rz are angles in degrees, not a rotation vector"
_ARC = "an arc begins where the arm is"
_PASS = "{pass}"
_LEVEL = "{level}"
_IF_MM = "if V is in mm/s"
_KRL_FRAME = r" \{ X <num1> , Y <num2> , Z <num3> , A <num4> , B <num5> , C <num6> (?:, <among> )?\}<more>"
# A turns about Z, B about Y and C about X: the same order as here, written from the other end
_POSE = "POSE({num1}, {num2}, {num3}, {num6}, {num5}, {num4})"
_KRL_AXES = r" \{ A1 <num1> , A2 <num2> , A3 <num3> , A4 <num4> , A5 <num5> , A6 <num6> (?:, <among> )?\}<more>"
_JOINTS = "MOVEJ JOINT({num1}, {num2}, {num3}, {num4}, {num5}, {num6})"
_PTP, _LIN, _CIRC = "PTP SPTP", "LIN SLIN", "CIRC SCIRC"

# the pattern with a speed stands before the one without: the first that fits is taken
_KRL = (
    Shape(
        (KRL,), "PTP P1 CONT Vel=50 % PDAT1", r" <point> CONT Vel = <pct> %<more>", "MOVEJ {point}{pct}", _CONT, _PTP
    ),
    Shape((KRL,), "PTP HOME Vel=100 % DEFAULT", r" <point> Vel = <pct> %<more>", "MOVEJ {point}{pct}", words=_PTP),
    Shape((KRL,), "PTP {A1 0, A2 -90, A3 90, A4 0, A5 0, A6 0}", _KRL_AXES, _JOINTS, words=_PTP),
    Shape((KRL,), "PTP {X 400, Y 0, Z 500, A 0, B 90, C 0}", _KRL_FRAME, f"MOVEJ {_POSE}", words=_PTP),
    Shape((KRL,), "PTP XP1:{Z -50}", r" <point> : <moved><more>", "MOVEJ {point} * {moved}", words=_PTP),
    Shape((KRL,), "PTP P1 C_PTP", r" <point> (?:CONT\b|C_\w+(?: C_\w+)?)<more>", "MOVEJ {point}", _CONT, _PTP),
    Shape((KRL,), "PTP XP1", r" <point><more>", "MOVEJ {point}", words=_PTP),
    Shape((KRL,), "PTP_REL {Z 50} #TOOL", r" <moved> #TOOL<more>", "MOVEJ HERE * {moved}", words="PTP_REL SPTP_REL"),
    Shape((KRL,), "PTP_REL {Z 50}", r" <shift>(?: #BASE)?<more>", "MOVEJ HERE + {shift}", words="PTP_REL SPTP_REL"),
    Shape(
        (KRL,),
        "LIN P2 CONT Vel=0.25 m/s CPDAT1",
        r" <point> CONT Vel = <mps> m/s<more>",
        "MOVE {point}{mps}",
        _CONT,
        _LIN,
    ),
    Shape((KRL,), "LIN P2 Vel=2 m/s CPDAT1", r" <point> Vel = <mps> m/s<more>", "MOVE {point}{mps}", words=_LIN),
    Shape((KRL,), "LIN {X 400, Y 0, Z 500, A 0, B 90, C 0}", _KRL_FRAME, f"MOVE {_POSE}", words=_LIN),
    Shape((KRL,), "LIN XP1:{Z -50}", r" <point> : <moved><more>", "MOVE {point} * {moved}", words=_LIN),
    Shape((KRL,), "LIN P2 C_DIS", r" <point> (?:CONT\b|C_\w+(?: C_\w+)?)<more>", "MOVE {point}", _CONT, _LIN),
    Shape((KRL,), "LIN XP2", r" <point><more>", "MOVE {point}", words=_LIN),
    # #TOOL first: what the other pattern takes is in the frame
    Shape((KRL,), "LIN_REL {Z 50} #TOOL", r" <moved> #TOOL<more>", "MOVE HERE * {moved}", words="LIN_REL SLIN_REL"),
    Shape(
        (KRL,),
        "LIN_REL {X 0, Y 0, Z 50}",
        r" <shift>(?: #BASE)?<more>",
        "MOVE HERE + {shift}",
        words="LIN_REL SLIN_REL",
    ),
    Shape(
        (KRL,),
        "CIRC P1 P2 Vel=0.5 m/s CPDAT1",
        r" <point1>(?: ,|[ \t]) <point2> Vel = <mps> m/s<more>",
        "MOVEC {point1}, {point2}{mps}",
        words=_CIRC,
    ),
    Shape((KRL,), "CIRC P1, P2", r" <point1> , <point2><more>", "MOVEC {point1}, {point2}", words=_CIRC),
)
# a speed of RAPID is that of the tool in mm/s, of MoveJ too, where this language needs a percentage: it is left out;
# a time stands beside a speed that it replaces
_RAPID = (
    Shape(
        (RAPID,),
        "MoveL p10, v1000\\T:=3, z50, tool0;",
        r"(?:<switch1> ,)? <place> (?:<switch2>)?, <item> \\T := <time> , <zone><more>",
        "MOVE {place}{time}{zone}",
    ),
    Shape(
        (RAPID,),
        "MoveL p10, v1000, z50, tool0;",
        r"(?:<switch1> ,)? <place> (?:<switch2>)?, v<mms> (?:<switch3>)?, <zone><more>",
        "MOVE {place}{mms}{zone}",
    ),
    Shape(
        (RAPID,),
        "MoveL [[600,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool1;",
        r" \[ \[ <mm> \] .* , v<mms> , <zone><more>",
        "MOVE POSE({mm}, rx, ry, rz){mms}{zone}",
        _QUATERNION,
    ),
    Shape(
        (RAPID,),
        "MoveL p10, vFast, z50, tool0;",
        r"(?:<switch1> ,)? <place> (?:<switch2>)?, <item> , <zone><more>",
        "MOVE {place}{zone}",
        _SPEED,
    ),
    Shape((RAPID,), "MoveL p10, v100", r" <place> , v<mms><more>", "MOVE {place}{mms}"),
    Shape(
        (RAPID,),
        "MoveJ p10, v1000\\T:=3, z50, tool0;",
        r"(?:<switch1> ,)? <place> (?:<switch2>)?, <item> \\T := <time> , <zone><more>",
        "MOVEJ {place}{time}{zone}",
    ),
    Shape(
        (RAPID,),
        "MoveJ p10, v1000, z50, tool0;",
        r"(?:<switch1> ,)? <place> (?:<switch2>)?, <item> , <zone><more>",
        "MOVEJ {place}{zone}",
        _PCT,
    ),
    Shape(
        (RAPID,),
        "MoveJ [[600,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool1;",
        r" \[ \[ <mm> \] .* , <item> , <zone><more>",
        "MOVEJ POSE({mm}, rx, ry, rz){zone}",
        f"{_QUATERNION}, and {_PCT}",
    ),
    Shape((RAPID,), "MoveJ p10, v100", r" <place> , <item>", "MOVEJ {place}", _PCT),
    Shape(
        (RAPID,),
        "MoveC p20, p30, v100, z5, tool0;",
        r"(?:<switch1> ,)? <place1> , <place2> (?:<switch2>)?, v<mms> (?:<switch3>)?, <zone><more>",
        "MOVEC {place1}, {place2}{mms}{zone}",
    ),
    Shape(
        (RAPID,),
        "MoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;",
        r" \[ \[ <values> \] .* , <item> , <zone><more>",
        "MOVEJ JOINT({values}){zone}",
        _PCT,
    ),
    Shape(
        (RAPID,),
        "MoveAbsJ jHome, v200, fine, tool0;",
        r" <point> (?:<switch1>)?, <item> , <zone><more>",
        "MOVEJ {point}{zone}",
        _PCT,
    ),
)
# a distance is along the hand, and a negative one away from the work piece
_MELFA = (
    Shape((MELFA,), "Mov P1", r" <point>(?:[ \t]+<with>)?", "MOVEJ {point}"),
    Shape((MELFA,), "Mov P1,-50", r" <point> , <num>(?:[ \t]+<with>)?", "MOVEJ {point} * (0, 0, {num})"),
    Shape((MELFA,), "Mvs P1", r" <point>(?:[ \t]+<with>)?", "MOVE {point}"),
    Shape((MELFA,), "Mvs P1,-50", r" <point> , <away>(?:[ \t]+<with>)?", "APPROACH {point}, {away}"),
    Shape((MELFA,), "Mvs P1,50", r" <point> , <num>(?:[ \t]+<with>)?", "MOVE {point} * (0, 0, {num})"),
    Shape((MELFA,), "Mvs ,-50", r" , <away>(?:[ \t]+<with>)?", "DEPART {away}"),
    Shape((MELFA,), "Mvr P1,P2,P3", r" <lost> , <point2> , <point3>", "MOVEC {point2}, {point3}", _ARC),
)
# a parameter of the controller decides between mm/s and cm/min for V, so the hint says for which it holds
_INFORM = (
    Shape(
        (INFORM,),
        "MOVJ C00001 VJ=50.00 PL=1",
        r" <point>(?: VJ = <pct>)?(?: <exact>| <level>)?<more>",
        "MOVEJ {point}{pct}{exact}",
        _LEVEL,
    ),
    Shape(
        (INFORM,),
        "MOVL P002 V=138.0 CR=10.0",
        r" <point> V = <mms> CR = <num><more>",
        "MOVE {point}{mms}, ZONE {num}",
        _IF_MM,
    ),
    Shape(
        (INFORM,),
        "MOVL P002 V=138.0 PL=1",
        r" <point> V = <mms>(?: <exact>| <level>)?<more>",
        "MOVE {point}{mms}{exact}",
        f"{_IF_MM}; {_LEVEL}",
    ),
    Shape((INFORM,), "MOVL P002", r" <point>(?: <exact>| <level>)?<more>", "MOVE {point}{exact}", _LEVEL),
)
# CNT is no length: how far from the corner the arm turns depends on its speed
_TP_END = r"(?:<fine>|<cnt>)(?: ACC <accel>)?<more>"
_TP_SPEED = r"(?:<mms> mm/sec|<cmm> cm/min|<time> sec|<rate> mm/sec|<lost>)"
_TP = (
    Shape(
        (TP,),
        "J P[1] 100% FINE",
        rf" <point> (?:<pct> %|<time> sec|<rate> %|<lost>) {_TP_END}",
        "MOVEJ {point}{pct}{time}{rate}{fine}{accel}",
        "{cnt}",
    ),
    Shape(
        (TP,),
        "L P[2] 250mm/sec CNT50",
        rf" <point> {_TP_SPEED} {_TP_END}",
        "MOVE {point}{mms}{cmm}{time}{rate}{fine}{accel}",
        "{cnt}",
    ),
    Shape(
        (TP,),
        "C P[2] P[3] 250mm/sec FINE",
        rf" <point1>[ \t,:]+<point2> {_TP_SPEED} {_TP_END}",
        "MOVEC {point1}, {point2}{mms}{cmm}{time}{rate}{fine}{accel}",
        "{cnt}",
    ),
)
_KAREL = (
    Shape((KAREL,), "MOVE TO p1", r" TO <point>", "MOVEJ {point}", "MOVE where $MOTYPE is LINEAR"),
    Shape(
        (KAREL,), "MOVE NEAR p1 BY 100", r" NEAR <point> BY <num>", "APPROACH {point}, {num}", "where $MOTYPE is LINEAR"
    ),
    Shape(
        (KAREL,),
        "MOVE RELATIVE VEC(0,0,100)",
        r" RELATIVE VEC \( <mm> \)",
        "MOVE HERE + ({mm})",
        "where $MOTYPE is LINEAR",
    ),
    Shape((KAREL,), "MOVE AWAY 50", r" AWAY <num>", "DEPART {num}", "where $MOTYPE is LINEAR"),
    Shape(
        (KAREL,),
        "WITH $SPEED=100, $MOTYPE=LINEAR MOVE TO p1",
        r" \$SPEED = <mms> , \$MOTYPE = LINEAR MOVE TO <point>",
        "MOVE {point}{mms}",
    ),
)
# lengths in m and angles in rad; a and v of movej are of joints, in rad/s, and no percentages. A time replaces a speed,
# and is 0 where there is none
_A = r"(?: , <acc>)?"
_R = r"(?: , (?:t = )?0(?:\.0*)?)?(?: , r = <radius>)? \)"
_TIMED = rf"{_A}(?: , <vel>)? , t = <time>(?: , r = <radius>)? \)"
_STRAIGHT = rf"{_A}(?: , (?:v = )?<mps>)?{_R}"
_JOINED = rf"{_A}(?: , <vel>)?{_R}"
_GOAL = r" \( (?:(?:<vector>)?<posed>|<turned>|<pose>)"
_MOVEL = "MOVEL MOVEP"
_OF_JOINTS = "SPEED and ACCEL of MOVEJ are percentages"
_UR = (
    Shape(
        (UR,),
        "movel(pick, a=1.2, v=0.25, t=3, r=0.05)",
        _GOAL + _TIMED,
        "MOVE {posed}{turned}{pose}{time}{radius}",
        "{vector}",
        _MOVEL,
    ),
    Shape(
        (UR,),
        "movel(p[0.4,0.1,0.3,0,3.14,0], a=1.2, v=0.25)",
        _GOAL + _STRAIGHT,
        "MOVE {posed}{turned}{pose}{mps}{radius}",
        "{vector}",
        _MOVEL,
    ),
    Shape(
        (UR,),
        "movel(pick, 1.2, 0.25, 0, 0.05)",
        _GOAL + r" , <acc> , <mps> , 0(?:\.0*)? , <radius> \)",
        "MOVE {posed}{turned}{pose}{mps}{radius}",
        "{vector}",
        _MOVEL,
    ),
    Shape(
        (UR,),
        "movel(pick, a=acc, v=slow)",
        _GOAL + r" , <among> \)",
        "MOVE {posed}{turned}{pose}",
        "{vector}",
        _MOVEL,
    ),
    Shape((UR,), "movej(home, t=3)", r" \( (?:<joints>|<pose>)" + _TIMED, "MOVEJ {joints}{pose}{time}{radius}"),
    Shape(
        (UR,),
        "movej([0,-1.57,1.57,0,1.57,0], a=1.4, v=1.05)",
        r" \( (?:<joints>|<pose>)" + _JOINED,
        "MOVEJ {joints}{pose}{radius}",
        _OF_JOINTS,
    ),
    Shape(
        (UR,),
        "movej(p[0.4,0.1,0.3,0,3.14,0], a=1.4, v=1.05)",
        r" \( (?:get_inverse_kin \( )?(?:(?:<vector>)?<posed>|<turned>|<pose>)(?: \))?" + _JOINED,
        "MOVEJ {posed}{turned}{pose}{radius}",
        "{vector}",
    ),
    Shape(
        (UR,),
        "movec(p1, p2, a=1.2, v=0.25)",
        rf" \( <point1> , <point2>{_STRAIGHT}",
        "MOVEC {point1}, {point2}{mps}{radius}",
    ),
)
# APPRO and JAPPRO move the joints, and APPROACH of this language does not: the distance becomes an offset
_AS_AND_VPLUS = (
    Shape(
        (AS,),
        "LMOVE SHIFT(p1 BY 0,0,50)",
        r" SHIFT \( <point> BY <mm> \)",
        "MOVE {point} + ({mm})",
        words="LMOVE MOVES",
    ),
    Shape((AS,), "JMOVE SHIFT(p1 BY 0,0,50)", r" SHIFT \( <point> BY <mm> \)", "MOVEJ {point} + ({mm})"),
    Shape((AS,), "JMOVE #p1", r" <point><more>", "MOVEJ {point}"),
    Shape((AS,), "LMOVE p2", r" <point><more>", "MOVE {point}"),
    Shape((AS,), "LAPPRO p1,50", r" <point> , <num><more>", "APPROACH {point}, {num}"),
    Shape((AS,), "JAPPRO p1,80", r" <point> , <num><more>", "MOVEJ {point} * (0, 0, -{num})"),
    Shape((AS,), "LDEPART 50", r" <num>", "DEPART {num}"),
    Shape((AS,), "JDEPART 50", r" <num>", "MOVEJ HERE * (0, 0, -{num})"),
    Shape((AS, PAC), "DRAW 0,0,50", r" <num1> , <num2> , <num3>", "MOVE HERE + ({num1}, {num2}, {num3})"),
    Shape((VPLUS,), "MOVES p1", r" <point>", "MOVE {point}"),
    Shape((VPLUS,), "APPROS p1, 50", r" <point> , <num>", "APPROACH {point}, {num}"),
    Shape((VPLUS,), "APPRO p1, 50", r" <point> , <num>", "MOVEJ {point} * (0, 0, -{num})"),
    Shape((VPLUS,), "DEPARTS 50", r" <num>", "DEPART {num}"),
)
# P after Move is the joint motion, and a point of that name would end the line here: it cannot be both
_PAC = (
    Shape((PAC,), "Move P, @P P1, S=50", r" P , (?:<pass> )?<point> , S = <pct>", "MOVEJ {point}{pct}", _PASS),
    Shape((PAC,), "Move P, @P P1", r" P , (?:<pass> )?<point><more>", "MOVEJ {point}", _PASS),
    Shape((PAC,), "Move L, @E P2, S=50", r" L , (?:<pass> )?<point> , <lost>", "MOVE {point}", f"{_PASS}; {_SPEED}"),
    Shape((PAC,), "Move L, P1 + P(0,0,50)", r" L , <point> \+ P? \( <mm> \)<more>", "MOVE {point} + ({mm})"),
    Shape((PAC,), "Move L, @P P2", r" L , (?:<pass> )?<point>", "MOVE {point}", _PASS),
    Shape(
        (PAC,), "Move C, P1, @P P2", r" C , <point1> , (?:<pass> )?<point2><more>", "MOVEC {point1}, {point2}", _PASS
    ),
    Shape((PAC,), "Approach L, P1, @P 50", r" L , <point> , (?:<pass> )?<num><more>", "APPROACH {point}, {num}", _PASS),
    Shape(
        (PAC,),
        "Approach P, P1, @P 50",
        r" P , <point> , (?:<pass> )?<num><more>",
        "MOVEJ {point} * (0, 0, -{num})",
        _PASS,
    ),
    Shape((PAC,), "Depart L, @P 50", r" L , (?:<pass> )?<num><more>", "DEPART {num}", _PASS),
    Shape((PAC,), "Depart P, @P 50", r" P , (?:<pass> )?<num><more>", "MOVEJ HERE * (0, 0, -{num})", _PASS),
)
# point, tool and motion descriptor; those of URScript have names and =, so the two never fit one line
_VAL3_END = r" , <item1> , <item2> \)"
_VAL3 = (
    Shape(
        (VAL3,),
        "movel(appro(pPick,{0,0,-50,0,0,0}),tGrip,mSlow)",
        rf" \( <appro>{_VAL3_END}",
        "MOVE {appro}",
    ),
    Shape(
        (VAL3,),
        "movej(appro(pPick,{0,0,-50,0,0,0}),tGrip,mFast)",
        rf" \( <appro>{_VAL3_END}",
        "MOVEJ {appro}",
    ),
    Shape((VAL3,), "movej(jHome, tFlange, mFast)", rf" \( <point>{_VAL3_END}", "MOVEJ {point}"),
    Shape((VAL3,), "movel(pPick, tGripper, mSlow)", rf" \( <point>{_VAL3_END}", "MOVE {point}"),
    Shape(
        (VAL3,), "movec(pVia, pEnd, tTool, mNom)", rf" \( <point1> , <point2>{_VAL3_END}", "MOVEC {point1}, {point2}"
    ),
    Shape((VAL3,), "waitEndMove()", r" \( \)", "", "what reads or acts waits for the end of motion"),
)
# VAL3 before URScript: two names without = are a tool and a descriptor
MOTION = (*_KRL, *_RAPID, *_MELFA, *_INFORM, *_TP, *_KAREL, *_VAL3, *_UR, *_AS_AND_VPLUS, *_PAC)
