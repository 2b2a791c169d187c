#!/usr/bin/env python3
"""Writes docs/evidence/rig.md: the rig of Allgaier, Gaul, Keiper and Willner, by eigenvalues and in time.

Takes some 15 minutes. The words describe this rig; every number of the program is computed.
"""

import cmath
import csv
import math

import runs

STUDY = "rig"
# What an independent assembly with quadratic elements gives, with its source in words (scripts/peers/lagrange.py).
QUADRATIC = runs.json.loads((runs.ROOT / "scripts/peers/converged.json").read_text())["known"]["rig"]
REFERENCE_HZ = 2215
MU = 0.152
# Largest element of the disk under the track and elsewhere [m], and elements over the length of the beam.
MESHES = [(0.0105, 0.021, 18), (0.0084, 0.018, 20), (0.0063, 0.014, 28), (0.0058, 0.013, 30)]
# The same for a beam with more elements across.
FINE_BEAM = (0.0084, 0.018, 20)
ACROSS = 4
THRESHOLD_MESH = MESHES[1]
# Meshes of elements that bend, and the μ of their lock-in.
BENDING = [MESHES[0], MESHES[1], MESHES[3]]
LOCK_IN_MUS = [0.09, 0.1, 0.105, 0.11]
MUS = [0.01, 0.05, 0.075, 0.1, MU, 0.2, 0.3]
# Modes of this range are those of the squeal [Hz].
RANGE_HZ = (1500, 3000)


def scene(fine_m, coarse_m, along, across=2, element="full"):
    found = runs.shipped(STUDY)["scene"]
    found["pin"].update(elements=[across, across, along], element=element)
    found["disk"]["ring"]["element"] = element
    found["disk"]["ring"].update(element_size_m=fine_m, coarse_element_size_m=coarse_m)
    return found


def squeal(mesh, mus, across=2, element="full"):
    """The mode of the squeal that grows fastest, by μ, and the number of nodes."""
    name = f"rig_{round(1e5 * mesh[0])}_{len(mus)}_{across}_{element}"
    path = runs.WORK / f"{name}.json"
    path.write_text(runs.json.dumps(runs.shipped(STUDY, name=name, scene=scene(*mesh, across, element), grid={"mu": mus})))
    out = runs.WORK / name
    runs.tribosweep("stability", str(path), "--out", str(out))
    with (out / "modes.csv").open() as lines:
        rows = list(csv.DictReader(lines))
    found = {}
    for mu in mus:
        modes = [(float(row["growth_rate_per_s"]), float(row["frequency_hz"])) for row in rows
                 if float(row["mu"]) == mu and RANGE_HZ[0] < float(row["frequency_hz"]) < RANGE_HZ[1]]
        found[mu] = max(modes, default=None)
    forecast = runs.json.loads(runs.tribosweep("validate", str(path), "--json"))
    mesh = forecast["groups"][0]
    return found, mesh["nodes"] + mesh["disk_nodes"]


def amplitude(history, frequency_hz, from_s, to_s):
    """The amplitude [N] of the normal force at a frequency, with a Hann window."""
    pairs = [(t, n) for t, n in zip(history["time_s"], history["normal_n"]) if from_s <= t < to_s]
    mean = sum(n for _, n in pairs) / len(pairs)
    weights = [1 - math.cos(2 * math.pi * (t - from_s) / (to_s - from_s)) for t, _ in pairs]
    total = sum(w * (n - mean) * cmath.exp(-2j * math.pi * frequency_hz * t) for w, (t, n) in zip(weights, pairs))
    return 2 * abs(total) / sum(weights)


def strongest(history, from_s, to_s):
    """The strongest line [Hz] of the normal force in the range of the squeal."""
    return max(range(*RANGE_HZ, 10), key=lambda frequency: amplitude(history, frequency, from_s, to_s))


