#!/usr/bin/env python3
"""Writes scripts/peers/converged.json: converged values of the reference pin, from elements of high order on graded meshes.

    lagrange.py [--part deflections|modes]... [--out FILE]

This is an assembly of another kind than the program's. The shape functions are Lagrange polynomials of any order on a grid
of boxes whose sizes grow from the edges at which stresses are singular. All integrals are products of one-dimensional ones, so
all matrices are sums of Kronecker products. It shares no code with the program. The edge of the clamp is always a line of nodes.

It needs numpy, scipy and pypardiso (README.md). The pages' scripts read the file, so they need none of them.
"""

import argparse
import json
import math
from functools import reduce
from pathlib import Path

import numpy as np
import pypardiso
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spl

OUT = Path(__file__).resolve().parent / "converged.json"

# The reference scene.
SIZE_M = (0.012, 0.015, 0.010)
YOUNG_PA, POISSON, DENSITY_KG_M3 = 1e9, 0.3, 2500.0
FORCE_N, TRACK_M, BETA_R_S = 30.0, 0.0914, 5e-8
CLAMP_M = 0.001
# The program's own meshes, on which this code with trilinear elements has to give the program's values.
UNIFORM = [(12, 15, 10), (24, 30, 20)]
RATIOS = [0.3, 0.4, 0.45, 0.48, 0.49, 0.495, 0.499]
# Order of the elements, and layers of elements towards each singular edge. Each layer is GRADING times as thick as the one before.
LEVELS = [(2, 2), (3, 3), (3, 4)]
GRADING = 0.15


def axis(points, order):
    """One-dimensional matrices on a grid: ∫ φφ, ∫ φφ', ∫ φ'φ', and the nodes."""
    lobatto = {1: [-1, 1], 2: [-1, 0, 1]}.get(order)
    if lobatto is None:
        inner = np.polynomial.legendre.Legendre.basis(order).deriv().roots()
        lobatto = [-1, *np.sort(inner.real), 1]
    local = np.array(lobatto, float)
    basis = [np.polynomial.Polynomial.fromroots(np.delete(local, i)) for i in range(order + 1)]
    basis = [b / b(local[i]) for i, b in enumerate(basis)]
    x, w = np.polynomial.legendre.leggauss(order + 1)
    value = np.array([b(x) for b in basis])
    slope = np.array([b.deriv()(x) for b in basis])
    count = order * (len(points) - 1) + 1
    mass, mixed, stiff = (sp.lil_matrix((count, count)) for _ in range(3))
    nodes = np.zeros(count)
    for e, (a, b) in enumerate(zip(points, points[1:])):
        h, own = b - a, range(order * e, order * e + order + 1)
        nodes[list(own)] = a + h * (local + 1) / 2
        place = np.ix_(own, own)
        mass[place] += value @ np.diag(w) @ value.T * h / 2
        mixed[place] += value @ np.diag(w) @ slope.T
        stiff[place] += slope @ np.diag(w) @ slope.T * 2 / h
    return mass.tocsr(), mixed.tocsr(), stiff.tocsr(), nodes


def kron(a, b, c):
    """Nodes are numbered with x fastest."""
    return reduce(lambda left, right: sp.kron(right, left, format="csr"), (a, b, c))


