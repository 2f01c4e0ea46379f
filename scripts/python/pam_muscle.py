"""Force of a pneumatic muscle and its inverse, from model.json and inverse.json; one file, NumPy alone.

    import pam_muscle as pam

    muscle = pam.Muscle.read("model.json")              # what pam-identify or pam-diagnose wrote, effects and all
    muscle.force_n(3e5, 0.25, +1)                       # eq. 11: gauge pressure in Pa, length in m, +1 contracting; arrays too
    muscle.settled_force_n(3e5, 0.25, +1)               # with the effects, where the muscle has long been
    force_n = muscle.predict(pam.Recording.read("run.csv"))    # what pam-predict calls force_model_N

    inverse = pam.Inverse.read("inverse.json")          # what pam-train-inverse wrote
    pressure_pa, outside = inverse.pressure_pa(200.0, 0.25, +1)

    memory = muscle.start()                             # step by step, in a simulation of one's own
    force_n = memory.step(pam.Moment(time_s=0.0, step_s=0.0, pressure_pa=3e5, length_m=0.25, ...))

Everything is SI. `predict` prepares a recording as pam-predict does: it smooths, dates each turn of the motion back to where the
length turned, and looks ahead whether a length stands still, so it needs the whole recording. `Memory.step` uses nothing after
the present moment and takes the kinematics from its caller.

Of pam-predict's reading, `Recording.read` does the plain part: a CSV file with a header such as
time_s,pressure_kPa,length_mm,force_N and stamps that rise. Files that need repairs go through pam-predict first.
"""

import csv
import dataclasses
import json
import math

import numpy as np

# --- Eq. 11 ------------------------------------------------------------------------------------------------------------------


# C10 + C01 of latex, in Pa: what effects of rubber are measured against.
LATEX_PA = 2.2e5


class Eq11:
    """Eq. 11 of one muscle: gas on a braid, rubber, strands that stretch, friction. Scalars and arrays alike."""

    def __init__(self, model):
        geometry = model["geometry"]
        value = {entry["name"]: np.float64(entry["value"]) for entry in model["parameters"]}
        self.k1, self.k2, self.k3_n = value["k1"], value["k2"], value["k3"]
        self.c10_pa, self.c01_pa = value["c10"], value["c01"]
        self.compliance_per_pa = 1.0 / value["strand_modulus"]
        self.rubber_friction, self.strand_friction = value["rubber_friction"], value["strand_friction"]
        self.as_printed = model["form"] == "as-printed"
        self.rest_length_m = np.float64(geometry["rest_length_m"])
        self.rest_radius_m = np.float64(geometry["rest_radius_m"])
        angle_rad = np.float64(geometry["braid_angle_rad"])
        wall_m, strands = np.float64(geometry["wall_thickness_m"]), np.float64(geometry["strand_count"])
        strand_diameter_m = np.float64(geometry["strand_diameter_m"])
        strand_m = self.rest_length_m / np.cos(angle_rad)
        turns = strand_m * np.sin(angle_rad) / (2.0 * np.pi * self.rest_radius_m)
        self.max_contraction_ratio = 1.0 - 1.0 / (np.sqrt(3.0) * np.cos(angle_rad))
        section_m2 = strands * np.pi * strand_diameter_m * strand_diameter_m / 4.0
        self.strand_square_m2 = strand_m**2
        self.per_pi_turns = 1.0 / (np.pi * turns)
        self.area_m2 = np.pi * self.rest_radius_m * self.rest_radius_m
        self.gas_a, self.gas_b = 3.0 / np.tan(angle_rad) ** 2, 1.0 / np.sin(angle_rad) ** 2
        self.rest_mid_wall_m, self.wall_m = 2.0 * self.rest_radius_m - wall_m, wall_m
        self.rubber_m3 = np.pi * self.rest_length_m * wall_m * self.rest_mid_wall_m
        # Strain of the strands per pressure, length and compliance: from equilibrium, and as the paper prints it.
        balanced_per_m = strand_m / (2.0 * np.pi * turns * turns * section_m2)
        if self.as_printed:
            self.strain_per_m = strand_m / (np.pi * turns * section_m2)
            self.braid_area_m2 = strand_m * strand_m / (np.pi * turns)
        else:
            self.strain_per_m = balanced_per_m
            self.braid_area_m2 = strand_m * strand_m / (4.0 * np.pi * turns * turns)
        modulus_pa = np.float64(model["strand_modulus_pa"])
        self.slide_per_pa_m = balanced_per_m / modulus_pa
        self.crossings = 0.5 * turns * strands * strands
        self.hertz_m_per_pa = 1.5 * (0.5 * strand_diameter_m) * (1.0 - 0.4 * 0.4) / modulus_pa
        stiffness_pa = self.c10_pa + self.c01_pa
        self.c10_share = self.c10_pa / stiffness_pa if stiffness_pa > 0.0 else 118.4 / (118.4 + 105.7)

    def diameter_m(self, length_m):
        """Diameter of the muscle; not a number where the strands are straight."""
        with np.errstate(invalid="ignore"):
            return np.sqrt(self.strand_square_m2 - length_m * length_m) * self.per_pi_turns

    def diameter_slope(self, length_m, diameter_m):
        """dD/dL."""
        return -length_m * (self.per_pi_turns * self.per_pi_turns) / diameter_m

    def slide_m_per_pa(self, length_m):
        """How far the strands slide over one another per pascal while the length is held."""
        return self.slide_per_pa_m * length_m * length_m

    def bladder_n_per_pa(self, length_m, diameter_m):
        """Forces of the bladder per unit of C10 and of C01."""
        inner_m = np.sqrt(diameter_m * diameter_m - 4.0 * self.rubber_m3 / np.pi / length_m)
        wall_m = 0.5 * (diameter_m - inner_m)
        slope = self.diameter_slope(length_m, diameter_m)
        wall_slope = -wall_m * ((diameter_m - wall_m) + length_m * slope) / (length_m * inner_m)
        d1 = 1.0 / self.rest_length_m
        l1, l2, l3 = length_m * d1, (diameter_m - wall_m) / self.rest_mid_wall_m, wall_m / self.wall_m
        d2, d3 = (slope - wall_slope) / self.rest_mid_wall_m, wall_slope / self.wall_m
        q1, q2, q3 = l1 * l1, l2 * l2, l3 * l3
        return (
            2.0 * self.rubber_m3 * (l1 * d1 + l2 * d2 + l3 * d3),
            2.0 * self.rubber_m3 * (l1 * (q2 + q3) * d1 + l2 * (q1 + q3) * d2 + l3 * (q1 + q2) * d3),
        )

    def braid_n(self, pressure_pa, length_m):
        """Loss by the stretch of the strands; not a number where the strain reaches 1."""
        strain = self.strain_per_m * pressure_pa * length_m * self.compliance_per_pa
        rest = np.where(strain < 1.0, 1.0 - strain, np.nan)[()]
        share = strain / rest**3 if self.as_printed else strain * (2.0 - strain) / (rest * rest)
        return self.braid_area_m2 * pressure_pa * share

    def base(self, pressure_pa, length_m):
        """The terms that effects are made of."""
        with np.errstate(invalid="ignore", divide="ignore"):
            contraction_ratio = (self.rest_length_m - length_m) / self.rest_length_m
            reach = 1.0 - self.k2 * contraction_ratio
            gas_n = self.k1 * self.area_m2 * pressure_pa * (self.gas_a * reach * reach - self.gas_b)
            diameter_m = self.diameter_m(length_m)
            by_c10, by_c01 = self.bladder_n_per_pa(length_m, diameter_m)
            bladder_n = (self.c10_pa * by_c10 + self.c01_pa * by_c01) * (-1.0 if self.as_printed else 1.0)
            normal_n = pressure_pa * np.pi * diameter_m * length_m
            friction_n = self.rubber_friction * normal_n
            if self.strand_friction != 0.0:
                radius_m = np.cbrt(self.hertz_m_per_pa * (np.maximum(normal_n, 0.0) / self.crossings))
                contact_m2 = self.crossings * np.pi * radius_m * radius_m
                friction_n = friction_n + self.strand_friction * (contact_m2 * pressure_pa)
            static_n = gas_n + self.k3_n + bladder_n - self.braid_n(pressure_pa, length_m)
            per_pa = self.c10_share * by_c10 + (1.0 - self.c10_share) * by_c01
        return Base(gas_n, normal_n, static_n, friction_n, per_pa * LATEX_PA)

    def force_n(self, pressure_pa, length_m, direction):
        """Force, with friction against the direction of motion: +1 contracting, -1 extending."""
        base = self.base(np.asarray(pressure_pa, float)[()], np.asarray(length_m, float)[()])
        return base.static_n - direction * base.friction_n


@dataclasses.dataclass
class Base:
    """Eq. 11 at one pressure and length, in N."""

    gas_n: float
    normal_n: float  # p pi D L
    static_n: float  # without friction
    friction_n: float  # while contracting; a loss
    latex_n: float  # a bladder of latex, C10 + C01 = 0.22 MPa
    slope_n_per_pa: float = 0.0  # of the force without friction; for effects that use it
    slope_n_per_m: float = 0.0


@dataclasses.dataclass
class Moment:
    """One instant, in SI. Pressure and length are as measured; rates, contraction and slide are smooth."""

    time_s: float  # since the start
    step_s: float  # since the instant before; 0 at the first and after a gap
    pressure_pa: float
    pressure_rate_pa_per_s: float
    length_m: float
    contraction_ratio: float  # (L0 - L) / L0 of a smooth length
    speed_m_per_s: float  # of contraction
    slide_speed_m_per_s: float  # of the braid: the same, and at rest that by pressure
    acceleration_m_per_s2: float  # of contraction
    direction: float  # of friction: +1 contracting, -1 extending
    came: float  # 1 where the muscle is known to have come in that direction
    slide_m: float  # travel of the braid, rising while it contracts
    rest_slide_m: float  # the part of it that pressure has made at rest
    force_n: float  # measured, smooth; the model's own of the step before where none is measured
    warmth_k: float = 0.0  # logged temperature above 20 C; 0 where none is logged


# --- Effects -----------------------------------------------------------------------------------------------------------------
#
# An effect has some of four methods, called in this order at every moment: `sees` changes what the muscle sees, `slides` gives the
# state of friction, `pulls` a force, `reads` what the load cell shows. It is made from its parameters and eq. 11.


class Slip:
    """Maxwell slip: six springs in parallel, each of which slips at its own distance."""

    DISTANCES = (0.15, 0.35, 0.7, 1.3, 2.3, 4.5)
    WEIGHTS = (0.14, 0.17, 0.22, 0.21, 0.17, 0.09)

    def __init__(self, distance):
        self.distance, self.states, self.last = distance, None, None

    def turn(self, by):
        """Turns every element over by `by`, from -1 to 1 by 2."""
        self.states = [min(max(z + by, -1.0), 1.0) for z in self.states]

    def follow(self, position, settled):
        """Share of the full force, in [-1, 1]; `settled` is that at the first moment."""
        if self.states is None:
            self.states, self.last = [settled] * 6, position
        step = (position - self.last) / self.distance
        self.last = position
        self.states = [min(max(z + step / r, -1.0), 1.0) for z, r in zip(self.states, self.DISTANCES)]
        share = 0.0
        for weight, state in zip(self.WEIGHTS, self.states):
            share += weight * state
        return share


