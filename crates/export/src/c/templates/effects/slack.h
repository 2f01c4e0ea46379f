/* h where h - w^3 / h^2 is `above_n`; max(above_n, 0) where w is 0. */
static inline double pam_taut_n(double above_n, double softness_n)
{
    const double sharp_n = 1e-3, far = 1e6;
    const double ratio = softness_n / fabs(above_n);
    double taut_n;
    int i;
    if (softness_n < sharp_n) {
        return above_n < 0.0 ? 0.0 : above_n;
    }
    if (above_n < -far * softness_n) {
        return softness_n * sqrt(softness_n / -above_n);
    }
    taut_n = softness_n * (above_n > 0.0 ? above_n / softness_n + fmin(ratio * ratio, 1.0) : fmin(sqrt(ratio), 1.0));
    /* Newton's steps from above, where the cubic is convex; six or seven do. */
    for (i = 0; i < 100; i++) {
        const double left = taut_n * taut_n * (taut_n - above_n) - softness_n * softness_n * softness_n;
        const double step_n = left / (taut_n * (3.0 * taut_n - 2.0 * above_n));
        taut_n -= step_n;
        if (step_n <= 1e-12 * taut_n) {
            break;
        }
    }
    return taut_n;
}

static inline double pam_slack_reads(double force_n)
{
    return PAM_SLACK_FLOOR_N + pam_taut_n(force_n - PAM_SLACK_FLOOR_N, PAM_SLACK_SOFTNESS_N);
}
