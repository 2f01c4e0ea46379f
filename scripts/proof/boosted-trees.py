#!/usr/bin/env python3
# /// script
# requires-python = ">=3.10"
# dependencies = ["numpy", "scikit-learn"]
# ///
"""Held-out RMSE, in N, of boosted trees on the signals and their past: what can be reached without any physics.

    boosted-trees.py FITTED.csv... --holdout HELD.csv...
"""
import argparse
import csv

import numpy as np
from sklearn.ensemble import HistGradientBoostingRegressor

LAGS_S = (0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32)


def features(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    column = lambda name: np.array([float(row[name]) for row in rows])
    time, pressure, length, force = (column(name) for name in ("time_s", "pressure_kPa", "length_mm", "force_N"))
    # Neighboring rows may share a stamp.
    steps = np.linspace(time[0], time[-1], len(time))
    lagged = [np.interp(steps - lag, steps, pressure) for lag in LAGS_S]
    smooth = np.convolve(np.pad(pressure, 25, mode="edge"), np.ones(51) / 51, mode="valid")
    direction = np.sign(np.gradient(smooth))
    return np.column_stack([pressure, length, direction, smooth, *lagged]), force


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fitted", nargs="+")
    parser.add_argument("--holdout", nargs="+", required=True)
    args = parser.parse_args()
    stack = lambda paths: [np.concatenate(part) for part in zip(*(features(path) for path in paths))]
    x, y = stack(args.fitted)
    trees = HistGradientBoostingRegressor(max_iter=400, learning_rate=0.06, min_samples_leaf=40, random_state=0).fit(x, y)
    x, y = stack(args.holdout)
    print(f"{np.sqrt(np.mean((trees.predict(x) - y) ** 2)):.4f}")


if __name__ == "__main__":
    main()
