/* Gauge pressure for a force, and whether it must not be relied on: the question lies where the network was not trained, or
   where no pressure gives the force. */
typedef struct {
    double pressure_pa;
    int outside;
} pam_pressure;

/* Lowest and highest force at a length and a direction; 0 where there is none. */
static inline int pam_reach_n(double length_m, double direction, double *lowest_n, double *highest_n)
{
    const double margin_m = 1e-9 * (PAM_LONGEST_M - PAM_SHORTEST_M);
    const double *below, *above;
    double position, share, contracting, bounds_n[4];
    int at, i;
    if (!(length_m >= PAM_SHORTEST_M - margin_m && length_m <= PAM_LONGEST_M + margin_m && direction >= -1.0
          && direction <= 1.0)) {
        return 0;
    }
    position = fmin(fmax((length_m - PAM_SHORTEST_M) * PAM_LENGTHS_PER_M, 0.0), PAM_N_REACH - 1);
    at = (int)position < PAM_N_REACH - 2 ? (int)position : PAM_N_REACH - 2;
    share = position - at;
    below = pam_reach[at];
    above = pam_reach[at + 1];
    for (i = 0; i < 4; i++) {
        bounds_n[i] = (1.0 - share) * below[i] + share * above[i];
    }
    contracting = 0.5 * (1.0 + direction);
    *lowest_n = (1.0 - contracting) * bounds_n[0] + contracting * bounds_n[2];
    *highest_n = (1.0 - contracting) * bounds_n[1] + contracting * bounds_n[3];
    return *lowest_n == *lowest_n; /* not a number beside a length without any reach */
}

/* One layer: `outputs` neurons on `inputs`, weights row by row. */
static inline void pam_layer(const double *weights, const double *biases, int inputs, int outputs, int activation,
                             const double *before, double *after)
{
    int row, column;
    for (row = 0; row < outputs; row++, weights += inputs) {
        double sum = 0.0;
        for (column = 0; column < inputs; column++) {
            sum += weights[column] * before[column];
        }
        sum += biases[row];
        if (activation == PAM_TANH) {
            const double decay = exp(-2.0 * fabs(sum));
            sum = copysign((1.0 - decay) / (1.0 + decay), sum);
        } else if (activation == PAM_SIGMOID) {
            sum = 1.0 / (1.0 + exp(-sum));
        }
        after[row] = sum;
    }
}

/* Pressure at which the muscle pulls with `force_n` at a length while it moves in a `direction` (+1 contracting, -1 extending). */
static inline pam_pressure pam_inverse(double force_n, double length_m, double direction)
{
    pam_pressure result;
    double one[PAM_WIDTH], other[PAM_WIDTH], lowest_n = 0.0, highest_n = 0.0;
    const double margin_n = PAM_FORCE_MARGIN_N;
    one[0] = (force_n - PAM_FORCE_OFFSET) / PAM_FORCE_SCALE;
    one[1] = (length_m - PAM_LENGTH_OFFSET) / PAM_LENGTH_SCALE;
    one[2] = (direction - PAM_DIRECTION_OFFSET) / PAM_DIRECTION_SCALE;
@LAYERS@    result.pressure_pa = PAM_PRESSURE_OFFSET + PAM_PRESSURE_SCALE * @ANSWER@[0];
    result.outside = !(pam_reach_n(length_m, direction, &lowest_n, &highest_n) && force_n >= lowest_n - margin_n
                       && force_n <= highest_n + margin_n);
    return result;
}
