"""Inverse network: pam-train-inverse against scikit-learn's MLPRegressor of equal size, to equal error."""

import json
import re
import time
import warnings

import numpy as np

import eq11
from process import ROOT, median, run, say

MUSCLE = ROOT / "configs/muscle-nominal.toml"
BENCH = ROOT / "datasets/bench-nominal"
RECORDINGS = ("isobaric-triangles", "isometric-ramps", "minor-loops", "length-steps")
OURS = "pam-train-inverse"
# As a peer is timed: one start, and its judging left out as far as it can be.
ALIKE = f"{OURS}, one start, unjudged"
VARIANTS = {OURS: [], ALIKE: ["--starts", 1, "--judge-points", 100]}
# What it says of that itself: without start, reading and drawing the points, and writing.
TRAINING = "its training alone"
SIZES = ((20,), (12, 12))
# RMSE of the pressure on unseen points, in percent of its range.
GOALS_PERCENT = (1.0, 0.3, 0.1, 0.03)
N_POINTS, N_HELD = 2000, 20_000
# Of ours, for each seed: some ten milliseconds each.
RUNS = 9
LBFGS_STEPS = (25, 50, 100, 200, 400, 800, 1600, 3200, 6400, 12_800, 25_600, 51_200)


class Points:
    """Points where the model has an inverse, drawn as pam-train-inverse draws its own, and scaled as it scales them."""

    def __init__(self, model):
        self.theta, self.muscle = eq11.theta_of(model), eq11.Muscle(model["geometry"])
        domain = model["domain"]
        self.pressure, self.length = domain["pressure_pa"], domain["length_m"]
        self.force = [max(domain["force_n"][0], 0.0), domain["force_n"][1]]
        self.span = self.pressure[1] - self.pressure[0]
        self.least_slope = 0.05 * (self.force[1] - self.force[0]) / self.span

    def force_of(self, pressure, length, direction):
        return self.muscle.force(self.muscle.rows(pressure, length, direction), self.theta)

    def draw(self, n, seed, design):
        """Inputs (force, length, direction) and pressure, each scaled to -1 to 1."""
        random = np.random.default_rng(seed)
        if design:
            g = 1.2207440846057596
            steps = np.arange(1, n + 1)[:, None] * g ** -np.arange(1.0, 4.0)
            shares = ((random.uniform(size=3) + steps) % 1 - 0.5) * 1.04 + 0.5
            p, l, s = np.clip(shares, 0, 1).T
            direction = np.clip((s - 0.5) * 10, -1, 1)
        else:
            p, l, s = random.uniform(size=(3, n))
            direction = np.sign(s - 0.5)
        length = self.length[0] + l * (self.length[1] - self.length[0])
        # The branch on which the force grows with the pressure ends where strands give way.
        grid = self.pressure[0] + self.span * np.linspace(0, 1, 257)
        reach = 1e-5 * self.span
        slope = (self.force_of(grid + reach, length[:, None], direction[:, None])
                 - self.force_of(grid - reach, length[:, None], direction[:, None])) / (2 * reach)
        force = self.force_of(grid, length[:, None], direction[:, None])
        rises = (slope >= self.least_slope) & (force >= self.force[0]) & (force <= self.force[1])
        first, last = rises.argmax(axis=1), 256 - rises[:, ::-1].argmax(axis=1)
        pressure = grid[first] + p * (grid[last] - grid[first])
        kept = rises.any(axis=1)
        return self.scaled(pressure[kept], length[kept], direction[kept])

    def scaled(self, pressure, length, direction):
        unit = lambda values, ends: (values - 0.5 * (ends[0] + ends[1])) / (0.5 * (ends[1] - ends[0]))
        force = self.force_of(pressure, length, direction)
        inputs = np.column_stack([unit(force, self.force), unit(length, self.length), direction])
        return inputs, unit(pressure, self.pressure)


def error_percent(answers, targets):
    """RMSE in percent of the range of pressure, which is 2 scaled."""
    return float(50 * np.sqrt(np.mean((answers - targets) ** 2)))


def ours_on(network, inputs):
    """A pam-inverse/1 network on inputs scaled to its box."""
    values = inputs
    for weights, biases, activation in zip(network["weights"], network["biases"], network["activations"]):
        sums = values @ np.array(weights).T + np.array(biases)
        values = np.tanh(sums) if activation == "tanh" else sums
    return values[:, 0]


def adam(size, training, held, seed, budget_s):
    """(seconds, error) along a training by adam, judging left out; and whether it ended by itself."""
    from sklearn.neural_network import MLPRegressor

    network = MLPRegressor(hidden_layer_sizes=size, activation="tanh", solver="adam", alpha=0, random_state=seed)
    spent, track, judge_at = 0.0, [], 0.0
    while spent < budget_s:
        start = time.perf_counter()
        network.partial_fit(*training)
        spent += time.perf_counter() - start
        if spent >= judge_at:
            track.append((spent, error_percent(network.predict(held[0]), held[1])))
            judge_at = spent * 1.05
    return track, False


