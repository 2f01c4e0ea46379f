static inline double pam_rate_dependent_hysteresis_pulls(const pam_moment *now, const pam_base *base)
{
    const double e_folds = log1p(fabs(now->slide_speed_m_per_s) / PAM_RATE_DEPENDENT_HYSTERESIS_ONSET_SPEED_M_PER_S);
    return -now->direction * base->normal_n * e_folds * PAM_RATE_DEPENDENT_HYSTERESIS_FRICTION_PER_E_FOLD;
}
