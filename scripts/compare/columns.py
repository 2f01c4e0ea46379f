"""The catalogue's effects as columns for a sparse regression, built once for all peers.

A peer that sums columns cannot know an effect's inner parameters (a time constant, a threshold), so each effect gets
columns at several of them, most in the very form in which the effect is concealed. A family is right where any of its
effects is concealed; where two effects make nearly the same column, it stands for both. All of this favors the peers.
"""

import numpy as np
from scipy.signal import lfilter, savgol_filter

import eq11


def low_pass(values, period, tau):
    share = 1 - np.exp(-period / tau)
    return lfilter([share], [1, share - 1], values, zi=[(1 - share) * values[0]])[0]


def slip(travel, threshold, start):
    """Maxwell slip: follows `travel` over `threshold`, held within -1 and 1."""
    out, state = np.empty(len(travel)), float(start)
    for row, step in enumerate((np.diff(travel, prepend=travel[0]) / threshold).tolist()):
        state = min(max(state + step, -1.0), 1.0)
        out[row] = state
    return out


def families(muscle, theta, recordings):
    """Columns of recordings one after the other: {family: (effects, columns)}; also the base force and its tangent.

    Each recording is time, pressure, length, force, direction.
    """
    found = {}
    base, tangent = [], []
    low, high = theta - 1e-6 * np.abs(theta) - 1e-15, theta + 1e-6 * np.abs(theta) + 1e-15
    wear = 0.0
    n_rows = sum(len(recording[0]) for recording in recordings)
    start = 0
    pieces = {}

    def add(family, effects, name, values):
        found.setdefault(family, effects)
        column = pieces.setdefault((family, name), np.zeros(n_rows))
        column[start : start + len(values)] = values

    longest_travel = max(muscle.rest_length - recording[2].min() for recording in recordings)
    reach = longest_travel / muscle.rest_length
    furthest = 0.0
    for index, (time, pressure, length, measured, signs) in enumerate(recordings):
        period = (time[-1] - time[0]) / (len(time) - 1)
        since = time - time[0]
        smooth = lambda values, order: savgol_filter(values, 11, 2, deriv=order, delta=period)
        force_at = lambda p, l: muscle.force(muscle.rows(p, l, signs), theta)
        force = force_at(pressure, length)
        by_pressure = (force_at(pressure + 10, length) - force_at(pressure - 10, length)) / 20
        by_length = (force_at(pressure, length + 1e-6) - force_at(pressure, length - 1e-6)) / 2e-6
        rows = muscle.rows(pressure, length, signs)
        base.append(force)
        steps = np.diag(high - low)
        tangent.append(np.column_stack([
            (muscle.force(rows, theta + 0.5 * step) - muscle.force(rows, theta - 0.5 * step)) / step.sum()
            for step in steps
        ]))
        speed, acceleration = -smooth(length, 1), -smooth(length, 2)
        contraction = 1 - length / muscle.rest_length
        travel = muscle.rest_length - savgol_filter(length, 11, 2)
        diameter, slope = muscle.diameter(length)
        normal = pressure * np.pi * diameter * length
        rubber = 2e5 * muscle.bladder(length)
        gas = rows[0] * (muscle.a * (1 - contraction) ** 2 - muscle.b)

        lag = {"channel-delay", "pressure-lag"}
        add("pressure rate and lag", lag, "rate", by_pressure * smooth(pressure, 1))
        for tau in (0.02, 0.05, 0.1, 0.2):
            add("pressure rate and lag", lag, tau, by_pressure * (low_pass(pressure, period, tau) - pressure))
        add("length rate", {"channel-delay"}, "rate", by_length * smooth(length, 1))
        for kpa in (5, 15, 40):
            z = slip(savgol_filter(pressure, 11, 2), kpa * 1e3, 0)
            add("gauge hysteresis", {"pressure-gauge-hysteresis"}, kpa, by_pressure * z)
        add("drift", {"force-drift"}, ("line", index), since)
        add("drift", {"force-drift"}, ("warm-up", index), 1 - np.exp(-since / 20))
        for share in np.arange(1, 8) / 8:
            add("step", {"force-step"}, (index, share), (since >= share * since[-1]).astype(float))
        add("compliance", {"series-compliance"}, 1, by_length * measured)
        add("inertia", {"inertia"}, 1, acceleration)
        for newton in (0, 5, 20):
            add("slack", {"slack"}, newton, np.maximum(newton - force, 0))
        for kpa in (10, 20, 40, 60):
            add("threshold", {"threshold-pressure"}, kpa, by_pressure * np.minimum(pressure, kpa * 1e3))
        add("end taper", {"end-taper"}, 1, pressure * diameter * (diameter - 2 * muscle.radius) * slope)
        for share in (0.6, 0.75, 0.9):
            add("lock-up", {"braid-lockup"}, share, np.logaddexp(0, (contraction - share * reach) / 0.01))
        for mm in (0.3, 1, 3):
            z = slip(travel, mm * 1e-3, signs[0])
            add("pre-sliding", {"presliding-hysteresis"}, mm, normal * (z - signs))
        for mm in (0.3, 1, 3, 10):
            add("rubber hysteresis", {"rubber-hysteresis"}, mm, slip(travel, mm * 1e-3, signs[0]))
        add("Coulomb sign", {"rubber-hysteresis"}, 1, signs)
        for mm_per_s in (1, 3, 10):
            fast = np.abs(speed) / (mm_per_s * 1e-3)
            add("Stribeck", {"stribeck"}, mm_per_s, signs * normal * np.exp(-fast))
        for mm_per_s in (1, 5):
            fast = np.abs(speed) / (mm_per_s * 1e-3)
            add("rate of friction", {"rate-dependent-hysteresis"}, mm_per_s, signs * normal * np.log1p(fast))
        add("friction by load", {"load-dependent-friction"}, 1, signs * np.maximum(force, 0))
        add("friction by load", {"load-dependent-friction"}, 2, signs * np.maximum(force, 0) * contraction)
        for power in (0, 0.5, 1):
            add("viscous", {"viscous-damping"}, power, np.maximum(pressure, 0) ** power * speed)
        for tau in (0.5, 2, 5, 20, 50):
            add("relaxation", {"viscoelastic-relaxation"}, tau, rubber - low_pass(rubber, period, tau))
            add("creep", {"pressure-creep"}, tau, gas - low_pass(gas, period, tau))
        slow = {"pressure-creep", "viscoelastic-relaxation"}
        add("logarithm of time", slow, "gas", gas * np.log1p(since))
        add("logarithm of time", slow, "rubber", rubber * np.log1p(since))
        here = np.maximum.accumulate(contraction)
        ever = np.maximum(here, furthest)
        for memory, most in (("recording", here), ("ever", ever)):
            for scale in (0.01, 0.03):
                softer = rubber * -np.expm1(-(most - contraction) / scale)
                add("softening", {"mullins-softening"}, (memory, scale), softer)
        shortest = np.minimum.accumulate(contraction)
        for scale in (0.01, 0.03):
            slackens = -np.expm1(-(contraction - shortest) / scale)
            add("softening", {"mullins-softening"}, ("axis", scale), (reach - contraction) * slackens)
        furthest = ever[-1]
        work = np.maximum(pressure, 0) * diameter * length * np.abs(speed)
        for tau in (20, 100, 300):
            heat = lfilter([1 - np.exp(-period / tau)], [1, -np.exp(-period / tau)], work)
            add("warming", {"thermal-softening"}, tau, rubber * heat)
        path = np.cumsum(np.abs(np.diff(travel, prepend=travel[0])))
        for power in (0.5, 1):
            add("wear", {"fatigue-wear"}, ("recording", power), gas * path**power)
            add("wear", {"fatigue-wear"}, ("ever", power), gas * (wear + path) ** power)
            add("run-in", {"fatigue-wear"}, ("recording", power), signs * normal * path**power)
            add("run-in", {"fatigue-wear"}, ("ever", power), signs * normal * (wear + path) ** power)
        wear += path[-1]
        start += len(time)
    names = [family for family, _ in pieces]
    return found, names, np.column_stack(list(pieces.values())), np.concatenate(base), np.vstack(tangent)


def theta_and_muscle(model):
    return eq11.theta_of(model), eq11.Muscle(model["geometry"])
