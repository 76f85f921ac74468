"""The document's Lagrangian, eqs (1) to (5), written out: slow, explicit, and independent of Pinocchio.

Source: docs/dynamics.md. Works from the published DH rows and body data of the robot file itself, so that it
shares nothing with the models under test but the numbers. 4x4 matrices, SI.
"""

import math
import tomllib
from importlib import resources

import numpy as np

Q = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]])


def published(name: str = "puma560") -> list[dict]:
    """Return the rows of [[axes]] as published (without corrections)."""
    text = resources.files("runtime.robot.library").joinpath(f"{name}.toml").read_text()
    return tomllib.loads(text)["axes"]


def link(row: dict, theta: float) -> np.ndarray:
    """Return (i-1)Ai of standard DH."""
    a, d, alpha = row["a_m"], row["d_m"], math.radians(row["alpha_deg"])
    ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array([[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]])


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
    out = [
        pseudo_inertia(row["mass_kg"], np.array(row["cog_m"]), np.diag(row["inertia_kg_m2"])) for row in rows
    ]
    if payload is not None:
        load = pseudo_inertia(payload[0], np.array(payload[1]), np.zeros((3, 3)))
        out[-1] = load if mode == "replace" else out[-1] + load
    return out


def derivatives(rows: list[dict], q: np.ndarray) -> list[list[np.ndarray]]:
    """Return U[j][i] = d(0A1...(j-1)Aj)/dtheta_i, zero for i > j (eqs 2 and 3)."""
    n = len(rows)
    A = [link(row, angle) for row, angle in zip(rows, q, strict=True)]
    U = [[np.zeros((4, 4)) for _ in range(n)] for _ in range(n)]
    for j in range(n):
        for i in range(j + 1):
            X = np.eye(4)
            for k in range(j + 1):
                X = X @ (Q @ A[k] if k == i else A[k])
            U[j][i] = X
    return U


def mass_matrix(rows: list[dict], q: np.ndarray, payload=None, mode: str = "add") -> np.ndarray:
    """Return M with M_ik = SUM_j Tr(U_jk J_j U_ji')."""
    n, U, J = len(rows), derivatives(rows, q), bodies(rows, payload, mode)
    return np.array(
        [[sum(np.trace(U[j][k] @ J[j] @ U[j][i].T) for j in range(n)) for k in range(n)] for i in range(n)]
    )


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
