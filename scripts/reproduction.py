#!/usr/bin/env python3
"""Writes docs/evidence/paper.md: compares the figures of the paper with ours, for its reference job, with our pictures.

Runs `inspect` at mu = 0.4, 7 rpm of studies/figure7.json, on the mesh of that study and on the draft's, and its overlay
over the speeds of the paper's Figure 8. What the paper shows and the words of the comparison are written here; every number
of ours is computed.
"""

import csv
import json
import shutil

import runs

STUDY = str(runs.ROOT / "studies" / "figure7.json")
# Behind the front edge, where the stress does not grow with the mesh. The paper does not say exactly where its node 1 is.
INSIDE = "0,-6"
SPEEDS = [2, 4, 6, 7, 15, 35]
PICTURES = runs.EVIDENCE / "reproduction"
# figure3a, the trajectories of all nodes, is left out because it is large; `inspect` draws it.
SHOWN = ["figure2a", "figure2b", "figure3b", "figure4", "figure5", "wave"]
UM, US, MM_S, MPA = 1e6, 1e6, 1e3, 1e-6


def inspect(name, *settings):
    """What `inspect` finds, from its folder in the work folder."""
    folder = runs.WORK / "reproduction" / name
    nodes = [argument for node in ("front_centre", "rear_centre", INSIDE) for argument in ("--node", node)]
    runs.tribosweep("inspect", STUDY, "omega_rpm=7", "mu=0.4", *nodes, *settings, "--out", str(folder))
    return folder, json.loads((folder / "inspection.json").read_text())


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def instants(node):
    """Name -> (time, stress, velocity relative to the disk) of a node's instants."""
    return {name: values for name, *values in node["instants"]["at"]}


def wave_table(summary):
    """A line for each wave along the middle of the face."""
    words = {"contact": "contact begins", "stick": "stick begins", "slip": "stick ends", "separation": "contact ends"}
    lines = []
    for wave in summary["waves"]:
        start, end = (y * 1e3 for y in wave["from_to_m"])
        delay = wave["delay_s"]
        speed = (end - start) * 1e-3 / delay if delay else None
        lines.append([words[wave["change"]], f"{start:.1f} … {end:.1f}", f"{wave['start_s'] * US:.1f}",
                      f"{((wave['start_s'] + delay) % summary['period_s']) * US:.1f}",
                      f"{abs(speed):.0f} m/s towards the {'rear' if speed > 0 else 'front'}" if speed else "–"])
    return runs.table(["change", "y from … to [mm]", "at its first node [µs]", "at its last [µs]", "travels with"], lines)


def towards_front(summary, change):
    """Share of the length of a change's waves that runs towards the front."""
    waves = [wave for wave in summary["waves"] if wave["change"] == change]
    length = {True: 0.0, False: 0.0}
    for wave in waves:
        start, end = wave["from_to_m"]
        length[wave["delay_s"] < 0] += end - start
    return length[True] / max(sum(length.values()), 1e-12)


def judge(holds, otherwise="Differs"):
    return "**Agrees:**" if holds else f"**{otherwise}:**"


def near(value, claimed, share):
    return abs(value / claimed - 1) <= share


def overlay():
    """The lines of the table of each node: what it does in one cycle at each speed."""
    folder = runs.WORK / "reproduction" / "overlay"
    speeds = ",".join(map(str, SPEEDS))
    runs.tribosweep("inspect", STUDY, "mu=0.4", "--overlay", f"omega_rpm={speeds}", "--node", "front_centre",
                    "--node", INSIDE, "--out", str(folder))
    shutil.copy(folder / "figure8_front_centre.svg", PICTURES / "figure8.svg")
    shutil.copy(folder / "figure8_x+0.000_y-6.000mm.svg", PICTURES / "figure8_inside.svg")
    return [speeds_of(folder / f"figure8_{name}.csv") for name in ("front_centre", "x+0.000_y-6.000mm")]


def by_the_disk():
    """The largest changes of frequency and mu* by the elastic disk, in per cent of the rigid disk's."""
    rigid = {row["omega_rpm"]: row for row in runs.sweep("studies/figure7.json") if row["mu"] == 0.4}
    pairs = [(row, rigid[row["omega_rpm"]]) for row in runs.sweep("studies/figure7-elastic.json")]
    return [100 * max(abs(elastic[name] / other[name] - 1) for elastic, other in pairs) for name in ("frequency_hz", "mu_star")]


