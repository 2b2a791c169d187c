#!/usr/bin/env python3
"""Writes docs/evidence/accuracy.md and docs/evidence/work_precision.svg: how accurate the results of the reference scene are.

    scripts/accuracy.py                 measure everything, which takes hours
    scripts/accuracy.py again NUMBER    run a preset again, and end with 3 if a μ* is not the one on the page

Converged values of static deflections, and the limits of μ* from which the presets' errors are taken, come from
scripts/peers/converged.json (scripts/peers/lagrange.py writes it).

Runs the work_precision studies one job at a time (their run times are part of the result), the mesh
convergence, the scans of step and damping, and the presets. Every verdict follows from a criterion that
the page states.
"""

import csv
import json
import math
import shutil
import subprocess
import sys

import runs
from evidence import parts

# Largest relative error of mu* that is asked for.
WANTED = 0.01
# Two neighbours of a scan are on different limit cycles if their frequencies differ by more than this (relative). The
# mesh and step errors of the frequency on one limit cycle are smaller.
SUDDEN = 0.01
SPEEDS = [2, 7, 12, 35]
# The presets are compared with this mesh, which is a third finer than the finest preset.
MEASURE = {"elements": [48, 60, 40], "safety_factor": 0.8}
CONVERGED = json.loads((runs.ROOT / "scripts/peers/converged.json").read_text())
TIMED = ["work_precision", "work_precision_fast", "work_precision_damping", "work_precision_detection"]
SCAN_SCENE = {"contact": {"mu": 0.4}, "disk": {"omega_rpm": 7}, "clamp": {"width_m": 0.002}}
SCAN_RUN = {"limit_s": 0.012, "stop_early": False, "average_last_fraction": 0.4}
STEPS = [8.85e-7, 7e-7, 5.5e-7, 4e-7, 2.8e-7, 2e-7]
# The limits of fine meshes are known at this damping.
BETA_R_S = 5e-8
DAMPING = [2e-8, 3e-8, 4e-8, 4.5e-8, 5e-8, 6e-8, 8e-8, 1.2e-7, 2e-7]
FIGURES = {"mu_star": "μ*", "frequency_hz": "f", "stick_share": "stick", "slip_share": "slip",
           "separated_share": "separated"}


def percent(x, digits=2):
    return f"{100 * x:.{digits}f} %"


def signed(x, digits=2):
    return f"{100 * x:+.{digits}f} %"


def mesh(elements):
    return " × ".join(map(str, elements))


def lines_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def floats(text):
    return [float(x) for x in text.split()]


def pareto(studies, database):
    """The comparison of studies: what is printed, its jobs and its refinements."""
    folder = runs.WORK / f"pareto-{studies[0]}"
    printed = runs.tribosweep("pareto", *studies, "--out", str(folder), database=database)
    return printed, lines_of(folder / "pareto.csv"), lines_of(folder / "refinement.csv"), folder


# ---------------------------------------------------------------- presets


def preset_study(name, **more):
    return {"name": f"preset-{name}", "scene": {"contact": {"mu": 0.4}}, "numerics": {"beta_r_s": BETA_R_S}, "grid": {"omega_rpm": SPEEDS}, **more}


def cases(rows):
    return [{"omega_rpm": float(row["omega_rpm"]), "mu_star": row["mu_star"], "frequency_hz": row["frequency_hz"],
             "shares": [row["stick_share"], row["slip_share"], row["separated_share"]]} for row in rows]


def node_steps(rows, elements):
    """Nodes × steps. A time on the coarser mesh costs a sixteenth of the same time on the job's own mesh."""
    steps = sum(row["steps"] + (row["start_simulated_s"] or 0.0) / row["time_step_s"] / 16 for row in rows)
    return math.prod(n + 1 for n in elements) * steps


def largest(found, true, error):
    return max(error(a, b) for a, b in zip(found, true))


def limit_error(a, b):
    return abs(a["mu_star"] / b["mu_star_limit"] - 1)


def add_limits(true):
    """Gives each case of the finest mesh the limit of fine meshes, and the relative uncertainty of this limit."""
    known = {case["omega_rpm"]: case for case in CONVERGED["known"]["mu_star"]["cases"]}
    for case in true:
        limit = known[case["omega_rpm"]]
        case["mu_star_limit"] = limit["value"]
        case["mu_star_uncertainty"] = max(abs(end / limit["value"] - 1) for end in limit["range"])


