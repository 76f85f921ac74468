"""Experiments A4 and A5 of docs/measured.md on one rigid axis with an ideal current loop."""

import math

import numpy as np
import pytest

from runtime.servo.servo_law import LEAD_S, Gains, ServoLaw

SMALLEST, LARGEST = 2.341, 9.680
MIDDLE = 0.5 * (SMALLEST + LARGEST)
KP, KV, KTN = 20.0, 80.0, 14.0


def step_response(
    D_model, D_true, *, tick_s=5e-4, Kf=0.0, Ka=0.0, source="command", T_model=0.0, T_true=0.0, size=0.1, seconds=1.5
):
    """Return alpha at every tick of a step; the arm between ticks is integrated exactly (constant torque)."""
    one = np.ones(1)
    gains = Gains(Kp=KP * one, Kv=KV * one, Ktn=KTN * one, rotor=0.0 * one, Kf=Kf, Ka=Ka, source=source)
    law = ServoLaw(gains, np.zeros(1), tick_s)
    law.update(np.array([D_model]), np.array([T_model]))
    theta, zero = np.array([[size]]), np.zeros((1, 1))
    law.command(theta, zero, zero)
    q, dq, out = 0.0, 0.0, []
    for _ in range(round(seconds / tick_s)):
        current = float(law.current(0, np.array([q]))[0])
        ddq = (KTN * current - T_true) / D_true
        q, dq = q + dq * tick_s + 0.5 * ddq * tick_s**2, dq + ddq * tick_s
        out.append(q)
        if not abs(q) < 1e3:
            break
    return np.array(out)


def overshoot(alpha, size=0.1):
    return float(np.maximum(0.0, alpha.max() / size - 1.0))


def settling(alpha, tick_s=5e-4, size=0.1):
    outside = np.flatnonzero(~(np.abs(alpha - size) <= 0.02 * size))
    return (outside[-1] + 1) * tick_s


@pytest.mark.parametrize("D", [SMALLEST, MIDDLE, LARGEST])
def test_scheduled_gain_answers_alike_at_every_inertia(D):
    alpha = step_response(D, D)
    assert overshoot(alpha) < 0.001
    assert settling(alpha) == pytest.approx(0.147, abs=0.0015)


def test_gain_fixed_for_the_smallest_inertia_swings_at_the_largest():
    alpha = step_response(SMALLEST, LARGEST)
    assert overshoot(alpha) == pytest.approx(0.17, abs=0.005)
    assert settling(alpha) == pytest.approx(0.41, abs=0.01)
    assert 0.5 * math.sqrt(KV / KP * SMALLEST / LARGEST) == pytest.approx(0.49, abs=0.005)


def test_gain_fixed_for_the_middle_inertia_still_swings():
    assert overshoot(step_response(MIDDLE, LARGEST)) == pytest.approx(0.017, abs=0.003)


def test_gain_fixed_for_the_largest_inertia_is_slow_at_the_smallest():
    alpha = step_response(LARGEST, SMALLEST)
    assert overshoot(alpha) < 0.001
    assert settling(alpha) == pytest.approx(0.186, abs=0.002)


def test_gain_fixed_for_the_largest_inertia_diverges_at_an_8_ms_servo():
    assert KV * LARGEST / SMALLEST * 8e-3 == pytest.approx(2.65, abs=0.01)
    assert np.abs(step_response(LARGEST, SMALLEST, tick_s=8e-3)).max() > 100.0
    scheduled = step_response(SMALLEST, SMALLEST, tick_s=8e-3)
    assert settling(scheduled, tick_s=8e-3) == pytest.approx(0.160, abs=0.008)


@pytest.mark.parametrize(("Kf", "expected"), [(0.3, 0.044), (0.6, 0.255), (0.9, 0.74)])
def test_measured_velocity_feed_forward_takes_damping_away(Kf, expected):
    alpha = step_response(SMALLEST, SMALLEST, Kf=Kf, source="measured")
    assert overshoot(alpha) == pytest.approx(expected, abs=0.02)


def test_measured_velocity_feed_forward_of_one_never_settles():
    alpha = step_response(SMALLEST, SMALLEST, Kf=1.0, source="measured", seconds=4.0)
    assert np.ptp(alpha[-1000:]) > 0.19


