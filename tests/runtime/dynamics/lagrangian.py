"""The document's Lagrangian, eqs (1) to (5), written out: slow, explicit, and independent of Pinocchio.

Source: docs/dynamics.md. Works from the published geometry and body data of the robot file itself, so that it
shares nothing with the models under test but the numbers. 4x4 matrices, SI. Two forms of a robot file are read:
rows of Denavit-Hartenberg, where ``(i-1)A_i`` turns about the old z axis, and joint lines in space, where

    0A_j = E_1(q_1) ... E_j(q_j) Z_j,   E_i = turn by q_i about line i of the zero pose, Z_j = translation to origin j

(the product of exponentials). In either form ``U_ji = d(0A_j)/dq_i`` has the matrix Q of its kind in front of the
factors i to j, and ``d2(0A_j)/dq_i dq_k`` a second one. With these, the velocity terms that the document leaves out
are the Christoffel sums of the derivatives of M, taken from the same matrices without any difference quotient.
"""

import math
import tomllib
from importlib import resources

import numpy as np

Q = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]])


def robot_file(name: str = "puma560") -> dict:
    return tomllib.loads(resources.files("runtime.robot.library").joinpath(f"{name}.toml").read_text())


def published(name: str = "puma560") -> list[dict]:
    """Return the rows of [[axes]] as published (without corrections)."""
    return robot_file(name)["axes"]


def link(row: dict, theta: float) -> np.ndarray:
    """Return (i-1)Ai of standard DH."""
    a, d, alpha = row["a_m"], row["d_m"], math.radians(row["alpha_deg"])
    ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array([[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]])


def twist(row: dict) -> np.ndarray:
    """Return the 4x4 velocity of a turn about the line of an axis at the zero pose, p -> w x (p - o), or along it."""
    w = np.array(row["direction"], dtype=float)
    if row.get("kind") == "prismatic":
        along = np.zeros((4, 4))
        along[:3, 3] = w / np.linalg.norm(w)
        return along
    W = np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]]) / np.linalg.norm(w)
    out = np.zeros((4, 4))
    out[:3, :3], out[:3, 3] = W, -W @ np.array(row["origin_m"])
    return out


def turn(row: dict, theta: float) -> np.ndarray:
    """Return E = exp(twist theta) for a unit line, in closed form: I + S sin + S S (1 - cos); a slide has S S = 0."""
    S = twist(row)
    if row.get("kind") == "prismatic":
        return np.eye(4) + theta * S
    return np.eye(4) + math.sin(theta) * S + (1.0 - math.cos(theta)) * (S @ S)


def factors(rows: list[dict], q: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray]]:
    """Return per axis the moving factor, the generator in front of it, and the fixed factor behind the chain."""
    if "d_m" in rows[0]:
        return [link(r, a) for r, a in zip(rows, q, strict=True)], [Q] * len(rows), [np.eye(4)] * len(rows)
    homes = []
    for row in rows:
        home = np.eye(4)
        home[:3, 3] = row["origin_m"]
        homes.append(home)
    return [turn(r, a) for r, a in zip(rows, q, strict=True)], [twist(r) for r in rows], homes


