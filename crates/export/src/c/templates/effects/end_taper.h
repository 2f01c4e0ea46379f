static inline double pam_end_taper_pulls(const pam_moment *now)
{
    const double fitting_m = PAM_REST_DIAMETER_M;
    const double diameter_m = pam_diameter_m(now->length_m);
    const double wider_m = fmax(diameter_m - fitting_m, 0.0);
    const double cone_n = now->pressure_pa * (0.5 * PAM_PI) * diameter_m * wider_m
                          * pam_diameter_slope(now->length_m, diameter_m);
    return cone_n * PAM_END_TAPER_COTANGENT_OF_TAPER + cone_n * wider_m / fitting_m * PAM_END_TAPER_BULGE_OF_TAPER;
}
