static inline double pam_load_dependent_friction_pulls(const pam_moment *now, const pam_base *base)
{
    const double per_load = PAM_LOAD_DEPENDENT_FRICTION_FRICTION_PER_LOAD
                            + PAM_LOAD_DEPENDENT_FRICTION_FRICTION_PER_LOAD_AND_CONTRACTION * now->contraction_ratio;
    return -now->direction * fmax(base->static_force_n, 0.0) * per_load;
}
