/* Slope of eq. 11 without friction over the length, in N/m, by a central difference. */
static inline double pam_slope_n_per_m(double pressure_pa, double length_m)
{
    return (pam_base_at(pressure_pa, length_m + 1e-5).static_force_n
            - pam_base_at(pressure_pa, length_m - 1e-5).static_force_n)
           / 2e-5;
}
