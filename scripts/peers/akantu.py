#!/usr/bin/env python3
"""What a step of the reference pin costs in Akantu: CPU nanoseconds per pin element and step, one thread.

Needs Akantu (`pip install akantu`); see README.md beside this file for what is compared and what is not the same.
The table goes to stdout, everything else to stderr.
"""

import argparse
import importlib.util
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

# Python looks beside the script first, and would import this file as the library of the same name.
HERE = pathlib.Path(__file__).resolve().parent
sys.path[:] = [folder for folder in sys.path if pathlib.Path(folder or ".").resolve() != HERE]

PIN_M = (0.012, 0.015, 0.010)
YOUNG_PA, POISSON, DENSITY = 1.0e9, 0.3, 2500.0
MU, FORCE_N = 0.4, 30.0
# The reference scene's 7 rpm at its track radius.
SPEED_M_S = 7.0 * 2.0 * math.pi / 60.0 * 0.0914
CLAMP_M = 0.001
# Farther than the pin slides in any run of a reasonable length.
OVERHANG_M = 0.002
SAFETY = 0.7
# The speed of a shared machine changes for seconds at a time. So all cases are timed in turn in several rounds, and each
# has a chance to run while the machine is fast.
ROUNDS = 3
CHUNKS = 5
CASES = {
    "friction": f"sliding contact with friction, μ = {MU}",
    "frictionless": "sliding contact without friction",
    "elastic": "no contact, the elastic pin alone (a lower bound)",
}
# Akantu allocates its fields of a megabyte again in every step, and by default glibc returns them to the system at once.
# Then the kernel takes a large part of the time to clear pages. This is not the library's arithmetic, so the cases are also
# timed without it. (Other C libraries ignore these variables.)
ALLOCATORS = {
    "as installed": {},
    "freed memory kept": {"MALLOC_MMAP_THRESHOLD_": str(32 << 20), "MALLOC_TRIM_THRESHOLD_": str(1 << 30)},
}


def grid(axes, first_node):
    """Coordinates and node numbers of a block."""
    import numpy as np

    coordinates = np.stack([c.ravel() for c in np.meshgrid(*axes, indexing="ij")], axis=1)
    shape = [len(axis) for axis in axes]
    return coordinates, first_node + np.arange(len(coordinates)).reshape(shape)


def quads(face):
    import numpy as np

    corners = (face[:-1, :-1], face[1:, :-1], face[1:, 1:], face[:-1, 1:])
    return np.stack([c.ravel() for c in corners], axis=1)


def hexahedra(nodes):
    import numpy as np

    return np.hstack([
        np.stack([c.ravel() for c in (layer[:-1, :-1], layer[1:, :-1], layer[1:, 1:], layer[:-1, 1:])], axis=1)
        for layer in (nodes[:, :, :-1], nodes[:, :, 1:])
    ])


def write_mesh(path, coordinates, groups):
    """A Gmsh 2.2 file: the contact surfaces have to be named groups, which Akantu's reader makes of physical names."""
    kinds = {4: (2, 3), 8: (3, 5)}
    with open(path, "w", encoding="ascii") as out:
        out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        out.write(f"$PhysicalNames\n{len(groups)}\n")
        for tag, (name, cells) in enumerate(groups.items(), 1):
            out.write(f'{kinds[cells.shape[1]][0]} {tag} "{name}"\n')
        out.write(f"$EndPhysicalNames\n$Nodes\n{len(coordinates)}\n")
        for number, point in enumerate(coordinates, 1):
            out.write(f"{number} {point[0]:.17g} {point[1]:.17g} {point[2]:.17g}\n")
        out.write(f"$EndNodes\n$Elements\n{sum(len(cells) for cells in groups.values())}\n")
        number = 0
        for tag, cells in enumerate(groups.values(), 1):
            for cell in cells:
                number += 1
                nodes = " ".join(str(node + 1) for node in cell)
                out.write(f"{number} {kinds[cells.shape[1]][1]} 2 {tag} {tag} {nodes}\n")
        out.write("$EndElements\n")


def write_parameters(path, mu, penalty):
    path.write_text(f"""
material elastic [
  name = elastic
  rho = {DENSITY}
  E = {YOUNG_PA}
  nu = {POISSON}
]
contact_detector [
  type = explicit
  master = disk
  slave = foot
  projection_tolerance = 1e-10
  max_iterations = 100
  extension_tolerance = 1e-5
]
contact_resolution penalty_linear [
  name = foot
  mu = {mu}
  epsilon_n = {penalty}
  epsilon_t = {penalty}
  is_master_deformable = true
]
""", encoding="ascii")


