#!/usr/bin/env python3
"""Writes docs/evidence/eigenvalues.md: what the eigenvalues say about random pins, beside the end of a run of each.

    scripts/verdicts.py [--pins N] [--seed N] [--program FILE]

Every pin has a random shape, clamp, holder, law, speed, load and damping on a small mesh. `tribosweep stability` gives its modes, and
`tribosweep solve` simulates it, with the eigenvalues switched off. Where both differ, more runs find out why.
"""

import argparse
import collections
import json
import random
import subprocess

import runs

LIMIT_S = 0.2


def pin(draw):
    """A random study of one point, and what kinds it belongs to."""
    shape = draw.choice(["block", "crowned block", "tilted block", "cylinder", "tilted cylinder"])
    height = draw.uniform(0.006, 0.012)
    scene = {"pin": {"young_modulus_pa": 10 ** draw.uniform(8.7, 9.7), "poisson_ratio": round(draw.uniform(0.2, 0.42), 3)}}
    body = scene["pin"]
    if "block" in shape:
        body["size_m"] = [round(draw.uniform(0.006, 0.014), 5), round(draw.uniform(0.006, 0.016), 5), round(height, 5)]
        body["elements"] = draw.choice([[4, 5, 4], [5, 6, 4], [6, 6, 5]])
    else:
        width = round(draw.uniform(0.006, 0.012), 5)
        body.update(shape="cylinder", diameter_m=width, size_m=[width, width, round(height, 5)])
        body["elements"] = draw.choice([[4, 4, 3], [4, 4, 4], [6, 6, 4]])
    if "tilted" in shape:
        body["tilt_x_deg"] = round(draw.uniform(0.005, 0.05), 4)
    if "crowned" in shape:
        body["base"] = {"crown_radius_m": round(draw.uniform(1, 10), 2)}
    side = draw.choice(["whole_top", "inner_side", "leading_end", "both_sides", "both_ends"])
    if shape not in ("block", "crowned block"):
        side = "whole_top"
    scene["clamp"] = {"side": side}
    if side != "whole_top":
        axis = 0 if side in ("inner_side", "both_sides") else 1
        scene["clamp"]["width_m"] = body["size_m"][axis] / body["elements"][axis]
    law = draw.choice(["coulomb", "coulomb", "regularised", "static_kinetic", "exponential"])
    mu = round(draw.uniform(0.05, 0.7), 3)
    contact = {"mu": mu, "law": law}
    if law in ("static_kinetic", "exponential"):
        contact["mu_static"] = round(mu * draw.uniform(1.0, 1.4), 3)
    if law in ("regularised", "exponential"):
        contact["speed_m_s"] = round(10 ** draw.uniform(-2.5, -0.5), 5)
    scene["contact"] = contact
    holder = "ideal"
    if draw.random() < 0.25 and "tilted" not in shape:
        holder = "holder"
        scene["holder"] = {"mass_kg": round(draw.uniform(0.02, 0.3), 3), "stiffness_y_n_m": round(10 ** draw.uniform(5.5, 7), 0),
                           "damping_y_n_s_m": round(10 ** draw.uniform(0.5, 2), 1)}
    scene["disk"] = {"omega_rpm": round(10 ** draw.uniform(0.3, 2.3), 2)}
    scene["load"] = {"force_n": round(draw.uniform(5, 60), 1), "ramp_s": 5e-4}
    damping = draw.choice([0, 2e-8, 5e-8, 2e-7, 1e-6])
    study = {"scene": scene, "numerics": {"beta_r_s": damping},
             "run": {"limit_s": LIMIT_S}, "stability": "simulate"}
    return study, {"shape": shape, "clamp": side, "law": law, "holder": holder, "damping": f"{damping:g} s"}


def call(arguments, program):
    return subprocess.run([program, *arguments], cwd=runs.WORK, capture_output=True, text=True)


def modes(path, program):
    """The modes of the point, the fastest growing first; none and the reason if there is no equilibrium."""
    done = call(["--db", "verdicts.db", "stability", path, "--json", "--no-thresholds", "--modes", "12", "--replace",
                 "--out", "verdicts-report"], program)
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    return lines, "" if lines else (done.stderr.strip().splitlines() or ["no mode"])[-1]


def simulate(path, program, **settings):
    done = call(["solve", path, "--json", *runs.set_arguments(settings)], program)
    if not done.stdout:
        return None, done.stderr.strip().splitlines()[0]
    return json.loads(done.stdout), ""


def of_modes(found):
    if not found:
        return "no modes"
    if found[0]["growth_rate_per_s"] > 0:
        return "unstable"
    return "stable" if found[0]["above_band"] in ("nothing", "damped") else "no mode in the band grows"


def vibrates(record):
    """Whether the run ended in a vibration that does not decay: none if its end says neither."""
    if record["status"] == "decayed":
        return False
    if record["status"] == "periodic" or record["regime"] not in ("stable", "undecided"):
        return True
    return None


