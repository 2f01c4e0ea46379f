typedef struct {
    int started;
    double travel_m, follower_m;
} pam_fatigue_wear;

static inline double pam_fatigue_wear_pulls(pam_fatigue_wear *memory, const pam_moment *now, const pam_base *base)
{
    const double reference_m = 100.0, half_play_m = 1.5e-4;
    if (!memory->started) {
        memory->travel_m = PAM_FATIGUE_WEAR_PAST_TRAVEL_M;
        memory->started = 1;
    }
    if (now->step_s == 0.0) {
        memory->follower_m = now->slide_m;
    } else {
        const double followed_m =
            fmin(fmax(memory->follower_m, now->slide_m - half_play_m), now->slide_m + half_play_m);
        memory->travel_m += fabs(followed_m - memory->follower_m);
        memory->follower_m = followed_m;
    }
    const double friction_n = now->direction * base->normal_n * PAM_FATIGUE_WEAR_FRICTION_LOSS_PER_REFERENCE_TRAVEL;
    return (friction_n - base->gas_n * PAM_FATIGUE_WEAR_LOSS_PER_REFERENCE_TRAVEL)
           * pow(memory->travel_m / reference_m, PAM_FATIGUE_WEAR_EXPONENT);
}
