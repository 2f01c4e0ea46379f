#!/usr/bin/env python3
"""Pressure (Pa) of a pam-inverse/1 file for lines of force (N), length (m) and direction (+1 contracting, -1 extending);
a 1 after it says that the point is outside the domain.  evaluate-inverse.py inverse.json < points.txt"""
import json, math, sys

ACTIVATIONS = {"tanh": math.tanh, "sigmoid": lambda z: 1 / (1 + math.exp(-z)), "linear": lambda z: z}

def pressure_pa(net, point):
    answers = [(value - s["offset"]) / s["scale"] for value, s in zip(point, net["input_scaling"])]
    for weights, biases, name in zip(net["weights"], net["biases"], net["activations"]):
        sums = [sum(w * a for w, a in zip(row, answers)) + bias for row, bias in zip(weights, biases)]
        answers = [ACTIVATIONS[name](z) for z in sums]
    return net["output_scaling"]["offset"] + net["output_scaling"]["scale"] * answers[0]

def is_outside(domain, force_n, length_m, direction):
    (short, long), reach = domain["length_m"], domain["reach"]
    at = (length_m - short) / (long - short) * (len(reach) - 1)
    if not (0 <= at <= len(reach) - 1 and -1 <= direction <= 1):
        return True
    below = min(int(at), len(reach) - 2)
    limits = [[r["extending_force_n"], r["contracting_force_n"]] for r in reach[below:below + 2]]
    if None in limits[0] + limits[1]:
        return True
    mix = lambda a, b, share: [(1 - share) * x + share * y for x, y in zip(a, b)]
    lowest, highest = mix(*(mix(*pair, (1 + direction) / 2) for pair in limits), at - below)
    return not lowest <= force_n <= highest

network = json.load(open(sys.argv[1], encoding="utf-8"))
for point in (list(map(float, line.split())) for line in sys.stdin):
    print(repr(pressure_pa(network, point)), int(is_outside(network["domain"], *point)))
