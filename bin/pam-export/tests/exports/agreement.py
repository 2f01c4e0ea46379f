"""For every line of cases.txt, a model and a recording: the largest difference from pam-export's vectors, in N, with the moments
of the vectors and with those that the module computes from the recording."""

import dataclasses

import numpy as np
import pam_muscle as pam

NAMES = [field.name for field in dataclasses.fields(pam.Moment)]


def largest(forces_n, expected_n):
    return float(np.abs(forces_n - expected_n).max())


for case in open("cases.txt", encoding="utf-8"):
    name, log = case.split()
    vectors = np.loadtxt(f"{name}.vectors.csv", delimiter=",", skiprows=1)
    muscle, expected_n = pam.Muscle.read(f"{name}.json"), vectors[:, -1]
    memory = muscle.start()
    stepped_n = [memory.step(pam.Moment(**dict(zip(NAMES, row)))) for row in vectors[:, :-1].tolist()]
    whole_n = muscle.predict(pam.Recording.read(log))
    print(name, largest(stepped_n, expected_n), largest(whole_n, expected_n), flush=True)
