/* Eq. 11 at a gauge pressure and a length, term by term, in N; all-zero slopes unless asked for. */
typedef struct {
    double gas_n;             /* gas on the braid */
    double bladder_n_per_pa;  /* bladder per pascal of C10 + C01; negative where rubber resists contraction */
    double normal_n;          /* p pi D L: what presses bladder and strands together */
    double static_force_n;    /* without friction */
    double friction_n;        /* friction of eq. 11 while contracting; a loss */
    double slope_n_per_pa;    /* of the force without friction */
    double slope_n_per_m;     /* the same, over the length */
} pam_base;

static inline double pam_diameter_m(double length_m)
{
    return sqrt(PAM_STRAND_LENGTH_SQUARE_M2 - length_m * length_m) * PAM_PER_PI_TURNS;
}

static inline double pam_diameter_slope(double length_m, double diameter_m)
{
    return -length_m * PAM_PER_PI_TURNS_SQUARE / diameter_m;
}

/* Loss by the stretch of the strands, in N; not a number where the strain reaches 1. */
static inline double pam_braid_n(double pressure_pa, double length_m)
{
    const double strain = PAM_STRAIN_PER_M * pressure_pa * length_m * PAM_STRAND_COMPLIANCE_PER_PA;
    const double rest = 1.0 - strain;
    if (strain >= 1.0) {
        return NAN;
    }
    return PAM_BRAID_AREA_M2 * pressure_pa
           * (PAM_AS_PRINTED ? strain / (rest * rest * rest) : strain * (2.0 - strain) / (rest * rest));
}

/* Forces of the bladder per unit of C10 and of C01, in N/Pa: V_r dI1/dL and V_r dI2/dL. */
static inline void pam_bladder_n_per_pa(double length_m, double diameter_m, double *by_c10, double *by_c01)
{
    const double inner_m = sqrt(diameter_m * diameter_m - PAM_WALL_TERM_M3 / length_m);
    const double wall_m = 0.5 * (diameter_m - inner_m);
    const double diameter_slope = pam_diameter_slope(length_m, diameter_m);
    const double wall_slope = -wall_m * ((diameter_m - wall_m) + length_m * diameter_slope) / (length_m * inner_m);
    const double d1 = PAM_PER_REST_LENGTH;
    const double l1 = length_m * d1;
    const double l2 = (diameter_m - wall_m) * PAM_PER_REST_MID_WALL;
    const double l3 = wall_m * PAM_PER_REST_WALL;
    const double d2 = (diameter_slope - wall_slope) * PAM_PER_REST_MID_WALL;
    const double d3 = wall_slope * PAM_PER_REST_WALL;
    const double q1 = l1 * l1, q2 = l2 * l2, q3 = l3 * l3;
    *by_c10 = 2.0 * PAM_RUBBER_VOLUME_M3 * (l1 * d1 + l2 * d2 + l3 * d3);
    *by_c01 = 2.0 * PAM_RUBBER_VOLUME_M3 * (l1 * (q2 + q3) * d1 + l2 * (q1 + q3) * d2 + l3 * (q1 + q2) * d3);
}

/* Friction between crossing strands per unit of its coefficient, in N. */
static inline double pam_contact_n(double pressure_pa, double normal_n)
{
    const double radius_m = cbrt(PAM_HERTZ_M_PER_PA * (fmax(normal_n, 0.0) / PAM_CROSSINGS));
    return PAM_CROSSINGS * PAM_PI * radius_m * radius_m * pressure_pa;
}

static inline pam_base pam_base_at(double pressure_pa, double length_m)
{
    pam_base base = {0};
    double by_c10, by_c01;
    const double contraction_ratio = (PAM_REST_LENGTH_M - length_m) / PAM_REST_LENGTH_M;
    const double reach = 1.0 - PAM_K2 * contraction_ratio;
    const double diameter_m = pam_diameter_m(length_m);
    pam_bladder_n_per_pa(length_m, diameter_m, &by_c10, &by_c01);
    base.gas_n = PAM_K1 * PAM_AREA_M2 * pressure_pa * (PAM_GAS_A * reach * reach - PAM_GAS_B);
    base.bladder_n_per_pa = PAM_C10_SHARE * by_c10 + (1.0 - PAM_C10_SHARE) * by_c01;
    base.normal_n = pressure_pa * PAM_PI * diameter_m * length_m;
    base.static_force_n = base.gas_n + PAM_K3_N + PAM_BLADDER_SIGN * (PAM_C10_PA * by_c10 + PAM_C01_PA * by_c01)
                          - pam_braid_n(pressure_pa, length_m);
    base.friction_n = PAM_RUBBER_FRICTION * base.normal_n;
    if (PAM_STRAND_FRICTION != 0.0) {
        base.friction_n += PAM_STRAND_FRICTION * pam_contact_n(pressure_pa, base.normal_n);
    }
    return base;
}

/* Force of a bladder of latex, C10 + C01 = 0.22 MPa, in N: what effects of rubber are measured against. */
static inline double pam_latex_n(const pam_base *base)
{
    return base->bladder_n_per_pa * PAM_LATEX_PA;
}

/* Eq. 11 alone, in N; `direction` is +1 contracting, -1 extending. */
static inline double pam_eq11_n(double pressure_pa, double length_m, double direction)
{
    const pam_base base = pam_base_at(pressure_pa, length_m);
    return base.static_force_n - direction * base.friction_n;
}