def full_inertia(values: list[float]) -> np.ndarray:
    """Return the 3x3 matrix of xx, yy, zz and, where given, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = [*values, 0.0, 0.0, 0.0][:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def pseudo_inertia(mass: float, cog: np.ndarray, inertia_cog: np.ndarray) -> np.ndarray:
    """Return J of eq (4) with the products taken as -I_xy, where I_xy is minus the integral of x y dm."""
    origin = inertia_cog + mass * (cog @ cog * np.eye(3) - np.outer(cog, cog))
    J = np.zeros((4, 4))
    J[:3, :3] = 0.5 * np.trace(origin) * np.eye(3) - origin
    J[:3, 3] = J[3, :3] = mass * cog
    J[3, 3] = mass
    return J


def bodies(rows: list[dict], payload=None, mode: str = "add") -> list[np.ndarray]:
    """Return J_1..J_n; ``payload`` is (mass, cog) of a point mass in the frame of the last link."""
    out = [pseudo_inertia(row["mass_kg"], np.array(row["cog_m"]), full_inertia(row["inertia_kg_m2"])) for row in rows]
    if payload is not None:
        load = pseudo_inertia(payload[0], np.array(payload[1]), np.zeros((3, 3)))
        out[-1] = load if mode == "replace" else out[-1] + load
    return out


def derivatives(rows: list[dict], q: np.ndarray) -> list[list[np.ndarray]]:
    """Return U[j][i] = d(0A1...(j-1)Aj)/dtheta_i, zero for i > j (eqs 2 and 3)."""
    return [[product(rows, q, j, (i,)) for i in range(len(rows))] for j in range(len(rows))]


def second_derivatives(rows: list[dict], q: np.ndarray) -> list[list[list[np.ndarray]]]:
    """Return V[j][i][k] = d2(0Aj)/dtheta_i dtheta_k, zero for i or k > j."""
    n = len(rows)
    return [[[product(rows, q, j, (i, k)) for k in range(n)] for i in range(n)] for j in range(n)]


def product(rows: list[dict], q: np.ndarray, j: int, by: tuple[int, ...]) -> np.ndarray:
    """Return 0A_j with a generator in front of factor i for every i of ``by``."""
    if max(by) > j:
        return np.zeros((4, 4))
    moving, generators, homes = factors(rows, q)
    X = np.eye(4)
    for k in range(j + 1):
        for _ in range(by.count(k)):
            X = X @ generators[k]
        X = X @ moving[k]
    return X @ homes[j]


def mass_matrix_derivative(rows: list[dict], q: np.ndarray, payload=None, mode: str = "add") -> np.ndarray:
    """Return dM[i, k, l] = dM_ik/dtheta_l, from U and V."""
    n, J = len(rows), np.array(bodies(rows, payload, mode))
    U, V = np.array(derivatives(rows, q)), np.array(second_derivatives(rows, q))
    half = np.einsum("jklab,jbc,jiac->ikl", V, J, U)
    assert half.shape == (n, n, n)
    return half + half.transpose(1, 0, 2)


def velocity_torque(rows: list[dict], q: np.ndarray, dq: np.ndarray, payload=None, mode: str = "add") -> np.ndarray:
    """Return the centrifugal and Coriolis torques: SUM_kl c_ikl dq_k dq_l, c = (M_ik,l + M_il,k - M_kl,i) / 2."""
    dM = mass_matrix_derivative(rows, q, payload, mode)
    christoffel = 0.5 * (dM + dM.transpose(0, 2, 1) - dM.transpose(2, 0, 1))
    return np.einsum("ikl,k,l->i", christoffel, dq, dq)


def inverse_dynamics(rows, q, dq, ddq, payload=None, mode: str = "add") -> np.ndarray:
    """Return all of tau, N m: inertia, velocity terms and gravity."""
    M = mass_matrix(rows, q, payload, mode)
    return M @ ddq + velocity_torque(rows, q, dq, payload, mode) + gravity(rows, q, payload, mode)


def mass_matrix(rows: list[dict], q: np.ndarray, payload=None, mode: str = "add") -> np.ndarray:
    """Return M with M_ik = SUM_j Tr(U_jk J_j U_ji')."""
    n, U, J = len(rows), derivatives(rows, q), bodies(rows, payload, mode)
    return np.array([[sum(np.trace(U[j][k] @ J[j] @ U[j][i].T) for j in range(n)) for k in range(n)] for i in range(n)])


def gravity(rows: list[dict], q: np.ndarray, payload=None, mode: str = "add") -> np.ndarray:
    """Return T_i = - SUM_j m_j g U_ji jr_j."""
    g = np.array([0.0, 0.0, -9.81, 0.0])
    n, U, J = len(rows), derivatives(rows, q), bodies(rows, payload, mode)
    return np.array([-sum(g @ U[j][i] @ J[j][:, 3] for j in range(n)) for i in range(n)])


def geometric(rows: list[dict], q: np.ndarray, payload=None, mode: str = "add") -> tuple[np.ndarray, np.ndarray]:
    """Return (D_i, T_i) by the cheap geometric forms of docs/dynamics.md, about each joint axis in world."""
    n, J = len(rows), bodies(rows, payload, mode)
    frames = [np.eye(4)]
    for row, angle in zip(rows, q, strict=True):
        frames.append(frames[-1] @ link(row, angle))
    D, T = np.zeros(n), np.zeros(n)
    for i in range(n):
        z, o = frames[i][:3, 2], frames[i][:3, 3]
        for j in range(i, n):
            mass = J[j][3, 3]
            R, p = frames[j + 1][:3, :3], frames[j + 1][:3, 3]
            second = J[j][:3, :3]
            inertia_origin = np.trace(second) * np.eye(3) - second
            cog = J[j][:3, 3] / mass if mass else np.zeros(3)
            inertia = R @ (inertia_origin - mass * (cog @ cog * np.eye(3) - np.outer(cog, cog))) @ R.T
            lever = np.cross(z, R @ cog + p - o)
            D[i] += z @ inertia @ z + mass * lever @ lever
            T[i] -= mass * lever @ np.array([0.0, 0.0, -9.81])
    return D, T