def test_measured_acceleration_feed_forward_of_one_is_unstable():
    assert np.abs(step_response(SMALLEST, SMALLEST, Ka=1.05, source="measured")).max() > 10.0


@pytest.mark.parametrize("miss", [7.0, -3.0])
def test_gravity_droop_follows_the_formula(miss):
    alpha = step_response(SMALLEST, SMALLEST, T_model=30.0, T_true=30.0 + miss, seconds=3.0)
    assert 0.1 - alpha[-1] == pytest.approx(miss / (KV * KP * SMALLEST), rel=0.01)


def test_a_command_in_motion_is_followed_without_lag_by_commanded_feed_forward():
    """With Kf = Ka = 1, exact D and rest at the start, only the half-tick of the speed estimate is left."""
    one, tick_s = np.ones(1), 5e-4
    law = ServoLaw(Gains(Kp=KP * one, Kv=KV * one, Ktn=KTN * one, rotor=0.0 * one), np.zeros(1), tick_s)
    law.update(np.array([LARGEST]), np.zeros(1))
    q, dq, worst = 0.0, 0.0, 0.0
    for k in range(4000):
        t = k * tick_s
        theta, beta, gamma = 0.1 * (1 - math.cos(3 * t)), 0.3 * math.sin(3 * t), 0.9 * math.cos(3 * t)
        worst = max(worst, abs(theta - q))
        law.command(np.array([[theta]]), np.array([[beta]]), np.array([[gamma]]))
        current = float(law.current(0, np.array([q]))[0])
        ddq = KTN * current / LARGEST
        q, dq = q + dq * tick_s + 0.5 * ddq * tick_s**2, dq + ddq * tick_s
    assert worst < 2e-5


@pytest.mark.parametrize("source", ["command", "measured"])
def test_the_law_broadcasts_over_leading_dimensions_and_equals_the_printed_equations(source):
    n, runs, tick_s = 6, 5, 1e-3
    rng = np.random.default_rng(3)
    g = Gains(
        Kp=np.full(n, KP),
        Kv=np.full(n, KV),
        Ktn=np.full(n, KTN),
        rotor=rng.uniform(0, 1, n),
        Kf=0.4,
        Ka=0.3,
        K2=0.9,
        Kc=5000.0,
        KT_scale=1.1,
        source=source,
    )
    alpha0, alpha1, D, T = (rng.normal(size=(runs, n)) for _ in range(4))
    theta, beta_cmd, gamma_cmd = (rng.normal(size=(runs, n)) for _ in range(3))
    law = ServoLaw(g, alpha0, tick_s)
    law.update(D, T)
    law.command(theta[None], beta_cmd[None], gamma_cmd[None])
    beta = (alpha1 - alpha0) / tick_s
    beta_ff, gamma = (beta, beta / tick_s) if source == "measured" else (beta_cmd, gamma_cmd)
    omega = KP * (theta + gamma * D * g.K2 / g.Kc - alpha1)  # (6), 410, (7)
    domega = omega + beta_ff * g.Kf - beta  # (8), 416
    D_total = D + g.rotor
    expected = KV / KTN * D_total * domega + gamma * g.Ka * D_total / KTN + T * 1.1 / KTN  # (9), (10), (11)
    np.testing.assert_allclose(law.current(0, alpha1), expected, rtol=1e-12)


def test_gains_held_fixed_replace_the_inertia_in_the_loop_only():
    one = np.ones(1)
    law = ServoLaw(Gains(Kp=KP * one, Kv=KV * one, Ktn=KTN * one, rotor=0.5 * one), np.zeros(1), 1e-3)
    law.update(np.array([3.0]), np.array([14.0]), D_control=np.array([2.0]))
    law.command(np.full((1, 1), 0.1), np.zeros((1, 1)), np.zeros((1, 1)))
    assert float(law.current(0, np.zeros(1))[0]) == pytest.approx(KV / KTN * 2.5 * KP * 0.1 + 14.0 / KTN)