def frequency_error(a, b):
    return abs(a["frequency_hz"] / b["frequency_hz"] - 1)


def shares_error(a, b):
    return max(abs(x - y) for x, y in zip(a["shares"], b["shares"]))


def measure_presets():
    """Measures the presets that have one mesh."""
    settings = [preset for preset in json.loads(runs.tribosweep("presets", "--json"))["presets"] if not preset["accuracy"]]
    rows = runs.sweep("studies/mesh_convergence_reference.json", "convergence.db")
    true = cases([row for row in rows if row["elements"] == MEASURE["elements"]])
    add_limits(true)
    rows = {p["name"]: runs.sweep(preset_study(p["name"], preset=p["name"]), f"preset-{p['name']}.db")
            for p in settings}
    standard = next(p for p in settings if p["name"] == "standard")
    unit = node_steps(rows["standard"], standard["elements"])
    presets = []
    for preset in settings:
        found = cases(rows[preset["name"]])
        presets.append({
            "name": preset["name"],
            "elements": preset["elements"],
            "safety_factor": preset["safety_factor"],
            "tolerance": preset["tolerance"],
            "drift_tolerance": preset["drift_tolerance"],
            "cases": found,
            "mu_star_error": largest(found, true, limit_error),
            "frequency_error": largest(found, true, frequency_error),
            "shares_error": largest(found, true, shares_error),
            "relative_cost": node_steps(rows[preset["name"]], preset["elements"]) / unit,
        })
    return {"reference": {"cases": true, "mu_star_source": CONVERGED["known"]["mu_star"]["source"]}, "presets": presets}


def presets_page(evidence):
    rows = [[f"`{p['name']}`", mesh(p["elements"]), p["safety_factor"], p["tolerance"], p["drift_tolerance"],
             percent(p["mu_star_error"]), percent(p["frequency_error"]), f"{p['shares_error']:.3f}",
             f"{p['relative_cost']:.2f}"] for p in evidence["presets"]]
    true = evidence["reference"]["cases"]

    def against(found, case):
        return f"{found['mu_star']:.4f} ({signed(found['mu_star'] / case['mu_star_limit'] - 1)})"

    by_speed = [[f"{case['omega_rpm']:g}", f"{case['mu_star_limit']:.4f} (± {percent(case['mu_star_uncertainty'])})"]
                + [against(p["cases"][i], case) for p in evidence["presets"]]
                + [against(case, case), f"{case['frequency_hz']:.0f}"] for i, case in enumerate(true)]
    return (
        runs.table(["preset", "mesh", "safety factor", "tolerance", "drift", "error of μ\\*", "error of f",
                    "error of shares", "cost"], rows)
        + "\nErrors are the largest over four speeds of the reference scene (clamp 1 mm, μ = 0.4), cost is nodes × steps with\n"
        "`standard` = 1. By speed, with the error beside each number:\n\n"
        + runs.table(["ω [rpm]", "μ\\*, limit"] + [f"μ\\*, `{p['name']}`" for p in evidence["presets"]]
                     + [f"μ\\*, {mesh(MEASURE['elements'])}", f"f [Hz], {mesh(MEASURE['elements'])}"], by_speed)
    )


def figure7_page(evidence):
    """Which preset has an error within WANTED, and what figure7 does."""
    study = runs.shipped("figure7")
    elements = study["scene"]["pin"]["elements"]
    same = [p["name"] for p in evidence["presets"] if p["elements"] == elements]
    true = evidence["reference"]["cases"]

    def within(p):
        """Speeds at which the error is within WANTED wherever the limit is in its range."""
        return [a["omega_rpm"] for a, b in zip(p["cases"], true)
                if limit_error(a, b) + b["mu_star_uncertainty"] <= WANTED]

    good = [p for p in evidence["presets"] if len(within(p)) == len(true)]
    own = next((p for p in evidence["presets"] if p["elements"] == elements), None)
    text = (f"`studies/figure7.json` uses {mesh(elements)} elements"
            + (f", those of `{same[0]}`.\n" if same else ".\n"))
    if own:
        text += (f"Its largest error of μ\\* over the four speeds is {percent(own['mu_star_error'])}: "
                 + ("within" if own["mu_star_error"] <= WANTED else "**not** within")
                 + f" the {percent(WANTED, 0)} that is wanted. With the\nuncertainty of the limit:\n\n")
    if good:
        text += (f"* the cheapest preset within the wanted error at all speeds is `{good[0]['name']}`, at {good[0]['relative_cost']:.0f} times the cost;\n")
    else:
        text += "* no preset is certainly within the wanted error at all speeds;\n"
    for p in evidence["presets"]:
        speeds = [f"{speed:g}" for speed in within(p)]
        text += f"* `{p['name']}` is within it at {len(speeds)} of {len(true)} speeds" + (
            f" ({', '.join(speeds)} rpm).\n" if speeds else ".\n")
    text += "\n"
    text += ("The cost of the whole sweep grows with the fourth power of the mesh's refinement. The sweep takes the finest mesh that\n"
             "still gives the figure in minutes on two cores.\n" if own and own["mu_star_error"] > WANTED else "")
    return text


