typedef struct {
    int started;
    double largest, longest; /* contraction and extension ratio */
    double follower, travelled;
} pam_mullins_softening;

static inline double pam_mullins_softening_pulls(pam_mullins_softening *memory, const pam_moment *now,
                                                 const pam_base *base)
{
    const double half_play = 5e-4;
    const double here = now->contraction_ratio;
    /* 6 (C10 + C01) of latex on the section of the bladder. */
    const double latex_stiffness_n = 6.0 * PAM_LATEX_PA * PAM_RUBBER_VOLUME_M3 * PAM_PER_REST_LENGTH;
    if (!memory->started) {
        memory->largest = PAM_MULLINS_SOFTENING_PAST_CONTRACTION;
        memory->travelled = PAM_MULLINS_SOFTENING_PAST_TRAVEL;
        memory->longest = PAM_MULLINS_SOFTENING_PAST_EXTENSION;
        memory->started = 1;
    }
    memory->largest = fmax(memory->largest, here);
    memory->longest = fmax(memory->longest, -here);
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
                  + expm1(-memory->travelled / PAM_MULLINS_SOFTENING_SETTLING_TRAVEL) * PAM_MULLINS_SOFTENING_SETTLING)
           + latex_stiffness_n * fmax(PAM_MAX_CONTRACTION_RATIO - here, 0.0)
                 * expm1(-(memory->longest + here) / PAM_MULLINS_SOFTENING_SOFTENING_CONTRACTION)
                 * PAM_MULLINS_SOFTENING_AXIAL_SOFTENING;
}