@pytest.mark.parametrize("source", ["command", "measured"])
def test_whole_rows_take_the_place_of_the_diagonal(source):
    n, runs, tick_s = 4, 3, 1e-3
    rng = np.random.default_rng(4)
    g = Gains(
        Kp=np.full(n, KP),
        Kv=np.full(n, KV),
        Ktn=rng.uniform(5, 15, n),
        rotor=rng.uniform(0, 1, n),
        Kf=0.4,
        Ka=0.3,
        K2=0.9,
        Kc=np.full(n, 5000.0),
        source=source,
    )
    half = rng.normal(size=(runs, n, n))
    M = half @ np.swapaxes(half, -1, -2)
    alpha0, alpha1, theta, beta_cmd, gamma_cmd = (rng.normal(size=(runs, n)) for _ in range(5))
    law = ServoLaw(g, alpha0, tick_s)
    law.update(np.einsum("rii->ri", M), np.zeros((runs, n)), rows=M)
    law.command(theta[None], beta_cmd[None], gamma_cmd[None])
    beta = (alpha1 - alpha0) / tick_s
    beta_ff, gamma = (beta, beta / tick_s) if source == "measured" else (beta_cmd, gamma_cmd)
    total = M + np.diag(g.rotor)
    domega = KP * (theta + np.einsum("rik,rk->ri", M, gamma) * 0.9 / 5000.0 - alpha1) + 0.4 * beta_ff - beta
    expected = np.einsum("rik,rk->ri", total, KV * domega + 0.3 * gamma) / g.Ktn
    np.testing.assert_allclose(law.current(0, alpha1), expected, rtol=1e-10)


def test_the_lead_for_the_weight_is_there_at_once_and_follows_a_new_load_slowly():
    """T KG / Kc: no step when the law starts, and 1 - exp(-t / LEAD_S) of the way after a LOAD, tick by tick."""
    n, ticks, tick_s = 3, 8, 1e-3
    one, zero = np.ones(n), np.zeros((ticks, n))
    law = ServoLaw(
        Gains(Kp=KP * one, Kv=KV * one, Ktn=KTN * one, rotor=0.0 * one, KG=0.5, Kc=np.array([1e4, 2e4, np.inf])),
        np.zeros(n),
        tick_s,
    )
    T = np.array([100.0, -100.0, 100.0])
    law.update(one, T)
    law.command(zero, zero, zero)
    assert np.allclose(law.reference, [0.005, -0.0025, 0.0], atol=0, rtol=1e-12)
    law.update(one, 3.0 * T)
    seen = []
    for _ in range(20):
        law.command(zero, zero, zero)
        seen.append(law.reference)
    lead = np.concatenate(seen)[:, 0]
    at = np.arange(0, len(lead), ticks)
    assert lead[at] == pytest.approx(0.015 - 0.01 * np.exp(-at * tick_s / LEAD_S), rel=1e-12)
    assert np.abs(np.diff(lead)).max() < 1.01 * 0.01 * (1.0 - math.exp(-8 * tick_s / LEAD_S)) / ticks
    assert not np.concatenate(seen)[:, 2].any()


def test_one_arm_through_rows_gives_what_many_give():
    """The product of one posture and that of leading dimensions are two code paths."""
    rng, n, ticks = np.random.default_rng(8), 4, 3
    rows = rng.normal(size=(n, n))
    rows = rows @ rows.T + n * np.eye(n)
    motion, alpha = rng.normal(size=(3, ticks, n)), rng.normal(size=(ticks, n))
    found = []
    for lead in ((), (2,)):

        def wide(x, lead=lead):
            return np.broadcast_to(x, (*lead, *x.shape)).copy()

        one = np.ones(n)
        law = ServoLaw(Gains(Kp=KP * one, Kv=KV * one, Ktn=KTN * one, rotor=one), wide(alpha[0]), 1e-3)
        law.update(wide(np.diag(rows)), wide(one), rows=wide(rows))
        law.command(*(np.broadcast_to(m[:, None], (ticks, 2, n)) if lead else m for m in motion))
        found.append(np.array([law.current(k, wide(alpha[k])).copy() for k in range(ticks)]))
    assert np.allclose(found[1], found[0][:, None], rtol=1e-12)