class Block:
    """Stiffness and mass of the pin. Degree of freedom of node n in direction d: d * nodes + n."""

    def __init__(self, grids, order, poisson=POISSON):
        axes = [axis(points, order) for points in grids]
        self.axes = axes
        first, shear = (YOUNG_PA * poisson / ((1 + poisson) * (1 - 2 * poisson)), YOUNG_PA / (2 * (1 + poisson)))

        def derivatives(a, b):
            """∫ ∂_a φ_I ∂_b φ_J."""
            def factor(k):
                mass, mixed, stiff, _ = axes[k]
                if a == b == k:
                    return stiff
                return mixed.T.tocsr() if a == k else mixed if b == k else mass
            return kron(*(factor(k) for k in range(3)))

        terms = {(a, b): derivatives(a, b) for a in range(3) for b in range(3)}
        laplace = terms[0, 0] + terms[1, 1] + terms[2, 2]
        blocks = [[first * terms[a, b] + shear * terms[b, a] + (shear * laplace if a == b else 0 * laplace)
                   for b in range(3)] for a in range(3)]
        self.stiffness = sp.bmat(blocks, format="csr")
        self.scalar_mass = DENSITY_KG_M3 * kron(*(mass for mass, *_ in axes))
        self.shape = [len(nodes) for *_, nodes in axes]
        self.count = math.prod(self.shape)
        z, y, x = np.meshgrid(axes[2][3], axes[1][3], axes[0][3], indexing="ij")
        self.at = np.stack([x.ravel(), y.ravel(), z.ravel()])
        self.base = np.flatnonzero(self.at[2] == 0.0)
        self.top = np.flatnonzero(np.isclose(self.at[2], SIZE_M[2]))
        # The share of the base that belongs to each of its nodes.
        ones = [np.asarray(mass.sum(axis=1)).ravel() for mass, *_ in axes[:2]]
        self.base_area = np.outer(ones[1], ones[0]).ravel()

    def mass(self, is_lumped):
        if is_lumped:
            return sp.diags(np.tile(np.asarray(self.scalar_mass.sum(axis=1)).ravel(), 3)).tocsr()
        return sp.block_diag([self.scalar_mass] * 3, format="csr")

    def unknowns(self, clamp_m, also_held=()):
        """The matrix that makes the field of the unknowns: the top tied in z (the last unknown), the clamp's strip held in x and y."""
        held = np.zeros(3 * self.count, bool)
        held[list(also_held)] = True
        strip = self.top[self.at[0][self.top] <= clamp_m * (1 + 1e-9)]
        assert np.isclose(self.at[0][strip].max(), clamp_m), "the clamp must end at a node"
        held[strip], held[self.count + strip] = True, True
        tied = 2 * self.count + self.top
        held[tied] = True
        free = np.flatnonzero(~held)
        columns = np.arange(len(free))
        rows, columns = np.concatenate([free, tied]), np.concatenate([columns, np.full(len(tied), len(free))])
        return sp.csr_matrix((np.ones(len(rows)), (rows, columns)), (3 * self.count, len(free) + 1))


def graded(start, end, layers, ends, coarse=2):
    """Points from start to end, with layers of elements that become thinner towards the given ends; `coarse` elements between."""
    steps = [GRADING**k for k in range(layers, 0, -1)]
    length = end - start
    if len(ends) == 2:
        middle = (start + end) / 2
        return graded(start, middle, layers, ["start"], coarse)[:-1] + graded(middle, end, layers, ["end"], coarse)
    inner = [*steps, *(GRADING + (1 - GRADING) * k / coarse for k in range(1, coarse + 1))]
    if ends == ["start"]:
        return [start, *(start + length * s for s in inner[:-1]), end]
    return [start, *(end - length * s for s in reversed(inner[:-1])), end]


def uniform(elements):
    return [np.linspace(0, size, n + 1) for size, n in zip(SIZE_M, elements)]


def clamped_grids(clamp_m, layers, y_from):
    """Graded towards both edges of the clamp's strip, the top, and the ends in y."""
    x = graded(0, clamp_m, layers, ["start", "end"], 1)[:-1] + graded(clamp_m, SIZE_M[0], layers, ["start"], 3)
    ends = ["start", "end"] if y_from == 0 else ["end"]
    y = graded(y_from, SIZE_M[1], layers - 1, ends, 2)
    z = graded(0, SIZE_M[2], layers, ["end"], 3)
    return x, y, z


# ---------------------------------------------------------------- static deflection


def deflection(grids, order, clamp_m, poisson, is_half):
    """Mean displacement [m] of the base in y under a uniform traction of μF/A, with μ = 0.4, and the number of unknowns.

    The load F on the tied top moves the base's mean in y by nothing, because the pin is symmetric about y = 7.5 mm. With `is_half` the grid is the
    half beyond that plane, on which u_x and u_z vanish under the traction.
    """
    block = Block(grids, order, poisson)
    held = list(2 * block.count + block.base)
    if is_half:
        plane = np.flatnonzero(np.isclose(block.at[1], SIZE_M[1] / 2))
        held += [*plane, *(2 * block.count + plane)]
    of = block.unknowns(clamp_m, held)
    if is_half:
        of = of[:, :-1]  # The tie does not move either.
    force = np.zeros(3 * block.count)
    force[block.count + block.base] = 0.4 * FORCE_N / (SIZE_M[0] * SIZE_M[1]) * block.base_area
    u = of @ pypardiso.spsolve((of.T @ block.stiffness @ of).tocsr(), of.T @ force)
    return float(u[block.count + block.base] @ block.base_area / block.base_area.sum()), of.shape[1]


