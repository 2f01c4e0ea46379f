"""The lift of exo-track in Python: the same plant by scipy.integrate.solve_ivp, the same controller 100 times a second.

    closed_loop_peer.py LIFT.toml MODEL.json METHOD RTOL TRACK.csv

Written from the equations in crates/exo: M q̈ = r T - G - d q̇, Dahl friction on the muscle's length, air and valve as a
first-order lag that the open valve limits, transport delay, and the controller with everything but effects. One arm
(exo-track moves two); sensors without noise or steps, as one noise cannot be drawn in two languages. The state between
two commands is smooth but for friction's reversals, so that every piece is integrated on its own.
"""

import time

STARTED = time.perf_counter()

import json  # noqa: E402
import math  # noqa: E402
import sys  # noqa: E402
import tomllib  # noqa: E402

from scipy.integrate import solve_ivp  # noqa: E402
from scipy.optimize import brentq  # noqa: E402

import eq11  # noqa: E402

GRAVITY, ATMOSPHERE, POLYTROPIC = 9.80665, 101_325.0, 1.2
RT, DENSITY, CRITICAL = 287.05 * 293.15, 1.185, 0.3


class Lever:
    """Muscle as the third side of the triangle over the elbow."""

    def __init__(self, arm, rest_length):
        self.product = arm["upper_m"] * arm["lower_m"]
        self.squares = arm["upper_m"] ** 2 + arm["lower_m"] ** 2
        self.offset = arm.get("mounted_length_mm", 1e3 * rest_length) * 1e-3 - math.sqrt(self.squares)

    def at(self, q):
        """Length of the muscle and its moment arm, in m."""
        side = math.sqrt(self.squares - 2 * self.product * math.sin(q))
        return side + self.offset, self.product * math.cos(q) / side


class Quintic:
    def __init__(self, start, end, duration):
        self.start, self.rise, self.duration = start, end - start, duration

    def at(self, t):
        s = min(max(t / self.duration, 0.0), 1.0)
        rest = 1 - s
        return (
            self.start + self.rise * s**3 * (10 + s * (-15 + 6 * s)),
            self.rise / self.duration * 30 * s * s * rest * rest,
            self.rise / self.duration**2 * 60 * s * rest * (1 - 2 * s),
        )


class World:
    """What plant and controller share: muscle, lever, weight, air."""

    def __init__(self, config, model):
        self.theta = tuple(float(value) for value in eq11.theta_of(model))
        self.muscle = eq11.Muscle(model["geometry"])
        self.lever = Lever(config["arm"], self.muscle.rest_length)
        load = config["load"]
        arm = config["arm"]
        self.inertia = (0.5 * load["mass_kg"] * arm["load_arm_m"] ** 2 + 0.5 * load["inertia_kg_m2"]
                        + arm["forearm_mass_kg"] * arm["forearm_center_m"] ** 2 + arm["forearm_inertia_kg_m2"])
        self.weight = GRAVITY * (0.5 * load["mass_kg"] * arm["load_arm_m"]
                                 + arm["forearm_mass_kg"] * arm["forearm_center_m"])
        self.solid = self.muscle.rubber_volume - config["valve"]["dead_volume_cm3"] * 1e-6

    def force(self, pressure, length, state):
        return self.muscle.force(self.muscle.rows(pressure, length, state, math.sqrt), self.theta)

    def air(self, length):
        volume, slope = self.muscle.volume(length)
        return volume - self.solid, slope

    def gravity(self, q):
        return self.weight * math.cos(q)


