"""Newton with an IPC barrier: the toolkit's step sizes next to ours.

usage: barriers.py [--steps 12] [--stiffness 1e5] [--lines 12000]

196 vertices of cloth fall onto a sphere. ipctk (pip install ipctk scipy) computes barriers for all runs, so that only
the step sizes differ. An unfree step is one whose positions, as rounded, errbound's certify does not call free. Then
random line searches of free_step: --lines scenes, at scales from 2^-300 to 2^300.
"""
import argparse
import time

import numpy as np

from errbound import ccd

DT, D_HAT, SPRING, MASS = 0.02, 0.01, 400.0, 0.001
TOLERANCE = 1e-2  # of the largest Newton displacement per time step, m/s
MAX_ITERATIONS = 200


def cloth(n=14):
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, n), np.linspace(-0.5, 0.5, n), indexing="ij")
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.vstack([np.column_stack([i, i + n, i + 1]), np.column_stack([i + 1, i + n, i + n + 1])])
    return np.column_stack([x.ravel(), y.ravel(), np.full(n * n, 0.32)]), faces


def sphere(n=8, radius=0.3):
    a, b = np.meshgrid(np.pi * np.arange(1, n + 1) / (n + 1), np.pi * np.arange(2 * n) / n, indexing="ij")
    rings = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], axis=-1).reshape(-1, 3)
    faces = [[2 * n * n + (i == n), *pair] for i in (0, n) for j in range(2 * n)
             for pair in [(2 * n * (i - (i == n)) + j, 2 * n * (i - (i == n)) + (j + 1) % (2 * n))][::1 if i == 0 else -1]]
    for i in range(n - 1):
        for j in range(2 * n):
            p, q = 2 * n * i + j, 2 * n * i + (j + 1) % (2 * n)
            faces += [[p, p + 2 * n, q], [q, p + 2 * n, q + 2 * n]]
    return radius * np.vstack([rings, [[0, 0, 1], [0, 0, -1]]]), np.array(faces)


class Problem:
    def __init__(self, stiffness):
        import ipctk
        ipctk.set_logger_level(ipctk.LoggerLevel.error)
        at, faces = cloth()
        ball, ball_faces = sphere()
        self.ipctk, self.free = ipctk, 3 * len(at)
        self.x = np.asfortranarray(np.vstack([at, ball]))
        self.faces = np.vstack([faces, ball_faces + len(at)]).astype(np.int32)
        self.mesh = ipctk.CollisionMesh(self.x, ipctk.edges(self.faces), self.faces)
        self.steps = ccd.Steps(self.faces, vertices=len(self.x))
        sides = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        self.springs = np.unique(sides, axis=0)
        self.lengths = np.linalg.norm(np.diff(at[self.springs], axis=1)[:, 0], axis=1)
        self.barrier = ipctk.BarrierPotential(D_HAT, stiffness)

    def contacts(self, x):
        found = self.ipctk.NormalCollisions()
        found.build(self.mesh, np.asfortranarray(x), D_HAT)
        return found

    def energy(self, x, goal):
        side = np.linalg.norm(np.diff(x[self.springs], axis=1)[:, 0], axis=1) - self.lengths
        return (MASS / 2 * ((x - goal)**2).sum() + DT**2 * SPRING / 2 * (side**2).sum() +
                DT**2 * self.barrier(self.contacts(x), self.mesh, np.asfortranarray(x)))

    def direction(self, x, goal):
        """Returns the Newton displacement."""
        from scipy.sparse import coo_matrix, identity
        from scipy.sparse.linalg import spsolve
        ends = np.diff(x[self.springs], axis=1)[:, 0]
        length = np.linalg.norm(ends, axis=1)
        n = ends / length[:, None]
        force = DT**2 * SPRING * (length - self.lengths)[:, None] * n
        gradient = MASS * (x - goal)
        np.add.at(gradient, self.springs[:, 0], -force)
        np.add.at(gradient, self.springs[:, 1], force)
        along = np.einsum("ki,kj->kij", n, n)
        stretch = np.maximum(0, 1 - self.lengths / length)[:, None, None]  # positive semidefinite
        block = DT**2 * SPRING * (along + stretch * (np.eye(3) - along))
        i, j = (3 * self.springs[:, k, None] + np.arange(3) for k in (0, 1))
        rows, columns, values = [], [], []
        for a, b, sign in (i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1):
            rows.append(np.broadcast_to(a[:, :, None], block.shape).ravel())
            columns.append(np.broadcast_to(b[:, None, :], block.shape).ravel())
            values.append((sign * block).ravel())
        shape = (x.size, x.size)
        hessian = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape).tocsc()
        contacts, ordered = self.contacts(x), np.asfortranarray(x)
        gradient = gradient.ravel() + DT**2 * self.barrier.gradient(contacts, self.mesh, ordered)
        hessian = hessian + MASS * identity(x.size, format="csc") + DT**2 * self.barrier.hessian(
            contacts, self.mesh, ordered, self.ipctk.PSDProjectionMethod.CLAMP)
        p = np.zeros(x.size)
        p[:self.free] = spsolve(hessian[:self.free, :self.free].tocsc(), -gradient[:self.free])
        return p.reshape(x.shape)


