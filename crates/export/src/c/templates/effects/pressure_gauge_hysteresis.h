typedef struct {
    pam_slip slip;
} pam_pressure_gauge_hysteresis;

static inline double pam_pressure_gauge_hysteresis_pulls(pam_pressure_gauge_hysteresis *memory, const pam_moment *now,
                                                         const pam_base *base)
{
    const double share =
        pam_slip_follow(&memory->slip, PAM_PRESSURE_GAUGE_HYSTERESIS_SLIP_PRESSURE_PA, now->pressure_pa, 0.0);
    return base->slope_n_per_pa * share * PAM_PRESSURE_GAUGE_HYSTERESIS_WIDTH_PA;
}
