typedef struct {
    int started;
    double gauge_pa, muscle_pa;
} pam_pressure_lag;

static inline void pam_pressure_lag_sees(pam_pressure_lag *memory, pam_moment *now)
{
    const double gauge_pa = now->pressure_pa;
    if (memory->started && now->step_s > 0.0) {
        const double ratio = now->step_s / PAM_PRESSURE_LAG_TIME_CONSTANT_S;
        const double slope_pa = (gauge_pa - memory->gauge_pa) / ratio;
        now->pressure_pa = gauge_pa - slope_pa + (memory->muscle_pa - memory->gauge_pa + slope_pa) * exp(-ratio);
    }
    memory->started = 1;
    memory->gauge_pa = gauge_pa;
    memory->muscle_pa = now->pressure_pa;
}
