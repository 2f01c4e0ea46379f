"""Unmodelled structure: pam-diagnose against sparse regression, symbolic regression and boosted trees, where no effect has a name."""

import json
import shutil
import time
import warnings

import numpy as np

from process import median, run, say

OURS = "pam-diagnose"
# What a column must contribute to be kept, as a share of the deviation of what eq. 11 leaves.
THRESHOLDS = (0.03, 0.1, 0.3)
# Rows that symbolic regression is given: with all of them a case takes an hour.
FEW = 3000
# Stretches of recording that folds are made of.
STRETCHES, FOLDS = 24, 6
TIME_CONSTANTS_S = (0.1, 1.0, 10.0)
HALF_WIDTHS = (0.02, 0.1)


def log(path):
    with open(path) as file:
        names = file.readline().strip().split(",")
    values = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
    return dict(zip(names, values))


def lagged(times, values, time_constant):
    """First-order lag, settled at the start."""
    out, state = np.empty_like(values), values[0]
    shares = -np.expm1(-np.diff(times, prepend=times[0]).clip(0) / time_constant)
    for at, (value, share) in enumerate(zip(values, shares)):
        state += share * (value - state)
        out[at] = state
    return out


def behind_play(values, half_width):
    out, state = np.empty_like(values), values[0]
    for at, value in enumerate(values):
        state = min(max(state, value - half_width), value + half_width)
        out[at] = state
    return out


def columns(rows, scale):
    """What drives a sentence of the grammar, with the memories that it may have, each of the size of one."""
    times, pressure = rows["time_s"], rows["pressure_kPa"] / scale["pressure"]
    stroke, force = rows["length_mm"] / scale["length"], rows["force_model_N"] / scale["force"]
    smooth = lagged(times, stroke, 0.05)
    speed = np.gradient(smooth, np.maximum.accumulate(times) + 1e-9 * np.arange(len(times)))
    direction = np.sign(speed)
    turns = np.flatnonzero(np.diff(direction, prepend=direction[0]))
    since = np.zeros(len(times), dtype=int)
    since[turns] = turns
    travel = np.abs(smooth - smooth[np.maximum.accumulate(since)])
    out = {
        "pressure": pressure, "length": stroke, "force": force, "direction": direction,
        "speed": np.clip(speed / scale["speed"], -5, 5), "time": (times - times[0]) / 60, "travel": travel,
    }
    for name, values in (("pressure", pressure), ("length", stroke)):
        for time_constant in TIME_CONSTANTS_S:
            out[f"{name}, lag {time_constant:g} s"] = lagged(times, values, time_constant)
        for half_width in HALF_WIDTHS:
            out[f"{name}, play {half_width:g}"] = behind_play(values, half_width)
    return np.column_stack(list(out.values()))