class Overstress:
    """Generalized Maxwell body with three time constants, each ten times the one before."""

    def __init__(self, time_constant_s):
        self.times_s = [time_constant_s, 10.0 * time_constant_s, 100.0 * time_constant_s]
        self.overstress, self.last = [0.0] * 3, None

    def follow(self, now, driver):
        """Overstress of each state; exact for a driver that moves evenly between moments."""
        if self.last is not None and now.time_s >= self.last[0]:
            step_s = now.step_s if now.step_s > 0.0 else now.time_s - self.last[0]
            change = driver - self.last[1]
            for index, time_s in enumerate(self.times_s):
                ratio = step_s / time_s
                decay, gain = (math.exp(-ratio), -math.expm1(-ratio) / ratio) if step_s > 0.0 else (1.0, 1.0)
                self.overstress[index] = self.overstress[index] * decay + change * gain
        else:
            self.overstress = [0.0] * 3
        self.last = (now.time_s, driver)
        return self.overstress


class ChannelDelay:
    """Belongs to recordings: `shift` moves their channels."""

    def __init__(self, values, eq11):
        self.delays_s = (values["pressure_delay_s"], values["length_delay_s"])


class PressureGaugeHysteresis:
    uses_slopes = True

    def __init__(self, values, eq11):
        self.slip, self.width_pa = Slip(values["slip_pressure_pa"]), values["width_pa"]

    def pulls(self, now, base):
        return base.slope_n_per_pa * self.slip.follow(now.pressure_pa, 0.0) * self.width_pa


class ForceDrift:
    def __init__(self, values, eq11):
        self.values = values

    def pulls(self, now, base):
        warm_up = -math.expm1(-now.time_s / self.values["warm_up_s"])
        return now.time_s * self.values["drift_n_per_s"] + warm_up * self.values["warm_up_n"]


class SeriesCompliance:
    TURN_M = 1e-4

    def __init__(self, values, eq11):
        self.values, self.rest_length_m, self.last = values, eq11.rest_length_m, None

    def sees(self, now):
        hardened = self.values["hardening_per_n"] * max(now.force_n, 0.0)
        softer = math.log1p(hardened) / hardened if hardened > 1e-9 else 1.0
        stretch_m = self.values["compliance_m_per_n"] * now.force_n * softer
        now.length_m -= stretch_m
        now.contraction_ratio += stretch_m / self.rest_length_m
        now.slide_m += stretch_m
        # The muscle turns where its own length does, not where the recorded one does.
        turned = now.direction
        if self.last is not None:
            slide_m, direction = self.last
            turned = min(max(direction + 2.0 * (now.slide_m - slide_m) / self.TURN_M, -1.0), 1.0)
        self.last = (now.slide_m, turned)
        now.direction += self.values["sliding_share"] * (turned - now.direction)


class Inertia:
    def __init__(self, values, eq11):
        self.rad_per_s, self.mass_kg, self.state = 2.0 * math.pi * values["mount_hz"], values["mass_kg"], None

    def pulls(self, now, base):
        driven, step_s = now.acceleration_m_per_s2, now.step_s
        if self.state is None or not step_s > 0.0:
            self.state = (driven, 0.0)
        else:
            value, rate = self.state
            ahead, decay = value - driven, math.exp(-self.rad_per_s * step_s)
            slide = rate + self.rad_per_s * ahead
            self.state = (driven + (ahead + slide * step_s) * decay, (rate - slide * self.rad_per_s * step_s) * decay)
        return -self.state[0] * self.mass_kg


class Slack:
    def __init__(self, values, eq11):
        self.floor_n, self.softness_n = values["floor_n"], values["softness_n"]

    def reads(self, force_n):
        return self.floor_n + self.taut_n(force_n - self.floor_n)

    def taut_n(self, above_n):
        """h where h - w^3 / h^2 is `above_n`; max(above_n, 0) where w is 0."""
        softness_n = self.softness_n
        if softness_n < 1e-3:
            return max(above_n, 0.0)
        if above_n < -1e6 * softness_n:
            return softness_n * math.sqrt(softness_n / -above_n)
        ratio = softness_n / abs(above_n) if above_n != 0.0 else math.inf
        share = above_n / softness_n + min(ratio * ratio, 1.0) if above_n > 0.0 else min(math.sqrt(ratio), 1.0)
        taut_n = softness_n * share
        for _ in range(100):
            left = taut_n * taut_n * (taut_n - above_n) - softness_n**3
            step_n = left / (taut_n * (3.0 * taut_n - 2.0 * above_n))
            taut_n -= step_n
            if step_n <= 1e-12 * taut_n:
                break
        return taut_n


class PressureLag:
    LEAST_AIR_MASS = 1e-3

    def __init__(self, values, eq11):
        self.time_constant_s, self.air_mass = values["time_constant_s"], values.get("air_mass", 0.0)
        self.last = None

    def sees(self, now):
        gauge_pa, muscle_pa_per_s = now.pressure_pa, 0.0
        if self.last is not None and now.step_s > 0.0:
            last_gauge_pa, last_muscle_pa, last_pa_per_s = self.last
            rate_pa_per_s = (gauge_pa - last_gauge_pa) / now.step_s
            behind_pa = self.time_constant_s * rate_pa_per_s
            off_pa = last_muscle_pa - (last_gauge_pa - behind_pa)
            if self.air_mass < self.LEAST_AIR_MASS:
                off_pa *= math.exp(-now.step_s / self.time_constant_s)
            else:
                off_pa, off_pa_per_s = self.swung(off_pa, last_pa_per_s - rate_pa_per_s, now.step_s)
                muscle_pa_per_s = rate_pa_per_s + off_pa_per_s
            now.pressure_pa = gauge_pa - behind_pa + off_pa
        self.last = gauge_pa, now.pressure_pa, muscle_pa_per_s

    def swung(self, off_pa, off_pa_per_s, step_s):
        """What is left of a distance from where an evenly moving gauge is followed to, and of its rate."""
        inertia_s2 = self.air_mass * self.time_constant_s**2
        a = 0.5 * self.time_constant_s / inertia_s2
        square = a * a - 1.0 / inertia_s2
        q = math.sqrt(max(abs(square), 1e-6 * a * a))
        if square > 0.0:
            slow, fast = -1.0 / (inertia_s2 * (a + q)), -(a + q)
            part_pa = (off_pa_per_s - fast * off_pa) / (slow - fast)
            slow_pa, fast_pa = part_pa * math.exp(slow * step_s), (off_pa - part_pa) * math.exp(fast * step_s)
            return slow_pa + fast_pa, slow * slow_pa + fast * fast_pa
        sine, cosine, decay = math.sin(q * step_s), math.cos(q * step_s), math.exp(-a * step_s)
        across_pa = (off_pa_per_s + a * off_pa) / q
        off = decay * (off_pa * cosine + across_pa * sine)
        return off, decay * q * (across_pa * cosine - off_pa * sine) - a * off


class ThresholdPressure:
    def __init__(self, values, eq11):
        self.threshold_pa = values["threshold_pa"]

    def sees(self, now):
        now.pressure_pa = self.hinge_pa(now.pressure_pa - self.threshold_pa) - self.hinge_pa(-self.threshold_pa)

    @staticmethod
    def hinge_pa(excess_pa, width_pa=1e4):
        root_pa = math.hypot(excess_pa, width_pa)
        if excess_pa < 0.0:
            return 0.5 * width_pa * width_pa / (root_pa - excess_pa)
        return 0.5 * (excess_pa + root_pa)


class EndTaper:
    def __init__(self, values, eq11):
        self.values, self.eq11 = values, eq11

    def pulls(self, now, base):
        fitting_m = 2.0 * self.eq11.rest_radius_m
        diameter_m = self.eq11.diameter_m(now.length_m)
        wider_m = max(diameter_m - fitting_m, 0.0)
        slope = self.eq11.diameter_slope(now.length_m, diameter_m)
        cone_n = now.pressure_pa * (0.5 * math.pi) * diameter_m * wider_m * slope
        return cone_n * self.values["cotangent_of_taper"] + cone_n * wider_m / fitting_m * self.values["bulge_of_taper"]


class BraidLockup:
    def __init__(self, values, eq11):
        self.values = values

    def pulls(self, now, base):
        onset = self.values["onset_contraction"]
        beyond = (now.contraction_ratio - self.values["lock_contraction"]) / onset
        return -onset * (max(beyond, 0.0) + math.log1p(math.exp(-abs(beyond)))) * self.values["stiffness_n"]


class PreslidingHysteresis:
    def __init__(self, values, eq11):
        self.slip, self.slide_at_rest = Slip(values["slip_distance_m"]), values["slide_at_rest"]
        # Models that do not say know the other alone.
        self.turns_at_rest = values.get("turns_at_rest", 0.0)
        self.rest_length_m = eq11.rest_length_m
        self.moved = None  # where and which way, when anything last moved

    def slides(self, now):
        moved = (now.contraction_ratio, now.rest_slide_m, now.direction)
        pressed = self.moved is not None and now.rest_slide_m != self.moved[1]
        if pressed:
            self.slip.turn(self.turns_at_rest * (now.direction - self.moved[2]))
        if self.moved is None or pressed or now.contraction_ratio != self.moved[0]:
            self.moved = moved
        slide_m = now.contraction_ratio * self.rest_length_m + self.slide_at_rest * now.rest_slide_m
        return self.slip.follow(slide_m, now.direction if now.came else 0.0)


class RubberHysteresis:
    def __init__(self, values, eq11):
        self.slip, self.width_n = Slip(values["slip_distance_m"]), values["width_n"]
        self.rest_length_m = eq11.rest_length_m

    def pulls(self, now, base):
        contraction_m = now.contraction_ratio * self.rest_length_m
        return -self.slip.follow(contraction_m, now.direction if now.came else 0.0) * self.width_n


class Stribeck:
    RENEWAL_M = 1e-4

    def __init__(self, values, eq11):
        self.values, self.last = values, None

    def crawl(self, speed_m_per_s):
        ratio = speed_m_per_s / self.values["stribeck_speed_m_per_s"]
        return math.exp(-(ratio ** self.values["exponent"]))

    def pulls(self, now, base):
        speed_m_per_s = abs(now.slide_speed_m_per_s)
        if self.last is None:
            level = self.crawl(speed_m_per_s)
        else:
            slide_m, last_m_per_s, last_level = self.last
            crawl = self.crawl(max(speed_m_per_s, last_m_per_s))
            renewed = abs(now.slide_m - slide_m) / self.RENEWAL_M + self.values["aging_per_s"] * now.step_s
            level = crawl + (last_level - crawl) * math.exp(-renewed)
        self.last = (now.slide_m, speed_m_per_s, level)
        return -now.direction * base.normal_n * level * self.values["static_friction"]


class RateDependentHysteresis:
    def __init__(self, values, eq11):
        self.values = values

    def pulls(self, now, base):
        e_folds = math.log1p(abs(now.slide_speed_m_per_s) / self.values["onset_speed_m_per_s"])
        return -now.direction * base.normal_n * e_folds * self.values["friction_per_e_fold"]


class LoadDependentFriction:
    def __init__(self, values, eq11):
        self.friction_per_load = values["friction_per_load"]
        self.winding = values.get("friction_per_load_and_contraction", 0.0)

    def pulls(self, now, base):
        per_load = self.friction_per_load + self.winding * now.contraction_ratio
        return -now.direction * max(base.static_n, 0.0) * per_load


class ViscousDamping:
    REFERENCE_PA = 3e5

    def __init__(self, values, eq11):
        self.values = values

    def pulls(self, now, base):
        with_pressure = self.values["damping_with_pressure_n_s_per_m"]
        return (
            -now.speed_m_per_s * self.values["damping_n_s_per_m"]
            - now.speed_m_per_s * now.pressure_pa / self.REFERENCE_PA * with_pressure
        )


def overstresses(values):
    """Amplitudes of the three states of an `Overstress`."""
    return values["overstress"], values["slow_overstress"], values["slowest_overstress"]


class ViscoelasticRelaxation:
    def __init__(self, values, eq11):
        self.overstress, self.amplitudes = Overstress(values["time_constant_s"]), overstresses(values)

    def pulls(self, now, base):
        states = self.overstress.follow(now, base.latex_n)
        return sum(amplitude * state for amplitude, state in zip(self.amplitudes, states))


