typedef struct {
    int started;
    double gauge_pa, muscle_pa, muscle_pa_per_s;
} pam_pressure_lag;

static inline void pam_pressure_lag_sees(pam_pressure_lag *memory, pam_moment *now)
{
    const double lag_s = PAM_PRESSURE_LAG_TIME_CONSTANT_S, air_mass = PAM_PRESSURE_LAG_AIR_MASS;
    const double gauge_pa = now->pressure_pa;
    double muscle_pa_per_s = 0.0;
    if (memory->started && now->step_s > 0.0) {
        const double rate_pa_per_s = (gauge_pa - memory->gauge_pa) / now->step_s;
        double off_pa = memory->muscle_pa - (memory->gauge_pa - lag_s * rate_pa_per_s);
        if (air_mass < 1e-3) {
            off_pa *= exp(-now->step_s / lag_s);
        } else {
            const double inertia_s2 = air_mass * lag_s * lag_s, a = 0.5 * lag_s / inertia_s2;
            const double square = a * a - 1.0 / inertia_s2, q = sqrt(fmax(fabs(square), 1e-6 * a * a));
            const double off_rate = memory->muscle_pa_per_s - rate_pa_per_s;
            if (square > 0.0) {
                const double slow = -1.0 / (inertia_s2 * (a + q)), fast = -(a + q);
                const double part_pa = (off_rate - fast * off_pa) / (slow - fast);
                const double slow_pa = part_pa * exp(slow * now->step_s);
                const double fast_pa = (off_pa - part_pa) * exp(fast * now->step_s);
                off_pa = slow_pa + fast_pa;
                muscle_pa_per_s = rate_pa_per_s + slow * slow_pa + fast * fast_pa;
            } else {
                const double sine = sin(q * now->step_s), cosine = cos(q * now->step_s), decay = exp(-a * now->step_s);
                const double across_pa = (off_rate + a * off_pa) / q, before_pa = off_pa;
                off_pa = decay * (before_pa * cosine + across_pa * sine);
                muscle_pa_per_s = rate_pa_per_s + decay * q * (across_pa * cosine - before_pa * sine) - a * off_pa;
            }
        }
        now->pressure_pa = gauge_pa - lag_s * rate_pa_per_s + off_pa;
    }
    memory->started = 1;
    memory->gauge_pa = gauge_pa;
    memory->muscle_pa = now->pressure_pa;
    memory->muscle_pa_per_s = muscle_pa_per_s;
}