def dissipation():
    """What the damping of the time scheme changes at the reference job."""
    found = {beta2: runs.record("studies/open_damping.json", mu=0.4, omega_rpm=7, damping_beta2=beta2) for beta2 in (0.5, 0.75, 1.0)}
    lines = [[f"{beta2:g}", f"{(beta2 - 0.5) * 55:g} ns", f"{own['mu_star']:.4f}", f"{own['frequency_hz']:.0f} Hz", own["regime"].replace("_", "–")]
             for beta2, own in found.items()]
    return (
        "## Dissipation\n\n"
        "The paper's scheme has a damping of its own, with β₂ between ½ and 1. At its time step of 55 ns this is stiffness-proportional damping\n"
        "β_R = (β₂ − ½) Δt between 0 and 27.5 ns ([theory.md](theory.md#time-scheme)). Ours is that of β₂ = 1, 27.5 ns, on every mesh and with every time\n"
        "step. The reference job over the range:\n\n"
        + runs.table(["β₂ at 55 ns", "β_R", "μ\\*", "frequency", "regime"], lines)
        + "\n[choices.md](choices.md#without-damping) shows what happens on finer meshes.\n\n"
    )


def top_face():
    """What a free top changes at the reference job and at other sides of the clamp."""
    sides = ["inner_side", "outer_side", "leading_end", "trailing_end"]
    found = {(top, side): runs.record("studies/open_clamp.json", mu=0.4, omega_rpm=7, clamp_side=side, top=top)
             for side in sides for top in ("tied_in_z", "free_in_z")}

    def cell(own):
        hz = f"{own['frequency_hz']:.0f} Hz" if own["frequency_hz"] else "stable"
        return f"{hz}, {own['mu_star']:.3f}" + ("" if own["status"] != "not_periodic" else " ~")

    lines = [[side.replace("_", " "), *(cell(found[top, side]) for top in ("tied_in_z", "free_in_z"))] for side in sides]
    return (
        "## The top face\n\n"
        "The paper says that F “is applied to all the nodes of the upper surface”, and also that it reaches a value “corresponding to a uniformly\n"
        "normal displacement on the top”. The first is a top that is free in z, the second one that stays plane. Frequency and μ\\* of the reference\n"
        "job (paper: 14 500 Hz; `~`: not periodic):\n\n"
        + runs.table(["held", "plane (`tied_in_z`)", "free (`free_in_z`)"], lines)
        + "\n"
    )


def speeds_of(path):
    of = {}
    for row in rows(path):
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
    return found


def speed_table(speeds):
    return runs.table(
        ["ω [rpm]", "largest σ_n [MPa], in", "τ_y while it sticks [MPa]", "mean μ_eq while it sticks", "stick", "separated"],
        [[f"{row['omega']}", f"{row['peak']:.2f}, {row['peak_state']}",
          f"{row['tau'][0]:.2f}–{row['tau'][1]:.2f}" if row["tau"] else "–",
          f"{row['ratio']:.3f}" if row["ratio"] is not None else "–", f"{row['stick']:.2f}", f"{row['separated']:.2f}"]
         for row in speeds],
    )


def behind_the_edge(folder):
    """Ranges over the nodes 1 to 2 mm behind the front edge on the middle line: largest stress, lift and y range."""
    of = {}
    for row in rows(folder / "face.csv"):
        if abs(float(row["x_m"])) < 1e-9 and 0.00099 < float(row["y_m"]) + 0.0075 < 0.00201:
            of.setdefault(row["node"], []).append(row)
    def extent(name, scale, minus=False):
        values = [[float(row[name]) * scale for row in history] for history in of.values()]
        found = [max(v) - (min(v) if minus else 0) for v in values]
        return f"{min(found):.2f}–{max(found):.2f}"
    return extent("sigma_n_delayed_pa", MPA), extent("gap_m", UM), extent("uy_m", UM, minus=True)


def loops(folder):
    """Share of the area of all loops that the clockwise ones have."""
    of = {}
    for row in rows(folder / "face.csv"):
        of.setdefault(row["node"], []).append((float(row["uy_m"]), float(row["uz_m"])))
    areas = []
    for path in of.values():
        areas.append(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(path, path[1:] + path[:1])) / 2)
    return -sum(area for area in areas if area < 0) / sum(map(abs, areas))


def increases(values):
    return all(a < b for a, b in zip(values, values[1:]))


