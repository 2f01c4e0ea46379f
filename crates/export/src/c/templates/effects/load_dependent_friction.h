static inline double pam_load_dependent_friction_pulls(const pam_moment *now, const pam_base *base)
{
    return -now->direction * fmax(base->static_force_n, 0.0) * PAM_LOAD_DEPENDENT_FRICTION_FRICTION_PER_LOAD;
}
