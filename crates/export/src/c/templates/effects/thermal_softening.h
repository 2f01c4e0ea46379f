typedef struct {
    int started;
    double time_s, warmth, wall_k, power;
} pam_thermal_softening;

static inline double pam_thermal_softening_pulls(pam_thermal_softening *memory, const pam_moment *now,
                                                 const pam_base *base)
{
    const double reference_w = 1e3;
    const double power = fmax(base->normal_n, 0.0) * fabs(now->speed_m_per_s) / reference_w;
    if (memory->started) {
        const double step_s = fmax(now->time_s - memory->time_s, 0.0), lag_s = PAM_THERMAL_SOFTENING_WALL_LAG_S;
        const double behind = lag_s > 0.0 ? exp(-step_s / lag_s) : 0.0;
        const double heating = now->step_s > 0.0 ? 0.5 * (power + memory->power) : 0.0;
        const double share = expm1(-step_s / PAM_THERMAL_SOFTENING_TIME_CONSTANT_S);
        memory->warmth += (memory->warmth - heating) * share;
        memory->wall_k = now->warmth_k + (memory->wall_k - now->warmth_k) * behind;
    } else {
        memory->wall_k = now->warmth_k;
    }
    memory->started = 1;
    memory->time_s = now->time_s;
    memory->power = power;
    return -pam_latex_n(base)
               * (memory->warmth * PAM_THERMAL_SOFTENING_SOFTENING_PER_KILOWATT
                  + memory->wall_k * PAM_THERMAL_SOFTENING_SOFTENING_PER_KELVIN)
           - base->gas_n * memory->wall_k * PAM_THERMAL_SOFTENING_GAS_FORCE_LOSS_PER_KELVIN;
}
