#!/usr/bin/env python3
# /// script
# dependencies = ["numpy>=2", "scipy>=1.14"]
# ///
"""Writes the MATLAB files that crates/recording/tests/reading reads, by SciPy: an independent writer.  make-mat-fixtures.py"""
import pathlib

import numpy as np
from scipy.io import savemat

FOLDER = pathlib.Path(__file__).parent.parent / "crates/recording/tests/reading/data"

index = np.arange(12)
time_s = 0.01 * index
pressure_kpa = 100.0 + 10.0 * index
length_mm = 260.0 - 0.5 * index
force_n = 20.0 + 3.0 * index


def column(values):
    return np.asarray(values).reshape(-1, 1)


def structures(rows):
    """A 1 x n structure array."""
    array = np.zeros((1, len(rows)), dtype=[(name, object) for name in rows[0]])
    for position, row in enumerate(rows):
        for name, value in row.items():
            array[0, position][name] = value
    return array


def write(name, variables, **options):
    path = FOLDER / name
    savemat(path, variables, **options)
    # The header names platform and date: the same bytes from every run.
    bytes_ = bytearray(path.read_bytes())
    text = b"MATLAB 5.0 MAT-file, written by SciPy for tests"
    bytes_[:116] = text.ljust(116)
    path.write_bytes(bytes_)


# As a script at the bench saves them: vectors of several types, a row and columns, and what is no signal.
write("vectors.mat", {
    "time_s": column(time_s),
    "p_meas": column(pressure_kpa / 100.0).astype(np.float32),
    "length_mm": length_mm,
    "force_N": column(force_n.astype(np.int16)),
    "comment": "first muscle",
    "gain": 2.5,
    "empty": np.zeros((0, 0)),
    "spectrum": column(force_n + 1j),
    "notes": np.array(["a", "b"], dtype=object),
})
# Structure with time, as Simulink's To Workspace and Scope blocks log it.
write("simulink.mat", {
    "out": {
        "time": column(time_s),
        "signals": structures([
            {"values": column(pressure_kpa), "dimensions": 1.0, "label": "pressure_kPa", "blockName": "lab/p"},
            {"values": np.stack([length_mm, force_n], axis=1), "dimensions": 2.0, "label": "", "blockName": "lab/mux"},
        ]),
        "blockName": "lab/Scope",
    },
}, do_compression=True)
# As dSPACE ControlDesk exports a measurement.
write("dspace.mat", {
    "rec_001": {
        "X": structures([{"Name": "", "Type": "Raster", "Data": time_s, "Unit": "s"}]),
        "Y": structures([
            {"Name": name, "Type": "Float64", "Data": data, "Unit": unit, "XIndex": 1.0}
            for name, data, unit in [("pressure", pressure_kpa, "kPa"), ('"Model Root/L"', length_mm, "mm"),
                                     ("force_N", force_n, "")]
        ]),
        "Description": structures([{"General": "a lift"}]),
    },
}, do_compression=True)
