"""The keys that a sidecar still lacks, in one short line: keys that the same axes lack are named together.

A template of seven axes lacks about a hundred values; listed axis by axis they were a line of 2,400 characters.
"""

from collections.abc import Mapping, Sequence


def listed(lacking: Mapping[str, Sequence[int]], n: int) -> str:
    """Return ``every axis: max_acceleration_deg_s2, all of [axes.motor]; J6: max_torque_nm``.

    ``lacking`` has the axes (0-based, of ``n``) by key.
    """
    # grouped by the axes: most keys are lacked by all of them, a few by one
    by_axes: dict[tuple[int, ...], list[str]] = {}
    for key, axes in lacking.items():
        if axes:
            by_axes.setdefault(tuple(axes), []).append(key)
    return "; ".join(f"{_axes(axes, n)}: {', '.join(keys)}" for axes, keys in by_axes.items())


def whole(keys: Sequence[str], tables: Mapping[str, Sequence[str]]) -> list[str]:
    """Return keys with those of each table that is missing as a whole in one entry."""
    left = list(keys)
    for name, inside in tables.items():
        if inside and set(inside) <= set(left):  # at the place of its first key, so that the order of the file stays
            left[left.index(inside[0])] = f"all of [{name}]"
            left = [key for key in left if key not in inside]
    return left


def _axes(axes: Sequence[int], n: int) -> str:
    """Return axes (0-based, rising) as ``J1 to J3, J6``, all ``n`` of them as ``every axis``."""
    if len(axes) == n:
        return "every axis"
    runs: list[list[int]] = []
    for axis in axes:
        if runs and axis == runs[-1][-1] + 1:
            runs[-1].append(axis)
        else:
            runs.append([axis])
    return ", ".join(f"J{run[0] + 1}" if len(run) == 1 else f"J{run[0] + 1} to J{run[-1] + 1}" for run in runs)
