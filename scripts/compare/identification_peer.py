"""One fit of eq. 11 by a peer, as a process of its own: reads the recording, fits, prints JSON.

    identification_peer.py SOLVER SEED ROWS.csv MODEL.json

ROWS.csv has the direction as its fifth column, 0 where a row does not count. MODEL.json gives the geometry alone.
"""

import time

STARTED = time.perf_counter()

import json  # noqa: E402
import sys  # noqa: E402

import numpy as np  # noqa: E402

import eq11  # noqa: E402
from recording import read  # noqa: E402

PARTICLES, MOVES = 60, 200
BUDGET = PARTICLES * MOVES


def pyswarms(cost, seed, **_):
    from pyswarms.single import GlobalBestPSO

    yield
    np.random.seed(seed)
    options = {"c1": 0.5, "c2": 0.3, "w": 0.9}
    box = (np.zeros(6), np.ones(6))
    swarm = GlobalBestPSO(n_particles=PARTICLES, dimensions=6, options=options, bounds=box)
    yield swarm.optimize(lambda xs: np.array([cost(x) for x in xs]), iters=MOVES, verbose=False)[1]


def pints_by(method):
    def solve(cost, seed, **_):
        import pints

        yield

        class Error(pints.ErrorMeasure):
            def n_parameters(self):
                return 6

            def __call__(self, x):
                return cost(x)

        np.random.seed(seed)
        box = pints.RectangularBoundaries(np.zeros(6), np.ones(6))
        start, spread = np.full(6, 0.5), np.full(6, 0.25)
        search = pints.OptimisationController(Error(), start, spread, box, method=getattr(pints, method))
        search.optimiser().set_population_size(PARTICLES)
        search.set_max_iterations(MOVES)
        search.set_log_to_screen(False)
        yield search.run()[0]

    return solve


def pycma(cost, seed, **_):
    import cma

    yield
    options = {"bounds": [0, 1], "seed": seed, "maxfevals": BUDGET, "verbose": -9}
    yield cma.fmin2(cost, np.full(6, 0.5), 0.25, options)[0]


def evolution(**options):
    def solve(cost, seed, **_):
        from scipy.optimize import differential_evolution

        yield
        yield differential_evolution(cost, [(0, 1)] * 6, rng=seed, **options).x

    return solve


def least_squares_from(start, method="trf"):
    def solve(residuals, starts, **_):
        from scipy.optimize import least_squares

        yield
        box = {} if method == "lm" else {"bounds": (np.zeros(6), np.ones(6))}
        yield least_squares(residuals, starts[start], method=method, **box).x

    return solve


# The same with eq. 11 evaluated whole each time, as a first script would: the only peer to compute again what does not
# depend on the parameters.
FIRST_SCRIPT = "pyswarms GlobalBest, first script"

SOLVERS = {
    "pyswarms GlobalBest": pyswarms,
    FIRST_SCRIPT: pyswarms,
    "PINTS PSO": pints_by("PSO"),
    "PINTS CMA-ES": pints_by("CMAES"),
    "pycma": pycma,
    "SciPy differential_evolution, matched": evolution(popsize=10, maxiter=MOVES - 1, tol=0, polish=False),
    "SciPy differential_evolution, default": evolution(),
    "SciPy least_squares trf, good start": least_squares_from("good"),
    "SciPy least_squares lm, good start": least_squares_from("good", "lm"),
    "SciPy least_squares trf, mid-box": least_squares_from("middle"),
}


def main():
    solver, seed, log, model = sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4]
    artifact = json.load(open(model))
    _, pressure, length, force, signs = read(log)
    counts = signs != 0
    pressure, length, force, signs = pressure[counts], length[counts], force[counts], signs[counts]
    muscle = eq11.Muscle(artifact["geometry"])
    low, high = eq11.bounds(muscle, pressure, length)
    rows = muscle.rows(pressure, length, signs)
    evaluations = 0

    def residuals(x):
        nonlocal evaluations
        evaluations += 1
        now = muscle.rows(pressure, length, signs) if solver == FIRST_SCRIPT else rows
        return muscle.force(now, low + x * (high - low)) - force

    def cost(x):
        residual = residuals(x)
        return residual @ residual

    good = (eq11.nominal(artifact["strand_modulus_pa"]) - low) / (high - low)
    starts = {"good": good, "middle": np.full(6, 0.5)}
    solving = SOLVERS[solver](cost=cost, residuals=residuals, seed=seed, starts=starts)
    before_import = time.perf_counter()
    next(solving)
    imported = time.perf_counter()
    x = next(solving)
    done = time.perf_counter()
    theta = low + np.asarray(x) * (high - low)
    rmse = float(np.sqrt(np.mean((muscle.force(rows, theta) - force) ** 2)))
    print(json.dumps({
        "fit_s": done - imported, "import_s": imported - before_import, "until_fit_s": imported - STARTED,
        "evaluations": evaluations, "rmse_n": rmse, "theta": list(theta),
    }))


if __name__ == "__main__":
    main()