def explained(verdict, found, record, path, program):
    """Why both differ, from further runs; empty if nothing explains it."""
    lead = found[0]
    rate = lead["growth_rate_per_s"]
    if verdict == "unstable":
        if rate * record["simulated_s"] < 12:
            return f"grows by exp({rate * record['simulated_s']:.1f}) in the run, which ends before"
        longer, _ = simulate(path, program, stop_early="false", average_last_fraction=0.2)
        if longer is not None and vibrates(longer):
            return "vibrates in a run that is not stopped early"
        step, _ = simulate(path, program, safety_factor=0.1)
        if step is not None and vibrates(step):
            return "vibrates with an eighth of the time step: the step damps the mode"
        return ""
    softly, _ = simulate(path, program, ramp_s=0.1 * LIMIT_S, limit_s=2 * LIMIT_S)
    if softly is not None and vibrates(softly) is False:
        return "both exist: with a ramp of 20 ms instead of 0.5 ms the run decays"
    frequency = record["frequency_hz"]
    if verdict != "stable" and frequency is not None and frequency > lead["band_hz"]:
        return "vibrates above the band, where nobody looked, and the table says so"
    study = json.loads((runs.WORK / path).read_text())
    if study["scene"]["contact"]["law"] == "static_kinetic":
        # Modes of this law are those of Coulomb's, because no node sticks in small vibrations about sliding.
        del study["scene"]["contact"]["mu_static"]
        study["scene"]["contact"]["law"] = "coulomb"
        (runs.WORK / f"coulomb-{path}").write_text(json.dumps(study))
        coulomb, _ = simulate(f"coulomb-{path}", program)
        if coulomb is not None and vibrates(coulomb) is False:
            return "both exist: with Coulomb's law, which has the same modes, the run decays; static friction holds the cycle"
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pins", type=int, default=100)
    parser.add_argument("--seed", type=int, default=37)
    parser.add_argument("--program", default=None, help="a program that is built already")
    options = parser.parse_args()
    if options.program is None:
        runs.build()
    runs.WORK.mkdir(parents=True, exist_ok=True)
    program = options.program or runs.PROGRAM
    draw = random.Random(options.seed)
    counts = collections.Counter()
    known = collections.Counter()
    kinds = collections.defaultdict(collections.Counter)
    differences = []
    number = 0
    while number < options.pins:
        study, kind = pin(draw)
        number += 1
        study["name"] = f"verdict-{number}"
        path = f"{study['name']}.json"
        (runs.WORK / path).write_text(json.dumps(study, indent=1))
        record, refusal = simulate(path, program)
        if record is None:
            # A clamp or a law that does not fit the mesh; another pin takes its place.
            print(f"{number}: refused: {refusal}", flush=True)
            number -= 1
            continue
        found, reason = modes(path, program)
        verdict = of_modes(found)
        end = {True: "vibrates", False: "decays", None: "open at its limit"}[vibrates(record)]
        counts[verdict, end] += 1
        for name, value in kind.items():
            kinds[name][value] += 1
        if found:
            known[found[0]["above_band"]] += 1
        differs = (verdict == "unstable" and end == "decays") or (
            verdict in ("stable", "no mode in the band grows") and end == "vibrates")
        print(f"{number}: {kind}: {verdict}, the run {end}{' ' + reason if reason else ''}", flush=True)
        if differs:
            why = explained(verdict, found, record, path, program)
            lead = found[0]
            differences.append([number, kind["shape"], kind["clamp"], kind["law"], kind["damping"],
                                f"{verdict}: {lead['frequency_hz'] / 1000:.1f} kHz, {lead['growth_rate_per_s']:.0f} 1/s",
                                f"{end}" + (f" at {record['frequency_hz'] / 1000:.1f} kHz" if record["frequency_hz"] else ""),
                                why or "**not explained**"])
            print(f"    {differences[-1]}", flush=True)
    page(number, options.seed, counts, known, kinds, differences)


def page(pins, seed, counts, known, kinds, differences):
    ends = ["vibrates", "decays", "open at its limit"]
    verdicts = ["unstable", "stable", "no mode in the band grows", "no modes"]
    table = runs.table(["the eigenvalues say", *(f"the run {end}" for end in ends)],
                       [[name, *(counts[name, end] for end in ends)] for name in verdicts])
    drawn = runs.table(["what is drawn", "how often"],
                       [[name, ", ".join(f"{value} {count}" for value, count in sorted(values.items()))]
                        for name, values in kinds.items()])
    words = {"nothing": "all modes of the mesh were looked for", "damped": "damping wins above the band, by an estimated bound",
             "not_looked_at": "nobody looked above the band"}
    above = runs.table(["above the band", "pins"], [[words.get(name, name), count] for name, count in sorted(known.items())])
    unexplained = sum("not explained" in line[-1] for line in differences)
    header = ["pin", "shape", "clamp", "law", "β_R", "eigenvalues", "run", "why"]
    listed = runs.table(header, differences) if differences else "There is none.\n"
    runs.write("verdicts", PAGE.format(
        pins=pins, seed=seed, limit_ms=round(1000 * LIMIT_S), table=table, drawn=drawn, above=above,
        differences=len(differences), listed=listed, unexplained=unexplained))


PAGE = """# Verdicts of eigenvalues beside runs

Written by `scripts/verdicts.py`; do not edit. [eigenvalues.md](eigenvalues.md#what-is-known-above-the-band) says what the verdicts claim.

{pins} random pins (seed {seed}) on small meshes, each once in `tribosweep stability` and once in a run of up to {limit_ms} ms without eigenvalues.

{drawn}
{table}
*Unstable*: a mode grows. *Stable*: none grows, and none can above the band. *Vibrates*: the run ends in a limit cycle or in a motion with
stick or separation. *Open*: the run reached its limit while it slipped everywhere, growing or decaying.

{above}
## Where both differ

{differences} pins. Not explained: {unexplained}.

{listed}"""


if __name__ == "__main__":
    main()
