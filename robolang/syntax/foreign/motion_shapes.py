"""Lines that move, of other languages. Data alone."""

from robolang.syntax.foreign.entry import AS, INFORM, KAREL, KRL, MELFA, PAC, RAPID, TP, UR, VAL3, VPLUS
from robolang.syntax.foreign.shape import Shape

_CONT = "ZONE is a radius in mm, write one to blend"
_CNT = "CNT{num} is a percentage: ZONE is a radius in mm"
_PL = "PL is a level, ZONE a radius in mm"
_PCT = "SPEED of MOVEJ is a percentage, the speed of this line is none"
_SPEED = "SPEED of MOVE is in mm/s, the speed of this line is not"
_QUATERNION = "rx, ry and rz are angles in degrees, not a quaternion"
_VECTOR = "rx, ry and rz are angles in degrees, not a rotation vector"
_ARC = "an arc begins where the arm is"
_PASS = "{pass}"
_KRL_FRAME = r" \{ X <num1> , Y <num2> , Z <num3> , A <num4> , B <num5> , C <num6>(?: ,.*)? \}.*"
# A turns about Z, B about Y and C about X: the same order as here, written from the other end
_POSE = "POSE({num1}, {num2}, {num3}, {num6}, {num5}, {num4})"
_KRL_AXES = r" \{ A1 <num1> , A2 <num2> , A3 <num3> , A4 <num4> , A5 <num5> , A6 <num6>(?: ,.*)? \}.*"
_JOINTS = "MOVEJ JOINT({num1}, {num2}, {num3}, {num4}, {num5}, {num6})"
_TO_KRL = r"(?: C_\w+)?(?:[ \t].*)?"

