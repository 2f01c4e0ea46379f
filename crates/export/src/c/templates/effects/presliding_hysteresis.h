typedef struct {
    pam_slip slip;
    int begun;
    /* When anything last moved. */
    double contraction_ratio, rest_slide_m, direction;
} pam_presliding_hysteresis;

static inline double pam_presliding_hysteresis_slides(pam_presliding_hysteresis *memory, const pam_moment *now)
{
    const double slide_m = now->contraction_ratio * PAM_REST_LENGTH_M
        + PAM_PRESLIDING_HYSTERESIS_SLIDE_AT_REST * now->rest_slide_m;
    const int pressed = memory->begun && now->rest_slide_m != memory->rest_slide_m;
    if (pressed)
        pam_slip_turn(&memory->slip, PAM_PRESLIDING_HYSTERESIS_TURNS_AT_REST * (now->direction - memory->direction));
    if (!memory->begun || pressed || now->contraction_ratio != memory->contraction_ratio) {
        memory->begun = 1;
        memory->contraction_ratio = now->contraction_ratio;
        memory->rest_slide_m = now->rest_slide_m;
        memory->direction = now->direction;
    }
    return pam_slip_follow(&memory->slip, PAM_PRESLIDING_HYSTERESIS_SLIP_DISTANCE_M, slide_m,
                           now->came != 0.0 ? now->direction : 0.0);
}
