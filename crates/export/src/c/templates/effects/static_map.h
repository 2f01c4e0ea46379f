/* Legendre polynomials up to the fourth degree, of a value between two rims; beyond them the map keeps its value at the rim. */
static inline void pam_legendre(double value, double low, double high, double polynomials[5])
{
    const double x = high > low ? fmin(fmax(2.0 * (value - low) / (high - low) - 1.0, -1.0), 1.0) : 0.0;
    polynomials[0] = 1.0;
    polynomials[1] = x;
    polynomials[2] = 0.5 * (3.0 * x * x - 1.0);
    polynomials[3] = 0.5 * (5.0 * x * x - 3.0) * x;
    polynomials[4] = 0.125 * ((35.0 * x * x - 30.0) * x * x + 3.0);
}

/* Of what is recorded, whatever the muscle sees of it. */
static inline double pam_static_map_pulls(const pam_moment *moment)
{
    double p[5], e[5];
    pam_legendre(moment->pressure_pa, PAM_STATIC_MAP_LOWEST_PA, PAM_STATIC_MAP_HIGHEST_PA, p);
    pam_legendre(moment->contraction_ratio, PAM_STATIC_MAP_LOWEST_CONTRACTION_RATIO,
                 PAM_STATIC_MAP_HIGHEST_CONTRACTION_RATIO, e);
    return PAM_STATIC_MAP_EVEN_P0_E1_N * p[0] * e[1] + PAM_STATIC_MAP_EVEN_P1_E0_N * p[1] * e[0]
           + PAM_STATIC_MAP_EVEN_P0_E2_N * p[0] * e[2] + PAM_STATIC_MAP_EVEN_P1_E1_N * p[1] * e[1]
           + PAM_STATIC_MAP_EVEN_P2_E0_N * p[2] * e[0] + PAM_STATIC_MAP_EVEN_P0_E3_N * p[0] * e[3]
           + PAM_STATIC_MAP_EVEN_P1_E2_N * p[1] * e[2] + PAM_STATIC_MAP_EVEN_P2_E1_N * p[2] * e[1]
           + PAM_STATIC_MAP_EVEN_P3_E0_N * p[3] * e[0] + PAM_STATIC_MAP_EVEN_P0_E4_N * p[0] * e[4]
           + PAM_STATIC_MAP_EVEN_P1_E3_N * p[1] * e[3] + PAM_STATIC_MAP_EVEN_P2_E2_N * p[2] * e[2]
           + PAM_STATIC_MAP_EVEN_P3_E1_N * p[3] * e[1] + PAM_STATIC_MAP_EVEN_P4_E0_N * p[4] * e[0]
           + moment->direction
                 * (PAM_STATIC_MAP_ODD_P0_E0_N * p[0] * e[0] + PAM_STATIC_MAP_ODD_P0_E1_N * p[0] * e[1]
                    + PAM_STATIC_MAP_ODD_P1_E0_N * p[1] * e[0] + PAM_STATIC_MAP_ODD_P0_E2_N * p[0] * e[2]
                    + PAM_STATIC_MAP_ODD_P1_E1_N * p[1] * e[1] + PAM_STATIC_MAP_ODD_P2_E0_N * p[2] * e[0]);
}
