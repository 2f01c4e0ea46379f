/* Slope of eq. 11 without friction over the pressure, in N/Pa, by a central difference of 100 Pa. */
static inline double pam_slope_n_per_pa(double pressure_pa, double length_m)
{
    return (pam_base_at(pressure_pa + 100.0, length_m).static_force_n
            - pam_base_at(pressure_pa - 100.0, length_m).static_force_n)
           / 200.0;
}