def lbfgs(size, training, held, seed, budget_s):
    """The same by lbfgs: from the start for each number of steps, as it cannot be watched."""
    from sklearn.neural_network import MLPRegressor

    track = []
    for steps in LBFGS_STEPS:
        network = MLPRegressor(hidden_layer_sizes=size, activation="tanh", solver="lbfgs", alpha=0, tol=1e-12, random_state=seed,
                               max_iter=steps, max_fun=100 * steps)
        start = time.perf_counter()
        network.fit(*training)
        seconds = time.perf_counter() - start
        track.append((seconds, error_percent(network.predict(held[0]), held[1])))
        if network.n_iter_ < steps:
            return track, True
        if seconds > budget_s / 2:
            break
    return track, False


def first_below(track, goal):
    """Seconds until the error is below the goal; none if never."""
    return next((seconds for seconds, error in track if error <= goal), None)


def trained_s(said):
    """Seconds that pam-train-inverse says its training took."""
    return float(re.search(r"^Training of .* in (\S+) s$", said, re.MULTILINE)[1])


def best_within(track, seconds):
    return min((error for at, error in track if at <= seconds), default=None)


def compare(programs, scratch, quick, seed):
    warnings.filterwarnings("ignore")
    model_path, inverse_path = scratch / "model.json", scratch / "inverse.json"
    run([programs / "pam-identify", *(BENCH / f"{name}.csv" for name in RECORDINGS), "--muscle", MUSCLE, "--out",
         model_path, "--quiet"], scratch)
    points = Points(json.loads(model_path.read_text()))
    held = points.draw(N_HELD, 1000 + seed, design=False)
    n_seeds, budget_s = (1, 5) if quick else (3, 20)
    lines = []
    for size in SIZES:
        train = [programs / "pam-train-inverse", "--model", model_path, "--hidden", ",".join(map(str, size)),
                 "--out", inverse_path]
        goals = (None, *GOALS_PERCENT)
        spent = {name: {goal: [] for goal in goals} for name in VARIANTS}
        reached = {name: {goal: [] for goal in goals} for name in VARIANTS}
        alone = {goal: [] for goal in goals}
        tracks = {"adam": [], "lbfgs": []}
        for repetition in range(n_seeds):
            for goal in goals:
                # Judged on other points than it stops by: a little below the goal.
                aim = [] if goal is None else ["--goal-percent", 0.8 * goal]
                for name, options in VARIANTS.items():
                    runs = [run([*train, *options, *aim, "--seed", seed + repetition], scratch, (0, 1), says="stderr")
                            for _ in range(RUNS)]
                    spent[name][goal].append(median([seconds for seconds, _ in runs]))
                    if name == ALIKE:
                        alone[goal].append(median([trained_s(said) for _, said in runs]))
                    inverse = json.loads(inverse_path.read_text())
                    reached[name][goal].append(error_percent(ours_on(inverse, held[0]), held[1]))
            training = points.draw(N_POINTS, seed + repetition, design=True)
            for name, descend in (("adam", adam), ("lbfgs", lbfgs)):
                say(f"inverse network: {size}, {name}, seed {repetition + 1}")
                tracks[name].append(descend(size, training, held, seed + repetition, budget_s))
        spent[TRAINING], reached[TRAINING] = alone, reached[ALIKE]
        own_end, final = median(alone[None]), median(reached[ALIKE][None])
        line = {"size": size, "ours": [{
            "name": name, "whole_s": median(spent[name][None]), "error_percent": reached[name][None],
            "to_goal": [
                {"goal": goal, "seconds": median(spent[name][goal]), "error": median(reached[name][goal])}
                for goal in GOALS_PERCENT
            ],
        } for name in (*VARIANTS, TRAINING)], "final": final, "peers": []}
        for name, runs in tracks.items():
            to_goal = []
            for goal in (*GOALS_PERCENT, final):
                times = [first_below(track, goal) for track, _ in runs]
                # A run that never gets there counts as longer than all that do.
                times = sorted(times, key=lambda seconds: np.inf if seconds is None else seconds)
                middle = times[len(times) // 2]
                to_goal.append({"goal": goal, "seconds": middle, "of": len(runs),
                                "reached": sum(seconds is not None for seconds in times)})
            line["peers"].append({
                "name": name, "to_goal": to_goal, "longest_s": max(track[-1][0] for track, _ in runs), "ended": all(ended for _, ended in runs),
                "best_percent": [min(error for _, error in track) for track, _ in runs],
                "at_equal_time": [best_within(track, own_end) for track, _ in runs],
            })
        lines.append(line)
    return {"n_points": N_POINTS, "n_held": len(held[1]), "budget_s": budget_s, "lines": lines}
