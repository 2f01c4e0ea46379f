"""Missing physics: pam-diagnose against PySINDy and LASSO, on cases whose truth is sealed before anything is asked."""

import functools
import json
import shutil
import time
import warnings

import numpy as np

import columns
from process import median, run, say
from recording import direction, near_flip, read

OURS = "pam-diagnose"
# What a column must contribute to be named, as a share of the deviation of the force.
THRESHOLDS = (0.001, 0.003, 0.01, 0.03)
# Stretches of recording that folds and bags are made of.
STRETCHES = 60
FOLDS = 6
BAGS = 20


def problem(programs, case, scratch):
    """Families, the family of each column, and the least-squares problem.

    Columns and residual are cleared of what refitting the base model would absorb, columns scaled to a root mean square of 1.
    """
    model = json.loads((case / "model.json").read_text())
    files = json.loads((case / "recordings.json").read_text())["estimation"]
    theta, muscle = columns.theta_and_muscle(model)
    recordings = []
    for name in files:
        recordings.append((*read(case / name)[:4], direction(programs, case / name, model, scratch)))
    effects, names, library, base, tangent = columns.families(muscle, theta, recordings)
    force = np.concatenate([recording[3] for recording in recordings])
    counts = ~np.concatenate([near_flip(recording[4], 5) for recording in recordings])
    library, residual, tangent = library[counts], (force - base)[counts], tangent[counts]
    q, _ = np.linalg.qr(tangent / np.linalg.norm(tangent, axis=0))
    before = np.linalg.norm(library, axis=0)
    library = library - q @ (q.T @ library)
    residual = residual - q @ (q.T @ residual)
    kept = np.linalg.norm(library, axis=0) > 1e-3 * before
    library = library[:, kept]
    library /= np.sqrt(np.mean(library**2, axis=0))
    return effects, [name for name, keep in zip(names, kept) if keep], Problem(library, residual, force.std())


def named(names, weights, asked):
    """Families in order of what their columns together contribute; those without weight are not named."""
    gram = np.tensordot(ALL, asked.gram, 1)
    contributes = {}
    for name in dict.fromkeys(names):
        part = np.where(np.array(names) == name, weights, 0.0)
        if part.any():
            contributes[name] = part @ gram @ part
    return sorted(contributes, key=contributes.get, reverse=True)


class Problem:
    """Least squares of the residual on the columns, as normal equations of stretches of recording.

    A regression sees of its rows only their normal equations, so a few dozen rows that have the same ones stand for tens
    of thousands: no peer's answer changes, and each runs a hundred times faster than it would on all rows.
    """

    def __init__(self, library, residual, scale):
        self.scale, self.n_rows = scale, len(residual)
        edges = np.linspace(0, self.n_rows, STRETCHES + 1).astype(int)
        pieces = [(library[a:b], residual[a:b]) for a, b in zip(edges, edges[1:])]
        self.gram = np.array([x.T @ x for x, _ in pieces])
        self.moment = np.array([x.T @ y for x, y in pieces])
        self.square = np.array([y @ y for _, y in pieces])
        self.sizes = np.diff(edges)

    def rows(self, weights):
        """Rows that stand for the stretches, each counted as often as `weights` says; mean square as of one row."""
        n = weights @ self.sizes
        gram, moment = np.tensordot(weights, self.gram, 1) / n, weights @ self.moment / n
        values, vectors = np.linalg.eigh(gram)
        root = np.sqrt(np.maximum(values, 1e-12 * values[-1]))
        return root[:, None] * vectors.T, (vectors.T @ moment) / root

    def mean_square(self, weights, coefficients):
        """Mean square error of coefficients (`columns × n`) on stretches."""
        gram, moment = np.tensordot(weights, self.gram, 1), weights @ self.moment
        quadratic = np.einsum("in,ij,jn->n", coefficients, gram, coefficients)
        return (weights @ self.square - 2 * moment @ coefficients + quadratic) / (weights @ self.sizes)

    @functools.cached_property
    def lasso_folds(self):
        """Coefficients by penalty, the largest penalty first, and the errors on each held fold."""
        rows, targets = self.rows(ALL)
        alphas = np.geomspace(1, 1e-3, 40) * np.abs(rows.T @ targets).max()
        errors = []
        for fold in range(FOLDS):
            held = (np.arange(STRETCHES) % FOLDS == fold).astype(float)
            errors.append(self.mean_square(held, path_of(*self.rows(ALL - held), alphas)))
        return path_of(rows, targets, alphas), np.array(errors)


ALL = np.ones(STRETCHES)


def stlsq_of(rows, targets, threshold):
    from pysindy import STLSQ

    # The ridge of the default acts on sums over rows; here, as there, it is next to nothing.
    return STLSQ(threshold=threshold, alpha=1e-6).fit(rows, targets[:, None]).coef_[0]


def stlsq(threshold):
    return lambda problem: stlsq_of(*problem.rows(ALL), threshold * problem.scale)


