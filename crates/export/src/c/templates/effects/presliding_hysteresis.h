typedef struct {
    pam_slip slip;
} pam_presliding_hysteresis;

static inline double pam_presliding_hysteresis_slides(pam_presliding_hysteresis *memory, const pam_moment *now)
{
    const double slide_m = now->slide_m + (PAM_PRESLIDING_HYSTERESIS_SLIDE_AT_REST - 1.0) * now->rest_slide_m;
    return pam_slip_follow(&memory->slip, PAM_PRESLIDING_HYSTERESIS_SLIP_DISTANCE_M, slide_m,
                           now->came != 0.0 ? now->direction : 0.0);
}
