static inline double pam_braid_lockup_pulls(const pam_moment *now)
{
    const double onset = PAM_BRAID_LOCKUP_ONSET_CONTRACTION;
    const double beyond = (now->contraction_ratio - PAM_BRAID_LOCKUP_LOCK_CONTRACTION) / onset;
    return -onset * (fmax(beyond, 0.0) + log1p(exp(-fabs(beyond)))) * PAM_BRAID_LOCKUP_STIFFNESS_N;
}