class Plant:
    def __init__(self, world, config):
        valve, plant = config["valve"], config["plant"]
        self.world, self.lag, self.supply = world, valve["lag_ms"] * 1e-3, valve["supply_kpa"] * 1e3
        # ISO 6358: liters per second and bar, at the reference density.
        self.conductance = valve["conductance_l_per_s_bar"] * 1e-8 * DENSITY
        self.presliding, self.damping = plant["presliding_mm"] * 1e-3, plant["damping_n_m_s"]
        self.friction = plant["friction_factor"]

    def flow(self, upstream, downstream):
        up, down = upstream + ATMOSPHERE, downstream + ATMOSPHERE
        beyond = (down - CRITICAL * up) / (1 - CRITICAL)
        if beyond <= 0:
            return self.conductance * up
        return self.conductance * math.sqrt(max(up * up - beyond * beyond, 0.0))

    def slopes(self, _, y, command, carried):
        q, dq, pressure, state = y
        world = self.world
        length, arm = world.lever.at(q)
        rate = -arm * dq
        volume, volume_slope = world.air(length)
        most = POLYTROPIC * RT / volume
        wanted = (command - pressure) / self.lag
        if wanted > 0:
            filled = min(wanted, most * self.flow(self.supply, pressure))
        else:
            filled = max(wanted, -most * self.flow(pressure, 0.0))
        expanded = POLYTROPIC * (pressure + ATMOSPHERE) * volume_slope * rate / volume
        tension = max(world.force(pressure, length, self.friction * state), 0.0)
        torque = arm * tension - carried * world.gravity(q) - self.damping * dq
        return (dq, torque / world.inertia, filled - expanded, (-rate - state * abs(rate)) / self.presliding)


class Controller:
    """Computed torque, force, pressure; integral action, disturbance observer, lag compensation, friction's state."""

    def __init__(self, world, config, reference, angle, pressure):
        control, valve = config["controller"], config["valve"]
        self.world, self.reference, self.control = world, reference, control
        self.period, self.limits = control["period_ms"] * 1e-3, (valve["lowest_kpa"] * 1e3, valve["highest_kpa"] * 1e3)
        self.loop, self.lag = control["pressure_loop_ms"] * 1e-3, control["valve_lag_ms"] * 1e-3
        self.ahead = self.loop + valve["delay_ms"] * 1e-3 + 0.5 * self.period
        pole = math.exp(-control["observer_rad_per_s"] * self.period)
        self.gains = 1 - pole**3, 1.5 * (1 - pole * pole) * (1 - pole), 0.5 * (1 - pole) ** 3
        self.presliding = control["presliding_mm"] * 1e-3
        self.q, self.dq, self.disturbance, self.integral = angle, 0.0, 0.0, 0.0
        self.state, self.followed = 0.0, world.lever.at(reference.start)[0]
        self.inertia, self.weight = world.inertia, world.weight
        self.pressure = pressure
        self.weighed = []

    def slid(self, travel):
        end = 1.0 if travel > 0 else -1.0
        return end + (self.state - end) * math.exp(-abs(travel) / self.presliding)

    def observe(self, carried, angle, pressure):
        length, arm = self.world.lever.at(self.q)
        torque = arm * max(self.world.force(0.5 * (pressure + self.pressure), length, self.state), 0.0)
        if carried >= 1:
            self.weighed.append(torque)
        rest = torque - carried * self.weight * math.cos(self.q)
        g, h, k = self.gains
        acceleration = rest / self.inertia + self.disturbance
        predicted = self.q + self.period * (self.dq + 0.5 * self.period * acceleration)
        surprise = angle - predicted
        self.q = predicted + g * surprise
        self.dq += self.period * acceleration + h * surprise / self.period
        self.disturbance += 2 * k * surprise / self.period**2
        self.pressure = pressure

    def begin_lift(self, config):
        """What was weighed during the hold takes the place of what was told."""
        if not self.weighed:
            return
        start, arm, load = self.reference.start, config["arm"]["load_arm_m"], config["load"]
        believed = self.weight * math.cos(start)
        per_kg = 0.5 * GRAVITY * arm * math.cos(start)
        more = (sum(self.weighed) / len(self.weighed) - believed) / per_kg
        more = min(max(more, -load["mass_kg"]), 2 * load["mass_kg"])
        before = self.inertia
        self.inertia += 0.5 * more * arm**2 + 0.5 * load["inertia_kg_m2"] * more / load["mass_kg"]
        self.weight += 0.5 * more * arm * GRAVITY
        kept = (before * (self.control["integral_per_s3"] * self.integral - self.disturbance) + believed
                - self.weight * math.cos(start))
        self.disturbance, self.integral = -kept / self.inertia, 0.0

    def inverse(self, force, length, state):
        low, high = self.limits
        excess = lambda pressure: self.world.force(pressure, length, state) - force
        if excess(low) > 0:
            return low
        if excess(high) < 0:
            return high
        return brentq(excess, low, high, xtol=1e-3)

    def update(self, t, carried, carried_ahead, angle, pressure):
        self.observe(carried, angle, pressure)
        lever, control = self.world.lever, self.control
        here, here_arm = lever.at(self.q)
        travel = self.followed - here
        if abs(travel) > 5e-5:
            step = math.copysign(abs(travel) - 5e-5, travel)
            self.state = self.slid(step)
            self.followed -= step
        q, dq, _ = self.reference.at(t)
        q_ahead, _, ddq_ahead = self.reference.at(t + self.ahead)
        error = q - self.q
        acceleration = (ddq_ahead + control["kd_per_s"] * (dq - self.dq) + control["kp_per_s2"] * error
                        + control["integral_per_s3"] * self.integral - self.disturbance)
        there, there_arm = lever.at(q_ahead)
        torque = self.inertia * acceleration + carried_ahead * self.weight * math.cos(q_ahead)
        force = max(torque / there_arm, 0.0)
        wanted = self.inverse(force, there, self.slid(self.followed - there))
        if self.limits[0] < wanted < self.limits[1]:
            self.integral += self.period * error
        volume, slope = self.world.air(here)
        expansion = POLYTROPIC * (pressure + ATMOSPHERE) * slope * (-here_arm * dq) / volume
        command = pressure + self.lag * ((wanted - pressure) / self.loop + expansion)
        return min(max(command, self.limits[0]), self.limits[1])