def limit(values):
    """The value of the finest level, and the last change, which is taken for its error."""
    return {"value": values[-1], "error": abs(values[-1] - values[-2])}


def deflections():
    found = []
    for clamp_m, ratios in [(0.002, RATIOS), (0.001, [POISSON])]:
        for poisson in ratios:
            coarse = [deflection(uniform(elements), 1, clamp_m, poisson, False)[0] for elements in UNIFORM]
            levels = []
            for order, layers in LEVELS:
                value, unknowns = deflection(clamped_grids(clamp_m, layers, SIZE_M[1] / 2), order, clamp_m, poisson, True)
                levels.append({"order": order, "layers": layers, "unknowns": unknowns, "deflection_m": value})
            found.append({"clamp_m": clamp_m, "poisson_ratio": poisson, "trilinear_m": coarse, "levels": levels,
                          **limit([level["deflection_m"] for level in levels])})
            print(json.dumps(found[-1]), flush=True)
    return found


# ---------------------------------------------------------------- friction modes


class Sliding:
    """Steady sliding of the pin: equilibrium with nodes that lift, and its modes."""

    def __init__(self, block, mu, omega_rpm, is_lumped=False):
        self.block, self.mu, count = block, mu, block.count
        at = block.at[:, block.base]
        x, y = TRACK_M + at[0] - SIZE_M[0] / 2, at[1] - SIZE_M[1] / 2
        radius = np.hypot(x, y)
        self.direction = np.stack([-y, x]) / radius
        self.speed = omega_rpm * 2 * math.pi / 60 * radius
        self.mass = block.mass(is_lumped)
        touching = np.ones(len(block.base), bool)
        for _ in range(50):
            node = block.base[touching]
            of = block.unknowns(CLAMP_M, 2 * count + node)
            rows = self.rows(of, touching)
            force = np.zeros(of.shape[1])
            force[-1] = -FORCE_N
            u = of @ pypardiso.spsolve((rows @ block.stiffness @ of).tocsr(), force)
            normal = (block.stiffness @ u)[2 * count + block.base]
            wanted = np.where(touching, normal >= 0, u[2 * count + block.base] < 0)
            if (wanted == touching).all():
                break
            touching = wanted
        else:
            raise RuntimeError("the contact does not settle")
        assert np.isclose(normal.sum(), FORCE_N, rtol=1e-6)
        self.of, self.rows_of, self.touching, self.normal = of, rows, touching, np.where(touching, normal, 0.0)

    def rows(self, of, touching):
        """The equations of the unknowns: where a node touches, friction is μ N in the direction of the disk."""
        count, node = self.block.count, self.block.base[touching]
        coupling = [sp.csr_matrix((-self.mu * self.direction[d][touching], (d * count + node, 2 * count + node)),
                                  (3 * count, 3 * count)) for d in (0, 1)]
        return of.T @ (sp.identity(3 * count, format="csr") + coupling[0] + coupling[1])

    def leading(self, modes=40):
        """The mode that grows fastest: its frequency [Hz] and growth rate [1/s], the unknowns and the share of open nodes."""
        block, of, count = self.block, self.of, self.block.count
        size = of.shape[1]
        stiffness = (self.rows_of @ block.stiffness @ of).tocsr()
        mass = (self.rows_of @ self.mass @ of).tocsr()
        # Friction turns with the velocity of the node across the sliding direction.
        across = np.stack([-self.direction[1], self.direction[0]])
        weight = self.mu * self.normal / self.speed
        turning = sum(sp.csr_matrix((weight * across[a] * across[b], (a * count + block.base, b * count + block.base)),
                                    (3 * count, 3 * count)) for a in (0, 1) for b in (0, 1))
        damping = (BETA_R_S * stiffness + of.T @ turning @ of).tocsr()
        solver = pypardiso.PyPardisoSolver()
        solver.factorize(stiffness)

        def inverse(y):
            first, second = y[:size], y[size:]
            return np.concatenate([-solver.solve(stiffness, mass @ second + damping @ first), first])

        operator = spl.LinearOperator((2 * size, 2 * size), matvec=inverse, dtype=float)
        start = np.random.default_rng(1).standard_normal(2 * size)
        values = 1 / spl.eigs(operator, modes, which="LM", v0=start, return_eigenvectors=False)
        value = max(values, key=lambda value: value.real)
        return {"frequency_hz": float(abs(value.imag) / (2 * math.pi)), "growth_per_s": float(value.real), "unknowns": size,
                "open_share": float(block.base_area[~self.touching].sum() / block.base_area.sum())}