def main():
    runs.build()
    meshes = [(mesh, *squeal(mesh, [MU])) for mesh in MESHES]
    mesh_rows = [[f"{1000 * mesh[0]:g}", mesh[2], nodes, f"{found[MU][1]:.0f}", f"{found[MU][0]:.0f}"]
                 for mesh, found, nodes in meshes]
    last_hz = meshes[-1][1][MU][1]
    two_hz = next(found[MU][1] for mesh, found, _ in meshes if mesh == FINE_BEAM)
    fine_beam_hz = squeal(FINE_BEAM, [MU], ACROSS)[0][MU][1]
    by_mu, _ = squeal(THRESHOLD_MESH, MUS)
    mu_rows = [[f"{mu:g}", f"{mode[1]:.0f}", f"{mode[0]:.0f}"] if mode and mode[0] > 1 else [f"{mu:g}", "", "no growth"]
               for mu, mode in by_mu.items()]
    stable = max(mu for mu, mode in by_mu.items() if not mode or mode[0] <= 1)
    growing = min(mu for mu, mode in by_mu.items() if mode and mode[0] > 1)
    rows = runs.sweep(f"studies/{STUDY}.json")
    time_rows = [[f"{row['mu']:g}", f"{row['mu_star']:.3f}", f"{row['n_over_f_min']:.2f} … {row['n_over_f_max']:.2f}",
                  f"{100 * row['separated_share']:.0f}"] for row in rows]
    history = runs.history(f"studies/{STUDY}.json", mu=MU)
    spans = [(0.002, 0.005), (0.005, 0.008)]
    line_hz = strongest(history, *spans[1])
    growth_per_s = math.log(amplitude(history, line_hz, *spans[1]) / amplitude(history, line_hz, *spans[0])) / 0.003
    full_hz = strongest(history, 0.02, 0.04)
    own, _ = squeal((0.008, 0.016, 24), [MU])
    bending = [(mesh, *squeal(mesh, [MU], element="incompatible")) for mesh in BENDING]
    bending_rows = [[f"{1000 * mesh[0]:g}", mesh[2], nodes, f"{found[MU][1]:.0f}", f"{found[MU][0]:.0f}"] for mesh, found, nodes in bending]
    locking, _ = squeal(THRESHOLD_MESH, LOCK_IN_MUS, element="incompatible")
    growths = [(mu, locking[mu][0] if locking[mu] else 0.0) for mu in LOCK_IN_MUS]
    runs.write("rig", page(locals()))


def converged(found):
    """The table of the quadratic elements, and what they say about the meshes of this program; `found` are its modes by mesh."""
    levels = QUADRATIC["levels"]
    rows = [[level["unknowns"], f"{level['frequency_hz']:.0f}", f"{level['growth_per_s']:.0f}"] for level in levels]
    growths, finest_hz = [level["growth_per_s"] for level in levels], levels[-1]["frequency_hz"]
    low, high = QUADRATIC["lock_in_mu"]
    growth, hz = found
    return (
        f"**These growth rates are not converged.** At μ = {QUADRATIC['mu']}, {QUADRATIC['source']}, gives:\n\n"
        + runs.table(["unknowns", "frequency [Hz]", "growth rate [1/s]"], rows)
        + f"\nSo the last mesh above is {100 * (hz / finest_hz - 1):.1f} % too high in frequency, and its growth rate is "
        f"{growth / max(growths):.1f} to {growth / min(growths):.1f} times too large. A line contact\nhas no compliance that does not depend on the mesh, so the "
        "growth rate of the quadratic elements still falls slowly, too; their\nfrequency does not. "
        f"They lock in between μ = {low:g} and {high:g}. With trilinear elements on a mesh like that of 8.4 mm the same assembly gives\n"
        "2442 to 2464 Hz and 775 to 782 1/s, as this program does: it is the elements, not the program.\n\n"
    )


def with_bending(rows, growths):
    """What incompatible elements give on the same meshes; `growths` are pairs of μ and growth rate."""
    levels = QUADRATIC["levels"]
    low, high = QUADRATIC["lock_in_mu"]
    text = ", ".join(f"{max(growth, 0.0):.0f} 1/s at {mu:g}" for mu, growth in growths)
    return (
        "## With elements that bend\n\n"
        "The same with `\"element\": \"incompatible\"` in pin and disk, at the same cost:\n\n"
        + runs.table(["disk elements [mm]", "beam elements", "nodes", "frequency [Hz]", "growth rate [1/s]"], rows)
        + f"\nThe quadratic elements have {levels[-1]['frequency_hz']:.0f} Hz, and {levels[-1]['growth_per_s']:.0f} to {levels[0]['growth_per_s']:.0f} 1/s. "
        f"Over μ, on the mesh with {1000 * THRESHOLD_MESH[0]:g} mm, the largest growth rate is\n{text}; the quadratic ones lock in between {low:g} and {high:g}.\n\n"
    )


