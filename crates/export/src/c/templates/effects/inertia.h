typedef struct {
    int started;
    double value, rate;
} pam_inertia;

static inline double pam_inertia_pulls(pam_inertia *memory, const pam_moment *now)
{
    const double rad_per_s = 2.0 * PAM_PI * PAM_INERTIA_MOUNT_HZ;
    const double driven = now->acceleration_m_per_s2, step_s = now->step_s;
    if (memory->started && step_s > 0.0) {
        const double ahead = memory->value - driven, decay = exp(-rad_per_s * step_s);
        const double slide = memory->rate + rad_per_s * ahead;
        memory->value = driven + (ahead + slide * step_s) * decay;
        memory->rate = (memory->rate - slide * rad_per_s * step_s) * decay;
    } else {
        memory->value = driven;
        memory->rate = 0.0;
    }
    memory->started = 1;
    return -memory->value * PAM_INERTIA_MASS_KG;
}
