"""What a rig does to the columns of a recording; no formula is the fitter's."""

# Half of the time over which rates are taken, s.
HALF_S = 0.04


def slope(times, values, order):
    """Value, first or second derivative at every instant: a parabola through the values around it, least squares."""
    answer, first, last = [], 0, 0
    for time_s, value in zip(times, values):
        while times[first] < time_s - HALF_S:
            first += 1
        while last < len(times) and times[last] <= time_s + HALF_S:
            last += 1
        near = [(times[at] - time_s, values[at]) for at in range(first, last)]
        sums = [sum(t**power for t, _ in near) for power in range(5)]
        right = [sum(v * t**power for t, v in near) for power in range(3)]
        # Cramer's rule for [1, t, t²].
        matrix = [[sums[row + column] for column in range(3)] for row in range(3)]
        whole = determinant(matrix)
        if len(near) < 5 or whole == 0.0:
            answer.append(0.0 if order else value)
            continue
        other = [[right[row] if column == order else matrix[row][column] for column in range(3)] for row in range(3)]
        answer.append(determinant(other) / whole * max(order, 1))
    return answer


def determinant(m):
    return (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))


def late(name, delay_s):
    def done(columns):
        times, values = columns["time_s"], columns[name]
        at, moved = 0, []
        for time_s in times:
            wanted = time_s - delay_s
            while at + 1 < len(times) and times[at + 1] <= wanted:
                at += 1
            left, right = at, min(at + 1, len(times) - 1)
            span = times[right] - times[left]
            share = min(max((wanted - times[left]) / span, 0.0), 1.0) if span > 0 else 0.0
            moved.append(values[left] + share * (values[right] - values[left]))
        columns[name] = moved
    return done


def compliant(mm_per_n):
    def done(columns):
        columns["length_mm"] = [length + mm_per_n * force for length, force in zip(columns["length_mm"], columns["force_N"])]
    return done


def with_play(half_kpa):
    def done(columns):
        # The noise of a gauge is made after its mechanism, which would swallow it.
        true = slope(columns["time_s"], columns["pressure_kPa"], 0)
        shown, read = true[0], []
        for value, pressure in zip(true, columns["pressure_kPa"]):
            shown = min(max(shown, value - half_kpa), value + half_kpa)
            read.append(shown + pressure - value)
        columns["pressure_kPa"] = read
    return done


def before_the_tube(time_constant_s):
    def done(columns):
        rates = slope(columns["time_s"], columns["pressure_kPa"], 1)
        columns["pressure_kPa"] = [value + time_constant_s * rate for value, rate in zip(columns["pressure_kPa"], rates)]
    return done


def heavy(mass_kg):
    def done(columns):
        rates = slope(columns["time_s"], columns["length_mm"], 2)
        columns["force_N"] = [force + mass_kg * 1e-3 * rate for force, rate in zip(columns["force_N"], rates)]
    return done
