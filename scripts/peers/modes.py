#!/usr/bin/env python3
"""The friction modes of the reference pin in three programs: this one, an assembly with scipy, and CalculiX.

    modes.py PROGRAM [--json] [--deck FILE]
                      compares the leading mode, and ends with 1 if two of them are further apart than 2·10⁻⁵ of it
                      --deck also keeps the input of CalculiX

The pin has 12 × 15 × 10 trilinear elements, a clamp of 1 mm and μ = 0.4, slides straight ahead and has no damping. tribosweep has a lumped
mass, and CalculiX a consistent one. The assembly has both: its lumped mode must be that of tribosweep, and its consistent one that of
CalculiX. What remains is rounding, and the penalty of CalculiX: from 10⁶ to 10⁷ N/mm³ the eigenvalue moves by 2.6·10⁻⁵ of itself, so some
3·10⁻⁶ are left.

In CalculiX all nodes must slip: the plane moves by 30 mm with a soft stick slope and a slightly larger μ, and the modes follow with
`*CHANGE FRICTION` (without it the tangent is that of stick). The load is 0.3 N, so that stress stiffening plays no part. Needs numpy, scipy
and `ccx` (Debian's package calculix-ccx, 2.20).
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import LinearOperator, eigs, splu

import second

COUNTS = (12, 15, 10)
MU, CLAMP_M, LOAD_N = 0.4, 0.001, 0.3
# Hz and 1/s near which the leading mode is looked for.
NEAR = (16.0e3, 6.0e3)
WITHIN = 2.0e-5


def node(i, j, k):
    return i + (COUNTS[0] + 1) * (j + (COUNTS[1] + 1) * k)


def elements():
    """The nodes of each element, with the corners in the order of `second.CORNERS`."""
    cells = np.array([(i, j, k) for k in range(COUNTS[2]) for j in range(COUNTS[1]) for i in range(COUNTS[0])])
    return np.array([[node(*(cell + corner)) for corner in second.CORNERS] for cell in cells])


def assembled(own):
    """The matrix of all elements from that of one, 24 × 24."""
    unknowns = (3 * elements()[:, :, None] + np.arange(3)).reshape(-1, 24)
    rows, columns = np.repeat(unknowns, 24, axis=1).ravel(), np.tile(unknowns, (1, 24)).ravel()
    return sparse.csr_matrix((np.tile(own.ravel(), len(unknowns)), (rows, columns)))


def leading_mode(is_lumped):
    """Frequency [Hz] and growth rate [1/s] of the leading mode of steady sliding, and the number of nodes in contact."""
    edges = np.array(second.SIZE_M) / COUNTS
    line = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6
    corner_mass = second.DENSITY * np.prod(edges) * np.kron(np.kron(line, line), line)
    if is_lumped:
        corner_mass = np.diag(corner_mass.sum(axis=1))
    stiffness, mass = assembled(second.element_stiffness(edges)), assembled(np.kron(corner_mass, np.eye(3)))
    held = round(CLAMP_M / edges[0])
    top = [node(i, j, COUNTS[2]) for j in range(COUNTS[1] + 1) for i in range(COUNTS[0] + 1)]
    clamp = [node(i, j, COUNTS[2]) for j in range(COUNTS[1] + 1) for i in range(held + 1)]
    base = [node(i, j, 0) for j in range(COUNTS[1] + 1) for i in range(COUNTS[0] + 1)]
    count = stiffness.shape[0]
    # All nodes of the top have the z of the first one.
    first = 3 * top[0] + 2
    tie = sparse.identity(count, format="lil")
    for own in top[1:]:
        tie[3 * own + 2, 3 * own + 2], tie[3 * own + 2, first] = 0.0, 1.0
    tied = {3 * own + 2 for own in top[1:]} | {3 * own + c for own in clamp for c in (0, 1)}
    contact = list(base)
    while True:
        gone = tied | {3 * own + 2 for own in contact}
        free = np.array([number for number in range(count) if number not in gone])
        into = tie.tocsc()[:, free]
        # A node that slips has the friction μN along +y, and N is the force in z that holds it.
        slips = sparse.identity(count, format="lil")
        for own in contact:
            slips[3 * own + 1, 3 * own + 2] = -MU
        out = (tie.tocsr().T @ slips.tocsr())[free]
        matrix, of_mass = (out @ stiffness @ into).tocsc(), (out @ mass @ into).tocsc()
        force = np.zeros(count)
        force[first] = -LOAD_N
        u = into @ splu(matrix).solve((out @ force))
        pressing = {own: (stiffness @ u)[3 * own + 2] for own in contact}
        lifted = [own for own in contact if pressing[own] < 0]
        if not lifted:
            break
        contact = [own for own in contact if own not in lifted]
    # (K + s² M) u = 0 near s = σ + iω.
    near = -((NEAR[1] + 2j * np.pi * NEAR[0]) ** 2)
    factors = splu((matrix - near * of_mass).tocsc().astype(complex))
    inverse = LinearOperator(matrix.shape, matvec=lambda x: factors.solve(of_mass @ x), dtype=complex)
    values = near + 1 / eigs(inverse, k=4, v0=np.ones(matrix.shape[0], dtype=complex), return_eigenvectors=False)
    roots = np.sqrt(-values.astype(complex))
    roots = np.where(roots.imag < 0, -roots, roots)
    best = roots[roots.real.argmax()]
    return best.imag / (2 * np.pi), best.real, len(contact)


def deck():
    """The input of CalculiX, in mm, N, t and MPa."""
    lines = ["*NODE, NSET=PIN"]
    for k in range(COUNTS[2] + 1):
        for j in range(COUNTS[1] + 1):
            for i in range(COUNTS[0] + 1):
                place = [1e3 * size * at / count for size, at, count in zip(second.SIZE_M, (i, j, k), COUNTS)]
                lines.append(f"{node(i, j, k) + 1}," + ",".join(f"{x:.9g}" for x in place))
    plane = 10**6
    corners = [(-60, -60), (60, -60), (60, 60), (-60, 60)]
    lines += ["*NODE, NSET=PLANE"] + [f"{plane + 4 * (z == 0) + own},{x},{y},{z}" for z in (-5, 0) for own, (x, y) in enumerate(corners)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=EPIN")
    # CalculiX goes round the lower face and then round the upper one.
    around = [0, 4, 6, 2, 1, 5, 7, 3]
    lines += [f"{number + 1}," + ",".join(str(own[at] + 1) for at in around) for number, own in enumerate(elements())]
    lines += ["*ELEMENT, TYPE=C3D8, ELSET=EPLANE", f"{plane}," + ",".join(str(plane + own) for own in range(8))]
    lines += ["*MATERIAL, NAME=PIN", "*ELASTIC", f"{second.YOUNG_PA * 1e-6},{second.POISSON}", "*DENSITY", f"{second.DENSITY * 1e-12}"]
    lines += ["*MATERIAL, NAME=PLANE", "*ELASTIC", "210000.,0.3", "*DENSITY", "7.8e-9"]
    lines += ["*SOLID SECTION, ELSET=EPIN, MATERIAL=PIN", "*SOLID SECTION, ELSET=EPLANE, MATERIAL=PLANE"]

    def group(name, members):
        lines.append(f"*NSET, NSET={name}")
        lines.extend(f"{own + 1}," for own in members)

    held = round(CLAMP_M * COUNTS[0] / second.SIZE_M[0])
    group("BASE", [node(i, j, 0) for j in range(COUNTS[1] + 1) for i in range(COUNTS[0] + 1)])
    group("CLAMP", [node(i, j, COUNTS[2]) for j in range(COUNTS[1] + 1) for i in range(held + 1)])
    lead = node(COUNTS[0], COUNTS[1], COUNTS[2])
    for j in range(COUNTS[1] + 1):
        for i in range(COUNTS[0] + 1):
            if node(i, j, COUNTS[2]) != lead:
                lines += ["*EQUATION", "2", f"{node(i, j, COUNTS[2]) + 1},3,1.,{lead + 1},3,-1."]
    lines += ["*SURFACE, NAME=SBASE, TYPE=NODE", "BASE", "*SURFACE, NAME=SPLANE, TYPE=ELEMENT", f"{plane},S2"]
    lines += ["*SURFACE INTERACTION, NAME=I", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1.e7,1.e-7", "*FRICTION", f"{MU * 1.0005},0.01"]
    lines += ["*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE", "SBASE,SPLANE", "*BOUNDARY", "CLAMP,1,2"]
    lines += ["*STEP, INC=1000", "*STATIC", "1.,1.", "*BOUNDARY", "PLANE,1,3", "*CLOAD", f"{lead + 1},3,-{LOAD_N}", "*END STEP"]
    lines += ["*STEP, INC=1000", "*STATIC", "1.,1.", "*BOUNDARY", "PLANE,2,2,30.", "*END STEP"]
    lines += ["*STEP, PERTURBATION", "*CHANGE FRICTION, INTERACTION=I", "*FRICTION", f"{MU},0.01", "*FREQUENCY", "20", "*END STEP"]
    return "\n".join(lines) + "\n"


def of_calculix(text):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "pin.inp").write_text(text)
        subprocess.run(["ccx", "-i", "pin"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        lines = (pathlib.Path(folder) / "pin.dat").read_text().splitlines()
    modes = [tuple(float(word) for word in line.split()[2:4]) for line in lines if re.match(r"^ +\d+( +-?0\.\d+E[+-]\d+){3}$", line)]
    return max(modes, key=lambda own: own[1])


def of_program(program):
    study = {
        "name": "modes",
        "scene": {
            "pin": {"elements": list(COUNTS)}, "clamp": {"side": "inner_side", "width_m": CLAMP_M},
            # So large a radius that the track is straight.
            "disk": {"track_radius_m": 100.0},
        },
        "numerics": {"beta_r_s": 0.0},
        "grid": {"mu": [MU], "omega_rpm": [1000]},
    }
    with tempfile.TemporaryDirectory() as folder:
        command = [str(pathlib.Path(program).resolve()), "stability", "-", "--no-thresholds", "--modes", "1", "--json"]
        done = subprocess.run(command, cwd=folder, input=json.dumps(study), stdout=subprocess.PIPE, text=True, check=True)
    mode = json.loads(done.stdout.splitlines()[0])
    return mode["frequency_hz"], mode["growth_rate_per_s"]


def main():
    text = deck()
    if "--deck" in sys.argv:
        pathlib.Path(sys.argv[sys.argv.index("--deck") + 1]).write_text(text)
    rows = []
    for name, mass, found in [("tribosweep", "lumped", of_program(sys.argv[1])), ("CalculiX", "consistent", of_calculix(text))]:
        frequency_hz, growth, touching = leading_mode(mass == "lumped")
        apart = abs(complex(found[1] - growth, 2 * np.pi * (found[0] - frequency_hz))) / abs(complex(growth, 2 * np.pi * frequency_hz))
        rows.append({"program": name, "mass": mass, "found": found, "assembly": (frequency_hz, growth), "contact_nodes": touching, "apart": apart})
    if "--json" in sys.argv:
        print(json.dumps(rows))
    else:
        for row in rows:
            values = "{:.2f} Hz, {:+.2f} 1/s; assembly, {} mass: {:.2f} Hz, {:+.2f} 1/s".format(*row["found"], row["mass"], *row["assembly"])
            print(f"{row['program']}: {values}, {row['contact_nodes']} nodes in contact: {row['apart']:.1e} apart")
    sys.exit(0 if all(row["apart"] <= WITHIN for row in rows) else 1)


if __name__ == "__main__":
    main()
