#!/usr/bin/env python3
"""Writes docs/evidence/strains.md: where large strains matter for a rubber pin.

The pin is computed with small and with finite strains over the load. The speed is in proportion to the load, so that all loads have one
result with small strains. Every number in the page is computed.
"""

import runs

LOADS = [2, 5, 10, 20, 35, 50]
MODULUS_PA = 3.6e6
SIDE_M = 0.010
MESHES = [[8, 8, 6], [12, 12, 9]]
FORMS = [("small", None), ("finite", "neo_hookean"), ("finite", "st_venant_kirchhoff")]


def study(elements, strains, law):
    pin = {
        "size_m": [SIDE_M, SIDE_M, 0.008],
        "elements": elements,
        "element": "selective",
        "strains": strains,
        "young_modulus_pa": MODULUS_PA,
        "poisson_ratio": 0.49,
        "density_kg_m3": 1100,
    }
    if law:
        pin["material"] = law
    return {
        "name": "-".join(["rubber", str(elements[0]), law or strains]).replace("_", "-"),
        "scene": {
            "pin": pin,
            "clamp": {"side": "inner_side", "width_m": SIDE_M / 4},
            "contact": {"mu": 0.4},
            "load": {"ramp_s": 0.01},
        },
        "damping": {"loss_factor": 0.05, "frequency_hz": 2000},
        "numerics": {"safety_factor": 0.5},
        "run": {"limit_s": 0.15},
        "detection": {"decay_observation_s": 0.05},
        "samples": {"zip": {"load_n": LOADS, "omega_rpm": LOADS}},
    }


def cells(row):
    """μ* and the frequency of a job."""
    if row["status"] == "failed":
        return ["stops", ""]
    return [f"{row['mu_star']:.4f}", "stable" if row["status"] == "decayed" else f"{row['frequency_hz']:.0f}"]


def rows_of(elements, form):
    # Jobs may fail: a mesh cannot have every strain.
    return {row["load_n"]: row for row in runs.sweep(study(elements, *form), fails=True)}


def page():
    coarse, fine = [[rows_of(elements, form) for form in FORMS] for elements in MESHES]
    strain = {load: load / (SIDE_M**2 * MODULUS_PA) for load in LOADS}

    def table(results):
        head = ["load (N)", "mean strain", "μ*, small", "Hz", "μ*, neo-Hookean", "Hz", "μ*, St Venant–Kirchhoff", "Hz"]
        lines = [
            [load, f"{strain[load]:.1%}".replace("%", " %")] + sum((cells(form[load]) for form in results), [])
            for load in LOADS
        ]
        return runs.table(head, lines)

    def change(results, load, name):
        small, neo, _ = (form[load] for form in results)
        return neo[name] / small[name] - 1

    def largest(results):
        """The highest load at which the neo-Hookean pin squeals."""
        return max(load for load in LOADS if results[1][load]["status"] == "periodic")

    top = largest(fine)
    stable = [load for load in LOADS if fine[1][load]["status"] == "decayed" and load > top]
    ends = (
        f"At {stable[0]} N ({strain[stable[0]]:.0%}) it does not squeal any more, although the linear pin still does."
        if stable
        else f"It squeals up to the highest load, {top} N."
    ).replace("%", " %")
    if stable:
        ends_how = (
            f" The runs begin at rest. Whether the pin could go on squealing at {stable[0]} N, if it squealed before, was not looked at."
        )
    else:
        ends_how = ""
    elements = [" × ".join(map(str, mesh)) for mesh in MESHES]
    return f"""# Large strains: a rubber pin

Written by `scripts/strains.py`; do not edit. It runs {len(LOADS) * len(FORMS) * len(MESHES)} jobs.

**A pin of rubber squeals {change(fine, LOADS[0], "frequency_hz"):.1%} higher than the linear model says at {strain[LOADS[0]]:.1%} of mean strain, and {change(fine, top, "frequency_hz"):.1%} higher at {strain[top]:.1%}. {ends}**

The pin is a block of {SIDE_M * 1e3:g} × {SIDE_M * 1e3:g} × 8 mm of rubber of 60 Shore A (E = {MODULUS_PA / 1e6:g} MPa, ν = 0.49, 1100 kg/m³, loss factor 0.05 at 2 kHz), clamped along a quarter of its top, with μ = 0.4 and
selective elements. The speed is in proportion to the load, 1 rpm per newton. With small strains the equations then have one solution for all loads ([studies.md](../study.md#warnings)), and the columns `small` show it. What the other columns have beside it is due to large strains.

{elements[1]} elements:

{table(fine)}
{elements[0]} elements:

{table(coarse)}
The neo-Hookean law is that of rubber. It stiffens under compression, so that the frequency rises with the load, in proportion to it at first. μ\\* moves by {max(abs(change(fine, load, "mu_star")) for load in LOADS if load <= top):.1%} at most, as long as the pin squeals.{ends_how} The St Venant–Kirchhoff law softens under
compression, and changes the frequency in the other direction: it is a law for large rotations, and not for rubber under a load. Where it says `stops`, an element is inverted or the deformation has outgrown the time step.

The two meshes differ by {abs(coarse[0][LOADS[0]]["frequency_hz"] / fine[0][LOADS[0]]["frequency_hz"] - 1):.1%} in the frequency of the linear pin. The program knows no mesh error for large strains, and none is measured here beyond this comparison. No measurement of a rubber pin is compared.
""".replace("%", " %").replace("  %", " %")


def main():
    runs.build()
    runs.write("large_strains", page())


if __name__ == "__main__":
    main()