def of_toolkit(problem, x, p):
    return problem.ipctk.compute_collision_free_stepsize(problem.mesh, x, np.asfortranarray(x + p))


def of_free_step(conservative):
    return lambda problem, x, p: problem.steps.free_step(x, p, conservative=conservative).fraction


def of_time(problem, x, p):
    """The exact time of the first contact, as it is."""
    first = problem.steps.run(x, x + p, first_contact=True).first_contact
    return 1 if first is None else first[0]


WAYS = {"ipctk": (of_toolkit, False), "free_step, conservative 0.8": (of_free_step(0.8), True),
        "free_step, conservative 1": (of_free_step(1), True), "exact time of contact": (of_time, False)}


def simulate(name, steps, stiffness):
    """Prints iterations, halvings, unfree steps and seconds of the step sizes."""
    problem = Problem(stiffness)
    size, again = WAYS[name]
    x, v, count = problem.x, np.zeros_like(problem.x), dict.fromkeys(("iterations", "halvings", "unfree"), 0)
    seconds, gravity, least = 0.0, np.zeros_like(x), np.inf
    gravity[:problem.free // 3, 2] = -9.8
    unconverged = 0
    for _ in range(steps):
        start, goal = x, x + DT * v + DT**2 * gravity
        for _ in range(MAX_ITERATIONS):
            p = problem.direction(x, goal)
            if np.abs(p).max() <= TOLERANCE * DT:
                break
            count["iterations"] += 1
            energy = problem.energy(x, goal)
            begin = time.perf_counter()
            alpha = size(problem, x, p)
            seconds += time.perf_counter() - begin
            for _ in range(60):
                end = np.asfortranarray(x + alpha * p)
                if problem.energy(end, goal) <= energy:
                    break
                count["halvings"] += 1
                begin = time.perf_counter()
                p, alpha = (p / 2, size(problem, x, p / 2)) if again else (p, alpha / 2)
                seconds += time.perf_counter() - begin
            found = problem.steps.certify(x, end)
            count["unfree"] += not found.is_free
            x = end
            least = min(least, problem.steps.least_distance(x).low)
        else:
            unconverged += 1
        v = (x - start) / DT
    intersects = not problem.steps.is_free(x)
    print(f"{name:28} {count['iterations']:10} {count['halvings']:8} {unconverged:11} {count['unfree']:6} "
          f"{'yes' if intersects else 'no':>10} {least:13.3g} {seconds:9.2f}", flush=True)


def line_search(seed):
    """One random line search: a mesh of faces, rods and points, far or near, large or small, and a random direction.

    Returns alpha, and how many of three spellings of x + alpha * p in NumPy are unfree.
    """
    random = np.random.default_rng(seed)
    scale = 2.0**random.integers(-300, 301)
    n = 24
    x = scale * (random.uniform(-1, 1, (n, 3)) + (random.choice([0, 0, 10, 1e6]) * random.uniform(-1, 1, 3)))
    if random.integers(3) == 0:
        x = scale * random.integers(-3, 4, (n, 3)) + 0.0
    faces = np.array([[3 * i, 3 * i + 1, 3 * i + 2] for i in range(5)])
    edges = np.array([[15, 16], [16, 17], [18, 19]])
    p = scale * random.choice([1e-6, 1, 1, 1e6]) * random.uniform(-1, 1, (n, 3))
    steps = ccd.Steps(faces, edges, vertices=n)
    alpha = (free := steps.free_step(x, p, conservative=random.choice([0.8, 1, 1]))).fraction
    in_place = x.copy()
    in_place += alpha * p
    ends = x + alpha * p, np.add(x, np.multiply(p, alpha)), in_place
    return alpha, sum(len(steps.run(x, end, adjacent_rods=True).pairs) > len(free.touching_at_start) for end in ends)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=12)
    parser.add_argument("--stiffness", type=float, default=1e5, help="of the barrier; less needs more iterations")
    parser.add_argument("--lines", type=int, default=12000)
    chosen = parser.parse_args()
    if chosen.lines:
        found = [line_search(seed) for seed in range(chosen.lines)]
        short = sum(alpha < 1 for alpha, _ in found)
        print(f"{chosen.lines} line searches, {short} with a contact on the way: {sum(n for _, n in found)} unfree")
    if chosen.steps:
        print(f"{'step sizes':28} {'iterations':>10} {'halvings':>8} {'unconverged':>11} {'unfree':>6} "
              f"{'intersects':>10} {'least distance':>13} {'seconds':>9}")
        for name in WAYS:
            simulate(name, chosen.steps, chosen.stiffness)


if __name__ == "__main__":
    main()
