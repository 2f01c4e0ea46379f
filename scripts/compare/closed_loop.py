"""Closed loop: exo-track against the same plant and controller in Python on SciPy's solve_ivp."""

import csv
import re

import numpy as np

from inverse_network import BENCH, MUSCLE, RECORDINGS
from process import ROOT, median, peer, run, say

OURS = "exo-track"
METHODS = ("RK23", "RK45", "LSODA")
TOLERANCES = ("1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7")
# What both must agree to at the finest steps, or one of them simulates something else: a thousandth of the errors
# of tracking, about.
AGREE_RAD = 1e-6


def configuration(step_ms):
    """configs/lift.toml with sensors that neither err nor round: one noise cannot be drawn in two languages."""
    text = (ROOT / "configs/lift.toml").read_text()
    for key in ("angle_noise_mrad", "angle_step_mrad", "pressure_noise_kpa", "pressure_step_kpa"):
        text = re.sub(rf"^{key} = \S+", f"{key} = 0.0", text, flags=re.M)
    return re.sub(r"^step_ms = \S+", f"step_ms = {step_ms}", text, flags=re.M)


def angles(path):
    return np.loadtxt(path, delimiter=",")[:, 1]


def ours(path):
    with open(path, newline="") as file:
        return np.array([float(row["left_angle_rad"]) for row in csv.DictReader(file)])


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def compare(programs, scratch, quick, seed):
    del seed  # Nothing is drawn.
    model, track = scratch / "model.json", scratch / "track.csv"
    run([programs / "pam-identify", *(BENCH / f"{name}.csv" for name in RECORDINGS), "--muscle", MUSCLE, "--out",
         model, "--quiet"], scratch)
    steps_ms = (1.0, 0.1)
    lifts = {}
    for step in (*steps_ms, 0.01):
        path = scratch / f"lift-{step}.toml"
        path.write_text(configuration(step))
        lifts[step] = path

    def python(method, tolerance):
        say(f"closed loop: solve_ivp {method}, rtol {tolerance}")
        return peer("closed_loop_peer.py", [lifts[1.0], model, method, tolerance, track], scratch)

    python("DOP853", "1e-10")
    exact = angles(track)

    def lift(step, *more):
        return run([programs / "exo-track", "--config", lifts[step], "--model", model, "--quiet", *more], scratch)[0]

    lift(0.01, "--out", track)
    agreement = ours(track) - exact
    if rms(agreement) > AGREE_RAD:
        raise SystemExit(f"error: exo-track and Python differ by {rms(agreement):.1e} rad: not the same plant")
    tracked = np.abs(exact - reference_angles(track))

    errors = {}
    for step in steps_ms:
        lift(step, "--out", track)
        errors[step] = rms(ours(track) - exact)
    ladder = []
    for method in METHODS:
        for tolerance in TOLERANCES:
            report = python(method, tolerance)
            ladder.append({"method": method, "rtol": tolerance, "error_rad": rms(angles(track) - exact),
                           "fit_s": report["fit_s"]})
            if ladder[-1]["error_rad"] < min(errors.values()):
                break
    lines = []
    n_few, n_many = (10, 60) if quick else (20, 220)
    for step in steps_ms:
        good = [entry for entry in ladder if entry["error_rad"] <= errors[step]]
        chosen = min(good, key=lambda entry: entry["fit_s"])
        whole, per_lift, peers = [], [], []
        for _ in range(2 if quick else 5):
            whole += [lift(step, "--out", track) for _ in range(3)]
            few, many = (lift(step, "--out", track, "--trials", n, "--threads", 1) for n in (n_few, n_many))
            per_lift.append((many - few) / (n_many - n_few))
            peers.append(python(chosen["method"], chosen["rtol"]))
        lines.append({
            "step_ms": step, "error_rad": errors[step], "whole_s": median(whole), "lift_s": median(per_lift),
            "peer": {**chosen, "fit_s": median([report["fit_s"] for report in peers]),
                     "whole_s": median([report["whole_s"] for report in peers])},
        })
    return {"agreement_rms_rad": rms(agreement), "agreement_max_rad": float(np.abs(agreement).max()),
            "tracking_max_rad": float(tracked.max()), "lines": lines, "ladder": ladder}


def reference_angles(path):
    with open(path, newline="") as file:
        return np.array([float(row["reference_angle_rad"]) for row in csv.DictReader(file)])
