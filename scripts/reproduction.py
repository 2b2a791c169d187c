#!/usr/bin/env python3
"""Writes docs/reproduction.md: the figures of the paper beside ours, for its reference job, with our pictures.

Runs `inspect` at mu = 0.4, 7 rpm of studies/figure7.json, on the mesh of that study and on the draft's, and its overlay
over the speeds of the paper's Figure 8. What the paper shows and the words of the comparison are written here; every number
of ours is computed.
"""

import csv
import json
import shutil

import runs

STUDY = str(runs.ROOT / "studies" / "figure7.json")
SPEEDS = [2, 4, 6, 7, 15, 35]
PICTURES = runs.ROOT / "docs" / "reproduction"
SHOWN = ["figure2a", "figure2b", "figure3a", "figure3b", "figure4", "figure5", "wave"]
UM, US, MM_S, MPA = 1e6, 1e6, 1e3, 1e-6


def inspect(name, *settings):
    """What `inspect` finds, from its folder in the work folder."""
    folder = runs.WORK / "reproduction" / name
    runs.tribosweep("inspect", STUDY, "omega_rpm=7", "mu=0.4", *settings, "--out", str(folder))
    return folder, json.loads((folder / "inspection.json").read_text())


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def instants(node):
    """Name -> (time, stress, velocity relative to the disk) of a node's instants."""
    return {name: values for name, *values in node["instants"]["at"]}


def direction(delay_s, length_m=0.015):
    """A wave in words."""
    towards = "rear to front" if delay_s < 0 else "front to rear"
    return f"{towards} in {abs(delay_s) * US:.0f} µs ({length_m / abs(delay_s):.0f} m/s)"


def overlay():
    """A line of the table for each speed: what the front centre does in one cycle."""
    folder = runs.WORK / "reproduction" / "overlay"
    speeds = ",".join(map(str, SPEEDS))
    runs.tribosweep("inspect", STUDY, "mu=0.4", "--overlay", f"omega_rpm={speeds}", "--node", "front_centre",
                    "--out", str(folder))
    of = {}
    for row in rows(folder / "figure8_front_centre.csv"):
        of.setdefault(row["job"], []).append(row)
    found = []
    for speed, history in zip(SPEEDS, of.values()):
        times = [float(row["since_cycle_begin_s"]) for row in history]
        # One and a half cycles are shown; shares are those of one.
        cycle = [row for row, time in zip(history, times) if time < times[-1] / 1.5]
        stick = [row for row in cycle if row["state"] == "stick"]
        tau = [float(row["tau_y_pa"]) for row in stick]
        sigma = [float(row["sigma_n_pa"]) for row in cycle]
        peak = max(range(len(sigma)), key=sigma.__getitem__)
        found.append({
            "omega": speed,
            "peak": max(sigma) * MPA,
            "peak_state": cycle[peak]["state"],
            "tau": (min(tau) * MPA, max(tau) * MPA) if tau else None,
            "stick": len(stick) / len(cycle),
            "separated": sum(row["state"] == "separated" for row in cycle) / len(cycle),
            "ratio": sum(float(row["mu_eq"]) for row in stick) / len(stick) if stick else None,
        })
    shutil.copy(folder / "figure8_front_centre.svg", PICTURES / "figure8.svg")
    return found


def increases(values):
    return all(a < b for a, b in zip(values, values[1:]))


