#!/usr/bin/env python3
"""A second solver of the reference scene, written from the equations alone: a block of trilinear hexahedra on a rigid disk.

    second.py < CASES        CASES is a JSON list; prints a list of results in JSON
    second.py --check PROGRAM
                             solves three cases with both, and ends with 1 if μ* or the frequency are further apart than their windows allow

It shares nothing with the program but the equations of docs/evidence/theory.md: lumped mass M, stiffness K by 2 × 2 × 2 Gauss points, damping
β_R K, central differences, Lagrange multipliers for contact with Coulomb's law, which are diagonal on a rigid disk. The top face is a plane
that moves in z and carries the load; a strip along its inner side is held in x and y. It is slow and short on purpose. Needs numpy.

A case has elements, clamp_width_m, mu, omega_rpm, time_step_s, limit_s, ramp_s and beta_r_s; sizes, material and load are those of the paper.
"""

import json
import subprocess
import sys

import numpy as np

SIZE_M = (0.012, 0.015, 0.010)
YOUNG_PA, POISSON, DENSITY = 1.0e9, 0.3, 2500.0
RADIUS_M, LOAD_N = 0.0914, 30.0
# The part of a run over which figures are averaged.
LAST = 0.4

CORNERS = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def element_stiffness(edges):
    """The stiffness of a box, 24 × 24, with the components of a corner next to each other."""
    first, second = YOUNG_PA * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG_PA / (2 * (1 + POISSON))
    law = np.diag([2 * second] * 3 + [second] * 3)
    law[:3, :3] += first
    stiffness = np.zeros((24, 24))
    half = np.array(edges) / 2
    for point in (2 * CORNERS - 1) / np.sqrt(3):
        signs = 2 * CORNERS - 1
        factors = 1 + signs * point
        # The derivatives of the shape functions Π (1 + s ξ)/2 with respect to x, y and z.
        slopes = np.stack([signs[:, a] * factors[:, (a + 1) % 3] * factors[:, (a + 2) % 3] / 8 / half[a] for a in range(3)], axis=1)
        strain = np.zeros((6, 8, 3))
        for a in range(3):
            strain[a, :, a] = slopes[:, a]
        for row, (a, b) in zip((3, 4, 5), ((0, 1), (1, 2), (2, 0))):
            strain[row, :, a], strain[row, :, b] = slopes[:, b], slopes[:, a]
        strain = strain.reshape(6, 24)
        stiffness += strain.T @ law @ strain * np.prod(half)
    return stiffness