# ---------------------------------------------------------------- work and precision


def work_page():
    for study in TIMED:
        runs.sweep(f"studies/{study}.json", "precision.db", ["--threads", "1"])
    printed, jobs, _, folder = pareto(TIMED, "precision.db")
    shutil.copy(folder / "pareto.svg", runs.EVIDENCE / "work_precision.svg")
    front = [job for job in jobs if job["on_wall_front"] == "true"]
    front.sort(key=lambda job: float(job["wall_s"]))
    rows = [[job["elements"].replace("x", " × "), f"{1e6 * float(job['time_step_s']):.3f}",
             "yes" if job["stop_early"] == "true" else "no", f"{float(job['tolerance']):g}, {float(job['drift_tolerance']):g}",
             ("" if job["resolved"] == "true" else "≤ ")
             + percent(max(abs(float(job["mu_star_error"])), float(job["mu_star_resolution"]))),
             f"{float(job['wall_s']):.2f}"] for job in front]
    return (
        "![relative error of μ* against solver time](work_precision.svg)\n\nThe Pareto front:\n\n"
        + runs.table(["mesh", "Δt [µs]", "stopped early", "tolerance, drift", "error of μ\\*", "time [s]"], rows)
        + "\nAll jobs, as `tribosweep pareto " + " ".join(TIMED) + "` prints them:\n\n"
        + "#" + printed,
        jobs,
    )


def early_page(jobs):
    """What stopping early changes and saves, over the pairs of the product study."""
    def settings(job):
        return job["elements"], job["safety_factor"], job["time_step_s"], job["beta2"], job["beta_r_s"]

    whole = {settings(job): job for job in jobs if job["stop_early"] == "false"}
    product = [job for job in jobs if job["stop_early"] == "true" and job["study"] == "work_precision"]
    pairs = [(job, whole[settings(job)]) for job in product if settings(job) in whole]
    change = [abs(float(a["mu_star"]) / float(b["mu_star"]) - 1) for a, b in pairs]
    steps = [1 - float(a["steps"]) / float(b["steps"]) for a, b in pairs]
    wall = 1 - sum(float(a["wall_s"]) for a, _ in pairs) / sum(float(b["wall_s"]) for _, b in pairs)
    return (
        f"At 12 rpm with the default tolerances, over {len(pairs)} pairs of mesh and step: μ\\* changes by at most "
        f"{percent(max(change), 3)} (median {percent(sorted(change)[len(change) // 2], 3)}), {percent(min(steps), 0)} to "
        f"{percent(max(steps), 0)} of the steps of a 12 ms run are saved, {percent(wall, 0)} of the solver time in all.\n"
    )


# ---------------------------------------------------------------- mesh


def convergence_verdict(line):
    """Converged: a clean order, or a last change within half of WANTED."""
    values = floats(line["values"])
    last = abs(values[-1] / values[-2] - 1)
    if line["verdict"] == "clean":
        return f"converges, order {float(line['order']):.2f}, to {float(line['limit']):.4f}"
    if line["verdict"] == "within_noise":
        return "converged within its standard error"
    settled = f"settled within {percent(last)}" if last <= WANTED / 2 else "**not converged**"
    return f"{settled} ({line['verdict'].replace('_', ' ')})"


