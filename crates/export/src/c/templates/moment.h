/* One instant, in SI. Pressure and length are as measured; rates, contraction and slide are smooth. pam_observe computes an
   instant from a pressure and a length as they are measured; pam-export --vectors writes those that pam-predict uses. */
typedef struct {
    double time_s;                 /* since the start; seconds to weeks, never back */
    double step_s;                 /* since the instant before; 0 at the first and after a gap */
    double pressure_pa;            /* gauge */
    double pressure_rate_pa_per_s; /* smooth */
    double length_m;               /* clamp to clamp */
    double contraction_ratio;      /* (L0 - L) / L0 of a smooth length */
    double speed_m_per_s;          /* of contraction, -dL/dt, smooth */
    double slide_speed_m_per_s;    /* of the braid: the same, and at rest that by pressure */
    double acceleration_m_per_s2;  /* of contraction, smooth */
    double direction;              /* of friction: +1 contracting, -1 extending, in between while it turns over, 0 unknown */
    double came;                   /* 1 where the muscle is known to have come in that direction, else 0 */
    double slide_m;                /* travel of the braid, rising while it contracts */
    double rest_slide_m;           /* the part of it that pressure has made at rest */
    double force_n;                /* measured, smooth; pam_own_force_n where it is not measured */
    double warmth_k;               /* logged temperature above 20 C; 0 where none is logged */
} pam_moment;