class PressureCreep:
    LEAST_PA = 1e3

    def __init__(self, values, eq11):
        self.share_of_length, self.amplitudes = values["share_of_length"], overstresses(values)
        self.by_pressure, self.by_force = (Overstress(values["time_constant_s"]) for _ in range(2))
        self.area_m2 = 0.0

    def pulls(self, now, base):
        if abs(now.pressure_pa) > self.LEAST_PA:
            self.area_m2 = base.gas_n / now.pressure_pa
        states = zip(self.by_pressure.follow(now, now.pressure_pa), self.by_force.follow(now, base.gas_n))
        share = self.share_of_length
        columns = [(1.0 - share) * self.area_m2 * pressure + share * force for pressure, force in states]
        return sum(amplitude * column for amplitude, column in zip(self.amplitudes, columns))


class MullinsSoftening:
    HALF_PLAY = 5e-4

    def __init__(self, values, eq11):
        self.values, self.follower = values, 0.0
        self.largest, self.travelled = values.get("past_contraction", -1.0), values.get("past_travel", 0.0)
        self.longest = values.get("past_extension", -1.0)
        # 6 (C10 + C01) of latex on the section of the bladder, and where an ideal braid pulls no more.
        self.stiffness_n = 6.0 * LATEX_PA * eq11.rubber_m3 / eq11.rest_length_m
        self.slack_contraction = eq11.max_contraction_ratio

    def pulls(self, now, base):
        here = now.contraction_ratio
        self.largest, self.longest = max(self.largest, here), max(self.longest, -here)
        if now.step_s == 0.0:
            self.follower = here
        else:
            followed = min(max(self.follower, here - self.HALF_PLAY), here + self.HALF_PLAY)
            self.travelled += abs(followed - self.follower)
            self.follower = followed
        below = (self.largest - here) / self.values["softening_contraction"]
        settled = self.travelled / self.values["settling_travel"]
        softer = math.expm1(-below) * self.values["softening"] + math.expm1(-settled) * self.values["settling"]
        within = (self.longest + here) / self.values["softening_contraction"]
        tension_n = self.stiffness_n * max(self.slack_contraction - here, 0.0)
        return base.latex_n * softer + tension_n * math.expm1(-within) * self.values.get("axial_softening", 0.0)


class ThermalSoftening:
    REFERENCE_W = 1e3

    def __init__(self, values, eq11):
        self.values, self.warmth, self.wall_k, self.last = values, 0.0, 0.0, None
        self.wall_lag_s = values.get("wall_lag_s", 0.0)

    def pulls(self, now, base):
        power = max(base.normal_n, 0.0) * abs(now.speed_m_per_s) / self.REFERENCE_W
        if self.last is not None:
            last_s, last_power = self.last
            heating = 0.5 * (power + last_power) if now.step_s > 0.0 else 0.0
            step_s = max(now.time_s - last_s, 0.0)
            self.warmth += (self.warmth - heating) * math.expm1(-step_s / self.values["time_constant_s"])
            behind = math.exp(-step_s / self.wall_lag_s) if self.wall_lag_s > 0.0 else 0.0
            self.wall_k = now.warmth_k + (self.wall_k - now.warmth_k) * behind
        else:
            self.wall_k = now.warmth_k
        self.last = (now.time_s, power)
        softer = self.warmth * self.values["softening_per_kilowatt"] + self.wall_k * self.values["softening_per_kelvin"]
        weaker = self.wall_k * self.values.get("gas_force_loss_per_kelvin", 0.0)
        return -base.latex_n * softer - base.gas_n * weaker


class FatigueWear:
    REFERENCE_M, HALF_PLAY_M = 100.0, 1.5e-4

    def __init__(self, values, eq11):
        self.values, self.travel_m, self.follower_m = values, values.get("past_travel_m", 0.0), 0.0

    def pulls(self, now, base):
        if now.step_s == 0.0:
            self.follower_m = now.slide_m
        else:
            followed_m = min(max(self.follower_m, now.slide_m - self.HALF_PLAY_M), now.slide_m + self.HALF_PLAY_M)
            self.travel_m += abs(followed_m - self.follower_m)
            self.follower_m = followed_m
        worn = (self.travel_m / self.REFERENCE_M) ** self.values["exponent"]
        friction_n = now.direction * base.normal_n * self.values.get("friction_loss_per_reference_travel", 0.0)
        return (friction_n - base.gas_n * self.values["loss_per_reference_travel"]) * worn


class EndStretch:
    """Ends that grow a little longer as they are pulled, without a name in physics."""

    uses_slopes = True

    def __init__(self, values, eq11):
        self.stretch_m_per_n = values["stretch_m_per_n"]

    def pulls(self, now, base):
        return -base.static_n * base.slope_n_per_m * self.stretch_m_per_n


class StaticMap:
    """What is left of a static force, without a name in physics: Legendre polynomials in pressure and contraction as recorded."""

    pulls_as_recorded = True

    def __init__(self, values, eq11):
        self.values = values

    def polynomials(self, value, low, high):
        x = min(max(2.0 * (value - low) / (high - low) - 1.0, -1.0), 1.0) if high > low else 0.0
        third, fourth = 0.5 * (5.0 * x * x - 3.0) * x, 0.125 * ((35.0 * x * x - 30.0) * x * x + 3.0)
        return 1.0, x, 0.5 * (3.0 * x * x - 1.0), third, fourth

    def pulls(self, now, base):
        values = self.values
        p = self.polynomials(now.pressure_pa, values["lowest_pa"], values["highest_pa"])
        rims = values["lowest_contraction_ratio"], values["highest_contraction_ratio"]
        e = self.polynomials(now.contraction_ratio, *rims)
        force_n = 0.0
        for kind, sign, least, degree in (("even", 1.0, 1, 4), ("odd", now.direction, 0, 2)):
            for total in range(least, degree + 1):
                for i in range(total + 1):
                    force_n += sign * p[i] * e[total - i] * values[f"{kind}_p{i}_e{total - i}_n"]
        return force_n


def spelled(part):
    """Name and numbers of a part of a sentence, which is a name alone where it has no numbers."""
    return (part, {}) if isinstance(part, str) else next(iter(part.items()))


class Empirical:
    """A term without a name in physics: a driver, what is remembered of it, a curve of that, a factor. An effect of a user's own
    file stands in a model in the same way."""

    SCALES = {
        "one": lambda now, base: 1.0,
        "pressure": lambda now, base: now.pressure_pa,
        "gas-force": lambda now, base: base.gas_n,
        "bladder-force": lambda now, base: base.latex_n,
        "friction": lambda now, base: now.direction * base.normal_n,
        "direction": lambda now, base: now.direction,
        "contracting": lambda now, base: 0.5 * (1.0 + now.direction),
        "extending": lambda now, base: 0.5 * (1.0 - now.direction),
        "slope-over-pressure": lambda now, base: base.slope_n_per_pa,
        "slope-over-length": lambda now, base: base.slope_n_per_m,
    }

    def __init__(self, sentence, values):
        (self.driver, self.limits), (self.memory, self.numbers) = spelled(sentence["driver"]), spelled(sentence["memory"])
        (self.shape, self.places), self.seen = spelled(sentence["shape"]), sentence["seen"]
        if sentence["scale"] not in self.SCALES:
            raise ValueError(f"scale {sentence['scale']!r} is unknown here; take pam_muscle.py of the pam-export that knows it")
        self.scale = self.SCALES[sentence["scale"]]
        self.uses_slopes = sentence["scale"].startswith("slope-over-")
        # Amplitudes of a curve with knots are numbered: rise_1, rise_2, ...
        numbered = sorted(values, key=lambda name: int(name.rpartition("_")[2]) if "_" in name else 0)
        self.amplitudes = [values[name] for name in numbered]
        self.started, self.direction, self.turn_m, self.flips, self.moved_s = False, 0.0, 0.0, 0, 0.0
        self.last, self.last_s, self.last_m, self.first, self.second = 0.0, 0.0, 0.0, 0.0, 0.0

    def pulls(self, now, base):
        value = float(self.driven(now, base))
        argument = float(self.remembered(value, now, base))
        self.started = True
        low, high = self.seen
        beyond = max(low - argument, argument - high, 0.0)
        weight = max(1.0 - beyond / (0.1 * (high - low)), 0.0)
        return weight * self.scale(now, base) * self.curve(min(max(argument, low), high))

    def driven(self, now, base):
        """What drives the term."""
        if self.driver in ("travel-since-reversal", "cycle"):
            if not self.started or now.direction != self.direction:
                self.flips += self.direction != 0.0
                self.direction, self.turn_m = now.direction, now.slide_m
            return abs(now.slide_m - self.turn_m) if self.driver != "cycle" else 1.0 + self.flips // 2
        if self.driver in ("time-since-last-move", "time-since-pressure-moved"):
            moves = abs(now.pressure_rate_pa_per_s) > self.limits["above_pa_per_s"]
            moves = moves or abs(now.speed_m_per_s) > self.limits.get("above_m_per_s", math.inf)
            if not self.started or moves:
                self.moved_s = now.time_s
            return now.time_s - self.moved_s
        return {
            "pressure": now.pressure_pa,
            "contraction": now.contraction_ratio,
            "speed": now.speed_m_per_s,
            "force": base.static_n,
            "time": now.time_s,
        }[self.driver]

    def remembered(self, value, now, base):
        """What is remembered of the driver, which has come to `value`."""
        if not self.started:
            self.last, self.last_s, self.last_m = value, now.time_s, now.length_m
            came = now.direction if now.came else 0.0
            settled = {"play": value - came * self.numbers.get("half_width", 0.0), "largest": value, "dahl": came}
            self.first = settled.get(self.memory, 0.0)
        change = value - self.last
        elapsed_s = now.step_s if now.step_s > 0.0 else max(now.time_s - self.last_s, 0.0)
        elapsed_s = elapsed_s if self.started else 0.0
        travelled_m = abs(now.length_m - self.last_m)
        self.last, self.last_s, self.last_m = value, now.time_s, now.length_m
        if self.memory == "none":
            return value
        if self.memory == "lag":
            self.first = self.fallen(self.first, change, elapsed_s / self.numbers["time_constant_s"])
        elif self.memory == "two-lags":
            first_s, second_s = self.numbers["time_constants_s"]
            before = value - change - self.first
            self.first = self.fallen(self.first, change, elapsed_s / first_s)
            self.second = self.fallen(self.second, value - self.first - before, elapsed_s / second_s)
            return self.first + self.second
        elif self.memory == "play":
            half_width = self.numbers["half_width"]
            self.first = min(max(self.first, value - half_width), value + half_width)
            return value - self.first
        elif self.memory == "dahl":
            if change != 0.0:
                sign = math.copysign(1.0, change)
                self.first = sign + (self.first - sign) * math.exp(-abs(change) / self.numbers["distance"])
        elif self.memory == "largest":
            self.first = max(self.first, value)
            return self.first - value
        elif self.memory == "travelled":
            self.first += abs(change)
        elif self.memory == "work":
            self.first += abs(base.static_n) * travelled_m
        else:
            raise ValueError(f"memory {self.memory!r} is unknown here; take pam_muscle.py of the pam-export that knows it")
        return self.first

    @staticmethod
    def fallen(missing, change, ratio):
        """What has not followed after `ratio` time constants in which the driver changed evenly by `change`."""
        gain = -math.expm1(-ratio) / ratio if ratio > 1e-9 else 1.0
        return missing * math.exp(-ratio) + change * gain

    def curve(self, x):
        """How the term answers."""
        if self.shape == "line":
            return self.amplitudes[0] * x
        if self.shape == "saturation":
            away = x - self.places["from"]
            return -math.copysign(1.0, away) * math.expm1(-abs(away) / self.places["over"]) * self.amplitudes[0]
        if self.shape == "bump":
            return math.exp(-(((x - self.places["center"]) / self.places["width"]) ** 2)) * self.amplitudes[0]
        knots, values = self.places["knots"], self.amplitudes
        if self.shape == "monotone":
            steps = zip(values, knots, knots[1:])
            return sum(rise * min(max((x - left) / (right - left), 0.0), 1.0) for rise, left, right in steps)
        # Cubic Hermite; the slope at a knot is that from the knot before to the knot after.
        right = min(max(sum(knot <= x for knot in knots), 1), len(knots) - 1)
        left, before, after = right - 1, max(right - 2, 0), min(right + 1, len(knots) - 1)
        width = knots[right] - knots[left]
        t = min(max((x - knots[left]) / width, 0.0), 1.0)
        left_slope = (values[right] - values[before]) / (knots[right] - knots[before])
        right_slope = (values[after] - values[left]) / (knots[after] - knots[left])
        through = (2.0 * t**3 - 3.0 * t**2 + 1.0) * values[left] + (3.0 * t**2 - 2.0 * t**3) * values[right]
        return through + width * ((t**3 - 2.0 * t**2 + t) * left_slope + (t**3 - t**2) * right_slope)