def mesh_table(study):
    """The convergence of mu* in a study, its largest last changes and its finest values by damping and speed."""
    runs.sweep(f"studies/{study}.json", "convergence.db")
    _, jobs, refinement, _ = pareto([study], "convergence.db")
    lines = [line for line in refinement if line["direction"] in ("mesh", "mesh_and_step") and line["figure"] == "mu_star"]
    by_case = {job["case"]: job for job in jobs}
    rows, worst, finest = [], {}, {}
    for line in sorted(lines, key=lambda line: (float(by_case[line["case"]]["beta_r_s"]),
                                                float(by_case[line["case"]]["omega_rpm"]))):
        job = by_case[line["case"]]
        values = floats(line["values"])
        last = values[-1] / values[-2] - 1
        damping = float(job["beta_r_s"])
        worst[damping] = max(worst.get(damping, 0), abs(last))
        finest[damping, float(job["omega_rpm"])] = values[-1]
        rows.append([f"{damping:g}", f"{float(job['omega_rpm']):g}", *(f"{value:.4f}" for value in values),
                     signed(last), convergence_verdict(line)])
    sizes = floats(lines[0]["sizes"])
    text = runs.table(["β_R [s]", "ω [rpm]"] + [f"h = {1e3 * size:.2f} mm" for size in sizes]
                      + ["last change", "verdict"], rows)
    return text, worst, finest, sizes


def finest_words(finest):
    """How far the finest mesh is from the limit of fine meshes."""
    known = CONVERGED["known"]["mu_star"]["cases"]
    off = {case["omega_rpm"]: value / case["value"] - 1 for case in known for (_, omega), value in finest.items()
           if omega == case["omega_rpm"]}
    return ("The finest mesh is not the limit: against the limits of the presets' table it is off by\n"
            + ", ".join(f"{signed(off[omega], 1)} at {omega:g} rpm" for omega in sorted(off)) + ".")


def mesh_page():
    reference, worst, finest, _ = mesh_table("mesh_convergence_reference")
    text = ("The reference scene (clamp 1 mm), time step 0.8 of the limit on every mesh, the last 40 % of 9 ms:\n\n" + reference
            + f"\nThe largest last change of μ\\* is {percent(max(worst.values()))}. {finest_words(finest)}\n\n"
            "The same with a clamp of 2 mm, Δt = 2·10⁻⁷ s on every mesh, the last 40 % of 8 ms, and two dampings:\n\n")
    table, worst, finest, _ = mesh_table("mesh_convergence")
    text += table
    text += ("\nVerdict: *converges* when the observed order is clean (criterion at the end), *settled* when the last change of\n"
             f"μ\\* is within {percent(WANTED / 2, 1)}, *not converged* otherwise. The largest last change is "
             + ", ".join(f"{percent(change)} at β_R = {damping:g} s" for damping, change in sorted(worst.items())) + ".\n")
    by_damping = max(abs(finest[2e-7, speed] / finest[5e-8, speed] - 1) for speed in SPEEDS)
    return text + "\n" + damping_page(worst, by_damping)


def damping_page(worst, by_damping):
    """Whether mu* converges with more damping; then short waves hinder convergence, and not the code."""
    little, much = worst[5e-8], worst[2e-7]
    if much <= WANTED / 2 < little:
        return (
            "At 5·10⁻⁸ s the short waves are hardly damped (β_R ω/2 is 0.2 % of critical at 14.5 kHz, 1.4 % at\n"
            "90 kHz), and each finer mesh adds shorter ones, which the contact's opening and closing excites. With four times\n"
            f"the damping the same code settles within {percent(much)} at every speed. This suggests that lightly damped short waves of\n"
            "the model, and not the code, keep μ\\* from settling at 5·10⁻⁸ s; [choices.md](choices.md#without-damping) has their share with less damping.\n"
            f"The limit of {percent(WANTED / 2, 1)} is a choice: half of the accuracy that is wanted. The damping itself changes μ\\* by up to\n"
            f"{percent(by_damping)} on the finest mesh; that of the paper's scheme is between 0 and 2.75·10⁻⁸ s.\n"
        )
    return (f"The largest last change is {percent(little)} at 5·10⁻⁸ s and {percent(much)} at four times it: "
            + ("both are settled.\n" if little <= WANTED / 2 else
               "more damping " + ("helps but does not settle it.\n" if much < little else "does not help.\n")))


