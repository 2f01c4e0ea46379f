typedef struct {
    pam_overstress overstress;
} pam_viscoelastic_relaxation;

static inline double pam_viscoelastic_relaxation_pulls(pam_viscoelastic_relaxation *memory, const pam_moment *now,
                                                       const pam_base *base)
{
    const double *overstress_n = memory->overstress.overstress_n;
    pam_overstress_follow(&memory->overstress, now, PAM_VISCOELASTIC_RELAXATION_TIME_CONSTANT_S, pam_latex_n(base));
    return PAM_VISCOELASTIC_RELAXATION_OVERSTRESS * overstress_n[0]
           + PAM_VISCOELASTIC_RELAXATION_SLOW_OVERSTRESS * overstress_n[1]
           + PAM_VISCOELASTIC_RELAXATION_SLOWEST_OVERSTRESS * overstress_n[2];
}