def bagged(threshold):
    def weigh(problem):
        random = np.random.default_rng(1)
        bags = [np.bincount(random.integers(STRETCHES, size=STRETCHES), minlength=STRETCHES) for _ in range(BAGS)]
        return np.median([stlsq_of(*problem.rows(bag), threshold * problem.scale) for bag in bags], axis=0)

    return weigh


def path_of(rows, targets, alphas):
    from sklearn.linear_model import lasso_path

    # scikit-learn divides the squares by the number of rows, which stand for a mean here.
    root = np.sqrt(len(targets))
    return lasso_path(root * rows, root * targets, alphas=alphas, precompute=True, max_iter=500, tol=1e-3)[1]


def lasso(one_error):
    """LASSO by blocked folds: the best penalty, or the largest within one standard error of the best."""

    def weigh(problem):
        paths, errors = problem.lasso_folds
        mean = errors.mean(axis=0)
        choice = mean.argmin()
        if one_error:
            bar = mean[choice] + errors[:, choice].std(ddof=1) / np.sqrt(FOLDS)
            choice = np.flatnonzero(mean <= bar)[0]
        return paths[:, choice]

    return weigh


PEERS = {
    **{f"PySINDy STLSQ {100 * threshold:g} %": stlsq(threshold) for threshold in THRESHOLDS},
    "PySINDy bagged 1 %": bagged(0.01),
    # The second takes the path of the first.
    "LASSO, best on blocked folds": lasso(one_error=False),
    "LASSO, one standard error": lasso(one_error=True),
}


def diagnosed(programs, case, scratch):
    files = json.loads((case / "recordings.json").read_text())
    held = [word for name in files["holdout"] for word in ("--holdout", case / name)]
    command = [programs / "pam-diagnose", *(case / name for name in files["estimation"]), *held, "--model",
               case / "model.json", "--out", scratch / "diagnosis.json", "--quiet"]
    seconds, _ = run(command, scratch, (0, 1))
    artifact = json.loads((scratch / "diagnosis.json").read_text())
    return seconds, [effect["id"] for effect in artifact["effects"]]


def count(sheet, truth, kind, names, effects_of, seconds):
    """Adds a case to the sheet of a method; `effects_of` says for which effects a name stands."""
    right = [bool(effects_of(name) & truth) for name in names]
    found = {effect for effect in truth if any(effect in effects_of(name) for name in names)}
    first_few = {effect for effect in truth if any(effect in effects_of(name) for name in names[: len(truth)])}
    sheet["seconds"].append(seconds)
    sheet["concealed"] += len(truth)
    sheet["found"] += len(found)
    sheet["found_first"] += len(first_few)
    sheet["names"] += len(names)
    sheet["false"] += right.count(False)
    if kind == "nothing":
        sheet["nulls"] += 1
        sheet["nulls_named"] += bool(names)
        sheet["nulls_false"] += len(names)
    if kind == "single":
        sheet["singles"] += 1
        sheet["single_first"] += bool(right and right[0])
        sheet["single_among"] += any(right)
        sheet["single_alone"] += right == [True]


def compare(programs, scratch, quick, seed, n_cases=60, folder=None):
    """On fresh cases, or on the first of those that `prove --generate-only` has left in a folder."""
    n_cases = min(n_cases, 8) if quick else n_cases
    if folder is None:
        folder = scratch / "cases"
        shutil.rmtree(folder, ignore_errors=True)
        say(f"missing physics: generating {n_cases} cases")
        run([programs / "prove", "--cases", n_cases, "--seed", seed, "--generate-only", folder, "--quiet"], scratch)
    sealed = json.loads((folder / "truth/truth.json").read_text())
    cases, seed = sealed["cases"][:n_cases], sealed["seed"]
    warnings.filterwarnings("ignore")
    keys = ("concealed", "found", "found_first", "names", "false", "nulls", "nulls_named", "nulls_false", "singles",
            "single_first", "single_among", "single_alone")
    sheets = {name: {"seconds": [], **dict.fromkeys(keys, 0)} for name in [OURS, *PEERS]}
    n_columns, building = 0, []
    for index, truth in enumerate(cases):
        say(f"missing physics: case {index + 1} of {len(cases)}")
        case = folder / "cases" / truth["name"]
        # What no catalogue has cannot be named by anyone.
        concealed = {effect["id"] for effect in truth["concealed"]} - {"rubbing-tie", "bad-spot"}
        seconds, ids = diagnosed(programs, case, scratch)
        count(sheets[OURS], concealed, truth["kind"], ids, lambda name: {name}, seconds)
        start = time.perf_counter()
        effects, names, asked = problem(programs, case, scratch)
        building.append(time.perf_counter() - start)
        n_columns = max(n_columns, len(names))
        for peer, weigh in PEERS.items():
            start = time.perf_counter()
            weights = weigh(asked)
            seconds = time.perf_counter() - start
            count(sheets[peer], concealed, truth["kind"], named(names, weights, asked), effects.get, seconds)
    for sheet in sheets.values():
        sheet["seconds"] = median(sheet["seconds"])
    return {"n_cases": len(cases), "seed": seed, "n_columns": n_columns, "building_s": median(building), "lines": [
        {"name": name, **sheet} for name, sheet in sheets.items()
    ]}