def lift(config, model, method, rtol):
    """Angle at every period from the start of the lift on: (time, angle)."""
    world = World(config, model)
    plant = Plant(world, config)
    period, delay = config["controller"]["period_ms"] * 1e-3, config["valve"]["delay_ms"] * 1e-3
    wanted = config["reference"]
    reference = Quintic(wanted["from_rad"], wanted["to_rad"], wanted["duration_s"])
    handover, before = wanted["handover_s"], wanted["handover_s"] + wanted["hold_s"]
    share = Quintic(0.0, 1.0, handover)
    carried_at = lambda t: share.at(t + before)[0]
    start = reference.start
    length, arm = world.lever.at(start)
    controller = Controller(world, config, reference, start, 0.0)
    pressure = controller.inverse(carried_at(-before) * world.gravity(start) / arm, length, 0.0)
    controller.pressure = pressure
    state = [start, 0.0, pressure, config["plant"]["friction_state"]]
    # Errors allowed: a share of the angle's range, its rate, 100 kPa and 1.
    atol = [rtol * 0.1, rtol * 0.1, rtol * 1e5, rtol]
    told, track = pressure, []
    first, last = -round(before / period), round((wanted["duration_s"] + wanted["settle_s"]) / period)
    for index in range(first, last + 1):
        t = index * period
        if index == 0:
            controller.begin_lift(config)
        carried = carried_at(t)
        command = controller.update(t, carried, carried_at(t + controller.ahead), state[0], state[2])
        if index >= 0:
            track.append((t, state[0]))
        for span, telling in (((0.0, delay), told), ((delay, period), command)):
            done = solve_ivp(plant.slopes, span, state, method=method, rtol=rtol, atol=atol, args=(telling, carried),
                             first_step=span[1] - span[0])
            state = done.y[:, -1]
        told = command
    return track


def main():
    config = tomllib.load(open(sys.argv[1], "rb"))
    model = json.load(open(sys.argv[2]))
    imported = time.perf_counter()
    track = lift(config, model, sys.argv[3], float(sys.argv[4]))
    done = time.perf_counter()
    with open(sys.argv[5], "w") as file:
        file.writelines(f"{t},{q!r}\n" for t, q in ((t, float(q)) for t, q in track))
    print(json.dumps({"fit_s": done - imported, "import_s": imported - STARTED}))


if __name__ == "__main__":
    main()