def scans_page():
    """mu* over step and damping on one mesh: two limit cycles."""
    scene = dict(SCAN_SCENE, pin={"elements": [12, 15, 10]})
    steps = runs.sweep({"name": "accuracy-steps", "scene": scene, "run": SCAN_RUN,
                        "grid": {"ramp_s": [2.5e-4, 1e-3], "time_step_s": STEPS}}, "scans.db")
    damping = runs.sweep({"name": "accuracy-damping", "scene": scene, "run": SCAN_RUN, "numerics": {"time_step_s": 4e-7},
                          "grid": {"beta_r_s": DAMPING}}, "scans.db")
    first = [row for row in steps if row["ramp_s"] == 2.5e-4]
    second = [row for row in steps if row["ramp_s"] == 1e-3]

    def jump(rows, value):
        """The neighbours with the largest change of mu*, in words, and whether the change is sudden."""
        pairs = [(abs(b["mu_star"] / a["mu_star"] - 1), a, b) for a, b in zip(rows, rows[1:])]
        size, a, b = max(pairs, key=lambda pair: pair[0])
        others = sorted(pair[0] for pair in pairs)[-2]
        of_frequency = abs(b["frequency_hz"] / a["frequency_hz"] - 1)
        sudden = of_frequency > SUDDEN
        return (f"The largest change of μ\\* between neighbours is {percent(size)}, from {a[value]:g} s ({a['frequency_hz']:.0f} Hz) to "
                f"{b[value]:g} s ({b['frequency_hz']:.0f} Hz); the next largest is {percent(others)}. "
                + (f"The frequency changes by {percent(of_frequency)} there: another limit cycle.\n" if sudden
                   else "The frequency hardly changes there: the same limit cycle.\n")), sudden

    def line(row, value):
        return [f"{row[value]:g}", f"{row['mu_star']:.5f} ± {row['mu_star_se']:.5f}", f"{row['frequency_hz']:.0f}",
                f"{row['separated_share']:.3f}", row["status"]]

    apart = max(abs(a["mu_star"] - b["mu_star"]) for a, b in zip(first, second))
    fine = [row for row in first if row["time_step_s"] <= 4e-7]
    spread = max(row["mu_star"] for row in fine) / min(row["mu_star"] for row in fine) - 1
    by_step, step_jumps = jump(first, "time_step_s")
    by_damping, damping_jumps = jump(damping, "beta_r_s")
    text = "Time step, β_R = 5·10⁻⁸ s:\n\n"
    text += runs.table(["Δt [s]", "μ\\*", "f [Hz]", "separated", "status"], [line(row, "time_step_s") for row in first])
    text += "\n" + by_step
    text += (f"Below 4·10⁻⁷ s μ\\* is converged to {percent(spread)}. A load ramp four times as long changes no μ\\* of the table by\n"
             f"more than {apart:.5f}: with these ramps the state does not depend on how it was reached.\n\n")
    text += "Damping, Δt = 4·10⁻⁷ s:\n\n"
    text += runs.table(["β_R [s]", "μ\\*", "f [Hz]", "separated", "status"], [line(row, "beta_r_s") for row in damping])
    text += "\n" + by_damping
    if step_jumps and damping_jumps:
        text += (
            "\nStep and damping each move the contact across a sudden change between two limit cycles, which differ in μ\\*, in\n"
            "frequency and in separation. Near this change, a coarse step or mesh does not cause a small error: it leads to another\n"
            "limit cycle. This, and not the order of the scheme, limits the accuracy of μ\\* at this speed. The change also happens at a\n"
            "fixed small step when only the damping varies, so it is a property of the equations on this mesh and not of the time\n"
            "integration.\n"
        )
    return text


# ---------------------------------------------------------------- page


LOCKING = [0.3, 0.4, 0.45, 0.48, 0.49, 0.495, 0.499]


CLAMPED_M = 0.002


def deflection(clamp_m, nu):
    """The converged static deflection, with its error and the levels that it was found on."""
    return next(entry for entry in CONVERGED["deflections"]
                if (entry["clamp_m"], entry["poisson_ratio"]) == (clamp_m, nu))


