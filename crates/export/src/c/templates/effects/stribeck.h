typedef struct {
    int started;
    double slide_m, speed_m_per_s, level;
} pam_stribeck;

static inline double pam_stribeck_crawl(double speed_m_per_s)
{
    return exp(-pow(speed_m_per_s / PAM_STRIBECK_STRIBECK_SPEED_M_PER_S, PAM_STRIBECK_EXPONENT));
}

static inline double pam_stribeck_pulls(pam_stribeck *memory, const pam_moment *now, const pam_base *base)
{
    const double renewal_m = 1e-4;
    const double speed_m_per_s = fabs(now->slide_speed_m_per_s);
    double level = pam_stribeck_crawl(memory->started ? fmax(speed_m_per_s, memory->speed_m_per_s) : speed_m_per_s);
    if (memory->started) {
        const double renewed = fabs(now->slide_m - memory->slide_m) / renewal_m + PAM_STRIBECK_AGING_PER_S * now->step_s;
        level += (memory->level - level) * exp(-renewed);
    }
    memory->started = 1;
    memory->slide_m = now->slide_m;
    memory->speed_m_per_s = speed_m_per_s;
    memory->level = level;
    return -now->direction * base->normal_n * level * PAM_STRIBECK_STATIC_FRICTION;
}