class Problem:
    """Columns and what eq. 11 leaves of the force, fitted and held out; errors are against the force without noise."""

    def __init__(self, fitted, held, truth):
        span = lambda name: max(np.ptp(np.concatenate([rows[name] for rows in fitted])), 1e-9)
        scale = {"pressure": span("pressure_kPa"), "length": span("length_mm"), "force": span("force_model_N")}
        scale["speed"] = np.median([np.abs(np.gradient(lagged(rows["time_s"], rows["length_mm"], 0.05))).mean()
                                    / np.maximum(np.diff(rows["time_s"]).mean(), 1e-9) for rows in fitted])
        scale["speed"] = max(scale["speed"] / scale["length"], 1e-9)
        self.x = np.concatenate([columns(rows, scale) for rows in fitted])
        self.y = np.concatenate([rows["force_N"] - rows["force_model_N"] for rows in fitted])
        self.held = np.concatenate([columns(rows, scale) for rows in held])
        self.left = np.concatenate([true - rows["force_model_N"] for rows, true in zip(held, truth)])
        self.folds = (np.arange(len(self.y)) * STRETCHES // len(self.y)) % FOLDS

    def error(self, predicted):
        return float(np.sqrt(np.mean((self.left - predicted) ** 2)) / np.sqrt(np.mean(self.left**2)))


def alone(x):
    """A constant and the columns."""
    return np.column_stack([np.ones(len(x)), x])


def products(x):
    """A constant, the columns, and products of two of them."""
    pairs = [x[:, i] * x[:, j] for i in range(x.shape[1]) for j in range(i, x.shape[1])]
    return np.column_stack([np.ones(len(x)), x, *pairs])


def sparse(library):
    """PySINDy's STLSQ over what `library` makes of the columns; the threshold is that with the least error on blocked folds."""
    return lambda problem, _seed: stlsq(problem, library)


def stlsq(problem, library):
    from pysindy import STLSQ

    rows, target = library(problem.x), problem.y
    sizes = np.sqrt(np.mean(rows**2, axis=0)) + 1e-12
    rows = rows / sizes

    def weigh(use, threshold):
        try:
            return STLSQ(threshold=threshold * target.std(), alpha=1e-6).fit(rows[use], target[use, None]).coef_[0]
        except ValueError:  # Nothing is above the threshold.
            return np.zeros(rows.shape[1])

    def folded(threshold):
        errors = []
        for fold in range(FOLDS):
            held = problem.folds == fold
            errors.append(np.mean((rows[held] @ weigh(~held, threshold) - target[held]) ** 2))
        return np.mean(errors)

    weights = weigh(np.ones(len(target), dtype=bool), min(THRESHOLDS, key=folded))
    return library(problem.held) / sizes @ weights, int(np.count_nonzero(weights))


def symbolic(problem, seed):
    """gplearn, on rows drawn at random."""
    from gplearn.genetic import SymbolicRegressor

    few = np.random.default_rng(seed).choice(len(problem.y), min(FEW, len(problem.y)), replace=False)
    search = SymbolicRegressor(
        population_size=1000, generations=20, parsimony_coefficient=0.001, random_state=seed,
        function_set=("add", "sub", "mul", "div", "abs", "max", "min"), max_samples=0.9,
    )
    search.fit(problem.x[few], problem.y[few])
    return search.predict(problem.held), search._program.length_


def trees(problem, _seed):
    from sklearn.ensemble import HistGradientBoostingRegressor

    forest = HistGradientBoostingRegressor(max_iter=400, learning_rate=0.06, min_samples_leaf=40, random_state=0)
    return forest.fit(problem.x, problem.y).predict(problem.held), None


PEERS = {
    "PySINDy STLSQ, columns": sparse(alone), "PySINDy STLSQ, products of two": sparse(products), "gplearn": symbolic,
    "boosted trees": trees,
}


def asked(programs, case, scratch):
    """The problem for the peers; what is left with the augmented model, its terms, and the time of the diagnosis."""
    fitted, held = (sorted(case.glob(f"{letter}*.csv")) for letter in "eh")
    truth = [np.loadtxt(case.parent / "truth" / case.name / path.name, skiprows=1) for path in held]
    apart = [word for path in held for word in ("--holdout", path)]
    model, augmented, out = scratch / "model.json", scratch / "augmented.json", scratch / "predicted.csv"
    augmented.unlink(missing_ok=True)
    seconds = 0.0
    for command in (
        ["pam-identify", *fitted, *apart, "--muscle", case / "muscle.toml", "--out", model],
        ["pam-diagnose", *fitted, *apart, "--model", model, "--out", scratch / "diagnosis.json", "--out-model", augmented],
    ):
        try:
            took, _ = run([programs / command[0], *command[1:], "--quiet"], scratch, (0, 1))
        except SystemExit:
            return None
        seconds = took
    def predicted(path, by):
        run([programs / "pam-predict", path, "--model", by, "--out", out, "--quiet"], scratch, (0, 1))
        return log(out)
    problem = Problem([predicted(path, model) for path in fitted], [predicted(path, model) for path in held], truth)
    ours = problem.error(np.concatenate(
        [predicted(path, augmented)["force_model_N"] - predicted(path, model)["force_model_N"] for path in held]))
    empirical = json.loads((scratch / "diagnosis.json").read_text()).get("empirical") or {"terms": []}
    return problem, ours, len(empirical["terms"]), seconds


def compare(programs, scratch, quick, seed):
    n_cases = 4 if quick else 40
    folder = scratch / "cases"
    shutil.rmtree(folder, ignore_errors=True)
    say(f"unmodelled structure: generating {n_cases} cases")
    run([programs / "worlds", "--out", folder, "--cases", n_cases, "--seed", seed, "--half", "report", "--kind", "nameless"],
        scratch)
    warnings.filterwarnings("ignore")
    lines = {name: {"left": [], "terms": [], "seconds": []} for name in (OURS, *PEERS)}
    refused = 0
    for case in sorted(folder.glob("case*")):
        answer = asked(programs, case, scratch)
        if answer is None:
            refused += 1
            continue
        problem, left, terms, seconds = answer
        outcomes = {OURS: (left, terms, seconds)}
        for name, peer in PEERS.items():
            start = time.perf_counter()
            predicted, terms = peer(problem, seed)
            outcomes[name] = (problem.error(predicted), terms, time.perf_counter() - start)
        for name, (left, terms, seconds) in outcomes.items():
            for key, value in zip(("left", "terms", "seconds"), (left, terms, seconds)):
                lines[name][key].append(value)
        say(f"unmodelled structure: {case.name} " + ", ".join(f"{name} {of[0]:.2f}" for name, of in outcomes.items()))
    summary = [
        {
            "name": name, "left": median(line["left"]), "worst": float(np.quantile(line["left"], 0.9)),
            "harmed": sum(left > 1.0 for left in line["left"]), "seconds": median(line["seconds"]),
            "terms": None if None in line["terms"] else median(line["terms"]),
            "beaten_by_ours": sum(ours <= left for ours, left in zip(lines[OURS]["left"], line["left"])),
        }
        for name, line in lines.items()
    ]
    n_columns = 7 + 2 * (len(TIME_CONSTANTS_S) + len(HALF_WIDTHS))
    return {"n_cases": len(lines[OURS]["left"]), "refused": refused, "seed": seed, "n_columns": n_columns, "lines": summary}
