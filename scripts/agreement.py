#!/usr/bin/env python3
"""Writes docs/evidence/paper.md: the program beside an independent solver, and what stopping early changes.

The independent numbers below are from a separate throw-away implementation of the same model; they
are data, everything else in the page is computed.
"""

import math

import runs

# omega_rpm: (mu*, f [Hz], shares, range of N/F), mu = 0.4; scene as in TABLE_SCENE, statistics over the last 40 % of 20 ms.
TABLE = {
    0.5: (0.383, 15780, (0.37, 0.61, 0.02), "0.88–1.11"),
    2: (0.342, 15760, (0.32, 0.66, 0.02), "0.60–1.40"),
    6: (0.285, 15520, (0.20, 0.68, 0.12), "0.14–1.90"),
    7: (0.288, 15480, (0.17, 0.68, 0.15), "0.12–1.90"),
    35: (0.365, 15480, (0.02, 0.59, 0.39), "0.11–2.50"),
    100: (0.396, 15740, (0.00, 0.58, 0.42), "0.04–2.65"),
}
STABLE_ROW = (7, 0.2, 0.200)
TIME_STEPS = {1.6e-6: 0.2900, 8e-7: 0.2854, 4e-7: 0.2837, 5.5e-8: 0.2829}
# elements: (time step [s], mu*, f [Hz]), beta_R = 5e-8 s, 10 ms
MESHES = {
    (6, 8, 5): (1.73e-6, 0.2941, 15520),
    (12, 15, 10): (8.85e-7, 0.2956, 15480),
    (18, 22, 15): (5.83e-7, 0.2947, 15560),
}
# (omega_rpm, mu*, f [Hz]) with the reference clamp, 12 x 15 x 10, ramp 0.5 ms, 10 ms
REFERENCE_CLAMP = [(6, 0.265, 15800), (12, 0.301, 15400)]

TABLE_SCENE = {
    "pin": {"elements": [6, 8, 5]},
    "clamp": {"side": "inner_side", "width_m": 0.002},
    "load": {"force_n": 30, "ramp_s": 1e-3},
}
NUMERICS = {"beta2": 0.5, "beta_r_s": 2e-8, "time_step_s": 1.75e-6}
WHOLE = {"limit_s": 0.02, "stop_early": False, "average_last_fraction": 0.4}


def study(name, grid, scene=TABLE_SCENE, numerics=NUMERICS, run=WHOLE):
    return {"name": name, "scene": scene, "numerics": numerics, "run": run, "grid": grid}


def speeds():
    grid = {"omega_rpm": list(TABLE), "mu": [0.4]}
    full = runs.sweep(study("agreement-table", grid))
    early = runs.sweep(study("agreement-early", grid, run={"limit_s": 0.02}))
    rows = []
    for row, stopped in zip(full, early):
        mu_star, frequency, shares, normal = TABLE[row["omega_rpm"]]
        found = (row["stick_share"], row["slip_share"], row["separated_share"])
        rows.append(
            [
                f"μ 0.4, {row['omega_rpm']:g} rpm",
                f"{mu_star:.3f}",
                f"{row['mu_star']:.4f}",
                f"{abs(row['mu_star'] - mu_star):.4f}",
                frequency,
                f"{row['frequency_hz']:.0f}",
                f"{100 * abs(row['frequency_hz'] / frequency - 1):.2f} %",
                " / ".join(f"{share:.2f}" for share in shares),
                " / ".join(f"{share:.2f}" for share in found),
                f"{max(abs(a - b) for a, b in zip(found, shares)):.3f}",
                normal,
                f"{row['n_over_f_min']:.2f}–{row['n_over_f_max']:.2f}",
                f"{stopped['status']}, {1e3 * stopped['simulated_s']:.1f} ms, "
                f"{stopped['mu_star'] - row['mu_star']:+.4f}",
            ]
        )
    omega, mu, mu_star = STABLE_ROW
    [row] = runs.sweep(study("agreement-stable", {"omega_rpm": [omega], "mu": [mu]}))
    rows.append([f"μ {mu}, {omega} rpm", f"{mu_star:.3f}", f"{row['mu_star']:.4f}",
                 f"{abs(row['mu_star'] - mu_star):.4f}", "decays", row["status"], "", "0 / 1 / 0",
                 " / ".join(f"{row[name]:.2f}" for name in ("stick_share", "slip_share", "separated_share")),
                 "", "1.00", f"{row['n_over_f_min']:.2f}–{row['n_over_f_max']:.2f}", ""])
    return runs.table(
        ["case", "μ*, independent", "μ*", "difference", "f [Hz], independent", "f [Hz]", "difference",
         "stick/slip/separated, independent", "shares", "largest difference", "N/F, independent", "N/F (smoothed over 2 µs)", "stopped early: Δμ*"], rows)