# the pattern with a speed stands before the one without: the first that fits is taken
_KRL = (
    Shape(
        (KRL,),
        "PTP P1 CONT Vel=50 % PDAT1",
        r" <point> CONT Vel = <pct> %<more>",
        "MOVEJ {point}{pct}",
        _CONT,
        "PTP SPTP",
    ),
    Shape(
        (KRL,), "PTP HOME Vel=100 % DEFAULT", r" <point> Vel = <pct> %<more>", "MOVEJ {point}{pct}", words="PTP SPTP"
    ),
    Shape((KRL,), "PTP {A1 0, A2 -90, A3 90, A4 0, A5 0, A6 0}", _KRL_AXES, _JOINTS, words="PTP SPTP"),
    Shape((KRL,), "PTP {X 400, Y 0, Z 500, A 0, B 90, C 0}", _KRL_FRAME, f"MOVEJ {_POSE}", words="PTP SPTP"),
    Shape((KRL,), "PTP P1 C_PTP", r" <point> C_\w+(?: C_\w+)?", "MOVEJ {point}", _CONT, "PTP SPTP"),
    Shape((KRL,), "PTP XP1", r" <point><more>", "MOVEJ {point}", words="PTP SPTP"),
    Shape(
        (KRL,),
        "LIN P2 CONT Vel=0.25 m/s CPDAT1",
        r" <point> CONT Vel = <mps> m/s<more>",
        "MOVE {point}{mps}",
        _CONT,
        "LIN SLIN",
    ),
    Shape((KRL,), "LIN P2 Vel=2 m/s CPDAT1", r" <point> Vel = <mps> m/s<more>", "MOVE {point}{mps}", words="LIN SLIN"),
    Shape((KRL,), "LIN {X 400, Y 0, Z 500, A 0, B 90, C 0}", _KRL_FRAME, f"MOVE {_POSE}", words="LIN SLIN"),
    Shape((KRL,), "LIN P2 C_DIS", r" <point> C_\w+", "MOVE {point}", _CONT, "LIN SLIN"),
    Shape((KRL,), "LIN XP2", r" <point><more>", "MOVE {point}", words="LIN SLIN"),
    Shape(
        (KRL,),
        "LIN_REL {X 0, Y 0, Z 50}",
        r" \{ X <num1> , Y <num2> , Z <num3> \}.*",
        "MOVE HERE + ({num1}, {num2}, {num3})",
        words="LIN_REL SLIN_REL",
    ),
    Shape(
        (KRL,),
        "CIRC P1 P2 Vel=0.5 m/s CPDAT1",
        r" <point1>(?: ,|[ \t]) <point2> Vel = <mps> m/s<more>",
        "MOVEC {point1}, {point2}{mps}",
        words="CIRC SCIRC",
    ),
    Shape((KRL,), "CIRC P1, P2", r" <point1> , <point2><more>", "MOVEC {point1}, {point2}", words="CIRC SCIRC"),
)
# a speed of RAPID is that of the tool in mm/s, of MoveJ too, where this language needs a percentage: it is left out
_RAPID = (
    Shape((RAPID,), "MoveL p10, v1000, z50, tool0;", r" <place> , v<mms> , <zone><more>", "MOVE {place}{mms}{zone}"),
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
        r" <place> , [A-Za-z]\w* , <zone><more>",
        "MOVE {place}{zone}",
        _SPEED,
    ),
    Shape((RAPID,), "MoveL p10, v100", r" <place> , v<mms><more>", "MOVE {place}{mms}"),
    Shape((RAPID,), "MoveJ p10, v1000, z50, tool0;", r" <place> , v\w+ , <zone><more>", "MOVEJ {place}{zone}", _PCT),
    Shape(
        (RAPID,),
        "MoveJ [[600,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool1;",
        r" \[ \[ <mm> \] .* , v\w+ , <zone><more>",
        "MOVEJ POSE({mm}, rx, ry, rz){zone}",
        f"{_QUATERNION}, and {_PCT}",
    ),
    Shape((RAPID,), "MoveJ p10, v100", r" <place> , v\d+<more>", "MOVEJ {place}", _PCT),
    Shape(
        (RAPID,),
        "MoveC p20, p30, v100, z5, tool0;",
        r" <place1> , <place2> , v<mms> , <zone><more>",
        "MOVEC {place1}, {place2}{mms}{zone}",
    ),
    Shape(
        (RAPID,),
        "MoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;",
        r" \[ \[ <values> \] .* , v\w+ , <zone><more>",
        "MOVEJ JOINT({values}){zone}",
        _PCT,
    ),
    Shape(
        (RAPID,),
        "MoveAbsJ jHome, v200, fine, tool0;",
        r" <point>(?: \\\w+)? , v\w+ , <zone><more>",
        "MOVEJ {point}{zone}",
        _PCT,
    ),
)
# a distance is along the hand, and a negative one away from the work piece
_MELFA = (
    Shape((MELFA,), "Mov P1", r" <point>", "MOVEJ {point}"),
    Shape((MELFA,), "Mov P1,-50", r" <point> , <num>", "MOVEJ {point} * (0, 0, {num})"),
    Shape((MELFA,), "Mvs P1", r" <point>", "MOVE {point}"),
    Shape((MELFA,), "Mvs P1,-50", r" <point> , <away>", "APPROACH {point}, {away}"),
    Shape((MELFA,), "Mvs P1,50", r" <point> , <num>", "MOVE {point} * (0, 0, {num})"),
    Shape((MELFA,), "Mvs ,-50", r" , <away>", "DEPART {away}"),
    Shape((MELFA,), "Mvr P1,P2,P3", r" <point1> , <point2> , <point3>", "MOVEC {point2}, {point3}", _ARC),
)
# a parameter of the controller decides between mm/s and cm/min for V, so the hint says for which it holds
_INFORM = (
    Shape((INFORM,), "MOVJ C00001 VJ=50.00 PL=1", r" <point> VJ = <pct> PL = \d+<more>", "MOVEJ {point}{pct}", _PL),
    Shape((INFORM,), "MOVJ C00001 VJ=50.00", r" <point> VJ = <pct><more>", "MOVEJ {point}{pct}"),
    Shape((INFORM,), "MOVJ P001", r" <point>", "MOVEJ {point}"),
    Shape(
        (INFORM,),
        "MOVL P002 V=138.0 CR=10.0",
        r" <point> V = <mms> CR = <num><more>",
        "MOVE {point}{mms}, ZONE {num}",
        "if V is in mm/s",
    ),
    Shape(
        (INFORM,),
        "MOVL P002 V=138.0 PL=1",
        r" <point> V = <mms> PL = \d+<more>",
        "MOVE {point}{mms}",
        f"if V is in mm/s; {_PL}",
    ),
    Shape((INFORM,), "MOVL P002 V=138.0", r" <point> V = <mms><more>", "MOVE {point}{mms}", "if V is in mm/s"),
    Shape((INFORM,), "MOVL P002", r" <point>", "MOVE {point}"),
)
# CNT is no length: how far from the corner the arm turns depends on its speed
_TP = (
    Shape((TP,), "J P[1] 100% FINE", r" <point> <pct> % <fine><more>", "MOVEJ {point}{pct}{fine}"),
    Shape((TP,), "J P[1] 100% CNT50", r" <point> <pct> % CNT <num><more>", "MOVEJ {point}{pct}", _CNT),
    Shape((TP,), "L P[2] 250mm/sec FINE", r" <point> <mms> mm/sec <fine><more>", "MOVE {point}{mms}{fine}"),
    Shape((TP,), "L P[2] 250mm/sec CNT50", r" <point> <mms> mm/sec CNT <num><more>", "MOVE {point}{mms}", _CNT),
    Shape(
        (TP,),
        "C P[2] P[3] 250mm/sec FINE",
        r" <point1>[ \t,:]+<point2> <mms> mm/sec <fine><more>",
        "MOVEC {point1}, {point2}{mms}{fine}",
    ),
    Shape(
        (TP,),
        "C P[2] P[3] 250mm/sec CNT50",
        r" <point1>[ \t,:]+<point2> <mms> mm/sec CNT <num><more>",
        "MOVEC {point1}, {point2}{mms}",
        _CNT,
    ),
    Shape((KAREL,), "MOVE TO p1", r" TO <point>", "MOVEJ {point}", "MOVE where $MOTYPE is LINEAR"),
)
# lengths in m and angles in rad; a and v of movej are of joints, in rad/s, and no percentages
_UR = (
    Shape((UR,), "movej(get_inverse_kin(p1), a=1, v=1)", r" \( get_inverse_kin \( <point> \).*", "MOVEJ {point}"),
    Shape(
        (UR,),
        "movel(pose_trans(p1, p[0,0,-0.1,0,0,0]), a=1.2, v=0.25)",
        r" \( pose_trans \( <point> , p \[ <m> \] \) (?:, a = [\d.]+ )?, v = <mps>[^=]*",
        "MOVE {point} * ({m}){mps}",
    ),
    Shape(
        (UR,),
        "movej([0,-1.57,1.57,0,1.57,0], a=1.4, v=1.05)",
        r" \( \[ <rad> \].*",
        "MOVEJ JOINT({rad})",
        "angles are in degrees, SPEED and ACCEL of MOVEJ percentages",
    ),
    Shape(
        (UR,),
        "movej(p[0.4,0.1,0.3,0,3.14,0], a=1.4, v=1.05)",
        r" \( p \[ <m> \].*",
        "MOVEJ POSE({m}, rx, ry, rz)",
        _VECTOR,
    ),
    Shape(
        (UR,),
        "movel(p[0.4,0.1,0.3,0,3.14,0], a=1.2, v=0.25)",
        r" \( p \[ <m> \] (?:, a = [\d.]+ )?, v = <mps>[^=]*",
        "MOVE POSE({m}, rx, ry, rz){mps}",
        _VECTOR,
        "MOVEL MOVEP",
    ),
    Shape(
        (UR,),
        "movel(p[0.4,0.1,0.3,0,3.14,0])",
        r" \( p \[ <m> \].*",
        "MOVE POSE({m}, rx, ry, rz)",
        _VECTOR,
        "MOVEL MOVEP",
    ),
    Shape(
        (UR,),
        "movel(pick, a=1.2, v=0.25, r=0.05)",
        r" \( <point> (?:, a = [\d.]+ )?, v = <mps> , r = <radius> \)",
        "MOVE {point}{mps}{radius}",
        words="MOVEL MOVEP",
    ),
    Shape(
        (UR,),
        "movel(pick, a=1.2, v=0.25)",
        r" \( <point> (?:, a = [\d.]+ )?, v = <mps> \)",
        "MOVE {point}{mps}",
        words="MOVEL MOVEP",
    ),
    Shape(
        (UR,),
        "movej(home, a=1.4, v=1.05)",
        r" \( <point> , a = .*",
        "MOVEJ {point}",
        "SPEED and ACCEL of MOVEJ are percentages",
    ),
    Shape(
        (UR,),
        "movec(p1, p2, a=1.2, v=0.25)",
        r" \( <point1> , <point2> (?:, a = [\d.]+ )?, v = <mps>[^=]*",
        "MOVEC {point1}, {point2}{mps}",
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
    Shape((AS,), "LAPPRO p1,50", r" <point> , <num>", "APPROACH {point}, {num}"),
    Shape((AS,), "JAPPRO p1,80", r" <point> , <num>", "MOVEJ {point} * (0, 0, -{num})"),
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
    Shape((PAC,), "Move L, @E P2, S=50", r" L , (?:<pass> )?<point> , S = .*", "MOVE {point}", _SPEED),
    Shape((PAC,), "Move L, @P P2", r" L , (?:<pass> )?<point>", "MOVE {point}", _PASS),
    Shape(
        (PAC,), "Move C, P1, @P P2", r" C , <point1> , (?:<pass> )?<point2><more>", "MOVEC {point1}, {point2}", _PASS
    ),
    Shape((PAC,), "Approach L, P1, @P 50", r" L , <point> , (?:<pass> )?<num><more>", "APPROACH {point}, {num}"),
    Shape((PAC,), "Approach P, P1, @P 50", r" P , <point> , (?:<pass> )?<num><more>", "MOVEJ {point} * (0, 0, -{num})"),
    Shape((PAC,), "Depart L, @P 50", r" L , (?:<pass> )?<num><more>", "DEPART {num}"),
    Shape((PAC,), "Depart P, @P 50", r" P , (?:<pass> )?<num><more>", "MOVEJ HERE * (0, 0, -{num})"),
)
# point, tool and motion descriptor; those of URScript have names and =, so the two never fit one line
_VAL3 = (
    Shape(
        (VAL3,),
        "movel(appro(pPick,{0,0,-50,0,0,0}),tGrip,mSlow)",
        r" \( appro \( <point> , \{ <mm> \} \) , \w+ , \w+ \)",
        "MOVE {point} * ({mm})",
    ),
    Shape(
        (VAL3,),
        "movej(appro(pPick,{0,0,-50,0,0,0}),tGrip,mFast)",
        r" \( appro \( <point> , \{ <mm> \} \) , \w+ , \w+ \)",
        "MOVEJ {point} * ({mm})",
    ),
    Shape((VAL3,), "movej(jHome, tFlange, mFast)", r" \( <point> , \w+ , \w+ \)", "MOVEJ {point}"),
    Shape((VAL3,), "movel(pPick, tGripper, mSlow)", r" \( <point> , \w+ , \w+ \)", "MOVE {point}"),
    Shape(
        (VAL3,), "movec(pVia, pEnd, tTool, mNom)", r" \( <point1> , <point2> , \w+ , \w+ \)", "MOVEC {point1}, {point2}"
    ),
    Shape((VAL3,), "waitEndMove()", r" \( \)", "", "what reads or acts waits for the end of motion"),
)
MOTION = (*_KRL, *_RAPID, *_MELFA, *_INFORM, *_TP, *_UR, *_AS_AND_VPLUS, *_PAC, *_VAL3)
