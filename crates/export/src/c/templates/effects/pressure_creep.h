typedef struct {
    double area_m2; /* force of the gas per pascal */
    pam_overstress by_pressure, by_force;
} pam_pressure_creep;

static inline double pam_pressure_creep_pulls(pam_pressure_creep *memory, const pam_moment *now, const pam_base *base)
{
    const double least_pa = 1e3, share_of_length = PAM_PRESSURE_CREEP_SHARE_OF_LENGTH;
    const double amplitudes[3] = {PAM_PRESSURE_CREEP_OVERSTRESS, PAM_PRESSURE_CREEP_SLOW_OVERSTRESS,
                                  PAM_PRESSURE_CREEP_SLOWEST_OVERSTRESS};
    double force_n = 0.0;
    int i;
    if (fabs(now->pressure_pa) > least_pa) {
        memory->area_m2 = base->gas_n / now->pressure_pa;
    }
    pam_overstress_follow(&memory->by_pressure, now, PAM_PRESSURE_CREEP_TIME_CONSTANT_S, now->pressure_pa);
    pam_overstress_follow(&memory->by_force, now, PAM_PRESSURE_CREEP_TIME_CONSTANT_S, base->gas_n);
    for (i = 0; i < 3; i++) {
        force_n += amplitudes[i] * ((1.0 - share_of_length) * memory->area_m2 * memory->by_pressure.overstress_n[i]
                                    + share_of_length * memory->by_force.overstress_n[i]);
    }
    return force_n;
}
