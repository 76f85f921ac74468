"""Which estimates matter most, by runs."""

import math
from dataclasses import replace

import pytest

from robolang.experiments.estimate_weights import Weight, weights
from runtime.core.tomlfile import Source
from runtime.robot.files.estimate import estimate
from runtime.robot.files.importer import parse_model, with_sidecar
from runtime.robot.files.known import known_of
from runtime.robot.files.sidecar import template
from runtime.robot.files.sidecar_file import read_sidecar
from tests.runtime.robot.models import DATA, SIX


def estimated(text=SIX):
    source = Source("a.urdf", text)
    arm = parse_model(source)
    return with_sidecar(source, read_sidecar(Source("a.robot.toml", template(arm, estimate(known_of(arm)))), "a.urdf"))


@pytest.mark.physics
def test_each_kind_of_estimate_gets_a_weight_by_runs():
    spec = estimated()
    found = weights(spec)
    by_key = {weight.key: weight for weight in found}
    assert "max_speed_deg_s" not in by_key  # the file gives it
    assert len(by_key) == 11
    assert [weight.factor for weight in found] == sorted((weight.factor for weight in found), reverse=True)
    torque = by_key["max_torque_nm"]
    assert (torque.what, torque.factor) == ("torque_pct", pytest.approx(2.0, rel=0.02))
    assert by_key["motor.encoder_counts"].factor < 1.05
    assert by_key["motor.rotor_inertia_kg_m2"].factor > 1.2
    # of estimated values alone
    drives = {name: rule for name, rule in spec.estimated.items() if "coulomb" in name}
    assert [weight.key for weight in weights(replace(spec, estimated=drives))] == ["motor.coulomb_friction_nm"]


@pytest.mark.physics
def test_estimates_of_a_slide_get_weights_under_their_own_keys():
    spec = estimated((DATA / "scara.urdf").read_text().replace(' effort="330"', ""))
    keys = ("max_force_n", "motor.travel_mm_per_turn", "max_acceleration_mm_s2")
    drives = {name: rule for name, rule in spec.estimated.items() if name.endswith(keys)}
    found = {weight.key: weight for weight in weights(replace(spec, estimated=drives))}
    assert set(found) == set(keys)
    # half the travel is twice the gear, which makes the rotor four times as heavy
    assert found["motor.travel_mm_per_turn"].scale == 0.5
    assert found["max_force_n"].factor > 1.1


@pytest.mark.physics
def test_an_arm_that_cannot_make_the_move_gets_no_weights():
    spec = estimated()
    weak = [replace(axis, limits=axis.limits.replaced(torque=axis.limits.torque * 1e-3)) for axis in spec.axes]
    assert weights(replace(spec, axes=tuple(weak))) == []


def test_a_run_that_ends_with_an_alarm_weighs_most():
    weight = Weight(key="k", scale=0.5, what="torque_pct", before=40.0, after=math.inf)
    assert weight.factor == math.inf
    assert "alarm" in weight.text
