"""Identification: pam-identify against what fits a model elsewhere."""

import json

import numpy as np

import eq11
from identification_peer import BUDGET, SOLVERS
from process import ROOT, median, peer, processor_s, run, say
from recording import direction, modelled, near_flip, read

MUSCLE = ROOT / "configs/muscle-nominal.toml"
OURS = "pam-identify"
# By default it starts four swarms, each of as many evaluations as a peer's one.
VARIANTS = {OURS: [], "pam-identify --starts 1": ["--starts", 1]}


def compare(programs, scratch, quick, seed):
    log, truth_path, model_path, rows_path = (
        scratch / name for name in ("log.csv", "truth.json", "model.json", "rows.csv")
    )
    run([programs / "pam-bench", "--muscle", MUSCLE, "--protocol", "isobaric-triangles", "--rate", 200,
         "--duration-scale", 0.129, "--seed", seed, "--out", log, "--truth", truth_path, "--quiet"], scratch)
    fit = [programs / "pam-identify", log, "--muscle", MUSCLE, "--quiet"]
    run([*fit, "--out", model_path], scratch)
    model, truth = json.loads(model_path.read_text()), json.loads(truth_path.read_text())
    time, pressure, length, force = read(log)
    signs = direction(programs, log, model, scratch)
    muscle = eq11.Muscle(model["geometry"])
    rows = muscle.rows(pressure, length, signs)
    off = np.abs(muscle.force(rows, eq11.theta_of(model)) - modelled(programs, log, model, scratch)).max()
    agreement = float(off / np.abs(force).max())
    if agreement > 1e-6:
        raise SystemExit(f"error: eq. 11 in NumPy is off from pam-predict by {agreement:.1e} of the largest force")
    # Friction's direction is uncertain near a reversal: those rows judge nobody.
    counts = ~near_flip(signs, 20)
    table = np.column_stack([time, pressure * 1e-3, length * 1e3, force, np.where(counts, signs, 0)])
    np.savetxt(rows_path, table, delimiter=",", fmt="%.6g", header="time_s,pressure_kPa,length_mm,force_N,direction")

    judged = tuple(column[counts] for column in rows)
    true = eq11.theta_of(truth)

    def quality(theta):
        theta = np.asarray(theta)
        parameters = np.delete(np.abs(theta / true - 1), 2)
        return float(np.sqrt(np.mean((muscle.force(judged, theta) - force[counts]) ** 2))), float(parameters.max())

    solvers = [name for name in SOLVERS if not (quick and "default" in name)]
    runs = {name: [] for name in [*VARIANTS, *solvers]}
    checks = []
    for repetition in range(1 if quick else 3):
        # Some twenty milliseconds each: three would be at the mercy of whatever else runs.
        for _ in range(9):
            for name, options in VARIANTS.items():
                before = processor_s()
                whole, _ = run([*fit, *options, "--seed", repetition + 1, "--out", model_path], scratch)
                used = processor_s() - before
                theta = eq11.theta_of(json.loads(model_path.read_text()))
                runs[name].append({"whole_s": whole, "processor_s": used, "theta": list(theta)})
            checks.append(run([*fit, "--check"], scratch)[0])
        for name in solvers:
            say(f"identification: {name}, seed {repetition + 1}")
            runs[name].append(peer("identification_peer.py", [name, repetition + 1, rows_path, model_path], scratch))
    lines = []
    for name, results in runs.items():
        qualities = [quality(result["theta"]) for result in results]
        whole = median([result["whole_s"] for result in results])
        ours = name in VARIANTS
        lines.append({
            "name": name,
            "whole_s": whole,
            "processor_s": median([result["processor_s"] for result in results]),
            # Of a program, what is left of it without reading and checking the input.
            "fit_s": whole - median(checks) if ours else median([result["fit_s"] for result in results]),
            "evaluations": None if ours else round(median([result["evaluations"] for result in results])),
            "rmse_n": [rmse for rmse, _ in qualities],
            "parameter_error": max(error for _, error in qualities),
        })
    return {
        "n_rows": len(force), "n_judged": int(counts.sum()), "agreement": agreement, "budget": BUDGET,
        "truth_rmse_n": quality(true)[0], "lines": lines, "n_runs": len(runs[solvers[0]]),
    }
