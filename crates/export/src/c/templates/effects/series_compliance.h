typedef struct {
    int started;
    double slide_m, direction; /* of the muscle itself */
} pam_series_compliance;

static inline void pam_series_compliance_sees(pam_series_compliance *memory, pam_moment *now)
{
    const double turn_m = 1e-4;
    const double hardened = PAM_SERIES_COMPLIANCE_HARDENING_PER_N * fmax(now->force_n, 0.0);
    const double softer = hardened > 1e-9 ? log1p(hardened) / hardened : 1.0;
    const double stretch_m = PAM_SERIES_COMPLIANCE_COMPLIANCE_M_PER_N * now->force_n * softer;
    double turned = now->direction;
    now->length_m -= stretch_m;
    now->contraction_ratio += stretch_m / PAM_REST_LENGTH_M;
    now->slide_m += stretch_m;
    if (memory->started) {
        turned = fmin(fmax(memory->direction + 2.0 * (now->slide_m - memory->slide_m) / turn_m, -1.0), 1.0);
    }
    memory->started = 1;
    memory->slide_m = now->slide_m;
    memory->direction = turned;
    now->direction += PAM_SERIES_COMPLIANCE_SLIDING_SHARE * (turned - now->direction);
}