def deflections():
    """The static deflections of the pin by Poisson's ratio, from tests/verification/locking.rs."""
    printed = subprocess.run(
        ["cargo", "test", "--release", "--test", "mechanics", "--", "--ignored", "--nocapture", "deflections_for_the_page"],
        cwd=runs.ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    lines = [line.split("deflections ")[1].split() for line in printed.splitlines() if "deflections 0" in line]
    return {float(nu): [float(x) for x in found] for nu, *found in lines}


def locking_page():
    """What the elements do near ν = 1/2: the static deflection, and mu* on two meshes."""
    found = deflections()
    rows = runs.sweep({"name": "accuracy-locking", "scene": {"clamp": {"width_m": 0.001}},
                       "grid": {"elements": [[12, 15, 10], [24, 30, 20]], "poisson_ratio": LOCKING, "omega_rpm": [7, 35]}}, "scans.db")
    by_place = {(tuple(row["elements"]), row["poisson_ratio"], row["omega_rpm"]): row for row in rows}

    def line(nu):
        draft, standard = found[nu]
        converged = deflection(CLAMPED_M, nu)
        cells = [nu, f"{1e6 * converged['value']:.3f}", signed(draft / converged["value"] - 1, 1),
                 signed(standard / converged["value"] - 1, 1)]
        for speed in [7, 35]:
            pair = [by_place[elements, nu, speed] for elements in [(12, 15, 10), (24, 30, 20)]]
            cells += [f"{row['mu_star']:.4f}" for row in pair] + [signed(pair[0]["mu_star"] / pair[1]["mu_star"] - 1)]
        return cells

    header = ["ν", "deflection, converged [µm]", "its error on 12 × 15 × 10", "on 24 × 30 × 20"] + [
        cell for speed in [7, 35] for cell in [f"μ\\*, {speed} rpm, 12 × 15 × 10", "24 × 30 × 20", "difference"]]
    return runs.table(header, [line(nu) for nu in LOCKING])


def locking_source():
    """Where the converged deflections come from."""
    own = deflection(CLAMPED_M, 0.3)
    last = own["levels"][-1]
    error = max(entry["error"] / entry["value"] for entry in CONVERGED["deflections"])
    return ("The converged deflections are from an independent assembly (`scripts/peers/lagrange.py`): elements of order "
            f"{last['order']} on\nmeshes that are graded towards the edges of the clamp, with {last['unknowns']} unknowns of half the pin. Its last "
            f"refinement changes them by {percent(error, 2)}\nat most. With trilinear elements on 12 × 15 × 10 it gives what this program gives, to six digits.")


def locking_words():
    """The errors of the elements at ν = 0.3 with both clamps, and how they grow with ν."""
    def errors(clamp_m, nu):
        entry = deflection(clamp_m, nu)
        return [value / entry["value"] - 1 for value in entry["trilinear_m"]]

    usual, narrow = errors(CLAMPED_M, 0.3), errors(0.001, 0.3)
    threshold, near = (errors(CLAMPED_M, nu)[0] / usual[0] for nu in (0.48, 0.495))
    value = deflection(0.001, 0.3)["value"]
    return (f"With the clamp of 1 mm and ν = 0.3 the converged deflection is {1e6 * value:.3f} µm, and the two meshes are off by "
            f"{signed(narrow[0], 1)} and {signed(narrow[1], 1)}.\nThese errors come from the edge of the clamp, where stresses are singular: "
            "the error falls with first order only, with other elements, too.\n"
            f"On 12 × 15 × 10 the error is {threshold:.1f} times as large at ν = 0.48 as at 0.3, and {near:.1f} times at 0.495.")


def again(number):
    """Runs a preset with one mesh again at all speeds. Ends with `DIFFERS` if a μ* is not the one in the page's table."""
    database = runs.empty_database("again.db")
    names = [preset["name"] for preset in json.loads(runs.tribosweep("presets", "--json"))["presets"] if not preset["accuracy"]]
    name = names[number % len(names)]
    lines = parts("accuracy")["accuracy"].split("| ω [rpm] | μ\\*, limit |")[1].splitlines()
    column = [cell.strip() for cell in lines[0].split("|")].index(f"μ\\*, `{name}`") + 3
    rows = [[cell.strip() for cell in line.split("|")] for line in lines[2:2 + len(SPEEDS)]]
    kept = {f"{row[1]} rpm": row[column].split()[0] for row in rows}
    found = cases(runs.sweep(preset_study(name, preset=name), database))
    texts = {f"{case['omega_rpm']:g} rpm": "" if case["mu_star"] is None else f"{case['mu_star']:.4f}" for case in found}
    print(f"`{name}`: {', '.join(f'μ* {text} at {speed}' for speed, text in texts.items())}")
    runs.end_again("accuracy", number % len(names), len(names), runs.differences(f"`{name}`, μ*", kept, texts))


def main():
    if sys.argv[1:2] == ["again"]:
        again(int(sys.argv[2]))
    runs.build()
    evidence = measure_presets()
    work, jobs = work_page()
    early = early_page(jobs)
    convergence = mesh_page()
    scans = scans_page()
    locking = locking_page()
    runs.write("accuracy", page(evidence, work, early, convergence, scans, locking))


def page(evidence, work, early, convergence, scans, locking):
    return f"""# Accuracy

Written by `scripts/accuracy.py`; do not edit. All jobs use μ = 0.4 and the reference scene, with β_R = 50 ns unless
another damping is given (the default was 50 ns when this was measured, and is 27.5 ns now). Where a 6 × 8 × 5 mesh takes
part, the clamp is 2 mm wide instead of 1 mm, because a clamp must be a whole number of elements wide.

## Presets in the reference scene

The presets that have one mesh, against limits that two other discretisations confirm. [mesh_errors.md](mesh_errors.md) has their errors over many scenes.

{presets_page(evidence)}
The errors of μ\\* are against the limit of fine meshes, which comes from {evidence['reference']['mu_star_source']}.
Those of f and shares are against {mesh(MEASURE['elements'])} elements (safety factor {MEASURE['safety_factor']}, the last 40 % of 9 ms). That mesh itself is off by up to
{percent(max(limit_error(case, case) for case in evidence['reference']['cases']), 1)} in μ\\* (last but one column). The limits are known at these four speeds only, and
where two limit cycles are near each other (μ = 0.5 and 4 rpm) the three discretisations differ by 10 %, because they are on different ones.

## The settings of figure7

With β_R = 50 ns; the limits of fine meshes are not known at its own 27.5 ns.
{figure7_page(evidence)}
## Error against run time

12 rpm, clamp 2 mm. The time is the solver time of single jobs that ran one after another. β₂ > ½ is damping by the
integrator, β_R = (β₂ − ½) Δt ([theory.md](theory.md#time-scheme)). Where it makes the sum of both 5·10⁻⁸ s, the row is equal to those of this
damping (β₂ = 0.58333 at 0.6 µs); the other rows show mostly the difference between two dampings.

{work}
## What stopping early changes

{early}
## Convergence with the mesh

{convergence}
## Step and damping at 7 rpm: two limit cycles?

12 × 15 × 10 elements, clamp 2 mm, the last 40 % of 12 ms. Two neighbours in a table are on different limit cycles when the
frequency changes by more than {percent(SUDDEN, 0)} between them.

{scans}
## Poisson's ratio near ½

Fully integrated trilinear elements are too stiff for a nearly incompressible body (volumetric locking). The deflection is
the mean displacement of the base in y under the loads of steady sliding, without dynamics (clamp 2 mm);
`tests/verification/locking.rs` computes it. μ\\* is that of the reference scene (clamp 1 mm) with the
usual settings.

{locking_source()}

{locking}
{locking_words()} The difference of μ\\* between
the two meshes is two to three times as large at 0.48; beyond, the meshes are also on different limit cycles, so a small difference
there means nothing. `validate`, `submit` and `run` warn from ν = 0.48 on. A finer mesh helps; the elements themselves stay as they are.

## Clean order

Three levels of refinement give an order when the differences of the figure have one sign, exceed twice their standard
error over cycles, and the order is within 0.5 … 3; with a fourth level the order of the three coarser must be within 0.5 of it.
Then the figure is extrapolated (Richardson), and the size of the correction is its uncertainty. Otherwise the value of the
finest level is used, and the last difference is its uncertainty. Errors below the uncertainty of the reference and the
standard errors are not resolved (`≤`).

## Not verified

* Errors at other friction coefficients, loads, materials and clamps. The presets are measured at μ = 0.4 on one scene.
* The state at β_R → 0: on the meshes of [choices.md](choices.md#without-damping) it does not converge.
* Uniqueness of the periodic state beyond the load ramps above: other initial states could reach other limit cycles.
* The normal stress at the edges of the contact and at the clamp: both are singular and grow with refinement.
* Aperiodic states (on 12 × 15 × 10 elements μ = 0.6 at 75 and 100 rpm): their averages have a standard error over cycles but no limit in the sense above.
* The shares of stick, slip and separation have no standard error over cycles; their resolution follows from the reference alone.
"""


if __name__ == "__main__":
    main()