def page(made):
    """The page from the variables of `main`."""
    meshes, mesh_rows, last_hz, fine_beam_hz, two_hz = (made[name] for name in ("meshes", "mesh_rows", "last_hz", "fine_beam_hz", "two_hz"))
    mu_rows, stable, growing, time_rows, line_hz = (made[name] for name in ("mu_rows", "stable", "growing", "time_rows", "line_hz"))
    growth_per_s, own, full_hz = (made[name] for name in ("growth_per_s", "own", "full_hz"))
    low, high = QUADRATIC["lock_in_mu"]
    return (
        "# A rig that squeals\n\n"
        "Written by `scripts/rig.py`; do not edit. The rig is that of Allgaier, Gaul, Keiper and Willner (1999): an aluminium beam of\n"
        "10 × 10 × 149 mm is pressed on an aluminium disk of 358 mm diameter, which is held at its bore. The beam is tilted by 4°, so that\n"
        "only its leading edge touches, at a radius of 162 mm. μ is 0.152. A commercial program has it among its verification cases, with\n"
        f"an unstable mode at {REFERENCE_HZ} Hz. The third diametral mode of the disk and the second bending of the beam lock in.\n\n"
        "`studies/rig.json` has this scene. There the far end of the beam is fixed and pushed by 0.1 mm. Here a load of 100 N acts on a holder\n"
        "of 10 kg, which hardly moves at the frequency of the squeal. Modes do not depend on that load, because the same nodes touch.\n\n"
        "## Its eigenvalues\n\n"
        "`tribosweep stability` at μ = 0.152, on four meshes:\n\n"
        + runs.table(["disk elements [mm]", "beam elements", "nodes", "frequency [Hz]", "growth rate [1/s]"], mesh_rows)
        + f"\nThe frequency falls with refinement; on the last mesh it is {100 * (last_hz / REFERENCE_HZ - 1):.0f} % above the reference. The beam has 2 × 2 elements\n"
        f"across, which bend too stiffly. With {ACROSS} × {ACROSS} elements across and {FINE_BEAM[2]} along, and the disk's elements of {1000 * FINE_BEAM[0]:g} mm, the frequency is\n"
        f"{fine_beam_hz:.0f} instead of {two_hz:.0f} Hz. The reference has elements of its own, a fixed end and another contact, and its own mesh error is not known.\n\n"
        + converged(meshes[-1][1][MU])
        + f"Over μ, on the mesh with {1000 * THRESHOLD_MESH[0]:g} mm:\n\n"
        + runs.table(["μ", "frequency [Hz]", "growth rate [1/s]"], mu_rows)
        + f"\nTwo modes lock in between μ = {stable:g} and {growing:g}. There is no damping in this rig, so that it squeals from there on.\n"
        f"Quadratic elements lock in at a larger μ, between {low:g} and {high:g}: lock-in needs two modes that meet, so it feels the error of both.\n"
        "With a tilt of −4° the trailing edge touches. Then nothing grows at μ = 0.152; a test has this\n"
        "(`tests/verification/rig.rs`).\n\n"
        + with_bending(made["bending_rows"], made["growths"])
        + "## In time\n\n"
        "`tribosweep run studies/rig.json` simulates 40 ms from rest, on elements of 8 mm:\n\n"
        + runs.table(["μ", "μ\\*", "N/F", "separated [% of node-time]"], time_rows)
        + f"\nAt μ = {MU} the normal force grows at {line_hz} Hz by {growth_per_s:.0f} 1/s between 2 and 8 ms. The eigenvalue on this mesh has\n"
        f"{own[MU][1]:.0f} Hz and {own[MU][0]:.0f} 1/s; a window of 3 ms tells lines apart that differ by some 300 Hz. Then the edge lifts\n"
        f"off and hits the disk again. After that the strongest line is at {full_hz} Hz, with half of that frequency beside it, and the\n"
        "motion is not periodic. What is said of the growth rates above holds for this run, too: it has the same elements.\n"
    )


if __name__ == "__main__":
    main()
