#!/usr/bin/env python3
"""How far results are from the limit of fine meshes on many scenes, and what the run on the coarser mesh says of that.

`run` solves the scenes on several meshes and keeps the results in docs/evidence/mesh_errors.csv. It takes hours, so it is not a part of other
runs. `run LEVEL ... --scenes NAME ...` adds some of them; the level `draft` has the mesh 1 with the settings of that preset, and the
level `1%` asks for an accuracy. `modes` and `sliding` fill mode_errors.csv and sliding_errors.csv. `again NUMBER` solves one scene again on two meshes, and ends with 3 if a result is not the kept one.

Without arguments it writes docs/evidence/mesh_errors.md and src/application/study/presets.json from the kept results. `--check` says whether they are up to
date.
"""

import argparse
import csv
import json
import math
import random
import re
import subprocess
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

def drawn_scenes(kind, seed, count):
    draw = random.Random(seed)
    made = []
    for number in range(count):
        height = round(draw.uniform(0.006, 0.014), 3)
        counts = [draw.randint(10, 14), draw.randint(10, 14), 10]
        size = [round(height / 10 * count, 6) for count in counts]
        young = float(f"{math.exp(draw.uniform(math.log(1.0e9), math.log(2.0e11))):.2g}")
        pin = {"size_m": size, "young_modulus_pa": young, "density_kg_m3": round(draw.uniform(1200, 7800), -2),
               "poisson_ratio": round(draw.uniform(0.2, 0.38), 2)}
        side = draw.choice(["inner_side", "outer_side", "leading_end", "trailing_end", "both_sides"])
        # A whole number of elements of mesh 1, so that no mesh has more elements for the sake of the clamp.
        clamp = {"side": side, "width_m": round(draw.randint(1, 4) * height / 10, 6)}
        # A tenth of a thousandth of E: the strain of the reference scene is 1.7 times as large.
        load = float(f"{1.0e-4 * young * size[0] * size[1] * draw.uniform(0.3, 3):.2g}")
        contact = draw.choice([{}, {}, {"law": "exponential", "speed_m_s": 0.05}])
        mu = sorted(round(draw.uniform(0.3, 0.55), 2) for _ in range(2))
        more = {"static": 1.25} if contact else {}
        # The same damping ratio as in the reference scene at the same wave number.
        slow = math.sqrt(1.0e9 / 2500) / math.sqrt(young / pin["density_kg_m3"]) * size[2] / 0.010
        made.append(scene(f"{kind}_{number}", None, pin=pin, clamp=clamp, load=load, contact=contact, mu=mu,
                          beta_r_s=float(f"{2.75e-8 * slow:.3g}"), **more))
    return made


# Scenes drawn at random. The share in the bounds was raised after the first draw and again after five scenes of the second one, so that
# only the rest and the third draw took no part in the choice.
FIRST_DRAW, SECOND_DRAW, THIRD_DRAW = drawn_scenes("drawn", 41, 11), drawn_scenes("second", 2, 8), drawn_scenes("third", 3, 12)
SECOND_CHOSEN = SECOND_DRAW[:5]
# A scene of the third draw may have the same μ twice, which no study can have.
THIRD_STUDIES = [own for own in THIRD_DRAW if own["mu"][0] != own["mu"][1]]
PROOF = SECOND_DRAW[5:] + THIRD_STUDIES
DRAWN = FIRST_DRAW + SECOND_CHOSEN
# The shares of before.
EARLIER_SHARES = [0.023, 0.03]
STEADY = ("periodic", "decayed")
FIGURE7 = "figure7"
DATA = runs.ROOT / "docs/evidence/mesh_errors.csv"
MODES = runs.ROOT / "docs/evidence/mode_errors.csv"
COLUMNS = ["scene", "level", "omega_rpm", "mu", "mu_static", "elements_x", "elements_y", "elements_z", "status", "regime", "mu_star",
           "mu_star_se", "frequency_hz", "stick_share", "slip_share", "separated_share", "decided_by", "time_step_s", "steps",
           "start_simulated_s", "wall_s", "mesh_elements_x", "mesh_elements_y", "mesh_elements_z", "mu_star_mesh_error", "accuracy_reached", "mesh_error_unknown", "solver_version"]
# These columns are those of the program.
EXPORTED = COLUMNS[2:-1]

# Scenes for which the share in the bounds of modes was chosen.
MODES_CHOSEN = ["reference", "steel"]
# Modes of a point that are kept.
MODES_KEPT = 6
MODE_COLUMNS = ["scene", "level", "omega_rpm", "mu", "mode", "frequency_hz", "growth_rate_per_s", "converged"]

# Scenes drawn for steady sliding, and their meshes as multiples of the coarsest one, by its elements along the larger side of the face.
SLIDING = runs.ROOT / "docs/evidence/sliding_errors.csv"
SLIDING_SCENES = 60
SLIDING_LEVELS = {1: [1, 2, 3, 10], 2: [1, 2, 5], 3: [1, 2, 4], 4: [1, 2, 3]}
# A scene whose finest mesh takes longer is left out.
SLIDING_LIMIT_S = 40
SLIDING_COLUMNS = ["scene", "level", "omega_rpm", "mu", "shape", "law", "radius_over_length", "elements_x", "elements_y", "elements_z", "contact_nodes", "lifted_nodes", "mu_star",
                   "mu_star_mesh_error", "solver_version"]


def speeds_rpm(own):
    pin = {"size_m": [0.012, 0.015, 0.010], "young_modulus_pa": 1.0e9, "density_kg_m3": 2500, **own["pin"]}
    area = math.pi / 4 * pin["diameter_m"] ** 2 if "diameter_m" in pin else pin["size_m"][0] * pin["size_m"][1]
    speed = own["load"] / area / math.sqrt(pin["young_modulus_pa"] * pin["density_kg_m3"])
    return [float(f"{share * speed / RADIUS_M * 30 / math.pi:.3g}") for share in SPEEDS]


def study(own, level, points=None):
    pin = dict(own["pin"])
    base = {"pin": pin, "clamp": own["clamp"], "load": {"force_n": own["load"]}, "contact": own["contact"]}
    for name in ("top", "holder"):
        if name in own:
            base[name] = own[name]
    made = {"name": f"mesh-{own['name']}-{level.strip('%')}", "preset": "draft" if level == "draft" else "standard", "scene": base}
    if level == "1%":
        made["accuracy"] = {"mu_star": 0.01}
    else:
        pin["elements"] = [multiple(level) * count for count in own["counts"]]
    if "beta_r_s" in own:
        made["numerics"] = {"beta_r_s": own["beta_r_s"]}
    if points is not None:
        return dict(made, samples={"points": points})
    grid = {"omega_rpm": speeds_rpm(own)}
    if "static" in own:
        made["samples"] = {"zip": {"mu": own["mu"], "mu_static": [own["static"] * mu for mu in own["mu"]]}}
    else:
        grid["mu"] = own["mu"]
    return dict(made, grid=grid)


