#!/usr/bin/env python3
# /// script
# requires-python = ">=3.10"
# dependencies = ["numpy", "scikit-learn"]
# ///
"""Held-out RMSE, in N, of boosted trees on the signals and their past: what can be reached without any physics.

    boosted-trees.py FITTED.csv... --holdout HELD.csv... [--truth HELD.csv...]

With --truth the error is that against the forces of those files, row by row. With --beside-model the files are those that pam-predict
writes, and the trees learn what its model leaves: they need not learn eq. 11, nor leave its range.
"""
import argparse
import csv

import numpy as np
from sklearn.ensemble import HistGradientBoostingRegressor

LAGS_S = (0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32)


def columns(path, *names):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [np.array([float(row[name]) for row in rows]) for name in names]


def features(path):
    time, pressure, length, force = columns(path, "time_s", "pressure_kPa", "length_mm", "force_N")
    # Neighboring rows may share a stamp.
    steps = np.linspace(time[0], time[-1], len(time))
    lagged = [np.interp(steps - lag, steps, pressure) for lag in LAGS_S]
    smooth = np.convolve(np.pad(pressure, 25, mode="edge"), np.ones(51) / 51, mode="valid")
    direction = np.sign(np.gradient(smooth))
    return np.column_stack([pressure, length, direction, smooth, *lagged]), force


def concatenated(paths, name):
    return np.concatenate([columns(path, name)[0] for path in paths])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fitted", nargs="+")
    parser.add_argument("--holdout", nargs="+", required=True)
    parser.add_argument("--truth", nargs="+")
    parser.add_argument("--beside-model", action="store_true")
    args = parser.parse_args()
    stack = lambda paths: [np.concatenate(part) for part in zip(*(features(path) for path in paths))]
    given = lambda paths: concatenated(paths, "force_model_N") if args.beside_model else 0.0
    x, y = stack(args.fitted)
    trees = HistGradientBoostingRegressor(max_iter=400, learning_rate=0.06, min_samples_leaf=40, random_state=0)
    trees.fit(x, y - given(args.fitted))
    x, y = stack(args.holdout)
    if args.truth:
        y = concatenated(args.truth, "force_N")
    print(f"{np.sqrt(np.mean((given(args.holdout) + trees.predict(x) - y) ** 2)):.4f}")


if __name__ == "__main__":
    main()
