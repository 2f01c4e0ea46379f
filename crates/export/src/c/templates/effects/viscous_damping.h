static inline double pam_viscous_damping_pulls(const pam_moment *now)
{
    const double reference_pa = 3e5;
    return -now->speed_m_per_s * PAM_VISCOUS_DAMPING_DAMPING_N_S_PER_M
           - now->speed_m_per_s * now->pressure_pa / reference_pa * PAM_VISCOUS_DAMPING_DAMPING_WITH_PRESSURE_N_S_PER_M;
}