def measure(case, options):
    """Runs one case in this process, and gives what was found as a dictionary."""
    import akantu as aka
    import numpy as np

    contact_wanted = case != "elastic"
    axes = [np.linspace(0.0, size, count + 1) for size, count in zip(PIN_M, options.elements)]
    coordinates, pin = grid(axes, 0)
    groups = {"pin": hexahedra(pin)}
    if contact_wanted:
        # A surface without elements behind it crashes Akantu, so the disk is a slab, all of its nodes prescribed.
        disk_axes = [np.linspace(-OVERHANG_M, size + OVERHANG_M, options.disk + 1) for size in PIN_M[:2]]
        disk_axes.append(np.array([-PIN_M[2] / options.elements[2], 0.0]))
        disk_coordinates, disk = grid(disk_axes, pin.size)
        coordinates = np.vstack([coordinates, disk_coordinates])
        # Normals point out of the bodies: the foot's downwards.
        groups |= {"slab": hexahedra(disk), "foot": quads(pin[:, :, 0])[:, ::-1], "disk": quads(disk[:, :, 1])}

    # As stiff as an element of the pin: stiffer would leave less of the step's margin, softer penetrates more.
    penalty = YOUNG_PA * options.elements[2] / PIN_M[2]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_mesh(folder / "pin.msh", coordinates, groups)
        write_parameters(folder / "pin.dat", MU if case == "friction" else 0.0, penalty)
        aka.parseInput(str(folder / "pin.dat"))
        mesh = aka.Mesh(3)
        mesh.read(str(folder / "pin.msh"))

    if contact_wanted:
        model = aka.CouplerSolidContact(mesh)
        solid, contact = model.getSolidMechanicsModel(), model.getContactMechanicsModel()
    else:
        model = solid = aka.SolidMechanicsModel(mesh)
    model.initFull(_analysis_method=aka._explicit_lumped_mass)
    if contact_wanted:
        # The variable keeps the selector alive: the detector does not own it.
        selector = aka.PhysicalSurfaceSelector(mesh)
        contact.getContactDetector().setSurfaceSelector(selector)
    step_s = SAFETY * solid.getStableTimeStep()
    model.setTimeStep(step_s)

    displacement, force = solid.getDisplacement(), solid.getExternalForce()
    blocked = solid.getBlockedDOFs()
    top = pin[:, :, -1]
    # At least one row of nodes on a mesh that is coarser than the clamp.
    rows = max(1, int(np.sum(axes[0] <= CLAMP_M * (1.0 + 1e-9))))
    blocked[top[:rows].ravel(), :2] = True
    share = np.ones(top.shape)
    share[[0, -1], :] /= 2.0
    share[:, [0, -1]] /= 2.0
    share = (share / share.sum()).ravel()
    top = top.ravel()
    if contact_wanted:
        moving = disk.ravel()
        blocked[moving] = True
    else:
        # Without a disk nothing else holds the pin in z.
        blocked[pin[:, :, 0].ravel(), 2] = True

    # The ramp ends within the warm-up, so all timed steps are under the full load.
    ramp_s = 0.8 * options.warm_up * step_s

    def advance(first, count):
        for step in range(first, first + count):
            time_s = (step + 1) * step_s
            if step <= options.warm_up:
                force[top, 2] = -FORCE_N * min(1.0, time_s / ramp_s) * share
            if contact_wanted:
                displacement[moving, 1] = SPEED_M_S * time_s
            model.solveStep()

    advance(0, options.warm_up)
    done, chunk = options.warm_up, options.steps // (ROUNDS * CHUNKS)
    seconds, normal_n, tangential_n = [], [], []
    for _ in range(CHUNKS):
        begun = time.process_time()
        advance(done, chunk)
        seconds.append(time.process_time() - begun)
        done += chunk
        if contact_wanted:
            total = contact.getInternalForce()[pin.ravel()].sum(axis=0)
            normal_n.append(float(total[2]))
            tangential_n.append(float(total[1]))
    if not np.isfinite(displacement).all() or np.abs(displacement[pin.ravel()]).max() > 0.1 * PIN_M[2]:
        raise RuntimeError("the run diverged: its time means nothing")
    pin_elements = math.prod(options.elements)
    found = {
        "version": str(aka.__version__),
        "ns": [second * 1e9 / (chunk * pin_elements) for second in seconds],
        "step_s": step_s,
    }
    if contact_wanted:
        gaps = contact.getGaps()[pin[:, :, 0].ravel()]
        found |= {
            "normal_n": normal_n,
            "ratio": sum(tangential_n) / sum(normal_n),
            "in_contact": int((gaps > 0.0).sum()),
            "foot_nodes": int(pin[:, :, 0].size),
        }
    return found


