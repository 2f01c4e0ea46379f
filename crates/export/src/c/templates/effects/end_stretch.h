static inline double pam_end_stretch_pulls(const pam_base *base)
{
    return -base->static_force_n * base->slope_n_per_m * PAM_END_STRETCH_STRETCH_M_PER_N;
}
