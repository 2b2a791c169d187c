#!/usr/bin/env python3
"""Runs many scenes on several meshes: how far a result is from the limit of fine meshes, and what its coarser mesh says of that."""

import json
import math
import sys

import runs

# μ and speeds of every scene. A speed is given over that of the scene: σ/√(Eρ) with the mean pressure σ.
MU = [0.35, 0.5]
SPEEDS = [0.3, 0.64, 1.4, 3.5]
# Meshes, as multiples of a scene's own counts.
LEVELS = [1, 2, 3, 4]


def scene(name, counts, pin=None, clamp=None, load=30.0, contact=None, mu=None, **more):
    return {"name": name, "counts": counts, "pin": pin or {}, "clamp": {"side": "inner_side", "width_m": 0.001, **(clamp or {})},
            "load": load, "contact": contact or {}, "mu": mu or MU, **more}


BLOCK = [12, 15, 10]
SCENES = [
    scene("reference", BLOCK),
    scene("outer", BLOCK, clamp={"side": "outer_side"}),
    scene("leading", BLOCK, clamp={"side": "leading_end"}),
    scene("wide_clamp", BLOCK, clamp={"width_m": 0.004}),
    scene("both_sides", BLOCK, clamp={"side": "both_sides", "width_m": 0.002}),
    scene("whole_top", BLOCK, clamp={"side": "whole_top"}),
    scene("free_top", BLOCK, top="free_in_z"),
    scene("gentle", BLOCK, mu=[0.15, 0.25]),
    scene("gentle_rod", [12, 12, 12], pin={"size_m": [0.010, 0.010, 0.010], "young_modulus_pa": 2.8e9, "density_kg_m3": 1410, "poisson_ratio": 0.38}, clamp={"width_m": 0.0025}, load=50.0, mu=[0.15, 0.25]),
    scene("damped", BLOCK, beta_r_s=1.0e-7),
    scene("small", [12, 16, 10], pin={"size_m": [0.006, 0.008, 0.005], "young_modulus_pa": 2.0e9, "density_kg_m3": 1200, "poisson_ratio": 0.35}, load=10.0),
    scene("tall", [8, 8, 16], pin={"size_m": [0.008, 0.008, 0.016]}, load=10.0),
    scene("flat", [20, 20, 8], pin={"size_m": [0.020, 0.020, 0.008], "young_modulus_pa": 3.0e9}, clamp={"width_m": 0.002}, load=60.0),
    scene("polymer", [12, 12, 12], pin={"size_m": [0.010, 0.010, 0.010], "young_modulus_pa": 2.8e9, "density_kg_m3": 1410, "poisson_ratio": 0.38}, clamp={"width_m": 0.0025}, load=50.0),
    scene("steel", [10, 12, 10], pin={"size_m": [0.010, 0.012, 0.010], "young_modulus_pa": 2.1e11, "density_kg_m3": 7800}, load=200.0),
    scene("static", BLOCK, contact={"law": "static_kinetic"}, static=1.25),
    scene("falling", BLOCK, contact={"law": "exponential", "speed_m_s": 0.05}, static=1.25),
    scene("regularised", BLOCK, contact={"law": "regularised", "speed_m_s": 0.005}),
    scene("cylinder", [8, 8, 10], pin={"shape": "cylinder", "diameter_m": 0.008, "size_m": [0.008, 0.008, 0.010]}, load=10.0, finest=3),
    scene("disc", [12, 12, 8], pin={"shape": "cylinder", "diameter_m": 0.015, "size_m": [0.015, 0.015, 0.010]}, clamp={"side": "trailing_end"}, load=30.0, finest=3),
    scene("holder", BLOCK, holder={"mass_kg": 0.005, "stiffness_y_n_m": 5.0e6, "damping_y_n_s_m": 20}),
    scene("plate", BLOCK, pin={"regions": [{"above_m": 0.008, "young_modulus_pa": 2.1e11, "poisson_ratio": 0.3, "density_kg_m3": 7800}]}, finest=3),
]
RADIUS_M = 0.0914


def speeds_rpm(own):
    pin = {"size_m": [0.012, 0.015, 0.010], "young_modulus_pa": 1.0e9, "density_kg_m3": 2500, **own["pin"]}
    area = math.pi / 4 * pin["diameter_m"] ** 2 if "diameter_m" in pin else pin["size_m"][0] * pin["size_m"][1]
    speed = own["load"] / area / math.sqrt(pin["young_modulus_pa"] * pin["density_kg_m3"])
    return [float(f"{share * speed / RADIUS_M * 30 / math.pi:.3g}") for share in SPEEDS]


def study(own, level, points=None):
    pin = dict(own["pin"], elements=[level * count for count in own["counts"]])
    if pin.get("shape") == "cylinder":
        pin["size_m"] = own["pin"]["size_m"]
    grid = {"omega_rpm": speeds_rpm(own)}
    contact = own["contact"]
    base = {"pin": pin, "clamp": own["clamp"], "load": {"force_n": own["load"]}, "contact": contact}
    for name in ("top", "holder"):
        if name in own:
            base[name] = own[name]
    made = {"name": f"mesh-{own['name']}-{level}", "preset": "standard", "scene": base}
    if "beta_r_s" in own:
        made["numerics"] = {"beta_r_s": own["beta_r_s"]}
    if "static" in own:
        made["samples"] = {"zip": {"mu": own["mu"], "mu_static": [own["static"] * mu for mu in own["mu"]]}}
    else:
        grid["mu"] = own["mu"]
    if points is not None:
        return dict(made, samples={"points": points})
    return dict(made, grid=grid)


def main():
    levels = [int(x) for x in sys.argv[1].split(",")]
    names = sys.argv[2:] or [own["name"] for own in SCENES]
    runs.WORK.mkdir(parents=True, exist_ok=True)
    settled = {}
    for level in levels:
        for own in SCENES:
            if own["name"] in names:
                points = settled[own["name"]] if level > 2 else None
                # The general stiffness of these pins costs three times as much.
                if points == [] or level > own.get("finest", 4):
                    continue
                rows = runs.sweep(study(own, level, points), "meshes.db", ("--threads", runs.os.environ.get("T", "2")))
                if level == 2:
                    keys = ["omega_rpm", "mu"] + ["mu_static"] * ("static" in own)
                    settled[own["name"]] = [{key: row[key] for key in keys} for row in rows
                                            if row["status"] in ("periodic", "decayed")]
                for row in rows:
                    print(json.dumps({"scene": own["name"], "level": level, **row}), flush=True)


if __name__ == "__main__":
    main()