# μ and the speed [rpm] of a point of docs/evidence/eigenvalues.md.
POINTS = [(0.4, 7)]
# Order of the elements, layers towards the clamp's edges, top and ends, and further elements of the base in x and y.
MODE_LEVELS = [(2, 2, 3), (2, 3, 3), (2, 4, 3)]


def mode_grids(layers, more):
    x = graded(0, CLAMP_M, layers, ["start", "end"], 1)[:-1] + graded(CLAMP_M, SIZE_M[0], layers, ["start"], 2 + more)
    y = graded(0, SIZE_M[1], layers - 1, ["start", "end"], 1 + more)
    z = graded(0, SIZE_M[2], layers, ["end"], 2 + more)
    return x, y, z


def modes():
    found = []
    for mu, omega_rpm in POINTS:
        [draft, _] = UNIFORM
        trilinear = Sliding(Block(uniform(draft), 1), mu, omega_rpm, True).leading()
        levels = []
        for order, layers, more in MODE_LEVELS:
            own = Sliding(Block(mode_grids(layers, more), order), mu, omega_rpm).leading()
            levels.append({"order": order, "layers": layers, **own})
            print(mu, omega_rpm, json.dumps(levels[-1]), flush=True)
        found.append({"mu": mu, "omega_rpm": omega_rpm, "trilinear": {"elements": draft, **trilinear}, "levels": levels,
                      **{name: limit([level[name] for level in levels]) for name in ("frequency_hz", "growth_per_s")}})
        print(json.dumps(found[-1]), flush=True)
    return found


PARTS = {"deflections": deflections, "modes": modes}


# What other codes give where this one does not reach. Each value has its source in words, which the pages repeat.
KNOWN = {
    "mu_star": {
        "source": "three discretisations (this program's; the same pin with a quarter of the mass in the contact nodes; elements with "
                  "incompatible modes), the last two in an independent tensor-product code, each on 24 × 30 × 20 and 36 × 45 × 30 "
                  "elements and extrapolated with order 1.75; the middle of the three, and their range",
        "mu": 0.4,
        "cases": [
            {"omega_rpm": 2, "value": 0.3498, "range": [0.3492, 0.3500]},
            {"omega_rpm": 7, "value": 0.2472, "range": [0.2463, 0.2481]},
            {"omega_rpm": 12, "value": 0.2928, "range": [0.2920, 0.2937]},
            {"omega_rpm": 35, "value": 0.3327, "range": [0.3325, 0.3329]},
        ],
    },
    "rig": {
        "source": "an independent assembly (scikit-fem) of beam and disk with quadratic hexahedra of 27 nodes, graded towards the "
                  "contact: undamped, the beam's end fixed, without the turning of friction",
        "mu": 0.152,
        "levels": [
            {"unknowns": 34000, "frequency_hz": 2272.4, "growth_per_s": 407.9},
            {"unknowns": 70000, "frequency_hz": 2273.6, "growth_per_s": 352.5},
            {"unknowns": 118000, "frequency_hz": 2273.2, "growth_per_s": 330.2},
        ],
        "lock_in_mu": [0.10, 0.11],
    },
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", action="append", choices=PARTS, help="compute this part again only")
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    found = json.loads(options.out.read_text()) if options.out.exists() else {}
    found.update(written_by="scripts/peers/lagrange.py", known=KNOWN)
    for part in PARTS if options.part is None else options.part:
        found[part] = PARTS[part]()
    options.out.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
