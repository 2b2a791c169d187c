#!/usr/bin/env python3
"""Writes docs/evidence/strains.md: does an aluminium pin whose edges yield shake down, and does that change μ*?

The speed is in proportion to the load, so that all loads have one result with small strains and without yielding. Every number in the
page is computed.
"""

import runs

LOADS = [1000, 3000, 5000, 7000, 9000]
NEWTON_PER_RPM = 500
YIELD_PA = 1.0e8
SIZE_M = [0.012, 0.015, 0.010]
MESHES = [[8, 10, 7], [12, 15, 10]]
HARDENING_PA = 1.0e9
LAWS = {
    "none": {},
    "isotropic": {"hardening_modulus_pa": HARDENING_PA},
    "kinematic": {"kinematic_modulus_pa": HARDENING_PA},
}
# The laws on each mesh, by its elements in x: the finer one takes longer.
OF_MESH = {8: ["none", "isotropic", "kinematic"], 12: ["none", "kinematic"]}
LONGER_LAWS = ["none", "kinematic"]
# The time limits of the longer runs, which do not stop when they are periodic.
LONGER_S = [0.002, 0.006]


def study(name, elements, law, loads=LOADS, **run):
    pin = {
        "size_m": SIZE_M,
        "elements": elements,
        "element": "selective",
        "young_modulus_pa": 7.0e10,
        "poisson_ratio": 0.33,
        "density_kg_m3": 2700,
    }
    if law is not None:
        pin["strains"] = "finite"
        pin["material"] = "j2"
        pin["plasticity"] = {"yield_stress_pa": YIELD_PA, **LAWS[law]}
    return {
        "name": f"yielding-{name}-{elements[0]}",
        "scene": {
            "pin": pin,
            "clamp": {"side": "inner_side", "width_m": 0.003},
            "contact": {"mu": 0.4},
        },
        "run": run,
        "samples": {"zip": {"load_n": loads, "omega_rpm": [load / NEWTON_PER_RPM for load in loads]}},
    }


def rows_of(name, elements, law, **run):
    # Jobs may fail: a mesh cannot have every strain.
    return {row["load_n"]: row for row in runs.sweep(study(name, elements, law, **run), fails=True)}


STATES = {"elastic": "elastic", "shaken_down": "shaken down", "yielding": "yields"}


def percent(value, digits=2):
    return f"{100 * value:.{digits}f} %"


def cells(row):
    """State, largest plastic strain, share of the plastic work, μ* and frequency."""
    if row["status"] == "failed":
        return ["stops"] + [""] * 4
    mark = "" if row["status"] == "periodic" else "~"
    frequency = "stable" if row["status"] == "decayed" else f"{row['frequency_hz'] / 1000:.2f}{mark}"
    return [
        STATES[row["plastic_state"]],
        percent(row["plastic_strain_max"]),
        percent(row["plastic_share"], 3),
        f"{row['mu_star']:.4f}{mark}",
        frequency,
    ]