def page():
    PICTURES.mkdir(parents=True, exist_ok=True)
    folder, fine = inspect("fine")
    _, draft = inspect("draft", "--preset", "draft")
    for name in SHOWN:
        shutil.copy(folder / f"{name}.svg", PICTURES / f"{name}.svg")
    record = fine["record"]
    front, rear, inside = fine["nodes"]
    at, behind = instants(front), instants(rear)
    speeds, speeds_inside = overlay()
    face = fine["face"]
    coarse_front, coarse_rear, coarse_inside = draft["nodes"]
    within = instants(inside)
    sigma_range, lift_range, y_range = behind_the_edge(folder)
    disk = front["target_velocity_m_s"] * MM_S
    frequency, friction = by_the_disk()
    elements = " × ".join(map(str, fine["job"]["scene"]["pin"]["elements"]))
    draft_elements = " × ".join(map(str, draft["job"]["scene"]["pin"]["elements"]))

    def span(a, b):
        return f"{(at[b][0] - at[a][0]) * US:.1f} µs"

    def picture(name, text):
        return f"![{text}](reproduction/{name}.svg)\n\n"

    return (
        "# The paper's figures beside ours\n\n"
        "Written by `scripts/reproduction.py`; do not edit. Paper: Baillet, d'Errico, Berthier, *Influence of sliding\n"
        "contact local dynamics on macroscopic friction coefficient variation*, Revue européenne des éléments finis 14\n"
        "(2005) 305–321. Its reference job is μ = 0.4, 7 rpm, 30 N. Ours is\n\n"
        "```sh\ntribosweep inspect studies/figure7.json omega_rpm=7 mu=0.4 --node front_centre --node rear_centre --node 0,-6\n```\n\n"
        f"on {elements} elements and a rigid disk. Where the mesh matters, the value on {draft_elements} elements (`--preset draft`)\n"
        "is given as well. Times are those of the pictures: microseconds since the beginning of the time that is shown. The\n"
        "paper's node 1 is at the front of the contact and node 2 at the rear; ours are the centres of the front and the rear\n"
        "edge. Claims about many jobs are in [paper.md](paper.md). Where numbers are compared, the verdict is computed;\n"
        "pictures are compared by eye.\n\n"
        "**Where is node 1?** At the edge itself the stress grows with refinement, as under the edge of a punch. The nodes 1 to\n"
        f"2 mm behind it, on the middle line, have a largest σ_n of {sigma_range} MPa, a lift of {lift_range} µm and move in y over\n"
        f"{y_range} µm. The paper has 0.5 MPa, 0.15 µm and 2 µm: stress and range are those of these nodes. So a node 1.5 mm behind the edge\n"
        "(`0,-6`) is shown as well.\n\n"

        "## Figure 1: the model\n\n"
        "Pin, disk, material and load are the same. The paper does not say at which side the two lines of the top are held: here a strip of\n"
        "1 mm at the inner side is held, and the top stays plane. [choices.md](choices.md) has the other choices. The paper's disk is elastic with a time step of 5.5·10⁻⁸ s; ours is rigid, with\n"
        f"{record['time_step_s']:.1e} s, which [elastic_disk.md](elastic_disk.md) shows to change the frequency by {frequency:.1f} % and μ*\n"
        f"by {friction:.1f} % at most.\n\n"

        + dissipation()
        + top_face()

        + "## Figure 2a: displacements and velocity of node 1\n\n" + picture("figure2a", "Displacements and velocity")
        + f"{judge(near(front['peak_to_peak_m'][1] * UM, 2, 0.15))} the y displacement is a saw-tooth of {front['peak_to_peak_m'][1] * UM:.1f} µm (paper: 2 µm). The node\n"
        f"moves slowly with the disk while it sticks, and returns faster. The node leaves the disk once a cycle, by {front['lift_max_m'] * UM:.2f} µm\n"
        f"({coarse_front['lift_max_m'] * UM:.2f} µm on the draft's mesh; paper: 0.15 µm); behind the edge it is {inside['lift_max_m'] * UM:.2f} µm, at the rear {rear['lift_max_m'] * UM:.2f} µm.\n"
        f"**Differs:** the frequency is {front['frequency_hz']:.0f} Hz instead of about 14 500 Hz, {front['frequency_hz'] / 14500:.2f} times the paper's. In contact\n"
        "the paper's node is at z ≤ −1 µm, ours at z = 0, the surface of the rigid disk, where the base of the pin starts.\n\n"

        "## Figure 2b: the equivalent friction coefficient\n\n" + picture("figure2b", "Equivalent friction coefficient")
        + f"{judge(min(front['shares']) > 0 and list(at) == ['t_A', 't_B', 't_C', 't_D', 't_E', 't_F'])} node 1 goes through slip, stick, slip and "
        "separation in every cycle. While it slips μ_eq is 0.4\n"
        f"(within {front['slip_friction_error']:.0e}), while it sticks its velocity is the disk's {disk:.0f} mm/s (within\n"
        f"{front['stick_speed_error_m_s']:.0e} m/s), and 0 means separation. The shares of stick, slip and separation are "
        f"{front['shares'][0]:.2f}, {front['shares'][1]:.2f} and\n{front['shares'][2]:.2f} at the front, {rear['shares'][0]:.2f}, "
        f"{rear['shares'][1]:.2f} and {rear['shares'][2]:.2f} at the rear. Both have the same frequency: {front['frequency_hz']:.0f} and\n"
        f"{rear['frequency_hz']:.0f} Hz. The front sticks in two parts, with a short slip in between that the paper does not show.\n\n"

        "## Figure 3a: trajectories in the y–z plane\n\n"
        f"**Agrees in part** (`figure3a.svg`): all loops of the paper go counter-clockwise (y to the right, z upwards). Of our\n"
        f"{face['separating']} nodes that separate, {face['counter_clockwise']} do; {face['nodes'] - face['separating']} of {face['nodes']} "
        f"nodes never leave the disk\nand have no loop, because the disk is rigid. On the draft's mesh it is {draft['face']['counter_clockwise']} of "
        f"{draft['face']['separating']}. The clockwise loops are narrow: they have\n"
        f"{100 * loops(folder):.0f} % of the area of all loops.\n"
        f"**Differs:** the largest separation is {face['lift_max_m'] * UM:.2f} µm ({draft['face']['lift_max_m'] * UM:.2f} µm on the draft's "
        "mesh; paper: about 0.3 µm), at a corner.\n\n"

        "## Figure 3b: phase planes\n\n" + picture("figure3b", "Phase planes")
        + f"{judge(rear['relative_speed_max_m_s'] > 2 * disk / MM_S and abs(behind['t_A'][2]) > 2 * abs(before_contact(folder, front)))} the horizontal part at {disk:.0f} mm/s is stick, and slip and separation are below it. Relative speeds are\n"
        f"several times the disk's: up to {front['relative_speed_max_m_s'] * MM_S:.0f} mm/s at the front and "
        f"{rear['relative_speed_max_m_s'] * MM_S:.0f} mm/s at the rear. When contact begins the rear\nnode has "
        f"{abs(behind['t_A'][2]) * MM_S:.0f} mm/s (paper: about 210), much faster than the front.\n"
        f"**Differs:** in the last step before contact our front node has {abs(before_contact(folder, front)) * MM_S:.0f} mm/s and the node behind\n"
        f"the edge {abs(before_contact(folder, inside)) * MM_S:.0f} mm/s (paper: about 70).\n\n"

        "## Figure 4: one cycle of node 1\n\n" + picture("figure4", "One cycle")
        + f"{judge(within['t_B'][0] <= within['t_C'][0] <= within['t_D'][0] and at['t_B'][0] <= at['t_C'][0] <= at['t_D'][0])} the order. "
        "Contact begins at t_A; stick from t_B to t_D, with the largest stress at t_C within it; then\n"
        f"slip until contact ends at t_E, and separation until t_F. They last {span('t_A', 't_B')}, {span('t_B', 't_D')}, "
        f"{span('t_D', 't_E')} and {span('t_E', 't_F')}. Before it separates\nthe node slips with up to "
        f"{front['instants']['slip_before_separation_m_s'] * MM_S:.0f} mm/s (paper: about 180).\n"
        f"**Differs:** the stress at t_C is {front['instants']['peak_pa'] * MPA:.2f} MPa "
        f"({coarse_front['instants']['peak_pa'] * MPA:.2f} MPa on the draft's mesh; paper: 0.5 MPa). At an edge it\ngrows with "
        "refinement, as under the edge of a punch, so a value at this node depends on the mesh as much as on the contact. Behind\n"
        f"the edge it is {inside['sigma_n_max_pa'] * MPA:.2f} and {coarse_inside['sigma_n_max_pa'] * MPA:.2f} MPa on the two meshes, and at the rear "
        f"{rear['sigma_n_max_pa'] * MPA:.2f} and {coarse_rear['sigma_n_max_pa'] * MPA:.2f} MPa.\n"
        f"There, as in the paper, the node sticks when the stress is largest: t_C is {(within['t_C'][0] - within['t_B'][0]) * US:.1f} µs after t_B and\n"
        f"{(within['t_D'][0] - within['t_C'][0]) * US:.1f} µs before t_D.\n\n"

        "## Figure 5: four snapshots\n\n" + picture("figure5", "Snapshots")
        + "By eye, the snapshots show the coupling that the paper describes. When node 1 comes into contact the front moves\n"
        "down, against z. After the largest stress the velocity field turns, slip spreads from the rear, and separation reaches the\n"
        "front last.\n\n"
        + picture("wave", "Waves along the middle of the contact face")
        + wave_table(fine)
        + "\nTimes are since the beginning of the cycle. Each row of neighbouring nodes with the same change counts as one wave.\n"
        f"{judge(min(towards_front(fine, 'stick'), towards_front(fine, 'slip')) > 0.99, 'Agrees in part')} stick begins and ends later towards the "
        f"front over {100 * towards_front(fine, 'stick'):.0f} % and {100 * towards_front(fine, 'slip'):.0f} % of the length of these waves.\n"
        f"{judge(min(towards_front(fine, 'separation'), towards_front(fine, 'contact')) > 0.99, 'Agrees in part')} in the paper contact and separation run from "
        f"the rear to the front, too. Ours do so over {100 * towards_front(fine, 'contact'):.0f} % and\n"
        f"{100 * towards_front(fine, 'separation'):.0f} % of the length: the nodes in the middle of the face do not separate, and on either side of them "
        "separation runs inwards\nfrom the edge. Only the order of the two sides is from the rear to the front.\n\n"

        "## Figure 6: forces far from the contact\n\n"
        f"T at the clamp and N of the contact over cycles and over the run are in `totals.svg`. μ* = ⟨T⟩/⟨F⟩ = {record['mu_star']:.4f} at the\n"
        f"clamp and {record['mu_star_contact']:.4f} from the contact forces, at a local coefficient of 0.4.\n\n"

        "## Figure 7: μ* against the disk's speed\n\n"
        "The README shows this figure; [paper.md](paper.md) compares it with the paper claim by claim.\n\n"

        "## Figure 8: stresses at node 1 and the disk's speed\n\n"
        "```sh\ntribosweep inspect studies/figure7.json --overlay omega_rpm=2,4,6,7,15,35 --node front_centre\n```\n\n"
        + picture("figure8", "Stresses at the front centre for six speeds")
        + "The same at the node behind the edge (`--node 0,-6`):\n\n"
        + picture("figure8_inside", "Stresses behind the front edge for six speeds")
        + "At the front centre:\n\n" + speed_table(speeds) + "\nBehind the edge:\n\n" + speed_table(speeds_inside) + "\n"
        + "What the paper says of this figure, at the front centre and behind the edge:\n\n" + verdicts(speeds, speeds_inside)
    )