def time_steps():
    rows = runs.sweep(study("agreement-steps", {"time_step_s": list(TIME_STEPS), "omega_rpm": [7], "mu": [0.4]}))
    found = {row["time_step_s"]: row["mu_star"] for row in rows}
    coarse, middle, fine, finest = (found[step] for step in TIME_STEPS)
    first, second = coarse - middle, middle - fine
    limit = fine - second * second / (first - second)
    lines = [[f"{step:g}", f"{expected:.4f}", f"{found[step]:.4f}", f"{abs(found[step] - expected):.4f}"]
             for step, expected in TIME_STEPS.items()]
    return (
        runs.table(["Δt [s]", "μ*, independent", "μ*", "difference"], lines)
        + f"\nThe first three steps alone give the observed order {math.log2(first / second):.2f} and (Aitken) the limit "
        f"{limit:.4f}; the step of 5.5·10⁻⁸ s gives {finest:.4f}, first-order Richardson from the second and third "
        f"{2 * fine - middle:.4f}. The order is between one and two: nodes close and stick "
        "within a step, which is of first order, and the integrator in between is of second order.\n"
    )


def meshes():
    rows = []
    for elements, (step, mu_star, frequency) in MESHES.items():
        scene = dict(TABLE_SCENE, pin={"elements": list(elements)})
        numerics = dict(NUMERICS, beta_r_s=5e-8, time_step_s=step)
        name = "agreement-mesh-" + "x".join(map(str, elements))
        run = dict(WHOLE, limit_s=0.01)
        [row] = runs.sweep(study(name, {"omega_rpm": [7], "mu": [0.4]}, scene, numerics, run))
        rows.append([" × ".join(map(str, elements)), f"{step:g}", f"{mu_star:.4f}", f"{row['mu_star']:.4f}",
                     f"{abs(row['mu_star'] - mu_star):.4f}", frequency, f"{row['frequency_hz']:.0f}"])
    for omega, mu_star, frequency in REFERENCE_CLAMP:
        scene = {"load": {"ramp_s": 5e-4}}
        numerics = {"beta_r_s": 5e-8, "time_step_s": 8.85e-7}
        run = dict(WHOLE, limit_s=0.01)
        [row] = runs.sweep(study(f"agreement-clamp-{omega}", {"omega_rpm": [omega], "mu": [0.4]}, scene, numerics, run))
        rows.append([f"12 × 15 × 10, reference clamp, {omega} rpm", "8.85e-07", f"{mu_star:.3f}",
                     f"{row['mu_star']:.4f}", f"{abs(row['mu_star'] - mu_star):.4f}", frequency,
                     f"{row['frequency_hz']:.0f}"])
    return runs.table(["mesh", "Δt [s]", "μ*, independent", "μ*", "difference", "f [Hz], independent", "f [Hz]"], rows)


def coarse_figure7(name, run=None):
    """The points of figure7 on 12 × 15 × 10 elements."""
    study = runs.shipped("figure7", name=name, run=run or {})
    study["scene"]["pin"]["elements"] = [12, 15, 10]
    return study


def early_stop():
    early = runs.sweep(coarse_figure7("figure7-early"))
    full = runs.sweep(coarse_figure7("figure7-whole", {"limit_s": 0.02, "stop_early": False,
                                                       "average_last_fraction": 0.4}))
    changes = [(abs(a["mu_star"] - b["mu_star"]), a) for a, b in zip(early, full)
               if a["status"] in ("periodic", "decayed")]
    changes.sort(key=lambda pair: -pair[0])
    stopped = [(a, b) for a, b in zip(early, full) if a["status"] in ("periodic", "decayed")]
    simulated = sum(a["simulated_s"] for a, _ in stopped), sum(b["simulated_s"] for _, b in stopped)
    worst = [[f"{row['mu']:g}", f"{row['omega_rpm']:g}", row["status"], f"{1e3 * row['simulated_s']:.2f}",
              f"{row['mu_star']:.4f}", f"{change:.5f}"] for change, row in changes[:6]]
    median = changes[len(changes) // 2][0]
    return (
        f"The points of `figure7` on 12 × 15 × 10 elements, with its damping (β_R = 27.5 ns). Each of the {len(changes)} jobs that stopped early is compared with the mean over the last "
        f"40 % of 20 ms of the same job. The median change of μ* is {median:.5f}, the largest {changes[0][0]:.5f}. Simulated time: "
        f"{simulated[0]:.2f} s instead of {simulated[1]:.2f} s. The largest changes:\n\n"
        + runs.table(["μ", "ω [rpm]", "status", "stopped at [ms]", "μ*", "change"], worst)
    )


def main():
    runs.build()
    runs.write(
        "agreement",
        "# Agreement with an independent solver\n\n"
        "Written by `scripts/agreement.py`; do not edit. The independent values come from a separate\n"
        "implementation of the same model, which was written before this program and then thrown away. Scene: the reference\n"
        "scene with a 2 mm clamp on\n"
        "6 × 8 × 5 elements, F ramped over 1 ms, β_R = 2·10⁻⁸ s, central difference, Δt = 1.75·10⁻⁶ s, statistics over\n"
        "the last 40 % of 20 ms.\n\n"
        "## Speeds\n\n" + speeds()
        + "\nThe last column is for runs that stop at the periodic state: status, simulated time and change of μ*.\n\n"
        "At 0.5 rpm this lightly damped case does not become periodic in 20 ms: the amplitude of N beats over about\n"
        "five cycles. The program reports it as `not_periodic`, with the same averages.\n\n"
        "## Time step (7 rpm)\n\n" + time_steps()
        + "\n## Mesh (7 rpm, clamp 2 mm, β_R = 5·10⁻⁸ s, 10 ms) and the reference clamp\n\n" + meshes()
        + "\n## What stopping early changes\n\n" + early_stop(),
    )


if __name__ == "__main__":
    main()