def multiple(level):
    """The elements of a level in each direction over those of the coarsest mesh."""
    return 1 if level == "draft" else int(level)


def rows_of(own, level, settled, database="meshes.db"):
    """The results of a scene on a level."""
    made = study(own, level, settled)
    rows = runs.sweep(made, database, ("--threads", runs.os.environ.get("T", "2")))
    return kept_rows(own["name"], level, rows)


def kept_rows(name, level, rows):
    version = runs.evidence.solver_version()
    return [{"scene": name, "level": level, **{column: row[column] for column in EXPORTED}, "solver_version": version} for row in rows]


def figure7_rows():
    """The jobs of figure7 with 1 % asked."""
    study = runs.shipped("figure7", name="mesh-figure7", accuracy={"mu_star": 0.01})
    study["scene"]["pin"].pop("elements", None)
    rows = runs.sweep(study, "meshes.db")
    return kept_rows(FIGURE7, "1%", rows)


def coarsest(rows, name):
    """The elements of mesh 1 of a drawn scene, which the program chose."""
    row = next(row for row in rows if row["scene"] == name and row["level"] == "1%")
    return [int(row[f"elements_{axis}"]) // 4 for axis in "xyz"]


def is_on_finest(row):
    """Whether a job that asks for an accuracy ended on its finest mesh, which is mesh 4."""
    return all(row[f"mesh_elements_{axis}"] == row[f"elements_{axis}"] for axis in "xyz")


def points_of(rows, level):
    """The points of a scene that have a steady state on a level: finer meshes cost too much for the others."""
    keys = ["omega_rpm", "mu", "mu_static"]
    settled = [row for row in rows if row["level"] == level and row["status"] in STEADY]
    return [{key: float(row[key]) for key in keys if row[key] not in ("", None)} for row in settled]


def run(levels, names):
    runs.WORK.mkdir(parents=True, exist_ok=True)
    if FIGURE7 in names:
        write([row for row in read() if row["scene"] != FIGURE7] + figure7_rows())
    for level in levels:
        for own in SCENES + DRAWN + PROOF:
            if names and own["name"] not in names:
                continue
            is_proof = own not in SCENES
            if (level == "1%") != is_proof and level not in ("3", "4") and not (is_proof and level == "2") or level == "4" and own.get("finest", 4) < 4:
                continue
            kept = read()
            if is_proof and level != "1%":
                own = dict(own, counts=coarsest(kept, own["name"]))
            of_scene = [row for row in kept if row["scene"] == own["name"]]
            if is_proof and level == "4":
                # The others have this mesh already, and the error of steady sliding is known from mesh 3.
                of_scene = [row for row in of_scene if row["status"] == "periodic" and not is_on_finest(row)]
            settled = points_of(of_scene, "1%" if is_proof else "2") if level in ("3", "4") else None
            if settled == []:
                continue
            new = rows_of(own, level, settled)
            kept = [row for row in kept if (row["scene"], row["level"]) != (own["name"], level)]
            write(kept + new)


def again(number):
    """Solves a scene again on meshes 1 and 2. Ends with `DIFFERS` if a result is not the kept one."""
    database = runs.empty_database("again.db")
    own, columns = SCENES[number % len(SCENES)], ["status", "regime", "mu_star", "frequency_hz"]
    differ = 0
    for level in ("1", "2"):
        found = {(str(row["mu"]), str(row["omega_rpm"])): row for row in rows_of(own, level, None, database)}
        kept = [row for row in read() if (row["scene"], row["level"]) == (own["name"], level)]
        if len(kept) != len(found):
            sys.exit(f"{own['name']}, mesh {level}: {len(found)} results, and {len(kept)} are kept")
        for row in kept:
            now = found[row["mu"], row["omega_rpm"]]
            texts = {name: "" if now[name] is None else str(now[name]) for name in columns}
            where = f"{own['name']}, mesh {level}, mu = {row['mu']}, {row['omega_rpm']} rpm"
            differ += runs.differences(where, {name: row[name] for name in columns}, texts)
        print(f"{own['name']}, mesh {level}: {len(kept)} results compared")
    runs.end_again("mesh_errors", number % len(SCENES), len(SCENES), differ)


def run_modes(levels, names):
    """The leading modes of the scenes at all points of the grid."""
    runs.WORK.mkdir(parents=True, exist_ok=True)
    for level in levels:
        for own in SCENES:
            # Pins that are no plain blocks have too many unknowns on fine meshes.
            if names and own["name"] not in names or multiple(level) > (4 if own.get("finest", 4) == 4 else 2):
                continue
            made = study(own, level)
            made.update(name=made["name"] + "-modes", run={"start": "rest"})
            path = runs.WORK / "modes.json"
            path.write_text(json.dumps(made))
            table = runs.WORK / "modes.csv"
            runs.tribosweep("stability", str(path), "--no-thresholds", "--modes", str(MODES_KEPT), "--csv", str(table), "--out",
                            str(runs.WORK / "modes"), "--threads", runs.os.environ.get("T", "2"), database="modes.db")
            new = [{"scene": own["name"], "level": level, **{name: row[name] for name in MODE_COLUMNS[2:]}} for row in read(table)]
            kept = [row for row in read(MODES) if (row["scene"], row["level"]) != (own["name"], level)]
            write(kept + new, MODES, MODE_COLUMNS)


def sliding_studies():
    """Studies of steady sliding at one point each on several meshes: pins from flat to slender on tracks from narrow to wide, drawn at random."""
    draw = random.Random(5)
    made = []
    for number in range(SLIDING_SCENES):
        is_cylinder = draw.random() < 0.2
        y = draw.choice([0.003, 0.005, 0.010, 0.020])
        x = y if is_cylinder else y * draw.choice([0.5, 1, 1, 2, 3])
        z = y * draw.choice([0.4, 1, 2, 4])
        radius = max(0.6 * x, y * draw.choice([0.7, 1, 2, 4, 10, 20]))
        # The same number of elements along x and y in a cylinder, and an even one for its core.
        along = 4 if is_cylinder else draw.choice([1, 2, 3, 4])
        size = max(x, y) / along
        counts = [along, along] if is_cylinder else [max(1, round(x / size)), max(1, round(y / size))]
        counts.append(max(1, min(3, round(z / size))))
        side = draw.choice(["whole_top", "collet", "leading_end"] if is_cylinder else ["whole_top", "collet", "leading_end", "inner_side", "outer_side", "both_sides"])
        law = draw.choice(["coulomb", "coulomb", "exponential", "regularised"])
        mu, speed = draw.choice([0.1, 0.3, 0.5, 0.8]), draw.choice([0.01, 0.1, 0.5])
        tilt = {name: round(0.001 * draw.random(), 5) for name in ("tilt_x_deg", "tilt_y_deg") if draw.random() < 0.2}
        stiff = draw.choice([3.0e9, 7.0e10, 2.1e11])
        load = draw.choice([1.0, 30.0, 300.0])
        width = {"collet": z / counts[2], "leading_end": y / counts[1]}.get(side, x / counts[0])
        pin = {"size_m": [x, y, z], "young_modulus_pa": stiff, "poisson_ratio": draw.choice([0.2, 0.3, 0.4]), "density_kg_m3": 2700, **tilt}
        pin.update({"shape": "cylinder", "diameter_m": y} if is_cylinder else {})
        # A wave needs four elements.
        if counts[1] >= 4 and draw.random() < 0.5:
            pin["base"] = {"wave_height_m": draw.choice([1.0e-7, 1.0e-6, 1.0e-5]), "wave_length_m": y}
        contact = {"coulomb": {}, "exponential": {"mu_static": 1.4 * mu, "speed_m_s": draw.choice([0.02, 0.2])}, "regularised": {"speed_m_s": 0.01}}[law]
        made.append({"name": f"sliding_{number}", "run": {"start": "rest"},
                     "scene": {"pin": pin, "clamp": {"side": side, **({} if side == "whole_top" else {"width_m": width})}, "load": {"force_n": load},
                               "contact": {"law": law, **contact}, "disk": {"track_radius_m": radius}},
                     "grid": {"elements": [[level * count for count in counts] for level in SLIDING_LEVELS[along]], "mu": [mu],
                              "omega_rpm": [float(f"{speed / radius * 30 / math.pi:.4g}")]}})
    return made


def run_sliding():
    """Steady sliding of the scenes drawn for it. A scene whose mesh is refused, or that takes too long, is left out and counted on the page."""
    runs.WORK.mkdir(parents=True, exist_ok=True)
    rows = []
    for made in sliding_studies():
        path, database = runs.WORK / "sliding.json", runs.empty_database("sliding.db")
        path.write_text(json.dumps(made))
        try:
            runs.tribosweep("stability", str(path), "--no-thresholds", "--modes", "1", "--out", str(runs.WORK / "sliding"), database=database, timeout_s=SLIDING_LIMIT_S)
        except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as error:
            print(f"{made['name']} is left out: {error}")
            continue
        # The study of the modes has its own name.
        for row in runs.exported(f"{made['name']}-stability", database):
            scene = made["scene"]
            rows.append({**{name: row[name] for name in SLIDING_COLUMNS if name in row}, "scene": made["name"],
                         "level": int(row["elements_y"]) // made["grid"]["elements"][0][1], "shape": scene["pin"].get("shape", "wavy block" if "base" in scene["pin"] else "block"), "law": scene["contact"]["law"],
                         "radius_over_length": f"{scene['disk']['track_radius_m'] / scene['pin']['size_m'][1]:g}", "solver_version": runs.evidence.solver_version()})
    write(rows, SLIDING, SLIDING_COLUMNS, names=[made["name"] for made in sliding_studies()])


def read(path=DATA):
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def write(rows, path=DATA, columns=COLUMNS, names=[own["name"] for own in SCENES + DRAWN + PROOF] + [FIGURE7]):
    rows.sort(key=lambda row: (names.index(row["scene"]), row["level"], float(row["mu"]), float(row["omega_rpm"])))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


# ---------------------------------------------------------------- what the results say


# Orders of the limit of fine meshes: the numbers of the page are of the middle one, and their ranges of all.
ORDERS = [1.75, 1.5, 2.0]
# Frequencies that differ by a larger share belong to different limit cycles.
SAME_FREQUENCY = 0.01
# Pairs of a mesh and the coarser mesh that comes before it.
PAIRS = [("2", "1"), ("3", "2"), ("4", "2")]
ASKED = [0.05, 0.02, 0.01]
SOURCE = (runs.ROOT / "src/mechanics/analysis/mesh_error.rs").read_text()


def constant(pattern):
    """A number of the program's bounds."""
    return float(re.search(pattern + r" ([\d.e-]+)", SOURCE).group(1))


SHARE = {"mu_star": constant(r"const MU_STAR: Bound = Bound \{ share:"), "frequency_hz": constant(r"const FREQUENCY: Bound = Bound \{ share:")}
MESH = constant(r"const MESH: f64 =")
EXTRAPOLATED_SHARE = constant(r"const EXTRAPOLATED_SHARE: f64 =")
NUMBERS = ["omega_rpm", "mu", "mu_star", "mu_star_se", "frequency_hz", "stick_share", "slip_share", "separated_share", "steps", "time_step_s",
           "start_simulated_s", "wall_s", "mu_star_mesh_error"]


def jobs_of(rows, names):
    """The results of each job by its level."""
    jobs = {}
    for row in rows:
        if row["scene"] in names:
            made = dict(row, **{name: float(row[name]) if row[name] else None for name in NUMBERS})
            for which in ("elements", "mesh_elements"):
                made[which] = [int(row[f"{which}_{axis}"]) for axis in "xyz"]
            job = jobs.setdefault((row["scene"], made["mu"], made["omega_rpm"]), {})
            job[row["level"]] = made
            if row["level"] == "1%" and is_on_finest(row):
                job["4"] = made
    return list(jobs.values())


def is_steady(row):
    return row is not None and row["status"] in STEADY


def is_cycle(row):
    return row is not None and row["status"] == "periodic"


def has_same_frequency(a, b):
    return abs(a["frequency_hz"] - b["frequency_hz"]) <= SAME_FREQUENCY * a["frequency_hz"]


def limit(job, name="mu_star", order=ORDERS[0]):
    """The limit of fine meshes of a job with a limit cycle on its two finest meshes; none if these are different cycles."""
    finest = [level for level in ("4", "3", "2") if level in job][:2]
    if finest not in (["4", "3"], ["3", "2"]) or not all(is_cycle(job[level]) for level in finest):
        return None
    fine, coarse = (job[level] for level in finest)
    if not has_same_frequency(fine, coarse):
        return None
    return fine[name] + (fine[name] - coarse[name]) / ((multiple(finest[0]) / multiple(finest[1])) ** order - 1)


def why_unknown(fine, coarse):
    """Why a bound is not known; none if it is."""
    if not is_steady(coarse):
        return "not settled"
    if fine["status"] != coarse["status"]:
        return "outcome"
    if fine["regime"] != coarse["regime"]:
        return "regime"
    return None if has_same_frequency(fine, coarse) else "frequency"


def bound(fine, coarse, name="mu_star"):
    """The program's bound of the error, relative."""
    ratio = (math.prod(fine["mesh_elements"]) / math.prod(coarse["mesh_elements"])) ** (1 / 3)
    share = SHARE[name] * MESH**3 / math.prod(fine["mesh_elements"])
    return abs(fine[name] - coarse[name]) / (ratio - 1) / fine[name] + share


def quantile(values, share):
    """The smallest value that covers a share of all."""
    return sorted(values)[max(math.ceil(share * len(values)) - 1, 0)]


def errors(jobs, level, name="mu_star", order=ORDERS[0]):
    """Relative errors of the limit cycles of a level."""
    pairs = [(job.get(level), limit(job, name, order)) for job in jobs]
    return [abs(row[name] / true - 1) for row, true in pairs if is_cycle(row) and true is not None]


def percent(value, digits=2):
    return f"{100 * value:.{digits}f} %"


def mesh_table(jobs):
    def line(level, words):
        of_mu, of_f = (errors(jobs, level, name) for name in ("mu_star", "frequency_hz"))
        worst = [quantile(errors(jobs, level, order=order), 0.95) for order in ORDERS]
        return [words, len(of_mu), percent(quantile(of_mu, 0.5)), f"{percent(quantile(of_mu, 0.95), 1)} ({percent(min(worst), 1)} to {percent(max(worst), 1)})",
                percent(max(of_mu), 1), percent(quantile(of_f, 0.5)), percent(quantile(of_f, 0.95))]
    lines = [("draft", "1, settings of `draft`"), ("1", "1"), ("2", "2"), ("3", "3"), ("4", "4")]
    return runs.table(["mesh", "jobs", "μ\\*: median", "95 %", "largest", "f: median", "95 %"], [line(*of) for of in lines if any(of[0] in job for job in jobs)])


def pair_table(jobs, name):
    def line(fine, coarse):
        found = [(job[fine], job[coarse], job) for job in jobs if is_cycle(job.get(fine)) and coarse in job]
        unknown = [why for why in (why_unknown(f, c) for f, c, _ in found) if why]
        known = [(f, c, job) for f, c, job in found if not why_unknown(f, c) and "4" in job and limit(job) is not None]
        def coverage(order, of):
            return sum(abs(f[name] - limit(job, name, order)) <= of(f, c) * f[name] for f, c, job in known) / len(known)
        covered = [coverage(order, lambda f, c: bound(f, c, name)) for order in ORDERS]
        alone = coverage(ORDERS[0], lambda f, c: bound(f, c, name) - SHARE[name] * MESH**3 / math.prod(f["mesh_elements"]))
        reasons = ", ".join(f"{why} {unknown.count(why)}" for why in sorted(set(unknown))) or "none"
        return [f"{fine}, after {coarse}", len(known), percent(covered[0], 1), f"{percent(min(covered), 1)} to {percent(max(covered), 1)}", percent(alone, 0),
                percent(quantile([bound(f, c, name) for f, c, _ in known], 0.5)), f"{len(unknown)} ({reasons})"]
    return runs.table(["mesh", "jobs", "covered", "with orders 1.5 to 2", "by the difference alone", "median bound", "unknown"],
                      [line(*pair) for pair in PAIRS])


def extrapolated_table(jobs):
    def line(fine, coarse):
        pairs = [(job[fine], job[coarse], limit(job)) for job in jobs
                 if "4" in job and is_cycle(job.get(fine)) and coarse in job and not why_unknown(job[fine], job[coarse]) and limit(job) is not None]
        pairs = [(f["mu_star"], f["mu_star"] - c["mu_star"], true) for f, c, true in pairs]
        pairs = [(f, d, true) for f, d, true in pairs if abs(d) <= EXTRAPOLATED_SHARE * f]
        ratio = multiple(fine) / multiple(coarse)
        plain = [abs(f / true - 1) for f, _, true in pairs]
        better = [abs((f + d / (ratio**2 - 1)) / true - 1) for f, d, true in pairs]
        return [f"{fine}, after {coarse}", len(pairs), percent(quantile(plain, 0.5)), percent(quantile(better, 0.5)), percent(quantile(plain, 0.95), 1),
                percent(quantile(better, 0.95), 1), percent(sum(b < a for a, b in zip(plain, better)) / len(pairs), 0)]
    # Only this pair has a limit that both of its meshes have no part in.
    return runs.table(["mesh", "jobs", "median error of μ\\*", "extrapolated", "95 %", "extrapolated", "extrapolated is better"], [line("2", "1")])


def sliding_words():
    """What the kept results of steady sliding say of its bound. The finest mesh of a scene stands for the limit."""
    scenes = {}
    for row in read(SLIDING):
        scenes.setdefault(row["scene"], []).append(row)
    found = []
    for rows in scenes.values():
        at = {int(row["level"]): row for row in rows}
        finest = max(at)
        if len(at) < 2:
            continue
        limit_of = float(at[finest]["mu_star"])
        for level, row in at.items():
            if level != finest:
                error, bound_of = abs(float(row["mu_star"]) - limit_of), float(row["mu_star_mesh_error"])
                found.append({"scene": row["scene"], "error": error / limit_of, "used": error / bound_of, "narrow": float(row["radius_over_length"]) <= 2,
                              "in_contact": int(row["contact_nodes"])})
    wide = [own for own in found if not own["narrow"]]
    narrow = [own for own in found if own["narrow"]]
    most = max(found, key=lambda own: own["used"])
    version = ", ".join(sorted({row["solver_version"] for rows in scenes.values() for row in rows}))
    return (f"Its errors were computed in {SLIDING_SCENES} scenes drawn at random, with version {version} of the solver ([sliding_errors.csv](sliding_errors.csv)): blocks, cylinders, tilted pins and waves, with three laws and six clamps, at one element to twelve "
            f"along a side of the face. None of them has an elastic disk, a mesh from a file or several materials. {len({own['scene'] for own in found})} have a result; the others are refused, or their finest mesh takes more than {SLIDING_LIMIT_S} s. Against the finest mesh, "
            f"{sum(own['used'] <= 1 for own in found)} of {len(found)} errors of the coarser ones are within their bound. They are at most {percent(max(own['error'] for own in narrow), 1)} of μ\\* where the track's radius is at most twice the length of the pin along it, and "
            f"at most {percent(max(own['error'] for own in wide), 2)} elsewhere. The median error is {percent(quantile([own['used'] for own in found], 0.5), 0)} of its bound, and the largest one {percent(most['used'], 0)}, "
            f"in a pin with {most['in_contact']} nodes in contact.")


def node_steps(rows):
    """Nodes × steps of a job on its meshes. A coarser mesh has shorter steps in proportion to its elements."""
    return sum(math.prod(n + 1 for n in row["mesh_elements"]) * row["steps"] for row in rows)


def asked(jobs, accuracy):
    """What a job becomes that asks for an accuracy: its last level, whether it is reached, and the levels that it runs on."""
    found = []
    for job in jobs:
        if "4" not in job or not is_cycle(job["4"]) or limit(job) is None:
            continue
        for fine, coarse, path in (("2", "1", "12"), ("4", "2", "124")):
            known = is_cycle(job[fine]) and not why_unknown(job[fine], job[coarse])
            reached = known and bound(job[fine], job[coarse]) <= accuracy
            if reached or fine == "4":
                found.append({"level": fine, "reached": reached, "error": abs(job[fine]["mu_star"] / limit(job) - 1),
                              "cost": node_steps([job[level] for level in path])})
                break
    return found


def cost_table(jobs):
    """Errors and costs of fixed meshes and of asked accuracies, over the same jobs."""
    same = [job for job in jobs if "4" in job and is_cycle(job["4"]) and limit(job) is not None]
    paths = {"1": "1", "2": "12", "3": "123", "4": "124"}
    cost = {level: sum(node_steps([job[step] for step in path if step in job]) for job in same) for level, path in paths.items()}

    def line(words, found, total):
        of = [error for error, _ in found]
        reached = [error for error, is_reached in found if is_reached]
        return [words, f"{total / cost['4']:.3f}", percent(quantile(of, 0.5)), percent(quantile(of, 0.95), 1), percent(max(of), 1), len(reached) or "–"]
    fixed = [line(f"mesh {level}", [(error, False) for error in errors(same, level)], cost[level]) for level in paths]
    by_asked = []
    for accuracy in ASKED:
        found = asked(jobs, accuracy)
        by_asked.append(line(f"{percent(accuracy, 0)} asked", [(of["error"], of["reached"]) for of in found], sum(of["cost"] for of in found)))
    return runs.table(["", "cost, mesh 4 = 1", "median error of μ\\*", "95 %", "largest", "reached"], fixed + by_asked)


def asked_table(jobs):
    def line(accuracy):
        found = asked(jobs, accuracy)
        reached = [of for of in found if of["reached"]]
        within = sum(of["error"] <= accuracy for of in reached)
        return [percent(accuracy, 0), len(found), sum(of["level"] == "2" for of in found), len(reached),
                f"{within} ({percent(within / len(reached), 1)})", percent(max(of["error"] for of in reached), 1)]
    return runs.table(["asked", "jobs", "end on mesh 2", "reached", "of these within what is asked", "largest error of them"],
                      [line(accuracy) for accuracy in ASKED])


def proof(jobs):
    """The drawn scenes: what was asked, reached and true."""
    with_cycle = [job for job in jobs if is_cycle(job.get("1%"))]
    reached = [job for job in with_cycle if job["1%"]["accuracy_reached"].lower() == "true"]

    def of(these, test, level="1%"):
        """How many of these with a limit pass, with each order, and how many have a limit."""
        known = [job for job in these if limit(job) is not None]
        return [sum(test(job[level], abs(job[level]["mu_star"] - limit(job, order=order))) for job in known) for order in ORDERS], len(known)
    def in_bound(row, error):
        return error <= row["mu_star_mesh_error"]
    covered, with_bound = of([job for job in with_cycle if job["1%"]["mu_star_mesh_error"] is not None], in_bound)
    within, checked = of(reached, lambda row, error: error <= 0.01 * row["mu_star"])
    standard = [job for job in jobs if is_cycle(job.get("2"))]
    standard_known = [job for job in standard if job["2"]["mu_star_mesh_error"] is not None]
    standard_covered, standard_limits = of(standard_known, in_bound, "2")
    reasons = [job["2"]["mesh_error_unknown"] for job in standard if job["2"]["mu_star_mesh_error"] is None]
    coarse = sum(job["1%"]["mesh_elements"] != job["1%"]["elements"] for job in reached)
    slides = [job for job in jobs if is_steady(job.get("1%")) and not is_cycle(job["1%"])]
    stay = [job for job in slides if "3" in job and job["3"]["status"] == "decayed"
            and abs(job["3"]["mu_star"] - job["1%"]["mu_star"]) <= job["1%"]["mu_star_mesh_error"]]
    return {"slides": len(slides), "stay": len(stay), "jobs": len(jobs), "with_cycle": len(with_cycle), "reached": len(reached), "coarse": coarse, "within": within, "checked": checked,
            "covered": covered, "with_bound": with_bound, "not_settled": len(jobs) - len(with_cycle) - len(slides), "standard": len(standard),
            "standard_known": len(standard_known), "standard_covered": standard_covered, "standard_limits": standard_limits,
            "reasons": "; ".join(f"{why} ({reasons.count(why)})" for why in sorted(set(reasons)))}


def ran_of(rows, scenes):
    """The scenes that have results on all levels; of mesh 4 there are only those that 1 % needs."""
    done = {(row["scene"], row["level"]) for row in rows}
    return [own for own in scenes if all((own["name"], level) in done for level in ("1%", "2", "3"))]


def versions(rows, scenes):
    """How many scenes ran with which version of the solver, in words. The oldest result of a scene counts."""
    found = [min(int(row["solver_version"]) for row in rows if row["scene"] == own["name"]) for own in scenes]
    return ", ".join(f"{found.count(version)} with version {version} of the solver" for version in sorted(set(found)))


def covered_with(jobs, share):
    """How many jobs of drawn scenes the bound covers with another share, in words."""
    known = [(job[level], limit(job)) for job in jobs for level in ("1%", "2") if limit(job) is not None and is_cycle(job.get(level))]
    known = [(row, true) for row, true in known if row["mu_star_mesh_error"] is not None]
    change = [(share - SHARE["mu_star"]) * MESH**3 / math.prod(row["mesh_elements"]) * row["mu_star"] for row, _ in known]
    covered = sum(abs(row["mu_star"] - true) <= row["mu_star_mesh_error"] + more for (row, true), more in zip(known, change))
    return f"{covered} of {len(known)} ({percent(covered / len(known), 0)})"


def drawn_words(drawn):
    return f"""{drawn['slides']} of {drawn['jobs']} jobs slide steadily, and {drawn['stay']} of these do so on mesh 3 with the same μ\\* within their bound. {drawn['with_cycle']} have a limit cycle, and {drawn['not_settled']} do not settle.

* With 1 % asked the bound covers {shares(drawn['covered'], drawn['with_bound'])} of the jobs with a bound and a limit.
* {drawn['reached']} of the limit cycles say that 1 % is reached, {drawn['coarse']} of them before the last mesh. Of those with a limit {shares(drawn['within'], drawn['checked'])} are within 1 % of it.
* With `standard` {drawn['standard_known']} of {drawn['standard']} limit cycles have a bound, and it covers {shares(drawn['standard_covered'], drawn['standard_limits'])} of those that have a limit. The error of the others is unknown: {drawn['reasons']}.
"""


def shares(counts, of):
    """A count with the middle order, its share, and the shares with all orders."""
    all_of = [count / of for count in counts]
    return f"{counts[0]} of {of} ({percent(all_of[0], 1)}; with orders 1.5 to 2 {percent(min(all_of), 1)} to {percent(max(all_of), 1)})"


def figure7_table(jobs):
    """The elements along x of the mesh on which each job of figure7 ends, with its bound."""
    by_point = {(job["1%"]["omega_rpm"], job["1%"]["mu"]): job["1%"] for job in jobs}
    speeds, mus = (sorted({point[axis] for point in by_point}) for axis in range(2))

    def cell(row):
        if row["mu_star_mesh_error"] is None:
            return f"{row['mesh_elements'][0]}, unknown"
        text = f"{row['mesh_elements'][0]}, {percent(row['mu_star_mesh_error'] / row['mu_star'])}"
        return text if row["accuracy_reached"].lower() == "true" else f"**{text}**"
    lines = [[f"{omega:g}"] + [cell(by_point[omega, mu]) for mu in mus] for omega in speeds]
    return runs.table(["ω [rpm]"] + [f"μ = {mu:g}" for mu in mus], lines)


def figure7_words(jobs):
    rows = [job["1%"] for job in jobs]
    cycles = [row for row in rows if is_cycle(row)]
    reached = sum(row["accuracy_reached"].lower() == "true" for row in cycles)
    # Version 10 gives steady sliding the bound of its own track and mesh.
    before = [int(row["solver_version"]) for row in rows if not is_cycle(row) and int(row["solver_version"]) < 10]
    of_before = f" Their bounds here are those of version {min(before)} of the solver, 0.02 % everywhere." if before else ""
    return (f"{len(rows) - len(cycles)} of {len(rows)} jobs slide steadily and end on 24 × 30 × 20 elements.{of_before} {reached} of the {len(cycles)} limit cycles reach 1 %. "
            f"The jobs take {sum(row['wall_s'] for row in rows):.0f} s of a thread, {sum(row['wall_s'] for row in cycles):.0f} s of these for limit cycles.")


# ---------------------------------------------------------------- modes of steady sliding


SAME_MODE = constant(r"const SAME_MODE: f64 =")
MODE_SHARE = constant(r"const MODE_SHARE: f64 =")
MODE_NUMBERS = ["growth_rate_per_s", "frequency_hz"]


def modes_of(rows):
    """The modes of each point by the level."""
    points = {}
    for row in rows:
        mode = {name: float(row[name]) for name in MODE_NUMBERS}
        points.setdefault((row["scene"], row["mu"], row["omega_rpm"]), {}).setdefault(row["level"], []).append(mode)
    return list(points.values())


def nearest(mode, modes):
    """The mode that is nearest to one, as the program finds it; none if its frequency is too far away."""
    near = [other for other in modes if other["frequency_hz"] > 0
            and abs(other["frequency_hz"] - mode["frequency_hz"]) <= SAME_MODE * min(mode["frequency_hz"], other["frequency_hz"])]
    return min(near, default=None, key=lambda other: math.hypot(math.tau * (other["frequency_hz"] - mode["frequency_hz"]),
                                                                other["growth_rate_per_s"] - mode["growth_rate_per_s"]))


def partner(mode, own, modes):
    """The same mode among those of another mesh; none if it is not clear which one it is."""
    other = nearest(mode, modes)
    return other if other is not None and nearest(other, own) is mode else None


def mode_pairs(points, fine, coarse):
    """Of each mode on the mesh `fine`: itself, its partner on `coarse`, and those on the two finest meshes; only where these are known."""
    found, unknown = [], 0
    for point in points:
        if not all(level in point for level in (fine, coarse, "3", "4")):
            continue
        for mode in point[fine]:
            same = partner(mode, point[fine], point[coarse])
            ends = [mode if level == fine else partner(mode, point[fine], point[level]) for level in "34"]
            unknown += same is None
            if same is not None and None not in ends:
                found.append((mode, same, *ends))
    return found, unknown


def mode_bound(name, fine, coarse, levels, share=MODE_SHARE):
    """The bound of the error of a mode."""
    size = math.tau * fine["frequency_hz"] if name == "growth_rate_per_s" else fine["frequency_hz"]
    return abs(fine[name] - coarse[name]) / (multiple(levels[0]) / multiple(levels[1]) - 1) + share * size


def mode_limit(name, finer, finest, order):
    return finest[name] + (finest[name] - finer[name]) / ((4 / 3) ** order - 1)


def mode_coverage(name, found, levels, share=MODE_SHARE, order=ORDERS[0]):
    covered = sum(abs(fine[name] - mode_limit(name, finer, finest, order)) <= mode_bound(name, fine, coarse, levels, share)
                  for fine, coarse, finer, finest in found)
    return covered / len(found)


def mode_table(points):
    def line(name, words, unit, levels):
        found, unknown = mode_pairs(points, *levels)
        covered = [mode_coverage(name, found, levels, order=order) for order in ORDERS]
        errors = [abs(fine[name] - mode_limit(name, finer, finest, ORDERS[0])) for fine, _, finer, finest in found]
        bounds = [mode_bound(name, fine, coarse, levels) for fine, coarse, *_ in found]
        return [words, f"{levels[0]}, after {levels[1]}", len(found), percent(covered[0], 1), f"{percent(min(covered), 1)} to {percent(max(covered), 1)}",
                percent(mode_coverage(name, found, levels, share=0), 0), f"{quantile(errors, 0.5):.3g} {unit}", f"{quantile(bounds, 0.5):.3g} {unit}", unknown]
    kinds = [("growth_rate_per_s", "growth rate", "1/s"), ("frequency_hz", "frequency", "Hz")]
    return runs.table(["", "mesh", "modes", "covered", "with orders 1.5 to 2", "by the difference alone", "median error", "median bound", "without a partner"],
                      [line(*kind, levels) for kind in kinds for levels in PAIRS])


def mode_words(rows):
    """The scenes whose modes are known on all meshes, and their points."""
    levels = {}
    for row in rows:
        levels.setdefault(row["scene"], set()).add(row["level"])
    complete = [name for name, own in levels.items() if own >= set("1234")]
    points = len({(row["scene"], row["mu"], row["omega_rpm"]) for row in rows if row["scene"] in complete})
    return f"{points} points of {len(complete)} scenes ({', '.join(f'`{name}`' for name in complete)})"


# ---------------------------------------------------------------- the page and the presets


def evidence(jobs):
    """What the program says of its presets."""
    standard = {id(job): node_steps([job[level] for level in "12"]) for job in jobs if limit(job) is not None and "1" in job}
    presets = []
    for name, level in (("draft", "draft"), ("standard", "2"), ("reference", "3")):
        of_mu, of_f = (errors(jobs, level, figure) for figure in ("mu_star", "frequency_hz"))
        both = [job for job in jobs if id(job) in standard and is_cycle(job.get(level))]
        path = {"draft": ["draft"], "2": ["1", "2"], "3": ["1", "2", "3"]}[level]
        cost = sum(node_steps([job[step] for step in path]) for job in both) / sum(standard[id(job)] for job in both)
        presets.append({"name": name, "jobs": len(of_mu), "mu_star_median": quantile(of_mu, 0.5), "mu_star_95": quantile(of_mu, 0.95),
                        "frequency_median": quantile(of_f, 0.5), "frequency_95": quantile(of_f, 0.95), "relative_cost": cost})
    return {"written_by": "scripts/mesh_errors.py", "scenes": len({job["2"]["scene"] for job in jobs if limit(job) is not None}), "presets": presets}


def scene_table(rows):
    def line(own):
        pin = {"size_m": [0.012, 0.015, 0.010], "young_modulus_pa": 1.0e9, "density_kg_m3": 2500, "poisson_ratio": 0.3, **own["pin"]}
        clamp = f"{own['clamp']['side']}, {1e3 * own['clamp']['width_m']:.3g} mm"
        shape = "cylinder " if pin.get("shape") == "cylinder" else ""
        size = " × ".join(f"{1e3 * edge:g}" for edge in pin["size_m"]) + " mm"
        more = own["contact"].get("law", "coulomb")
        rest = [name for name in ("top", "holder") if name in own] + (["a steel plate above"] if "regions" in pin else [])
        rest += [f"β_R {1e9 * own['beta_r_s']:.3g} ns"] if "beta_r_s" in own else []
        counts = " × ".join(map(str, own["counts"])) if own["counts"] else "that of `draft`"
        return [own["name"], f"{shape}{size}", f"{pin['young_modulus_pa'] / 1e9:g}, {pin['density_kg_m3']:g}, {pin['poisson_ratio']:g}", clamp,
                f"{own['load']:g}", more, " and ".join(f"{mu:g}" for mu in own["mu"]), counts, ", ".join(rest)]
    return runs.table(["scene", "pin", "E [GPa], ρ, ν", "clamp", "F [N]", "law", "μ", "mesh 1", "more"], [line(own) for own in SCENES + DRAWN + ran_of(rows, PROOF)])


def page(rows):
    chosen, others = ([row for row in read(MODES) if (row["scene"] in MODES_CHOSEN) == is_chosen] for is_chosen in (True, False))
    jobs = jobs_of(rows, [own["name"] for own in SCENES])
    ran = ran_of(rows, PROOF)
    drawn, unseen = (proof(jobs_of(rows, [own["name"] for own in scenes])) for scenes in (DRAWN, ran))
    earlier = [covered_with(jobs_of(rows, [own["name"] for own in scenes]), share)
               for scenes, share in zip((FIRST_DRAW, SECOND_CHOSEN), EARLIER_SHARES)]
    limits = [job for job in jobs if limit(job) is not None]
    figure7 = jobs_of(rows, [FIGURE7])
    other = sum("4" in job and "3" in job and all(is_cycle(job[level]) for level in "34") and limit(job) is None for job in jobs)
    presets = evidence(jobs)
    return f"""# Errors of the mesh

Written by `scripts/mesh_errors.py` from [mesh_errors.csv](mesh_errors.csv), [mode_errors.csv](mode_errors.csv) and [sliding_errors.csv](sliding_errors.csv), which the same script fills from runs; do not edit.

A result knows the error that its mesh makes if the job ran on a coarser mesh first. `mu_star_mesh_error` and `frequency_mesh_error_hz` are
absolute bounds, each chosen to cover {percent(0.95, 0)} of the jobs of the scenes below; [other scenes](#scenes-that-took-no-part) are counted apart. They say nothing of the time step, the damping or the model, and `mu_star_se` is the error of the mean
over time. This page says where the bounds come from, what they cover, and where the error is unknown.

## The bound

The result f on a mesh and c on a coarser one, whose elements are r times as large, have the bound

    |f - c| / (r - 1) + s |f| ({MESH:g}³ / number of elements)

with s = {SHARE["mu_star"]:g} for μ\\* and {SHARE["frequency_hz"]:g} for the frequency. The first term is the error of f if errors are of first order. They fall faster (order 1.5 to 2),
but contact that opens, closes and sticks leaves differences that are small by chance. The second term covers these. It falls with the third power of
the element size. The ratio r comes from the numbers of elements.

The error is *unknown*, with the reason beside it (`mesh_error_unknown`), if the job did not run on a coarser mesh, if the run there did not settle, or if its outcome, its
regime or its clamp is another one or its frequency is more than {percent(SAME_FREQUENCY, 0)} away: then the two are different limit cycles, and their difference is not an error.
A job that starts from rest, as with `draft`, runs on a coarser mesh with `"start": "compared"`.

μ\\* of steady sliding is a mean of the friction along the track, weighted with the pressure. This friction changes over the face with the direction of the curved track, and in some laws with the speed.
A mesh can only have the pressure in the wrong place. On a flat base it is wrong by less than an element, so the bound is the range of this friction over the face, over the number of elements across its side with fewer of them.
With waves or roughness, on an elastic disk and on a mesh from a file it is the whole range. It is unknown if the coarser mesh has a limit cycle. {sliding_words()}

## What it covers

{len(jobs)} jobs of {len(SCENES)} scenes ran on meshes with 1, 2, 3 and 4 times the elements of the table [below](#the-scenes) in each direction, with the numerics of `standard`. Each starts from the
limit cycle on a coarser mesh where there is one: half of its elements, or the next number that has a row of nodes at the clamp's edge. The limit of fine meshes is extrapolated from the two finest meshes, with order 1.75; ranges are those with orders 1.5 to 2. It is known
for {len(limits)} jobs. {other} have two different limit cycles on their two finest meshes, and the rest slide steadily or do not settle. The limit shares a mesh with the results of meshes 3 and 4,
so only the lines of mesh 2 are checked by meshes that have no part in them. The tables of bounds have the jobs with a mesh 4 only. The cylinders and the scene `plate` have no mesh 4: the limit of
{sum("4" not in job for job in limits)} jobs shares mesh 2, and bounds on these pins are not checked.

Errors of fixed meshes:

{mesh_table(jobs)}
Bounds of μ\\*. The last columns are the median of the bounds, and how many jobs with a limit cycle have none:

{pair_table(jobs, "mu_star")}
Bounds of the frequency:

{pair_table(jobs, "frequency_hz")}
Coverage holds for these scenes as a whole. A single scene can have more or less.

## The extrapolated value

`mu_star_extrapolated` is f + (f − c)/(r² − 1), as if the error were of second order. It is given where f and c differ by at most {percent(EXTRAPOLATED_SHARE, 0)}. It has no bound of its own, and is never put in the place of μ\\*.

{extrapolated_table(jobs)}
## An accuracy instead of a mesh

`"accuracy": {{ "mu_star": 0.01 }}` in a study, or `--accuracy 1%`: each job goes from a mesh of the draft's size to one of twice and one of four times as many elements in each direction, and ends where its own
bound is within what is asked. If it is not on the last mesh, the result is there and says so (`accuracy_reached` is false). A mesh that the study gives is the last one. The following is what the jobs of
above with a limit on mesh 4 become:

{asked_table(jobs)}
Errors against cost (nodes × steps on all meshes of a job), over the same jobs:

{cost_table(jobs)}
Limit cycles end early mainly if 5 % is asked: the second term of the bound alone is {percent(bound_floor(), 1)} on 24 × 30 × 20 elements. Many of these jobs are within 1 % there, as the table of errors shows, but their two meshes do
not prove it. So with 1 % asked the gain is in steady sliding, which ends on mesh 2, and in what is known; for limit cycles the cost is that of mesh 4. A fixed mesh that has 1 % for {percent(0.95, 0)} of the jobs would need about
{needed(jobs):.1f} times the elements of mesh 1 in each direction, {(needed(jobs) / 4) ** 4:.1f} times the cost of mesh 4, and would not say in which jobs it has it.

## figure7 with 1 % asked

{figure7_words(figure7)} Each cell has the elements along x of the last mesh and the bound of the error of μ\\*; bold: more than 1 %.

{figure7_table(figure7)}
It is hard where contact opens and closes in much of the face and μ\\* is far below μ: about its minimum over ω, and at fast disks with a large μ. There the
two last meshes differ by several tenths of a percent to percents.

## Scenes drawn at random

Size, material, clamp, load, law and μ of these scenes are drawn. Each has 8 jobs with 1 % asked, and the same jobs with the preset `standard`. The limit comes from the meshes 3 and 4. It shares a mesh with the jobs
that asked for 1 %, and none with those of `standard`.

### Scenes of the choice

s = {EARLIER_SHARES[0]:g}, which the scenes above alone need, covered {earlier[0]} of the drawn jobs of {len(FIRST_DRAW)} scenes, those with `standard` and with 1 % asked together. s = {EARLIER_SHARES[1]:g} covered {earlier[1]} of those of {len(SECOND_CHOSEN)} more scenes. So s was raised
to {SHARE["mu_star"]:g}. For these {len(DRAWN)} scenes together:

{drawn_words(drawn)}
### Scenes that took no part

{len(ran)} more scenes ran after the numbers were fixed: {versions(rows, ran)}. {len(THIRD_DRAW)} more were drawn before any of them ran. {len(THIRD_DRAW) - len(THIRD_STUDIES)} of these have the same μ twice, which
no study can have. Of the other {len(THIRD_STUDIES)}, {sum(own in THIRD_STUDIES for own in ran)} ran, in the order of the draw.

{drawn_words(unseen)}
## Modes of steady sliding

The frequency f and the growth rate of a mode have errors if `stability` computes the modes on the coarser mesh, too: with a start that is not `"rest"`, as the presets from `standard` on have it. They are the difference
over r - 1, as above, and {MODE_SHARE:g} of f or, for the growth rate, of 2πf. This share does not fall with the mesh: modes that are nearly alike, and nodes that lift off, change from mesh to mesh.
A mode has an error if each of the two meshes has it nearest to the other's, with frequencies at most {percent(SAME_MODE, 0)} apart. A threshold has the larger error of the growth rates beside it over their slope.

The share was chosen for the six leading modes of {mode_words(chosen)}. The limit is that of the meshes 3 and 4.

{mode_table(modes_of(chosen))}
The same for {mode_words(others)}, which took no part in the choice:

{mode_table(modes_of(others))}
Other scenes are not checked, neither are cylinders and regions.

## Presets

Errors of the presets over the same scenes. The mesh of `draft` is mesh 1, that of `standard` mesh 2 and that of `reference` mesh 3 in most scenes; in the others the preset takes a few elements less. The cost is nodes × steps with the coarser meshes, `standard` = 1.

{presets_table(presets)}
`two_percent` and `one_percent` ask for an accuracy, with the numerics of `standard`.

## The scenes

All have four speeds: {", ".join(f"{share:g}" for share in SPEEDS)} times σ/√(Eρ), where σ is the mean pressure.

{scene_table(rows)}
Young's modulus, density [kg/m³] and Poisson's ratio of a plate are those of steel.

## Not known

* Whether the bounds of μ\\* cover 95 % in other scenes: in those that took no part {unseen['covered'][0] + unseen['standard_covered'][0]} of {unseen['with_bound'] + unseen['standard_limits']} are covered, on two kinds of meshes of the same jobs.
* Errors of elastic disks, of meshes from files, of programs, and of scenes with rough or rounded bases: no such scene is among these. Jobs on elastic disks and with programs have no coarser run, so their error is unknown.
* Bounds on cylinders and pins of several materials: they are given, and not checked against a fourth mesh.
* Limits of jobs whose finest meshes have different limit cycles.
* The scene `plate` and the cylinders have three meshes, because the fourth costs too much.
"""


def bound_floor():
    return SHARE["mu_star"] * MESH**3 / (24 * 30 * 20)


def needed(jobs):
    """The multiple of mesh 1 that has 1 % for 95 % of the jobs, by the order 1.75."""
    return 4 * (quantile(errors(jobs, "4"), 0.95) / 0.01) ** (1 / ORDERS[0])


def presets_table(presets):
    return runs.table(["preset", "jobs", "error of μ\\*: median", "95 %", "error of f: median", "95 %", "cost"],
                      [[f"`{of['name']}`", of["jobs"], percent(of["mu_star_median"]), percent(of["mu_star_95"], 1), percent(of["frequency_median"]),
                        percent(of["frequency_95"]), f"{of['relative_cost']:.2f}"] for of in presets["presets"]])


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--check", action="store_true", help="say whether page and presets are those of the kept results")
    commands = arguments.add_subparsers(dest="command")
    solve = commands.add_parser("run", help="solve scenes and keep the results")
    solve.add_argument("levels", nargs="+", choices=["draft", "1", "2", "3", "4", "1%"], metavar="LEVEL")
    solve.add_argument("--scenes", nargs="+", default=[], metavar="NAME")
    modes = commands.add_parser("modes", help="compute the modes of scenes and keep them")
    modes.add_argument("levels", nargs="+", choices=["1", "2", "3", "4"], metavar="LEVEL")
    modes.add_argument("--scenes", nargs="+", default=[], metavar="NAME")
    commands.add_parser("sliding", help="compute steady sliding on tracks of all widths and keep it")
    once_more = commands.add_parser("again", help="solve a scene again and compare with what is kept")
    once_more.add_argument("number", nargs="?", type=int, default=0, help="of the scene (0)")
    given = arguments.parse_args()
    if given.command == "again":
        again(given.number)
    if given.command == "sliding":
        return run_sliding()
    if given.command:
        {"run": run, "modes": run_modes}[given.command](given.levels, given.scenes)
        # The rest of the rows may be older.
        if not given.scenes:
            runs.evidence.stamp("mesh_errors")
        return
    rows = read()
    written = {**{f"docs/evidence/{name}": text for name, text in runs.evidence.with_part("mesh_errors", page(rows)).items()},
               "src/application/study/presets.json": json.dumps(evidence(jobs_of(rows, [own["name"] for own in SCENES])), indent=2, ensure_ascii=False) + "\n"}
    for name, text in written.items():
        path = runs.ROOT / name
        if given.check:
            if not path.exists() or path.read_text() != text:
                sys.exit(f"{name} is not what scripts/mesh_errors.py writes: run it")
        else:
            path.write_text(text)
            print(f"written: {name}")


if __name__ == "__main__":
    main()
