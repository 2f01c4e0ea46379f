/* Maxwell slip: six springs in parallel, each of which slips at its own distance (Al-Bender, Lampaert and Swevers, 2005). */
typedef struct {
    int started;
    double last;
    double states[6];
} pam_slip;

/* Turns every element over by `by`, from -1 to 1 by 2. */
static inline void pam_slip_turn(pam_slip *slip, double by)
{
    int i;
    for (i = 0; i < 6; i++) {
        slip->states[i] = fmin(fmax(slip->states[i] + by, -1.0), 1.0);
    }
}

/* Share of the full force, in [-1, 1], at a `position`; `settled` is the share at the first instant. */
static inline double pam_slip_follow(pam_slip *slip, double distance, double position, double settled)
{
    static const double distances[6] = {0.15, 0.35, 0.7, 1.3, 2.3, 4.5};
    static const double weights[6] = {0.14, 0.17, 0.22, 0.21, 0.17, 0.09};
    double step, share = 0.0;
    int i;
    if (!slip->started) {
        slip->started = 1;
        slip->last = position;
        for (i = 0; i < 6; i++) {
            slip->states[i] = settled;
        }
    }
    step = (position - slip->last) / distance;
    slip->last = position;
    for (i = 0; i < 6; i++) {
        slip->states[i] = fmin(fmax(slip->states[i] + step / distances[i], -1.0), 1.0);
        share += weights[i] * slip->states[i];
    }
    return share;
}