def page():
    PICTURES.mkdir(parents=True, exist_ok=True)
    folder, fine = inspect("fine")
    _, draft = inspect("draft", "--preset", "draft")
    for name in SHOWN:
        shutil.copy(folder / f"{name}.svg", PICTURES / f"{name}.svg")
    record = fine["record"]
    front, rear = fine["nodes"]
    at, behind = instants(front), instants(rear)
    speeds = overlay()
    face, waves = fine["face"], fine["waves"]
    coarse_front, coarse_rear = draft["nodes"]
    disk = front["target_velocity_m_s"] * MM_S
    elements = " × ".join(map(str, fine["job"]["scene"]["pin"]["elements"]))
    draft_elements = " × ".join(map(str, draft["job"]["scene"]["pin"]["elements"]))

    def span(a, b):
        return f"{(at[b][0] - at[a][0]) * US:.1f} µs"

    def picture(name, text):
        return f"![{text}](reproduction/{name}.svg)\n\n"

    low = [row for row in speeds if row["omega"] <= 6]
    high = [row for row in speeds if row["omega"] >= 6]
    figure8 = runs.table(
        ["ω [rpm]", "largest σ_n [MPa], in", "τ_y while it sticks [MPa]", "mean μ_eq while it sticks", "stick", "separated"],
        [[f"{row['omega']}", f"{row['peak']:.2f}, {row['peak_state']}",
          f"{row['tau'][0]:.2f}–{row['tau'][1]:.2f}" if row["tau"] else "–",
          f"{row['ratio']:.3f}" if row["ratio"] is not None else "–", f"{row['stick']:.2f}", f"{row['separated']:.2f}"]
         for row in speeds],
    )

    def yes(fact, agrees, differs):
        return agrees if fact else differs

    all_forward = all(delay is not None and delay < 0 for delay in waves.values())
    return (
        "# The paper's figures beside ours\n\n"
        "Written by `scripts/reproduction.py`; do not edit. Paper: Baillet, d'Errico, Berthier, *Influence of sliding\n"
        "contact local dynamics on macroscopic friction coefficient variation*, Revue européenne des éléments finis 14\n"
        "(2005) 305–321. Its reference job is μ = 0.4, 7 rpm, 30 N. Ours is\n\n"
        "```sh\ntribosweep inspect studies/figure7.json omega_rpm=7 mu=0.4\n```\n\n"
        f"on {elements} elements and a rigid disk; where the mesh matters the same on {draft_elements} (`--preset draft`) is\n"
        "told. Times are those of the pictures: microseconds since the begin of what is shown. The paper's node 1 is at the\n"
        "front of the contact and node 2 at the rear; ours are the centres of the front and the rear edge. Claims about\n"
        "many jobs are in [physics.md](physics.md).\n\n"

        "## Figure 1: the model\n\n"
        "The same pin, disk, material and load. Which two lines of the top are held the paper does not say: here 1 mm at the\n"
        "inner side, and the top stays plane. The paper's disk is elastic with a time step of 5.5·10⁻⁸ s; ours is rigid, with\n"
        f"{record['time_step_s']:.1e} s, which [elastic_disk.md](elastic_disk.md) shows to change the frequency by 0.6 % and μ*\n"
        "by 1.5 % at most.\n\n"

        "## Figure 2a: displacements and velocity of node 1\n\n" + picture("figure2a", "Displacements and velocity")
        + f"**Agrees:** the y displacement is a saw-tooth of {front['peak_to_peak_m'][1] * UM:.1f} µm (paper: 2 µm): slow with the\n"
        f"disk while the node sticks, and back faster. The node leaves the disk once a cycle, by {front['lift_max_m'] * UM:.2f} µm\n"
        f"({coarse_front['lift_max_m'] * UM:.2f} µm on the draft's mesh; paper: 0.15 µm), and the rear by {rear['lift_max_m'] * UM:.2f} µm.\n"
        f"**Differs:** the frequency is {front['frequency_hz']:.0f} Hz instead of about 14 500 Hz, 1.08 times the paper's. In contact\n"
        "the paper's node is at z ≤ −1 µm, ours at 0, the surface of a rigid disk that begins where the pin does.\n\n"

        "## Figure 2b: the equivalent friction coefficient\n\n" + picture("figure2b", "Equivalent friction coefficient")
        + "**Agrees:** node 1 goes through slip, stick, slip and separation in every cycle. While it slips μ_eq is 0.4\n"
        f"(within {front['slip_friction_error']:.0e}), while it sticks its velocity is the disk's {disk:.0f} mm/s (within\n"
        f"{front['stick_speed_error_m_s']:.0e} m/s), and 0 means separation. The shares of stick, slip and separation are "
        f"{front['shares'][0]:.2f}, {front['shares'][1]:.2f} and\n{front['shares'][2]:.2f} at the front, {rear['shares'][0]:.2f}, "
        f"{rear['shares'][1]:.2f} and {rear['shares'][2]:.2f} at the rear. Both have the same frequency: {front['frequency_hz']:.0f} and\n"
        f"{rear['frequency_hz']:.0f} Hz. The front sticks in two parts, with a short slip in between that the paper does not show.\n\n"

        "## Figure 3a: trajectories in the y–z plane\n\n" + picture("figure3a", "Trajectories")
        + f"**Agrees in part:** the paper's loops all go in the trigonometric direction. Of ours {face['counter_clockwise']} of the\n"
        f"{face['separating']} nodes that separate do (y to the right, z upwards); {face['nodes'] - face['separating']} of {face['nodes']} "
        f"nodes never leave the disk\nand have no loop on a rigid one. On the draft's mesh it is {draft['face']['counter_clockwise']} of "
        f"{draft['face']['separating']}. The others are narrow loops near the front, where the\nnode comes back to the disk moving forward.\n"
        f"**Differs:** the largest separation is {face['lift_max_m'] * UM:.2f} µm ({draft['face']['lift_max_m'] * UM:.2f} µm on the draft's "
        "mesh; paper: about 0.3 µm), at a corner.\n\n"

        "## Figure 3b: phase planes\n\n" + picture("figure3b", "Phase planes")
        + f"**Agrees:** the horizontal part at {disk:.0f} mm/s is stick, and slip and separation are below it. Relative speeds are\n"
        f"several times the disk's: up to {front['relative_speed_max_m_s'] * MM_S:.0f} mm/s at the front and "
        f"{rear['relative_speed_max_m_s'] * MM_S:.0f} mm/s at the rear. When contact occurs the rear\ncomes with "
        f"{abs(behind['t_A'][2]) * MM_S:.0f} mm/s (paper: about 210), much faster than the front.\n"
        f"**Differs:** our front comes with {abs(at['t_A'][2]) * MM_S:.0f} mm/s, the velocity of its first step in contact, and with "
        f"{abs(before_contact(folder)) * MM_S:.0f} mm/s the step\nbefore (paper: about 70).\n\n"

        "## Figure 4: one cycle of node 1\n\n" + picture("figure4", "One cycle")
        + "**Agrees:** the order. Contact begins at t_A; stick from t_B to t_D, with the largest stress at t_C within it; then\n"
        f"slip until contact ends at t_E, and separation until t_F. They last {span('t_A', 't_B')}, {span('t_B', 't_D')}, "
        f"{span('t_D', 't_E')} and {span('t_E', 't_F')}. Before it separates\nthe node slips with up to "
        f"{front['instants']['slip_before_separation_m_s'] * MM_S:.0f} mm/s (paper: about 180).\n"
        f"**Differs:** the stress at t_C is {front['instants']['peak_pa'] * MPA:.2f} MPa "
        f"({coarse_front['instants']['peak_pa'] * MPA:.2f} MPa on the draft's mesh; paper: 0.5 MPa). At an edge it\ngrows with "
        "refinement, as under the edge of a punch; a value at this node says as much of the mesh as of the contact. At the\n"
        f"rear, which is not the edge that the friction presses down, it is {rear['sigma_n_max_pa'] * MPA:.2f} and "
        f"{coarse_rear['sigma_n_max_pa'] * MPA:.2f} MPa.\n\n"

        "## Figure 5: four snapshots\n\n" + picture("figure5", "Snapshots")
        + "**Agrees:** the coupling that the paper describes. As node 1 comes into contact the front moves down, opposed to z;\n"
        "after the largest stress the field turns, the face slips from the rear on, and separation reaches the front last.\n\n"
        + picture("wave", "Waves along the middle of the contact face")
        + f"{yes(all_forward, 'All changes travel as the paper says, from the rear to the front', 'Not all changes travel as in the paper, from the rear to the front')}: "
        f"contact comes from\n{direction(waves['contact_s'])}, stick from {direction(waves['stick_s'])}, its end from\n"
        f"{direction(waves['slip_s'])} and separation from {direction(waves['separation_s'])},\nalong the middle of the face where nodes have "
        "that change (the nodes in its middle do not separate).\n\n"

        "## Figure 6: forces far from the contact\n\n"
        f"T at the clamp and N of the contact over cycles and over the run are in `totals.svg`. μ* = ⟨T⟩/⟨F⟩ = {record['mu_star']:.4f} at the\n"
        f"clamp and {record['mu_star_contact']:.4f} from the contact forces, at a local coefficient of 0.4.\n\n"

        "## Figure 7: μ* against the disk's speed\n\n"
        "The picture of the README; see [physics.md](physics.md). **Agrees:** stable up to μ = 0.2, the minimum near 6 rpm, the\n"
        "regimes and their order, μ* → μ from below. Below the minimum μ* falls with ω, as the paper explains it, and not as\n"
        "one of its sentences says.\n\n"

        "## Figure 8: stresses at node 1 and the disk's speed\n\n"
        "```sh\ntribosweep inspect studies/figure7.json --overlay omega_rpm=2,4,6,7,15,35 --node front_centre\n```\n\n"
        + picture("figure8", "Stresses at the front centre for six speeds") + figure8
        + "\n"
        + yes(increases([row["peak"] for row in low]), "**Agrees:** up to 6 rpm the largest normal stress grows with ω, ",
              "**Differs:** up to 6 rpm the largest normal stress does not grow with ω, ")
        + yes(all(row["peak_state"] == "stick" for row in low), "and is reached while the node sticks.\n",
              "but is not reached while the node sticks at each of these speeds.\n")
        + yes(increases([-row["ratio"] for row in low]), "Their ratio while it sticks falls with ω, which is what lowers μ*.\n",
              "**Differs:** the ratio of tangential and normal stress at this node while it sticks does not fall from speed to speed;\n"
              "what lowers μ* is the whole face (the identity in physics.md).\n")
        + yes(increases([-row["stick"] for row in high]) and increases([row["separated"] for row in high]),
              "Above 6 rpm stick becomes shorter and separation longer with every speed.\n",
              "Above 6 rpm stick becomes shorter and separation longer, but not at this node from every speed to the next.\n")
    )


def before_contact(folder):
    """Velocity of the front relative to the disk in the last step before t_A."""
    start = next(float(row["time_s"]) for row in rows(folder / "instants.csv")
                 if row["node"] == "front_centre" and row["instant"] == "t_A")
    earlier = [row for row in rows(folder / "node_front_centre.csv") if float(row["time_s"]) < start]
    node = json.loads((folder / "inspection.json").read_text())["nodes"][0]
    return float(earlier[-1]["y_velocity_m_s"]) - node["target_velocity_m_s"]


if __name__ == "__main__":
    runs.build()
    runs.write("reproduction.md", page())
