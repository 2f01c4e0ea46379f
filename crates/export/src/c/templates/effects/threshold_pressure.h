static inline double pam_hinge_pa(double excess_pa)
{
    const double width_pa = 1e4;
    const double root_pa = hypot(excess_pa, width_pa);
    return excess_pa < 0.0 ? 0.5 * width_pa * width_pa / (root_pa - excess_pa) : 0.5 * (excess_pa + root_pa);
}

static inline void pam_threshold_pressure_sees(pam_moment *now)
{
    const double threshold_pa = PAM_THRESHOLD_PRESSURE_THRESHOLD_PA;
    now->pressure_pa = pam_hinge_pa(now->pressure_pa - threshold_pa) - pam_hinge_pa(-threshold_pa);
}