EFFECTS = {
    "channel-delay": ChannelDelay,
    "pressure-gauge-hysteresis": PressureGaugeHysteresis,
    "force-drift": ForceDrift,
    "series-compliance": SeriesCompliance,
    "inertia": Inertia,
    "slack": Slack,
    "pressure-lag": PressureLag,
    "threshold-pressure": ThresholdPressure,
    "end-taper": EndTaper,
    "braid-lockup": BraidLockup,
    "presliding-hysteresis": PreslidingHysteresis,
    "rubber-hysteresis": RubberHysteresis,
    "stribeck": Stribeck,
    "rate-dependent-hysteresis": RateDependentHysteresis,
    "load-dependent-friction": LoadDependentFriction,
    "viscous-damping": ViscousDamping,
    "viscoelastic-relaxation": ViscoelasticRelaxation,
    "pressure-creep": PressureCreep,
    "mullins-softening": MullinsSoftening,
    "thermal-softening": ThermalSoftening,
    "fatigue-wear": FatigueWear,
    "end-stretch": EndStretch,
    "static-map": StaticMap,
}

# What happened once, in one recording, belongs to no other.
EVENTS = ("force-step",)


class Memory:
    """A muscle along a motion. Its first moment finds it settled."""

    def __init__(self, muscle):
        self.eq11 = muscle.eq11
        self.effects = [EFFECTS[id](values, muscle.eq11) for id, values in muscle.effects]
        self.effects += [Empirical(sentence, values) for sentence, values in muscle.empirical]
        self.uses_slopes = any(getattr(effect, "uses_slopes", False) for effect in self.effects)

    def step(self, moment):
        """Force, in N, at the next moment."""
        now = dataclasses.replace(moment)
        for effect in self.having("sees"):
            effect.sees(now)
        slide = now.direction
        for effect in self.having("slides"):
            slide = effect.slides(now)
        base = self.eq11.base(np.float64(now.pressure_pa), np.float64(now.length_m))
        if self.uses_slopes:
            above, below = (self.eq11.base(now.pressure_pa + step_pa, now.length_m) for step_pa in (100.0, -100.0))
            base.slope_n_per_pa = (above.static_n - below.static_n) / 200.0
            longer, shorter = (self.eq11.base(now.pressure_pa, now.length_m + step_m) for step_m in (1e-5, -1e-5))
            base.slope_n_per_m = (longer.static_n - shorter.static_n) / 2e-5
        force_n = base.static_n - slide * base.friction_n
        for effect in self.having("pulls"):
            force_n += effect.pulls(moment if getattr(effect, "pulls_as_recorded", False) else now, base)
        for effect in self.having("reads"):
            force_n = effect.reads(force_n)
        return float(force_n)

    def having(self, method):
        """Effects that act in one way, in the order of the model."""
        return [effect for effect in self.effects if hasattr(effect, method)]


class Muscle:
    """A pam-model/1: eq. 11 with the effects beyond it, but for those of the fitted recordings alone."""

    def __init__(self, model):
        if model.get("schema") != "pam-model/1":
            raise ValueError(f"schema is {model.get('schema')!r}, expected 'pam-model/1'; write it with pam-identify")
        self.model, self.eq11 = model, Eq11(model)
        self.effects, self.empirical = [], []
        for entry in model["effects"]:
            if entry["id"] in EVENTS or entry.get("only_as_fitted"):
                continue
            values = {parameter["name"]: parameter["value"] for parameter in entry["parameters"]}
            if entry["id"] == "empirical":
                self.empirical.append((entry["sentence"], values))
            elif entry["id"] in EFFECTS:
                self.effects.append((entry["id"], values))
            else:
                raise ValueError(f"effect {entry['id']!r} is unknown here; take pam_muscle.py of the pam-export that knows it")

    @classmethod
    def read(cls, path):
        """The model in a file."""
        with open(path, encoding="utf-8") as file:
            return cls(json.load(file))

    def force_n(self, pressure_pa, length_m, direction):
        """Eq. 11 alone: gauge pressure in Pa, length in m, +1 contracting and -1 extending; numbers or arrays."""
        return self.eq11.force_n(pressure_pa, length_m, direction)

    def start(self):
        """A memory at the beginning of a motion."""
        return Memory(self)

    def settled_force_n(self, pressure_pa, length_m, direction):
        """Force where the muscle has long been and where it came slowly in `direction`; numbers or arrays."""
        return np.vectorize(self.settled_at)(pressure_pa, length_m, direction)[()]

    def settled_at(self, pressure_pa, length_m, direction):
        """The same for numbers."""

        def result_n(force_n):
            shortened_m = self.eq11.rest_length_m - length_m
            ratio = shortened_m / self.eq11.rest_length_m
            rest = dict(speed_m_per_s=0.0, slide_speed_m_per_s=0.0, acceleration_m_per_s2=0.0, rest_slide_m=0.0)
            now = Moment(0.0, 0.0, pressure_pa, 0.0, length_m, ratio, direction=direction, came=1.0,
                         slide_m=shortened_m, force_n=force_n, **rest)  # fmt: skip
            return self.start().step(now)

        before_n, excess_before_n = 0.0, result_n(0.0)
        force_n = excess_before_n
        if not Memory(self).having("sees"):
            return force_n
        # What the muscle sees may depend on the force: a secant towards the force that results in itself.
        for _ in range(50):
            excess_n = result_n(force_n) - force_n
            run_n = force_n - before_n
            slope = (excess_n - excess_before_n) / run_n if run_n != 0.0 else math.nan
            if abs(excess_n) <= 1e-12 * abs(force_n) or not math.isfinite(slope) or slope == 0.0:
                return force_n + excess_n
            before_n, excess_before_n = force_n, excess_n
            force_n -= excess_n / slope
        return force_n

    def predict(self, recording):
        """Force of every row of a recording, in N: what pam-predict calls force_model_N."""
        return self.along(self.moments(recording), recording.force_n is not None)

    def along(self, moments, has_force):
        """Force at every moment of one recording; without a measured force, effects see the model's own of the row before."""
        if not self.effects and not self.empirical:
            columns = [np.array([getattr(now, name) for now in moments])
                       for name in ("pressure_pa", "length_m", "direction")]  # fmt: skip
            return self.force_n(*columns)
        memory, forces_n = self.start(), []
        for now in moments:
            if not has_force:
                settled = (now.pressure_pa, now.length_m, now.direction)
                now.force_n = forces_n[-1] if forces_n else self.settled_at(*settled)
            forces_n.append(memory.step(now))
        return np.array(forces_n)

    def moments(self, recording):
        """Every row of a recording with the kinematics that pam-predict gives it."""
        directions, unknown = directions_of(recording, self)
        if unknown and recording.force_n is not None:
            # What effects do is not taken for friction: all of the model is asked, without friction and with all of it.
            law, forces_n = law_of(self), []
            for state in (0.0, 1.0):
                assumed = directions.copy()
                for rows in unknown:
                    assumed[rows] = state
                forces_n.append(self.along(self.moving(recording, assumed, unknown[-1].stop), True))
            for rows in unknown:
                directions[rows] = beginning(recording, rows, law, *(force_n[rows] for force_n in forces_n))
        return self.moving(recording, directions, len(directions))

    def moving(self, recording, directions, n_rows):
        """The first rows of a recording with these directions, as moments."""
        moments = walk(recording, directions, self, n_rows)
        delays_s = [effect.delays_s for effect in Memory(self).effects if isinstance(effect, ChannelDelay)]
        return shift(moments, *(sum(delays) for delays in zip(*delays_s))) if delays_s else moments


# --- Recordings --------------------------------------------------------------------------------------------------------------

UNITS = {  # (multiply, divide)
    "time": {"s": (1.0, 1.0), "ms": (1.0, 1e3), "us": (1.0, 1e6)},
    "pressure": {"kpa": (1e3, 1.0), "pa": (1.0, 1.0), "mpa": (1e6, 1.0), "bar": (1e5, 1.0),
                 "psi": (4.4482216152605, 0.0254 * 0.0254)},
    "length": {"mm": (1.0, 1e3), "m": (1.0, 1.0), "cm": (1.0, 1e2), "in": (0.0254, 1.0)},
    "force": {"n": (1.0, 1.0), "kn": (1e3, 1.0), "lbf": (4.4482216152605, 1.0), "kgf": (9.80665, 1.0)},
    "temperature": {"c": (1.0, 1.0), "k": (1.0, 1.0)},
}  # fmt: skip