def page():
    results = {(law, elements[0]): rows_of(law, elements, law) for elements in MESHES for law in OF_MESH[elements[0]]}
    linear = {elements[0]: rows_of("linear", elements, None) for elements in MESHES}
    longer = {
        law: [
            rows_of(f"{law}-{limit_s:g}".replace(".", "p"), MESHES[0], law, limit_s=limit_s, stop_early=False)
            for limit_s in LONGER_S
        ]
        for law in LONGER_LAWS
    }
    pressure = {load: load / (SIZE_M[0] * SIZE_M[1] * YIELD_PA) for load in LOADS}

    def table(elements):
        head = ["load (N)", "mean pressure / σ₀", "hardening", "state", "plastic strain", "share of plastic work", "μ*", "kHz"]
        lines = [
            [load, percent(pressure[load], 1), law, *cells(results[law, elements[0]][load])]
            for load in LOADS
            for law in OF_MESH[elements[0]]
        ]
        return runs.table(head, lines)

    def long_table():
        head = ["load (N)", "hardening"]
        for limit_s in LONGER_S:
            head += [f"plastic strain, {1000 * limit_s:g} ms", "share of plastic work"]
        lines = []
        for load in LOADS:
            for law in LONGER_LAWS:
                rows = [rows[load] for rows in longer[law]]
                if all(row["status"] != "failed" and row["plastic_strain_max"] > 0 for row in rows):
                    parts = [[percent(row["plastic_strain_max"]), percent(row["plastic_share"], 3)] for row in rows]
                    lines.append([load, law, *sum(parts, [])])
        return runs.table(head, lines)

    fine = MESHES[1][0]
    found = [(load, law, results[law, fine][load]) for load in LOADS for law in OF_MESH[fine]]
    of_linear = linear[fine][LOADS[0]]
    # With large strains and without yielding, each load has its own result.
    def change(load, row, name):
        return abs(row[name] / linear[fine][load][name] - 1)

    down = [(load, row) for load, law, row in found if row["plastic_state"] == "shaken_down"]
    going_on = sorted({load for load, law, row in found if row["plastic_state"] == "yielding"})
    in_words = lambda loads: " and ".join(f"{load:g}" for load in loads) + " N"
    largest = {name: max(change(load, row, name) for load, row in down) for name in ("mu_star", "frequency_hz")}
    claim = (
        f"At {in_words(sorted({load for load, row in down}))} the edges yield and shake down: next to nothing yields in the limit cycle, and μ\\* is "
        f"within {percent(largest['mu_star'])} and the frequency within {percent(largest['frequency_hz'])} of a linear pin."
    )
    without = f" At {in_words(going_on)} the pin goes on yielding on the finer mesh." if going_on else ""
    # The job that counts as periodic while it yields most.
    steady = [
        (load, law, row)
        for (law, across), rows in results.items()
        for load, row in rows.items()
        if row["status"] == "periodic" and row["plastic_state"] == "yielding" and across == MESHES[0][0] and law in LONGER_LAWS
    ]
    ratchets = ""
    for load, law, row in steady:
        after = longer[law][-1][load]
        ratchets += (
            f" At {load:g} N {'without hardening' if law == 'none' else 'with hardening: ' + law} it goes on: that job counts as periodic above, because its cycles repeat within the tolerances, and "
            f"its plastic strain grows from {percent(row['plastic_strain_max'], 1)} to {percent(after['plastic_strain_max'], 1)}. The μ\\* of such a job is a mean over its window."
        )
    differ = [
        load for load in LOADS if results["none", MESHES[0][0]][load]["plastic_state"] != results["none", fine][load]["plastic_state"]
    ]
    by_mesh = (
        f" At {in_words(differ)} the two meshes differ in their states without hardening." if differ else ""
    )
    meshes = [" × ".join(map(str, mesh)) for mesh in MESHES]
    return f"""# An aluminium pin that yields

Written by `scripts/yielding.py`; do not edit. It runs {len(LOADS) * (len(MESHES) + sum(map(len, OF_MESH.values())) + len(LONGER_LAWS) * len(LONGER_S))} jobs.

**{claim}{without}**

The pin is a block of 12 × 15 × 10 mm of soft aluminium (E = 70 GPa, ν = 0.33, 2700 kg/m³, σ₀ = {YIELD_PA / 1e6:g} MPa), clamped along 3 mm of its top, with μ = 0.4, selective elements and large strains. Hardening is none, isotropic or kinematic, with
{HARDENING_PA / 1e9:g} GPa. The speed is in proportion to the load, 1 rpm per {NEWTON_PER_RPM} N. Without yielding all loads then have nearly one result: the linear pin has μ\\* = {of_linear["mu_star"]:.4f} and {of_linear["frequency_hz"] / 1000:.2f} kHz on {meshes[1]} elements, and
{linear[MESHES[0][0]][LOADS[0]]["mu_star"]:.4f} and {linear[MESHES[0][0]][LOADS[0]]["frequency_hz"] / 1000:.2f} kHz on {meshes[0]}.

{meshes[1]} elements:

{table(MESHES[1])}
{meshes[0]} elements:

{table(MESHES[0])}
`~` is a run that is not periodic, and the numbers are averages over its last part. *Plastic strain* is the largest one of the pin at the end of the run. The *share of plastic work* is the plastic work within the averaging window over the sum of it and the work of friction there. A state is `shaken down` if that is at most 0.01 %.

## Does it go on?

Runs of {1000 * LONGER_S[0]:g} and {1000 * LONGER_S[1]:g} ms, which do not stop when they are periodic, on {meshes[0]} elements, where something has yielded:

{long_table()}
Where the plastic strain is the same in both columns, flow has ended.{ratchets}

A sharp edge has an infinite elastic stress, so the plastic strain there grows as the mesh is refined, and so does the effect of a load.{by_mesh} The load from which on the pin goes on yielding is therefore not a property of the pin alone. Heat and wear are not computed, and no measurement is compared.
"""


def main():
    runs.build()
    runs.write("yielding_pin", page())


if __name__ == "__main__":
    main()
