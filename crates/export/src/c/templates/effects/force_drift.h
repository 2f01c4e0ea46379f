static inline double pam_force_drift_pulls(const pam_moment *now)
{
    return now->time_s * PAM_FORCE_DRIFT_DRIFT_N_PER_S
           - expm1(-now->time_s / PAM_FORCE_DRIFT_WARM_UP_S) * PAM_FORCE_DRIFT_WARM_UP_N;
}
