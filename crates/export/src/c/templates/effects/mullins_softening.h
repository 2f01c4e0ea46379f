typedef struct {
    int started;
    double largest; /* contraction ratio */
} pam_mullins_softening;

static inline double pam_mullins_softening_pulls(pam_mullins_softening *memory, const pam_moment *now,
                                                 const pam_base *base)
{
    if (!memory->started || now->contraction_ratio > memory->largest) {
        memory->largest = now->contraction_ratio;
    }
    memory->started = 1;
    return pam_latex_n(base)
           * expm1(-(memory->largest - now->contraction_ratio) / PAM_MULLINS_SOFTENING_SOFTENING_CONTRACTION)
           * PAM_MULLINS_SOFTENING_SOFTENING;
}