def in_own_process(case, allocator, options):
    """Runs a case in a process of its own: Akantu keeps its parameters in a global, and may crash."""
    command = [sys.executable, __file__, "--only", case, "--elements", *map(str, options.elements),
               "--steps", str(options.steps), "--warm-up", str(options.warm_up), "--disk", str(options.disk)]
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    environment = os.environ | threads | allocator
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "found.json"
        done = subprocess.run([*command, "--json", str(path)], env=environment, stdout=sys.stderr, check=False)
        if done.returncode != 0 or not path.exists():
            return None
        return json.loads(path.read_text(encoding="utf-8"))


def describe(case, memory, found):
    """One line as evidence that the intended contact was timed."""
    line = f"{case}, {memory}: {statistics.median(found['ns']):.0f} ns, step {found['step_s']:.3g} s"
    if "ratio" in found:
        line += (f", normal force {min(found['normal_n']):.1f} … {max(found['normal_n']):.1f} N,"
                 f" tangential/normal {found['ratio']:.3f},"
                 f" {found['in_contact']} of {found['foot_nodes']} nodes in contact")
    return line


def report(options):
    runs = [(case, memory) for case in CASES for memory in ALLOCATORS]
    chunks, version, failed = {run: [] for run in runs}, "?", set()
    for _ in range(ROUNDS):
        for case, memory in runs:
            # A case that failed once would fail again.
            if (case, memory) in failed:
                continue
            found = in_own_process(case, ALLOCATORS[memory], options)
            if found is None:
                failed.add((case, memory))
                continue
            version = found["version"]
            chunks[case, memory] += found["ns"]
            print(describe(case, memory, found), file=sys.stderr, flush=True)
    print("| program | version | what was run | memory | ns per element and step, median | fastest … slowest |")
    print("| --- | --- | --- | --- | --- | --- |")
    for (case, memory), ns in chunks.items():
        result = "did not run | "
        if (case, memory) not in failed:
            result = f"{statistics.median(ns):.0f} | {min(ns):.0f} … {max(ns):.0f}"
        print(f"| Akantu | {version} | {CASES[case]} | {memory} | {result} |")
    if failed:
        sys.exit("akantu.py: not everything ran; the messages are above")


def at_least(least):
    def number(text):
        value = int(text)
        if value < least:
            raise argparse.ArgumentTypeError(f"must be at least {least}")
        return value
    return number


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--elements", type=at_least(1), nargs=3, metavar=("NX", "NY", "NZ"), default=[12, 15, 10],
                           help="elements of the pin (12 15 10)")
    arguments.add_argument("--steps", type=at_least(ROUNDS * CHUNKS), default=600, metavar="N",
                           help=f"timed steps of a case, in {ROUNDS} rounds of {CHUNKS} chunks (600)")
    arguments.add_argument("--warm-up", type=at_least(1), default=400, metavar="N",
                           help="steps before those of a round, in which the load comes on (400)")
    arguments.add_argument("--disk", type=at_least(1), default=1, metavar="N",
                           help="elements of the disk in x and in y (1: it is flat and rigid, and more cost more)")
    arguments.add_argument("--only", choices=CASES, help=argparse.SUPPRESS)
    arguments.add_argument("--json", type=pathlib.Path, help=argparse.SUPPRESS)
    options = arguments.parse_args()
    if importlib.util.find_spec("akantu") is None:
        sys.exit("akantu.py: this Python has no Akantu. Make a virtual environment, `pip install akantu` into it, and"
                 " start this script with its python; see README.md beside this script.")
    if options.json is None:
        report(options)
    else:
        options.json.write_text(json.dumps(measure(options.only, options)), encoding="utf-8")


if __name__ == "__main__":
    main()
