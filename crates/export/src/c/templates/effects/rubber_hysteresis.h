typedef struct {
    pam_slip slip;
} pam_rubber_hysteresis;

static inline double pam_rubber_hysteresis_pulls(pam_rubber_hysteresis *memory, const pam_moment *now)
{
    const double contraction_m = now->contraction_ratio * PAM_REST_LENGTH_M;
    const double share = pam_slip_follow(&memory->slip, PAM_RUBBER_HYSTERESIS_SLIP_DISTANCE_M, contraction_m,
                                         now->came != 0.0 ? now->direction : 0.0);
    return -share * PAM_RUBBER_HYSTERESIS_WIDTH_N;
}
