static inline void pam_series_compliance_sees(pam_moment *now)
{
    const double stretch_m = PAM_SERIES_COMPLIANCE_COMPLIANCE_M_PER_N * now->force_n;
    now->length_m -= stretch_m;
    now->contraction_ratio += stretch_m / PAM_REST_LENGTH_M;
    now->slide_m += stretch_m;
}
