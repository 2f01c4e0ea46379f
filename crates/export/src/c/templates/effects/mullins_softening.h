typedef struct {
    int started;
    double largest; /* contraction ratio */
    double follower, travelled;
} pam_mullins_softening;

static inline double pam_mullins_softening_pulls(pam_mullins_softening *memory, const pam_moment *now,
                                                 const pam_base *base)
{
    const double half_play = 5e-4;
    const double here = now->contraction_ratio;
    if (!memory->started) {
        memory->largest = PAM_MULLINS_SOFTENING_PAST_CONTRACTION;
        memory->travelled = PAM_MULLINS_SOFTENING_PAST_TRAVEL;
        memory->started = 1;
    }
    memory->largest = fmax(memory->largest, here);
    if (now->step_s == 0.0) {
        memory->follower = here;
    } else {
        const double followed = fmin(fmax(memory->follower, here - half_play), here + half_play);
        memory->travelled += fabs(followed - memory->follower);
        memory->follower = followed;
    }
    return pam_latex_n(base)
           * (expm1(-(memory->largest - here) / PAM_MULLINS_SOFTENING_SOFTENING_CONTRACTION)
                  * PAM_MULLINS_SOFTENING_SOFTENING
              + expm1(-memory->travelled / PAM_MULLINS_SOFTENING_SETTLING_TRAVEL) * PAM_MULLINS_SOFTENING_SETTLING);
}