def solve(case):
    counts = np.array(case["elements"])
    edges = np.array(SIZE_M) / counts
    own = element_stiffness(edges)
    shape = tuple(counts + 1)
    # The slice of the grid that has one corner of every element.
    views = [tuple(slice(c, c + n) for c, n in zip(corner, counts)) for corner in CORNERS]

    def internal(u):
        corners = np.concatenate([u[view] for view in views], axis=-1)
        parts = corners @ own
        force = np.zeros_like(u)
        for index, view in enumerate(views):
            force[view] += parts[..., 3 * index : 3 * index + 3]
        return force

    mass = np.zeros(shape)
    for view in views:
        mass[view] += DENSITY * np.prod(edges) / 8
    x = np.linspace(-SIZE_M[0] / 2, SIZE_M[0] / 2, shape[0])[:, None]
    y = np.linspace(-SIZE_M[1] / 2, SIZE_M[1] / 2, shape[1])[None, :]
    omega = case["omega_rpm"] * np.pi / 30
    surface = np.stack(np.broadcast_arrays(-omega * y, omega * (RADIUS_M + x)), axis=-1)
    held = np.linspace(0, SIZE_M[0], shape[0]) <= case["clamp_width_m"] * (1 + 1e-9)
    step, damping, mu = case["time_step_s"], case["beta_r_s"], case["mu"]
    base, top = mass[:, :, 0], mass[:, :, -1]

    u, v = np.zeros((*shape, 3)), np.zeros((*shape, 3))
    count = round(case["limit_s"] / step)
    begin = round((1 - LAST) * count)
    normal, tangential, states = np.zeros(count), np.zeros(count), np.zeros(3)
    for n in range(count):
        force = -internal(u + damping * v)
        # The reaction in y at the clamp, in the direction in which the pin is held back.
        tangential[n] = force[held, :, -1, 1].sum()
        load = LOAD_N * min(n * step / case["ramp_s"], 1.0)
        acceleration = force / mass[..., None]
        acceleration[held, :, -1, :2] = 0.0
        acceleration[:, :, -1, 2] = (force[:, :, -1, 2].sum() - load) / top.sum()
        v += step * acceleration
        # The multipliers bring the nodes of the base onto the disk and, if friction suffices, along with it.
        depth = -(u[:, :, 0, 2] + step * v[:, :, 0, 2])
        pressing = np.maximum(base * depth / step**2, 0.0)
        friction = base[..., None] * (surface - v[:, :, 0, :2]) / step
        size = np.linalg.norm(friction, axis=-1)
        slips = size > mu * pressing
        friction *= np.where(slips, mu * pressing / np.where(size > 0, size, 1.0), 1.0)[..., None]
        v[:, :, 0, 2] += step * pressing / base
        v[:, :, 0, :2] += step * friction / base[..., None]
        u += step * v
        normal[n] = pressing.sum()
        if n >= begin:
            touches = pressing > 0
            states += [(touches & ~slips).sum(), (touches & slips).sum(), (~touches).sum()]
    window = normal[begin:]
    spectrum = np.abs(np.fft.rfft((window - window.mean()) * np.hanning(len(window))))
    line = int(spectrum[1:].argmax()) + 1
    low, middle, high = np.log(spectrum[line - 1 : line + 2])
    frequency = (line + 0.5 * (low - high) / (low - 2 * middle + high)) / (len(window) * step)
    # Whole cycles, so that the part of a cycle that is left does not move the mean.
    cycles = int(len(window) * step * frequency)
    whole = round(cycles / (frequency * step)) or len(window)
    return {
        "mu_star": float(tangential[count - whole :].mean() / LOAD_N),
        "frequency_hz": float(frequency),
        "shares": [float(share) for share in states / states.sum()],
        "n_over_f": [float(window.min() / LOAD_N), float(window.max() / LOAD_N)],
    }


# The scene of the cases below: the reference scene with a clamp of 2 mm.
COARSE = {"elements": [6, 8, 5], "clamp_width_m": 0.002, "mu": 0.4, "time_step_s": 1.75e-6, "limit_s": 0.02, "ramp_s": 1e-3, "beta_r_s": 2e-8}


def with_program(program, case):
    """The record of the program for a case."""
    study = {
        "name": "second",
        "scene": {"pin": {"elements": case["elements"]}, "clamp": {"side": "inner_side", "width_m": case["clamp_width_m"]}, "load": {"force_n": LOAD_N, "ramp_s": case["ramp_s"]}},
        "numerics": {"beta2": 0.5, "beta_r_s": case["beta_r_s"], "time_step_s": case["time_step_s"]},
        "run": {"limit_s": case["limit_s"], "stop_early": False, "average_last_fraction": LAST},
        "grid": {"mu": [case["mu"]], "omega_rpm": [case["omega_rpm"]]},
    }
    done = subprocess.run([program, "solve", "-", "--set", f"mu={case['mu']}", "--set", f"omega_rpm={case['omega_rpm']}", "--json"], input=json.dumps(study), stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def check(program):
    wrong = False
    for omega in (2, 7, 35):
        case = {**COARSE, "omega_rpm": omega}
        here, there = solve(case), with_program(program, case)
        window_s = LAST * case["limit_s"]
        # Both average the same motion over whole cycles. Their windows may differ by a step at each end, in which T is at most μ times the largest N.
        allowed = 2 * case["mu"] * here["n_over_f"][1] * case["time_step_s"] / window_s
        # A tenth of a line of the spectrum, which a parabola through three lines finds.
        allowed_hz = 0.1 / window_s
        agrees = abs(here["mu_star"] - there["mu_star"]) <= allowed and abs(here["frequency_hz"] - there["frequency_hz"]) <= allowed_hz
        wrong |= not agrees
        print(f"{omega:3} rpm: μ* {here['mu_star']:.5f} and {there['mu_star']:.5f} (within {allowed:.5f}), f {here['frequency_hz']:.1f} and {there['frequency_hz']:.1f} Hz (within {allowed_hz:.1f}): {'agree' if agrees else 'DIFFER'}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--check"]:
        check(sys.argv[2])
    print(json.dumps([solve(case) for case in json.load(sys.stdin)]))