@dataclasses.dataclass
class Recording:
    """Columns of a recording, in SI; `force_n` and `temperature_k` are None where none was measured. Stamps rise."""

    time_s: np.ndarray
    pressure_pa: np.ndarray
    length_m: np.ndarray
    force_n: np.ndarray = None
    temperature_k: np.ndarray = None

    def __post_init__(self):
        for name in ("time_s", "pressure_pa", "length_m", "force_n", "temperature_k"):
            column = getattr(self, name)
            setattr(self, name, None if column is None else np.asarray(column, float))
        if not (np.diff(self.time_s) > 0.0).all():
            raise ValueError("time does not rise from row to row; pam-predict repairs what can be repaired")

    @classmethod
    def read(cls, path):
        """A CSV file whose header names each column quantity_unit, as in time_s,pressure_kPa,length_mm,force_N."""
        with open(path, newline="", encoding="utf-8-sig") as file:
            rows = [row for row in csv.reader(file) if row and not row[0].lstrip().startswith("#")]
        if not rows:
            raise ValueError(f"{path}: the file is empty")
        columns = {}
        for index, name in enumerate(rows[0]):
            quantity, _, unit = name.strip().lower().partition("_")
            if unit in UNITS.get(quantity, {}):
                multiply, divide = UNITS[quantity][unit]
                columns[quantity] = np.array([float(row[index]) for row in rows[1:]]) * multiply / divide
        missing = [quantity for quantity in ("time", "pressure", "length") if quantity not in columns]
        if missing:
            raise ValueError(f"{path}: the header names no {' and no '.join(missing)}; write it as in pressure_kPa")
        temperature = columns.get("temperature")
        if temperature is not None and "temperature_c" in (name.strip().lower() for name in rows[0]):
            temperature = temperature + 273.15
        return cls(columns["time"], columns["pressure"], columns["length"], columns.get("force"), temperature)

    def segments(self):
        """Ranges of rows between gaps in time: much longer than the usual step and than either neighbor."""
        steps_s = np.diff(self.time_s)
        if len(steps_s) < 4:
            return [range(len(self.time_s))]
        typical_s = np.sort(steps_s)[(len(steps_s) - 1) // 2]
        around_s = np.concatenate([[math.inf], steps_s, [math.inf]])
        neighbor_s = np.minimum(around_s[:-2], around_s[2:])
        gaps = (steps_s - typical_s > 20.0 * typical_s) & (steps_s > 3.0 * typical_s) & (steps_s > 5.0 * neighbor_s)
        bounds = [0, *(np.flatnonzero(gaps) + 1), len(self.time_s)]
        return [range(start, end) for start, end in zip(bounds, bounds[1:])]


# --- Direction of motion -----------------------------------------------------------------------------------------------------
#
# A play on the smooth length, dated back to where the length turned; at standstill what the model says of the pressure.

UNKNOWN = (-1.0, 1.0)  # between what the state of friction lies
STRETCH_ROWS = 1 << 18


def law_of(muscle):
    """How the direction is found for a muscle."""
    thresholds = muscle.model["direction"]
    standstill = thresholds.get("standstill", {"slides": {"over_pa": 0.0}})
    law = {} if isinstance(standstill, str) else standstill
    slides, relaxes = law.get("slides", {"over_pa": None}), law.get("relaxes")
    travels_m = thresholds.get("held_m", 0.0), thresholds.get("turn_m", 0.0)
    at_rest = slides["over_pa"], slides.get("share", 1.0), standstill == "sticks", relaxes
    return Law(thresholds["length_m"], thresholds["pressure_pa"], *travels_m, *at_rest)


def directions_of(recording, muscle):
    """State of friction at every row: +1 after contracting, -1 after extending, 0 where it is not known; and the slices of
    rows before the first motion of a segment, where it is not."""
    law = law_of(muscle)
    found, unknown = np.zeros(len(recording.time_s)), []
    for segment in recording.segments():
        carried, known = UNKNOWN, []
        for start in range(segment.start, segment.stop, STRETCH_ROWS):
            rows = slice(start, min(start + STRETCH_ROWS, segment.stop))
            columns = recording.time_s[rows], recording.pressure_pa[rows], recording.length_m[rows]
            bounds = bounds_of(*columns, law, muscle.eq11.as_printed, carried)
            carried = bounds[-1] if bounds else carried
            found[rows] = [hundredths(0.5 * (low + high)) for low, high in bounds]
            known += [is_known(bound) for bound in bounds]
        first = known.index(True) if True in known else len(known)
        if first > 0:
            unknown.append(slice(segment.start, segment.start + first))
    return found, unknown


@dataclasses.dataclass
class Law:
    """How the direction is found, in SI; `over_pa` is None where friction does not slide at standstill, `share` what of it does, and
    `relaxes` None or the time constant and the share that stays."""

    length_m: float
    pressure_pa: float
    held_m: float
    turn_m: float
    over_pa: float
    share: float
    sticks: bool
    relaxes: dict

    def is_moved(self):
        """Whether friction moves little by little at a standstill."""
        slides = self.over_pa is not None and (self.over_pa > 0.0 or self.share < 1.0)
        return slides or self.sticks or self.relaxes is not None


def hundredths(state):
    """As pam-predict keeps it."""
    return math.copysign(math.floor(abs(100.0 * state) + 0.5), state) / 100.0


def is_known(bound):
    return bound[1] - bound[0] < 0.2


def sign_of(bound):
    """The sign where it is certain, 0 elsewhere."""
    return (1 if 0.5 * (bound[0] + bound[1]) >= 0.0 else -1) if is_known(bound) else 0


def beginning(recording, rows, law, neither_n, one_n):
    """Friction before the first motion of a segment: of all beginnings the one that comes nearest to the force measured there, where
    the model has these without friction and with all of it."""
    without_n, with_n = recording.force_n[rows] - neither_n, one_n - neither_n
    smooth_pa = moving_average(recording.pressure_pa[rows], 2)
    best, least = np.zeros(len(smooth_pa)), math.inf
    for index in range(-20, 21):
        state = index / 20
        middles = np.full(len(smooth_pa), state)
        if law.is_moved():
            bounds = rest_bounds(recording.time_s[rows], smooth_pa, law, (state, state))
            middles = np.array([0.5 * (low + high) for low, high in bounds])
        left = np.cumsum((without_n - middles * with_n) ** 2)[-1]
        if left < least:
            best, least = [hundredths(middle) for middle in middles], left
    return best


def bounds_of(time_s, pressure_pa, length_m, law, by_pressure, carried):
    """Bounds of the state at consecutive rows without a gap; `carried` are those before them."""
    n = len(time_s)
    if n < 2:
        return [carried] * n
    period_s = (time_s[n - 1] - time_s[0]) / (n - 1)
    half = min(max(int(math.floor(0.5 * 0.05 / period_s + 0.5)), 2), 50)
    marks = [0] * n
    if by_pressure:
        play(moving_average(pressure_pa, half), pressure_pa, law.pressure_pa, half, sign_of(carried), marks, 0)
        return [(float(mark), float(mark)) if mark else carried for mark in marks]
    shortening = -length_m
    contraction = moving_average(shortening, half)
    play(contraction, shortening, law.length_m, half, sign_of(carried), marks, 0)
    pressure = moving_average(pressure_pa, half)
    stills = standstills(time_s, contraction, law.length_m)
    most = int(2.0 / period_s)
    stills = [still for still in stills if not never_rests(shortening[still.start : still.stop], law.length_m)
              and not goes_over(shortening, still, most, NOISE * law.length_m)]  # fmt: skip
    noise_m = NOISE * law.length_m / math.sqrt(2 * half + 1)
    pushed = [pushed_rows(stills, index, contraction, noise_m, pressure, law.pressure_pa) for index in range(len(stills))]
    pushed = [rows for rows in pushed if rows is not None]
    slides = law.over_pa is not None and (law.over_pa > 2.0 * law.pressure_pa or law.share < 1.0)
    if law.over_pa is not None and not slides:
        for still in pushed:
            before = marks[still.start - 1] if still.start > 0 else sign_of(carried)
            rows = slice(still.start, still.stop)
            marks[rows] = [0] * len(still)
            play(pressure[rows], pressure_pa[rows], law.pressure_pa, half, before, marks, still.start)
            rest = next((around.stop - still.stop for around in stills if still.start in around), 0)
            carry_on(marks, still.stop, before, rest + 2 * half)
    bounds = [(float(mark), float(mark)) if mark else carried for mark in marks]
    moved = pushed if law.over_pa is not None or law.sticks else []
    if law.relaxes is not None:
        moved = [rows for rows in (held_rows(still, contraction, noise_m) for still in stills) if rows]
    if slides or law.sticks or law.relaxes is not None:
        for still in moved:
            rows = slice(still.start, still.stop)
            before = bounds[still.start - 1] if still.start > 0 else carried
            bounds[rows] = rest_bounds(time_s[rows], pressure[rows], law, before)
            unmoved = still.stop
            while unmoved < n and marks[unmoved] == 0:
                bounds[unmoved] = bounds[still.stop - 1]
                unmoved += 1
    # A parabola over n values leaves 2.25 / n of the variance in the middle one.
    values = 2.25 * (NOISE * law.length_m / 4e-6) ** 2
    longest = Window(time_s, min(0.5 * values * period_s, 0.15)).half
    path, slow = path_of(time_s, shortening, (longest, most), NOISE * law.length_m, turns_of(bounds, pushed))
    white_m = 1.5 * NOISE * law.length_m / math.sqrt(2 * longest + 1)
    wanders_m = sorted(rests_within(path, still)[1] for still in stills)
    path_noise_m = max(white_m, wanders_m[len(wanders_m) // 2] if wanders_m else 0.0)
    reach = min(max(int(math.floor(0.25 / period_s + 0.5)), 2 * half), 500)
    turn_over(path.tolist(), slow, path_noise_m, law, reach, carried, moved, bounds)
    return bounds


NOISE = 0.2  # deviations of the noise in a threshold


def carry_on(marks, start, before, most):
    """After a standstill friction is what the pressure has made of it, until the length turns or moves at all."""
    last, turn = marks[start - 1], start
    while turn < len(marks) and marks[turn] == before:
        turn += 1
    if turn - start >= most:
        turn = start
    marks[start:turn] = [last] * (turn - start)
    while turn < len(marks) and marks[turn] == 0:
        marks[turn] = last
        turn += 1


STICKS_UP_TO = 5.0  # times what a motion would give friction at the same pressure
STICKS_FROM_PA = 1e3


def rest_bounds(time_s, pressure, law, before):
    """Friction at a standstill: a stop that gives way from one sign to the other over `law.over_pa`, or up to a share, or what
    sticks at the force that it has, or relaxes to a share of what it was."""

    def stuck(state, times):
        return max(-STICKS_UP_TO, min(times * state, STICKS_UP_TO))

    def slid(state, by):
        return max(state, min(state + by, law.share)) if by > 0.0 else min(state, max(state + by, -law.share))

    (low, high), last_pa, bounds = before, float(pressure[0]), []
    for now_s, pressure_pa in zip(time_s.tolist(), pressure.tolist()):
        if law.relaxes is not None:
            to = law.relaxes["to"]
            share = to + (1.0 - to) * math.exp(-(now_s - float(time_s[0])) / law.relaxes["time_constant_s"])
            low, high = share * before[0], share * before[1]
        elif law.sticks:
            times = max(last_pa, STICKS_FROM_PA) / max(pressure_pa, STICKS_FROM_PA)
            low, high = stuck(low, times), stuck(high, times)
        else:
            by = 2.0 * (pressure_pa - last_pa) / law.over_pa
            low, high = slid(low, by), slid(high, by)
        last_pa = pressure_pa
        bounds.append((low, high))
    return bounds


def turns_of(bounds, pushed):
    """Rows at which the length turns as the signs say, not where the pressure turns friction over."""
    ways = [sign_of(bound) for bound in bounds]
    turns = [row for row in range(1, len(ways)) if ways[row] != ways[row - 1]]
    return [row for row in turns if not any(still.start <= row <= still.stop for still in pushed)]


def path_of(time_s, shortening, halves, noise_m, turns):
    """The shortening as parabolas describe it, over windows as long as its noise needs and as short as its turns do: one that goes across
    a turn that it does not describe, such as a corner, has its vertex elsewhere. Around a slow turn it is what a cubic says, over halves
    between the two of `halves`; those turns come with it."""
    n_rows, longest = len(shortening), halves[0]
    period_s = (time_s[n_rows - 1] - time_s[0]) / (n_rows - 1)
    bends = [(turn, *bend_at(shortening, turn, longest, noise_m)) for turn in turns]
    ends, path, start = [n_rows], [], 0
    for row, _, is_split in reversed(bends):
        ends.insert(0, row if is_split else ends[0])
    for index, end in enumerate(ends):
        around = bends[max(index - 1, 0) : index + 1]
        if index > 0 and bends[index - 1][2]:
            start = bends[index - 1][0]
        piece = shortening[start:end]
        half = min(min([longest, *(bend[1] for bend in around)]), (max(len(piece), 1) - 1) // 2)
        first, last = bends[index - 1][0] if index > 0 else 0, bends[index][0] if index < len(bends) else n_rows
        smooth = Window(time_s[start:end], half * period_s).parabolas(piece)[0] if len(piece) else piece
        path.append(smooth[first - start : last - start])
    path, slow = np.concatenate(path), []
    for index, (row, _, is_split) in enumerate(bends):
        if is_split:
            continue
        before = (turns[index - 1] + row) // 2 if index > 0 else 0
        after = (turns[index + 1] + row) // 2 if index + 1 < len(turns) else n_rows
        found = slow_turn_around(shortening, row, range(before, after), halves, noise_m)
        if found is not None:
            slow.append(found)
            path[found.rows.start : found.rows.stop] = found.values()
    return path, slow


class SlowTurn:
    """The cubic that describes the length around a slow turn, over as long a time as it does."""

    def __init__(self, rows, vertex, weights, origin_m, half):
        self.rows, self.vertex, self.way = rows, vertex, math.copysign(1.0, weights[2])
        self.weights, self.origin_m, self.half = weights, origin_m, half

    def values(self):
        return self.origin_m + cubics(np.arange(len(self.rows)) / self.half - 1.0) @ self.weights


def cubics(along):
    return np.stack([np.ones_like(along), along, along**2, along**3], 1)


def slow_turn_around(shortening, turn, room, halves, noise_m):
    """The longest slow turn around row `turn` within `room`, or None."""
    (least, most), found = halves, None
    half = least
    while half < most:
        half = min(2 * half, most)
        row, shorter = (turn, least) if found is None else (found.vertex, len(found.rows) // 2)
        longer = None
        for _ in range(3):
            reach = min(half, row - room.start, room.stop - 1 - row)
            if reach <= shorter:
                return found
            is_otherwise, here = slow_turn_over(shortening, range(row - reach, row + reach + 1), noise_m)
            if is_otherwise:
                return found
            if here is None:
                break
            row, longer = here.vertex, here
        found = found if longer is None else longer
    return found


def goes_over(shortening, still, most, noise_m):
    """Whether the length, which seems to rest, turns slowly there."""
    middle, least = (still.start + still.stop) // 2, len(still) // 2
    turn = slow_turn_around(shortening, middle, range(len(shortening)), (least, most), noise_m)
    return turn is not None and turn.vertex in still and abs(turn.weights[2]) > 100.0 * noise_m / math.sqrt(len(turn.rows))


def slow_turn_over(shortening, rows, noise_m):
    """Whether two cubics surely leave less than one over rows, and the slow turn that it is there, or None."""
    values, per_bin = shortening[rows.start : rows.stop], -(-len(rows) // 64)
    n_bins = len(values) // per_bin
    means = (values[: n_bins * per_bin] - values[0]).reshape(n_bins, per_bin).sum(1) / per_bin

    def cubic(first, last):
        half = 0.5 * ((last - first) * per_bin - 1.0)
        along = ((np.arange(last - first) + 0.5) * per_bin - 0.5) / half - 1.0
        return least_squares(cubics(along), means[first:last])

    one, before, after = cubic(0, n_bins), cubic(0, n_bins // 2), cubic(n_bins // 2, n_bins)
    if one is None or before is None or after is None:
        return False, None
    (left, weights), half = one, 0.5 * (n_bins * per_bin - 1.0)
    if left - before[0] - after[0] > (4.0 * noise_m) ** 2 / per_bin:
        return True, None
    _, slope, square, third = weights
    inner = square * square - 3.0 * slope * third
    below = square + math.copysign(math.sqrt(inner), square) if inner >= 0.0 else 0.0
    along = -slope / below if below != 0.0 else math.inf
    if abs(along) >= 1.0:
        return False, None
    away_m = math.copysign(1.0, square) * ((cubics(np.array([-1.0, 1.0])) - cubics(np.array([along]))) @ weights)
    if away_m.min() <= 8.0 * noise_m / math.sqrt(len(rows)):
        return False, None
    vertex = rows.start + int(math.floor(half * (along + 1.0) + 0.5))
    return False, SlowTurn(rows, vertex, weights, values[0], half)


def bend_at(shortening, row, half, noise_m):
    """Rows to either side of the longest parabola that describes the length around a turn, and whether it goes up to the turn from
    both sides, as at a corner."""

    def is_described(start, at, stop):
        stop = min(stop, len(shortening))
        return stop - start < 8 or not is_across(shortening[start:stop], at - start, noise_m)

    while True:
        before, after = max(row - half, 0), row + half + 1
        is_smooth = is_described(before, row, after)
        is_split = (not is_smooth and is_described(max(row - 2 * half - 1, 0), before, row)
                    and is_described(row, min(after, len(shortening)), row + 2 * half + 1))  # fmt: skip
        if is_smooth or is_split or half <= 4:
            return half, is_split
        half = max(half // 2, 4)


def is_across(values, at, noise_m):
    """Whether two parabolas, up to value `at` and from there on, surely leave less than one."""

    def left(values):
        along = np.arange(len(values), dtype=float) - 0.5 * len(values)
        found = least_squares(np.stack([np.ones_like(along), along, along**2], 1), values - values[0])
        return None if found is None else found[0]

    before, after = values[:at], values[at:]
    if len(before) < 4 or len(after) < 4:
        return True
    one, parts = left(values), (left(before), left(after))
    return one is None or None in parts or one - sum(parts) > (4.0 * noise_m) ** 2


def leaves(path, noise_m, rows, way):
    """Row at which a path leaves its farthest point to go a way, and where it is there: at its vertex, or at the end of a rest."""
    ahead_m = way * np.array(path[rows.start : rows.stop])
    farthest = int(np.argmin(ahead_m))
    last = int(np.flatnonzero(ahead_m <= ahead_m[farthest] + 2.0 * noise_m)[-1])
    before = farthest - 2 * (last - farthest)
    if last > farthest and before >= 0 and ahead_m[before] - ahead_m[farthest] > 4.0 * noise_m:
        return rows.start + farthest, way * ahead_m[farthest]
    return rows.start + last, way * ahead_m[farthest : last + 1].mean()


def turn_over(path, slow, noise_m, law, reach, carried, pushed, bounds):
    """Lets the states follow the travel along `path` after every turn; over the ranges `pushed` the pressure moves them. A turn is
    where the path leaves its farthest point, within `reach` rows of where the sign changes."""
    ways, is_pushed = [sign_of(bound) for bound in bounds], [False] * len(bounds)
    for still in pushed:
        is_pushed[still.start : still.stop] = [True] * len(still)

    def free(start, stop):
        return all(not is_pushed[row] and ways[row] != 0 for row in range(start, stop))

    state = 0.5 * (carried[0] + carried[1]) if is_known(carried) else None
    way_before, turn, from_m, at_turn, farthest_m, row = sign_of(carried), 0, path[0], state, 0.0, 0
    while row < len(bounds):
        if not is_known(bounds[row]):
            row += 1
            continue
        if is_pushed[row]:
            state, way_before = 0.5 * (bounds[row][0] + bounds[row][1]), 0
            row += 1
            continue
        way = float(ways[row])
        if ways[row] != way_before:
            # No farther than the turns on either side.
            stop = row
            while stop < min(len(path), row + reach) and ways[stop] == ways[row]:
                stop += 1
            here = next((one for one in slow if one.way == way and turn <= one.vertex and row in one.rows), None)
            around, left_m = ((here.vertex, path[here.vertex]) if here is not None
                              else leaves(path, noise_m, range(max(row - reach, turn), stop), way))  # fmt: skip
            # What came before the turn still goes the other way, what lies between it and here came this way already.
            if way_before != 0 and around > row and free(row, around):
                ways[row:around] = [way_before] * (around - row)
                continue
            back = max(around, turn)
            start = back if way_before != 0 and back < row and free(back, row) else row
            way_before = ways[row]
            ways[start:row] = [way_before] * (row - start)
            turn, farthest_m = min(around, row), 0.0
            from_m = path[row] if around > row else left_m
            at_turn = 0.5 * (bounds[start][0] + bounds[start][1]) if 0 < start < row else state
            row = start
        farthest_m = max(farthest_m, way * (path[row] - from_m))
        turned_m = max(farthest_m - law.held_m, 0.0)
        if at_turn is not None and turned_m == 0.0:
            state = at_turn
        elif at_turn is not None and law.turn_m > 0.0:
            state = min(max(at_turn + 2.0 * way * turned_m / law.turn_m, -1.0), 1.0)
        else:
            state = way
        bounds[row] = (state, state)
        row += 1


def moving_average(values, half):
    """Centered average over 2 half + 1 values, over fewer and still centered at the ends."""
    n, origin = len(values), values[0]
    sums = np.concatenate([[0.0], np.cumsum(values - origin)])
    index = np.arange(n)
    reach = np.minimum(half, np.minimum(index, n - 1 - index))
    return origin + (sums[index + reach + 1] - sums[index - reach]) / (2 * reach + 1)


def standstills(time_s, values, threshold):
    """Ranges of at least a second in which the values stay within a threshold, and shorter ones within less; in order."""
    found = within(time_s, values, threshold, 1.0)
    for short in within(time_s, values, 0.4 * threshold, 0.4):
        if all(short.stop <= still.start or still.stop <= short.start for still in found):
            found.append(short)
    return sorted(found, key=lambda still: still.start)


def within(time_s, values, threshold, least_s):
    """Ranges of at least `least_s` in which the values stay within a threshold."""
    found, start, low, high, values = [], 0, values[0], values[0], values.tolist()
    for index in range(len(values) + 1):
        if index < len(values):
            low, high = min(low, values[index]), max(high, values[index])
            if high - low <= threshold:
                continue
        if time_s[index - 1] - time_s[start] >= least_s:
            found.append(range(start, index))
        if index < len(values):
            start, low, high = index, values[index], values[index]
    return found


def never_rests(values, threshold):
    """Whether a parabola, a turn or a crawl, describes values better than a level with a motion before and after it."""
    along = np.linspace(-1.0, 1.0, len(values))
    bent = least_squares(np.stack([np.ones_like(along), along, along**2], 1), values - values[0])
    ends = np.minimum(along + 0.5, 0.0), np.maximum(along - 0.5, 0.0)
    level = least_squares(np.stack([np.ones_like(along), *ends], 1), values - values[0])
    if bent is None or level is None:
        return False
    left, (c0, c1, c2) = bent
    vertex = -0.5 * c1 / c2 if c2 != 0.0 else 0.0
    reached = [c0 + c1 * u + c2 * u * u for u in (-1.0, min(max(vertex, -1.0), 1.0), 1.0)]
    return level[0] - left > (3.0 * NOISE * threshold) ** 2 and max(reached) - min(reached) > 0.5 * threshold


def rests_within(values, still):
    """Mean and deviation in the middle half of a standstill."""
    n = len(still)
    middle = values[still.start + n // 4 : still.stop - n // 4]
    level = middle.sum() / len(middle)
    return level, math.sqrt(((middle - level) ** 2).sum() / len(middle))


def held_rows(still, contraction, noise_m):
    """Where in a standstill the length rests, without the end of the motion before it and the beginning of the next."""
    level, moves_m = rest_and_motion(contraction, still, noise_m)
    rests = [row for row in still if abs(contraction[row] - level) <= moves_m]
    return range(rests[0], rests[-1] + 1) if rests else range(0)


def rest_and_motion(contraction, still, noise_m):
    """Level on which a length rests in a standstill, and how far from it it moves."""
    level, spread_m = rests_within(contraction, still)
    return level, 3.0 * max(noise_m, spread_m)


def pushed_rows(stills, index, contraction, noise_m, pressure, threshold_pa):
    """Where in a standstill the pressure moves while the length rests; None where it does not. The end of a motion and the
    beginning of the next are left to the length."""
    still, n = stills[index], len(stills[index])
    level, moves_m = rest_and_motion(contraction, still, noise_m)
    after_motion = still.start > 0 and (index == 0 or stills[index - 1].stop < still.start)
    following = stills[index + 1].start if index + 1 < len(stills) else math.inf
    before_motion = still.stop < len(contraction) and following > still.stop
    deviations_m = np.abs(contraction[still.start : still.stop] - level).tolist()
    pressures_pa = pressure[still.start : still.stop].tolist()
    start, stop = still.start, still.stop
    if after_motion:
        start += moving_rows(deviations_m, pressures_pa, moves_m, threshold_pa)
    if before_motion:
        stop -= moving_rows(deviations_m[::-1], pressures_pa[::-1], moves_m, threshold_pa)
    return range(start, stop) if start < stop and np.ptp(pressure[start:stop]) > threshold_pa else None


def moving_rows(deviations_m, pressures_pa, moves_m, threshold_pa):
    """How many rows of a standstill, from its end inwards, belong to the motion beyond that end."""
    n = len(deviations_m)
    rest = next((at for at in range(n) if deviations_m[at] <= moves_m), None)
    if rest is None:
        return n
    far = next((at for at in reversed(range(rest)) if deviations_m[at] > 3.0 * moves_m), None)
    if far is None:
        return rest
    step_pa = pressures_pa[rest] - pressures_pa[far]
    farthest_pa, farthest_at = 0.0, rest
    for at in range(rest, n):
        along_pa = (pressures_pa[at] - pressures_pa[rest]) * math.copysign(1.0, step_pa)
        if along_pa > abs(step_pa) + threshold_pa:
            return rest
        if along_pa > farthest_pa:
            farthest_pa, farthest_at = along_pa, at
        if farthest_pa - along_pa > threshold_pa:
            return farthest_at
    return n


def play(smooth, raw, threshold, half, carried, marks, first):
    """The play operator on `smooth`, whose row 0 is `first` in `marks`: they become the sign of the motion, each flip dated back to
    where `raw` turned; 0 before the first motion where `carried` is 0."""
    smooth_list = smooth.tolist()
    if not smooth_list:
        return
    way, high, low = carried, smooth_list[0], smooth_list[0]
    high_at = low_at = last_turn = 0
    for index, value in enumerate(smooth_list):
        if value > high:
            high, high_at = value, index
        if value < low:
            low, low_at = value, index
        turned = 0
        if way == 0 and high - low > threshold:
            turned = 1 if high_at > low_at else -1
        elif way == 1 and high - value > threshold:
            turned = -1
        elif way == -1 and value - low > threshold:
            turned = 1
        marks[first + index] = way
        if turned == 0:
            if way > 0 and value >= high:
                low, low_at = value, index
            elif way < 0 and value <= low:
                high, high_at = value, index
            continue
        extreme, extreme_at = (low, low_at) if turned > 0 else (high, high_at)
        last_turn = dated(smooth, raw, index, extreme, extreme_at, threshold, half, way, turned, last_turn)
        # One that is dated within the average of the beginning began there.
        start = 0 if way == 0 and last_turn <= 2 * half else last_turn
        marks[first + start : first + index + 1] = [turned] * (index + 1 - start)
        way = turned
        high, high_at, low, low_at = value, index, value, index


def dated(smooth, raw, index, extreme, extreme_at, threshold, half, way, turned, last_turn):
    """The row at which a motion turned that was noticed at `index`."""
    near = np.flatnonzero(np.abs(smooth[extreme_at:index] - extreme) <= 0.5 * threshold)
    departed = extreme_at + int(near[-1]) if len(near) else extreme_at
    took = index - departed
    turn = max(max(departed - took, 0), extreme_at)
    if took <= half:
        # Faster than the average follows: the average smears the start, the raw values show it.
        near = np.flatnonzero(np.abs(raw[extreme_at : min(len(raw), index + half)] - extreme) <= 0.5 * threshold)
        turn = max(extreme_at + int(near[-1]) if len(near) else turn, turn)
    if way != 0:
        reach = min(max(max(index - turn, 0), half) + half, turn - last_turn)
        row = vertex_or_corner(raw, min(turn, index), reach, turned)
        if row is not None:
            turn = min(max(row, last_turn), index)
    return min(turn, index)


def vertex_or_corner(raw, row, reach, way):
    """The row around which `raw` turns to go the way of `way`: vertex of a parabola or corner of two lines, whichever leaves less."""
    for _ in range(3):
        reach = min(reach, row, len(raw) - 1 - row)
        if reach < 4:
            return None
        values = raw[row - reach : row + reach + 1]
        stride = -(-len(values) // 96)
        vertex, corner = vertex_of(values, stride), corner_of(values, stride, way)
        if vertex and vertex[2] * way > 0.0 and (corner is None or vertex[0] < corner[0]):
            at = vertex[1]
        elif corner:
            at = float(corner[1])
        else:
            return None
        row = row - reach + int(math.floor(min(max(at, 0.0), 2.0 * reach) + 0.5))
    return row


def vertex_of(values, stride):
    """Squares that a parabola leaves, its vertex in values from the first, its slope per value and value."""
    at, middle = np.arange(0, len(values), stride, dtype=float), float(len(values) // 2)
    found = least_squares(np.stack([np.ones_like(at), at - middle, (at - middle) ** 2], 1), values[::stride] - values[0])
    if found is None or found[1][2] == 0.0:
        return None
    left, weights = found
    bend = 2.0 * weights[2]
    vertex = middle - weights[1] / bend
    return (left, vertex, bend) if math.isfinite(vertex) else None


def corner_of(values, stride, way):
    """Squares that two lines leave which meet where they leave least, and that corner, where they turn the way of `way`."""
    n, best = len(values), None
    at = np.arange(0, n, stride, dtype=float)
    for corner in range(n // 4, n - n // 4, stride):
        ends = np.minimum(at - corner, 0.0), np.maximum(at - corner, 0.0)
        found = least_squares(np.stack([np.ones_like(at), *ends], 1), values[::stride] - values[corner])
        if found is not None and (best is None or found[0] < best[0]):
            best = (found[0], corner, found[1])
    if best is None:
        return None
    before, after = way * best[2][1], way * best[2][2]
    return best[:2] if after > 0.0 and before < 0.3 * after else None


def least_squares(rows, values):
    """Squares that are left, and weights; None where the columns are dependent."""
    try:
        factor = np.linalg.cholesky(rows.T @ rows)
    except np.linalg.LinAlgError:
        return None
    right = rows.T @ values
    weights = np.linalg.solve(factor.T, np.linalg.solve(factor, right))
    return float(values @ values - weights @ right), weights


# --- Kinematics of a recording -----------------------------------------------------------------------------------------------
#
# Rates and accelerations come from parabolas over centered windows (Savitzky and Golay, 1964), of a path without its knees: rows
# at which a drive changes its speed at once. What remembers its path gets an average that never overshoots.


class Window:
    """The parabola over 2 half + 1 evenly sampled rows."""

    def __init__(self, time_s, half_s):
        n = len(time_s)
        self.period_s = (time_s[n - 1] - time_s[0]) / (n - 1) if n > 1 else 1.0
        self.half = half = min(max(int(math.floor(half_s / self.period_s + 0.5)), 4), 50)
        self.sum2 = half * (half + 1.0) * (2.0 * half + 1.0) / 3.0
        self.sum4 = self.sum2 * (3.0 * half * half + 3.0 * half - 1.0) / 5.0
        self.width_s = 2.0 * half * self.period_s

    def curvature_noise(self):
        """Deviation of a curvature over that of the white noise of the rows."""
        n = 2.0 * self.half + 1.0
        return 2.0 * math.sqrt(n / (n * self.sum4 - self.sum2 * self.sum2)) / (self.period_s * self.period_s)

    def parabolas(self, channel):
        """Value, slope and curvature at every row; near the ends those of the nearest whole window."""
        n_rows, half = len(channel), self.half
        width = 2 * half + 1
        if n_rows < width:
            return channel.copy(), np.zeros(n_rows), np.zeros(n_rows)
        u = np.arange(-half, half + 1, dtype=float)
        origin = channel[half : n_rows - half]
        around = np.lib.stride_tricks.sliding_window_view(channel, width) - origin[:, None]
        total, first, second = around.sum(1), around @ u, around @ (u * u)
        determinant = width * self.sum4 - self.sum2 * self.sum2
        c0 = (self.sum4 * total - self.sum2 * second) / determinant
        c1, c2 = first / self.sum2, (width * second - self.sum2 * total) / determinant
        rows = np.arange(n_rows)
        center = np.clip(rows, half, n_rows - 1 - half)
        at, offset = center - half, (rows - center).astype(float)
        value = origin[at] + c0[at] + c1[at] * offset + c2[at] * offset * offset
        slope = c1[at] / self.period_s
        for row in [*range(half), *range(n_rows - half, n_rows)]:
            slope[row] = self.slope_near_end(channel, row)
        return value, slope, 2.0 * c2[at] / (self.period_s * self.period_s)

    def slope_near_end(self, channel, row):
        """That of the widest window around the row; the last two rows take that of their neighbor."""
        last = len(channel) - 1
        center = min(max(row, 2), last - 2)
        u = np.arange(1, min(self.half, center, last - center) + 1)
        first = (u * (channel[center + u] - channel[center - u])).sum()
        return first / (2.0 * (u * u).sum() * self.period_s)


def average_weights(window):
    """Positive weights of an average that never overshoots; they sum to one."""
    u = np.arange(-window.half, window.half + 1, dtype=float)
    slopes = np.cumsum(u * u - (u * u).sum() / (2 * window.half + 1))
    weights = np.cumsum(slopes)[:-2]
    return weights / weights.sum()


def averages(weights, channel):
    """The average around every row; beyond the ends the channel stays where it is."""
    half = len(weights) // 2
    padded = np.concatenate([np.full(half, channel[0]), channel, np.full(half, channel[-1])])
    around = np.lib.stride_tricks.sliding_window_view(padded, len(weights)) - channel[:, None]
    return channel + around @ weights


class Knees:
    """Rows at which the rate of a path changes at once, and the bent line that they make."""

    def __init__(self, knees, period_s):
        self.at = np.array([at for at, _ in knees])
        self.change = np.array([change for _, change in knees])
        self.slope, self.height = np.cumsum(self.change), np.cumsum(-self.change * self.at)
        self.period_s = period_s

    def added(self, rows):
        """What the knees so far have added to the path."""
        if not len(self.at):
            return np.zeros(len(rows))
        after = np.searchsorted(self.at, rows, side="right") - 1
        return np.where(after >= 0, self.slope[after] * rows + self.height[after], 0.0)

    def rates(self, n_rows):
        """Rate that they have added, averaged over the step before each row."""
        added = self.added(np.arange(n_rows, dtype=float))
        return np.concatenate([[0.0], (added[1:] - added[:-1]) / self.period_s])

    def bends(self, n_rows):
        """Second derivative by the knees over the step before each row, shared by two steps."""
        bends = np.zeros(n_rows)
        for at, change in zip(self.at, self.change):
            for row in range(max(math.floor(at - 0.5), 0), min(math.ceil(at + 1.5) + 1, n_rows)):
                if row - 1.5 < at < row + 0.5:
                    bends[row] += (1.0 - abs(at + 0.5 - row)) * change
        return bends / (self.period_s * self.period_s)

    def around(self, row):
        """The rows that no knee parts from `row`: the first after the last knee, and the last before the next."""
        following = int(np.searchsorted(self.at, float(row), side="right"))
        first = math.ceil(self.at[following - 1]) if following else 0
        return first, int(self.at[following]) if following < len(self.at) else 1 << 62


def take_knees(path, windows, noise):
    """The path without its knees, and the knees: those of the first window, then those of the second in what is left."""
    path, rows, found = path.copy(), np.arange(len(path), dtype=float), []
    for window in windows:
        knees = knees_of(path, window, noise)
        path -= Knees(knees, window.period_s).added(rows)
        found += knees
    return path, Knees(sorted(found, key=lambda knee: knee[0]), windows[0].period_s)


def knees_of(path, window, noise):
    """Bends that two straight lines describe down to the noise, as (row, change of the rate per row)."""
    half, n = window.half, len(path)
    if n <= 4 * half:
        return []
    gate = 6.0 * noise * window.curvature_noise()
    curvature = window.parabolas(path)[2].tolist()
    knees, row, end = [], half, n - half
    while row < end:
        start, peak, highest, way = row, row, 0.0, math.copysign(1.0, curvature[row])
        while row < end and way * curvature[row] > gate:
            if way * curvature[row] > highest:
                peak, highest = row, way * curvature[row]
            row += 1
        # A longer bend is one that lasts.
        if start < row <= start + 3 * half:
            knees += knee_near(path, peak, half, noise)
        row += 1
    return knees


def knee_near(path, peak, half, noise):
    """The knee within `half` rows of `peak`, if two lines describe the path there; a list of one or none."""
    n = 2 * half + 1
    along = np.arange(n) - float(half)
    squares = half * (half + 1) * n / 3.0

    def straightened(values):
        slope = (values @ along) / squares
        return values - (values.mean(-1)[..., None] + np.multiply.outer(slope, along))

    around = straightened(path[peak - half : peak + half + 1] - path[peak])
    bow = straightened(along**2)
    bowed = (bow @ around) ** 2 / (bow @ bow)
    reach = half * 10 - 10
    starts = np.arange(-reach, reach + 1) / 10.0
    hinges = straightened(np.maximum(along[None, :] - starts[:, None], 0.0))
    shares, sizes = hinges @ around, (hinges * hinges).sum(1)
    explained = shares * shares / sizes
    best = len(explained) - 1 - int(np.argmax(explained[::-1]))
    freedom = float(n - 4)
    left = around @ around - explained[best]
    most = freedom + 3.0 * math.sqrt(2.0 * freedom)
    if left < most * noise * noise and explained[best] - bowed > 9.0 * noise * noise:
        return [(peak + starts[best], shares[best] / sizes[best])]
    return []


class BacklashFilter:
    """Follows a channel but not its noise, without a lag while it goes on one way."""

    def __init__(self, noise, within_s):
        self.noise, self.within_s, self.position, self.way = noise, within_s, None, 0.0

    def follow(self, to, rate):
        if self.position is None:
            self.position = to
            return to
        by = to - self.position
        onward = by * self.way > 0.0 and rate * self.way * self.within_s > self.noise
        if abs(by) > self.noise or onward:
            self.position, self.way = to, math.copysign(1.0, by)
        return self.position


def walk(recording, directions, muscle, n_rows):
    """The first rows of a recording as moments."""
    moments, origin_s = [], recording.time_s[0]
    for segment in recording.segments():
        if segment.start < n_rows:
            rows = slice(segment.start, segment.stop)
            moments += walk_segment(recording, rows, directions, muscle, origin_s, n_rows - segment.start)
    return moments


class Channel:
    """Pressure or length of one segment: value, slope and curvature at every row."""

    def __init__(self, values, near, window, noise):
        self.rest, self.knees = take_knees(values, [window, near], noise)
        self.added = self.knees.added(np.arange(len(values), dtype=float))
        self.recorded = self.rest + self.added
        self.slope = window.parabolas(self.rest)[1] + self.knees.rates(len(values))
        self.curvature = near.parabolas(self.rest)[2] + self.knees.bends(len(values))


def walk_segment(recording, rows, directions, muscle, origin_s, most):
    """Moments of rows without a gap, so many at most."""
    eq11, thresholds = muscle.eq11, muscle.model["direction"]
    time_s = recording.time_s[rows]
    near, window = Window(time_s, 0.02), Window(time_s, 0.04)
    length = Channel(recording.length_m[rows], near, window, thresholds["length_m"] / 5.0)
    pressure = Channel(recording.pressure_pa[rows], near, window, thresholds["pressure_pa"] / 5.0)
    weights = average_weights(near)
    average_m = averages(weights, length.rest) + length.added
    average_pa = averages(weights, pressure.rest) + pressure.added
    force_n = near.parabolas(recording.force_n[rows])[0] if recording.force_n is not None else np.zeros(len(time_s))
    warmth_k = np.zeros(len(time_s))
    if recording.temperature_k is not None:
        warmth_k = near.parabolas(recording.temperature_k[rows])[0] - 293.15
    noise = math.sqrt((weights * weights).sum()) * (6.0 / 5.0)
    rest_slide_pa = eq11.slide_m_per_pa(eq11.rest_length_m) * thresholds["pressure_pa"]
    contraction = BacklashFilter(noise * thresholds["length_m"], window.width_s)
    slide = BacklashFilter(noise * (thresholds["length_m"] + rest_slide_pa), window.width_s)
    rest_slide = BacklashFilter(noise * rest_slide_pa, window.width_s)
    resting = resting_rows(length, window, thresholds["length_m"])
    slide_m_per_pa = eq11.slide_m_per_pa(average_m)
    by_pressure_m = np.cumsum(np.where(resting, slide_m_per_pa * np.diff(average_pa, prepend=average_pa[0]), 0.0))
    shortened_m = eq11.rest_length_m - average_m
    speeds = np.where(resting, slide_m_per_pa * pressure.slope, -length.slope)
    steps_s = np.diff(time_s, prepend=time_s[0])
    moments = []
    for at in range(min(len(time_s), most)):
        moments.append(Moment(
            time_s=float(time_s[at] - origin_s),
            step_s=float(steps_s[at]),
            pressure_pa=float(pressure.recorded[at]),
            pressure_rate_pa_per_s=float(pressure.slope[at]),
            length_m=float(length.recorded[at]),
            contraction_ratio=float(contraction.follow(shortened_m[at], -length.slope[at]) / eq11.rest_length_m),
            speed_m_per_s=float(-length.slope[at]),
            slide_speed_m_per_s=float(speeds[at]),
            acceleration_m_per_s2=float(-length.curvature[at]),
            direction=float(directions[rows.start + at]),
            came=0.0,
            slide_m=float(slide.follow(shortened_m[at] + by_pressure_m[at], speeds[at])),
            rest_slide_m=float(rest_slide.follow(by_pressure_m[at], speeds[at] if resting[at] else 0.0)),
            force_n=float(force_n[at]),
            warmth_k=float(warmth_k[at]),
        ))  # fmt: skip
    return moments


def resting_rows(length, window, threshold_m):
    """Rows at which the length has no speed and moves by less than a threshold within 0.1 s, but for the other side of a knee."""
    n, every = len(length.rest), window.half
    lengths = (window.parabolas(length.rest)[0] + length.added)[::every]
    reach = every * min(max(math.ceil(0.1 / (every * window.period_s)), 1), 20)
    resting = np.abs(length.slope) <= threshold_m / window.width_s
    for row in np.flatnonzero(resting):
        stop, start = length.knees.around(row)
        first = -(-max(row - reach, 0, stop) // every)
        last = min(min(row + reach, start) // every + 1, len(lengths))
        near = lengths[first:last]
        resting[row] = not len(near) or near.max() - near.min() <= threshold_m
    return resting


def shift(moments, pressure_s, length_s):
    """The moments with the pressure read `pressure_s` later and the length `length_s` later; a cubic between them."""
    moved = [dataclasses.replace(now) for now in moments]

    def cubic(share, values, slopes):
        t, t2, t3 = share, share * share, share * share * share
        return (
            (2.0 * t3 - 3.0 * t2 + 1.0) * values[0]
            + (t3 - 2.0 * t2 + t) * slopes[0]
            + (3.0 * t2 - 2.0 * t3) * values[1]
            + (t3 - t2) * slopes[1]
        )

    def between(share, left, right, *names):
        return {name: getattr(left, name) + share * (getattr(right, name) - getattr(left, name)) for name in names}

    for at, now in enumerate(moved):
        found = around(moments, at, pressure_s) if pressure_s != 0.0 else None
        if found:
            left, right, share = found
            slopes = left.pressure_rate_pa_per_s * right.step_s, right.pressure_rate_pa_per_s * right.step_s
            now.pressure_pa = cubic(share, (left.pressure_pa, right.pressure_pa), slopes)
            now.pressure_rate_pa_per_s = between(share, left, right, "pressure_rate_pa_per_s")["pressure_rate_pa_per_s"]
        found = around(moments, at, length_s) if length_s != 0.0 else None
        if found:
            left, right, share = found
            slopes = -left.speed_m_per_s * right.step_s, -right.speed_m_per_s * right.step_s
            length_m = cubic(share, (left.length_m, right.length_m), slopes)
            now.slide_m -= length_m - now.length_m
            now.length_m = length_m
            smooth = ("contraction_ratio", "speed_m_per_s", "slide_speed_m_per_s", "acceleration_m_per_s2")
            for name, value in between(share, left, right, *smooth).items():
                setattr(now, name, value)
            now.direction = left.direction if share < 0.5 else right.direction
    return moved


def around(moments, at, delay_s):
    """The moments around the time of one plus a delay, and how far between them it lies; None across a gap or an end."""
    time_s, left = moments[at].time_s + delay_s, at
    while left > 0 and moments[left].time_s > time_s:
        if moments[left].step_s == 0.0:
            return None
        left -= 1
    while left + 1 < len(moments) and moments[left + 1].time_s <= time_s:
        left += 1
        if moments[left].step_s == 0.0:
            return None
    if left + 1 >= len(moments) or moments[left + 1].step_s == 0.0 or time_s < moments[left].time_s:
        return None
    right = moments[left + 1]
    return moments[left], right, (time_s - moments[left].time_s) / right.step_s


# --- Inverse -----------------------------------------------------------------------------------------------------------------


class Inverse:
    """A pam-inverse/1: the pressure for a force, a length and a direction."""

    ACTIVATIONS = {"tanh": np.tanh, "sigmoid": lambda z: 1.0 / (1.0 + np.exp(-z)), "linear": lambda z: z}

    def __init__(self, artifact):
        if artifact.get("schema") != "pam-inverse/1":
            found = artifact.get("schema")
            raise ValueError(f"schema is {found!r}, expected 'pam-inverse/1'; write it with pam-train-inverse")
        self.layers = [
            (np.array(weights), np.array(biases), self.ACTIVATIONS[activation])
            for weights, biases, activation in zip(artifact["weights"], artifact["biases"], artifact["activations"])
        ]
        self.inputs, self.output = artifact["input_scaling"], artifact["output_scaling"]
        self.domain = domain = artifact["domain"]
        none = [math.nan, math.nan]
        reach = [(at["extending_force_n"] or none) + (at["contracting_force_n"] or none) for at in domain["reach"]]
        self.reach_n = np.array(reach)

    @classmethod
    def read(cls, path):
        """The network in a file."""
        with open(path, encoding="utf-8") as file:
            return cls(json.load(file))

    def pressure_pa(self, force_n, length_m, direction):
        """Gauge pressure in Pa, and whether it must not be relied on: no pressure gives the force, or the network was not trained
        there. Numbers or arrays."""
        point = np.broadcast_arrays(*(np.asarray(value, float) for value in (force_n, length_m, direction)))
        answers = np.stack([(value - s["offset"]) / s["scale"] for value, s in zip(point, self.inputs)], -1)
        for weights, biases, activation in self.layers:
            answers = activation(answers @ weights.T + biases)
        pressure_pa = self.output["offset"] + self.output["scale"] * answers[..., 0]
        return pressure_pa[()], self.is_outside(*point)[()]

    def is_outside(self, force_n, length_m, direction):
        """Whether no pressure of the domain gives the force there."""
        shortest_m, longest_m = self.domain["length_m"]
        margin_m, last = 1e-9 * (longest_m - shortest_m), len(self.reach_n) - 1
        inside = (length_m >= shortest_m - margin_m) & (length_m <= longest_m + margin_m) & (np.abs(direction) <= 1.0)
        position = np.clip((length_m - shortest_m) * (last / (longest_m - shortest_m)), 0.0, last)
        below = np.minimum(position.astype(int), last - 1)
        share = (position - below)[..., None]
        bounds_n = (1.0 - share) * self.reach_n[below] + share * self.reach_n[below + 1]
        contracting = 0.5 * (1.0 + direction)
        lowest_n = (1.0 - contracting) * bounds_n[..., 0] + contracting * bounds_n[..., 2]
        highest_n = (1.0 - contracting) * bounds_n[..., 1] + contracting * bounds_n[..., 3]
        margin_n = 2e-4 * (self.domain["force_n"][1] - self.domain["force_n"][0])
        return ~(inside & (force_n >= lowest_n - margin_n) & (force_n <= highest_n + margin_n))
