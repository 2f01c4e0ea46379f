"""Recordings as pam-bench writes them, with the direction of motion that the programs see."""

import json

import numpy as np

from process import run


def read(path):
    """Columns of a log in SI: time, pressure, length, force; uncounted columns beyond."""
    columns = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
    time, pressure, length, force, *rest = columns
    return (time, pressure * 1e3, length * 1e-3, force, *rest)


def modelled(programs, log, model, scratch):
    """Force of a model along a log as pam-predict says, in N."""
    path, out = scratch / "model-asked.json", scratch / "predicted.csv"
    path.write_text(json.dumps(model))
    run([programs / "pam-predict", log, "--model", path, "--out", out, "--quiet"], scratch)
    return read(out)[4]


def with_friction(model, coefficient):
    """The model with another coefficient of friction."""
    parameters = [dict(p, value=coefficient) if p["name"] == "rubber_friction" else p for p in model["parameters"]]
    return dict(model, parameters=parameters)


def direction(programs, log, model, scratch):
    """Direction of motion of every row, as the programs take it: what friction does to the model's force."""
    without, rubbed = (modelled(programs, log, with_friction(model, f), scratch) for f in (0.0, 0.01))
    # Friction is a share of the pressure, which noise takes below zero where the muscle is vented.
    signs = np.sign(np.round(without - rubbed, 3)) * np.sign(read(log)[1])
    known = np.flatnonzero(signs)
    return signs[known[np.maximum(np.searchsorted(known, np.arange(len(signs)), side="right") - 1, 0)]]


def near_flip(signs, rows):
    """Whether a row is within `rows` rows of a change of direction."""
    flips = np.flatnonzero(np.diff(signs)) + 1
    marks = np.zeros(len(signs) + 1)
    np.add.at(marks, np.maximum(flips - rows, 0), 1)
    np.add.at(marks, np.minimum(flips + rows, len(signs)), -1)
    return np.cumsum(marks)[:-1] > 0