def verdicts(*nodes):
    """What the paper says of its Figure 8, held against the rows of some nodes."""
    def low(rows):
        return [row for row in rows if row["omega"] <= 6]

    def high(rows):
        return [row for row in rows if row["omega"] >= 6]

    claims = [
        ("up to 6 rpm the largest σ_n grows with ω", lambda rows: increases([row["peak"] for row in low(rows)])),
        ("up to 6 rpm it is reached while the node sticks",
         lambda rows: all(row["peak_state"] == "stick" for row in low(rows))),
        ("up to 6 rpm the ratio of τ to σ_n while the node sticks falls with ω",
         lambda rows: increases([-row["ratio"] for row in low(rows)])),
        ("above 6 rpm stick becomes shorter with ω", lambda rows: increases([-row["stick"] for row in high(rows)])),
        ("above 6 rpm separation becomes longer with ω", lambda rows: increases([row["separated"] for row in high(rows)])),
    ]
    lines = [[claim, *("agrees" if holds(rows) else "not at every speed" for rows in nodes)]
             for claim, holds in claims]
    return runs.table(["claim", "front centre", "behind the edge"], lines)


def before_contact(folder, node):
    """Velocity of a node relative to the disk in the last step before t_A."""
    start = next(float(row["time_s"]) for row in rows(folder / "instants.csv")
                 if row["node"] == node["name"] and row["instant"] == "t_A")
    earlier = [row for row in rows(folder / f"node_{node['name']}.csv") if float(row["time_s"]) < start]
    return float(earlier[-1]["y_velocity_m_s"]) - node["target_velocity_m_s"]


if __name__ == "__main__":
    runs.build()
    runs.write("reproduction", page())
