"""Eq. 11 in NumPy, as the README states it; see crates/muscle/src/force for the derivations.

Written anew from the equations, so that no peer has to call the programs that it is compared with. `compare` checks
it against `pam-predict` to 1e-6 of the largest force before anything is timed. Strand friction is left out: a fit
holds it at zero, as one friction stands for both.
"""

import math

import numpy as np

# C01 / C10 of latex, at which the fitted sum is shared.
BLADDER_RATIO = 105.7 / 118.4
# Order of the parameters everywhere: k1, k2, k3 in N, C10 + C01 in Pa, 1/E in 1/Pa, f'.
NAMES = ("k1", "k2", "k3", "c10 + c01", "strand compliance", "rubber_friction")


class Muscle:
    """A muscle as measured; `geometry` is that of a model artifact, in SI."""

    def __init__(self, geometry):
        self.rest_length = geometry["rest_length_m"]
        self.radius, self.wall = geometry["rest_radius_m"], geometry["wall_thickness_m"]
        angle = geometry["braid_angle_rad"]
        self.a, self.b = 3 / math.tan(angle) ** 2, 1 / math.sin(angle) ** 2
        self.strand = self.rest_length / math.cos(angle)
        self.turns = self.strand * math.sin(angle) / (2 * math.pi * self.radius)
        section = geometry["strand_count"] * math.pi * geometry["strand_diameter_m"] ** 2 / 4
        self.strain_per_m = self.strand / (2 * math.pi * self.turns**2 * section)
        self.braid_area = self.strand**2 / (4 * math.pi * self.turns**2)
        self.mid_wall = 2 * self.radius - self.wall
        self.rubber_volume = math.pi * self.rest_length * self.wall * self.mid_wall

    def diameter(self, length, sqrt=np.sqrt):
        """Diameter in m, and its slope over the length."""
        diameter = sqrt(self.strand**2 - length * length) / (math.pi * self.turns)
        return diameter, -length / ((math.pi * self.turns) ** 2 * diameter)

    def bladder(self, length, sqrt=np.sqrt):
        """V_r dW/dL per unit of C10 + C01, in N/Pa."""
        diameter, slope = self.diameter(length, sqrt)
        inner = sqrt(diameter * diameter - 4 * self.rubber_volume / (math.pi * length))
        wall = 0.5 * (diameter - inner)
        wall_slope = -wall * ((diameter - wall) + length * slope) / (length * inner)
        l1, l2, l3 = length / self.rest_length, (diameter - wall) / self.mid_wall, wall / self.wall
        d1, d2, d3 = 1 / self.rest_length, (slope - wall_slope) / self.mid_wall, wall_slope / self.wall
        q1, q2, q3 = l1 * l1, l2 * l2, l3 * l3
        by_c10 = 2 * self.rubber_volume * (l1 * d1 + l2 * d2 + l3 * d3)
        by_c01 = 2 * self.rubber_volume * (l1 * (q2 + q3) * d1 + l2 * (q1 + q3) * d2 + l3 * (q1 + q2) * d3)
        return (by_c10 + BLADDER_RATIO * by_c01) / (1 + BLADDER_RATIO)

    def volume(self, length):
        """Volume inside the braid, in m³, and its slope over the length."""
        share = 1 / (4 * math.pi * self.turns**2)
        return length * (self.strand**2 - length * length) * share, (self.strand**2 - 3 * length * length) * share

    def rows(self, pressure, length, direction, sqrt=np.sqrt):
        """What of eq. 11 depends on the recording alone: computed once before a fit. SI; direction ±1."""
        diameter, _ = self.diameter(length, sqrt)
        return (
            math.pi * self.radius**2 * pressure,
            (self.rest_length - length) / self.rest_length,
            self.bladder(length, sqrt),
            self.strain_per_m * pressure * length,
            self.braid_area * pressure,
            direction * pressure * math.pi * diameter * length,
        )

    def force(self, rows, theta):
        """Force in N of `rows` with the six parameters of NAMES."""
        thrust, contraction, bladder, strain_per_compliance, braid, friction = rows
        k1, k2, k3, c_sum, compliance, f = theta
        reach = 1 - k2 * contraction
        strain = compliance * strain_per_compliance
        rest = 1 - strain
        stretch = braid * strain * (2 - strain) / (rest * rest)
        return k1 * thrust * (self.a * reach * reach - self.b) + k3 + c_sum * bladder - stretch - f * friction


def theta_of(model):
    """The six parameters of a model artifact."""
    value = {parameter["name"]: parameter["value"] for parameter in model["parameters"]}
    return np.array([
        value["k1"], value["k2"], value["k3"], value["c10"] + value["c01"], 1 / value["strand_modulus"],
        value["rubber_friction"],
    ])


def bounds(muscle, pressure, length):
    """The box that pam-identify searches: physics, and strands that stretch by 15 % at most."""
    stiffest, softest = 1e-12, 1 / 0.2e9
    softest = min(softest, 0.15 / (muscle.strain_per_m * np.max(pressure * length)))
    low = np.array([0.2, 0.5, -50.0, 0.0, stiffest, 0.0])
    high = np.array([2.0, 3.0, 50.0, 2.0e6, softest, 0.03])
    return low, high


# Where pam-identify, too, holds a parameter that a recording does not tell: a good start.
def nominal(strand_modulus_pa):
    return np.array([0.9, 1.05, 0.0, 224.1e3, 1 / strand_modulus_pa, 1.2e-3])
