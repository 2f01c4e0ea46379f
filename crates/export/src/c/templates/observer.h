/* Kinematics from pressure and length as they are measured: no instant after the present one is used.

   pam-predict knows the whole recording: it centers its windows, dates a turn back to where the length turned, and looks
   ahead whether a length will stand still. Here rates lag by 2 PAM_RATE_TIME_S, a turn is noticed once the length has come
   back by PAM_TURN_THRESHOLD_M, and a standstill once it has lasted PAM_STANDSTILL_S. The check program prints by how much
   the forces differ along a recording. */
#ifndef PAM_RATE_TIME_S
#define PAM_RATE_TIME_S 0.01 /* of the two filters in a row that rates come from */
#endif
#ifndef PAM_STANDSTILL_S
#define PAM_STANDSTILL_S 1.0
#endif

/* Critically damped filter: value, rate and acceleration of a channel. */
typedef struct {
    double value, rate, acceleration;
} pam_filter;

/* Follows a channel but not its noise, without a lag while it goes on one way. */
typedef struct {
    double position, way;
} pam_backlash_filter;

/* All zeros before the first instant. */
typedef struct {
    int started, resting;
    double time_s;
    pam_filter pressure, length;
    pam_backlash_filter contraction, slide, rest_slide;
    double state, sign;                    /* of friction, and of the last motion; 0 before any */
    double farthest_m;                     /* contraction from which a turn is measured */
    double at_turn, travel_m;              /* state at the last turn, and travel since */
    double still_s, still_low_m, still_high_m; /* since when the contraction lies between the two */
    double still_from, still_state;        /* friction when that began, and now if it is a standstill */
    double still_low_pa, still_high_pa;
    double by_pressure_m;
} pam_observer;

static inline void pam_filter_follow(pam_filter *filter, double step_s, double input)
{
    const double rad_per_s = 1.0 / PAM_RATE_TIME_S;
    const double ahead = filter->value - input, decay = exp(-rad_per_s * step_s);
    const double drift = filter->rate + rad_per_s * ahead;
    filter->value = input + (ahead + drift * step_s) * decay;
    filter->rate = (filter->rate - drift * rad_per_s * step_s) * decay;
    filter->acceleration = rad_per_s * (rad_per_s * (input - filter->value) - 2.0 * filter->rate);
}

static inline double pam_backlash_follow(pam_backlash_filter *filter, double noise, double to, double rate)
{
    const double by = to - filter->position;
    if (fabs(by) > noise || (by * filter->way > 0.0 && rate * filter->way * PAM_RATE_WINDOW_S > noise)) {
        filter->position = to;
        filter->way = by < 0.0 ? -1.0 : 1.0;
    }
    return filter->position;
}

/* Friction while the length may stand still: at once with any pressure beyond noise, or sliding over PAM_STANDSTILL_OVER_PA,
   up to PAM_STANDSTILL_SHARE of it, or stuck at the force that it has, or relaxing to a share of what it was. */
static inline void pam_still_follow(pam_observer *o, double step_s, double pressure_step_pa)
{
    const double pressure_pa = o->pressure.value;
    if (!PAM_STANDSTILL_SLIDES && !PAM_STANDSTILL_STICKS && !PAM_STANDSTILL_RELAXES) {
        return;
    }
    if (PAM_STANDSTILL_RELAXES) {
        const double left = exp(-step_s / PAM_STANDSTILL_TIME_CONSTANT_S), to = PAM_STANDSTILL_RELAXES_TO * o->still_from;
        o->still_state = to + left * (o->still_state - to);
    } else if (PAM_STANDSTILL_STICKS) {
        const double from_pa = fmax(pressure_pa - pressure_step_pa, PAM_STICKS_FROM_PA);
        const double stuck = o->still_state * from_pa / fmax(pressure_pa, PAM_STICKS_FROM_PA);
        o->still_low_pa = fmin(o->still_low_pa, pressure_pa);
        o->still_high_pa = fmax(o->still_high_pa, pressure_pa);
        o->still_state = fmin(fmax(stuck, -PAM_STICKS_UP_TO), PAM_STICKS_UP_TO);
    } else if (PAM_STANDSTILL_OVER_PA > 2.0 * PAM_PRESSURE_THRESHOLD_PA || PAM_STANDSTILL_SHARE < 1.0) {
        const double slid = o->still_state + 2.0 * pressure_step_pa / PAM_STANDSTILL_OVER_PA;
        o->still_low_pa = fmin(o->still_low_pa, pressure_pa);
        o->still_high_pa = fmax(o->still_high_pa, pressure_pa);
        o->still_state = pressure_step_pa > 0.0 ? fmax(o->still_state, fmin(slid, PAM_STANDSTILL_SHARE))
                                                : fmin(o->still_state, fmax(slid, -PAM_STANDSTILL_SHARE));
    } else if (o->still_state <= 0.0 && pressure_pa - o->still_low_pa > PAM_PRESSURE_THRESHOLD_PA) {
        o->still_state = 1.0;
        o->still_high_pa = pressure_pa;
    } else if (o->still_state >= 0.0 && o->still_high_pa - pressure_pa > PAM_PRESSURE_THRESHOLD_PA) {
        o->still_state = -1.0;
        o->still_low_pa = pressure_pa;
    } else {
        o->still_low_pa = fmin(o->still_low_pa, pressure_pa);
        o->still_high_pa = fmax(o->still_high_pa, pressure_pa);
    }
}

static inline void pam_restart_still(pam_observer *o, double contraction_m)
{
    o->still_s = o->time_s;
    o->still_low_m = o->still_high_m = contraction_m;
    o->still_low_pa = o->still_high_pa = o->pressure.value;
    o->still_from = o->still_state = o->state;
    o->resting = 0;
}

/* State of friction by the travel since the last turn: it keeps its sign over PAM_HELD_M, then turns over within PAM_TURN_M. */
static inline void pam_turn_over(pam_observer *o)
{
    const double turned_m = o->travel_m - PAM_HELD_M;
    if (turned_m <= 0.0) {
        o->state = o->at_turn;
    } else {
        o->state = PAM_TURN_M > 0.0 ? fmin(fmax(o->at_turn + 2.0 * o->sign * turned_m / PAM_TURN_M, -1.0), 1.0) : o->sign;
    }
}

/* A motion the other way, or after a rest, which has gone on for `travel_m` when it is noticed. */
static inline void pam_turned(pam_observer *o, double sign, double contraction_m, double travel_m)
{
    o->at_turn = o->sign == 0.0 && o->state == 0.0 ? sign : o->state;
    o->sign = sign;
    o->travel_m = travel_m;
    o->farthest_m = contraction_m;
    pam_turn_over(o);
}

static inline void pam_direction_follow(pam_observer *o, double contraction_m)
{
    const double moved_m = contraction_m - o->farthest_m;
    if (o->sign * moved_m > 0.0) {
        o->travel_m += fabs(moved_m);
        o->farthest_m = contraction_m;
        pam_turn_over(o);
    } else if (fabs(moved_m) > PAM_TURN_THRESHOLD_M) {
        pam_turned(o, moved_m < 0.0 ? -1.0 : 1.0, contraction_m, fabs(moved_m));
    }
}

/* The instant `step_s` after the one before at a gauge pressure and a length. A `step_s` of 0 begins anew, as after a gap:
   friction is unknown then, until the first motion. Add the length of the gap to the observer's time_s before. */
static inline pam_moment pam_observe(pam_observer *o, double step_s, double pressure_pa, double length_m)
{
    pam_moment now = {0};
    const double before_pa = o->pressure.value;
    const double noise = PAM_NOISE_PER_THRESHOLD * sqrt(fmin(0.25 * step_s / PAM_RATE_TIME_S, 1.0));
    double contraction_m, slide_m_per_pa, pressure_step_pa;
    int at_rest;
    if (!o->started || step_s <= 0.0) {
        pam_observer fresh = {0};
        fresh.time_s = o->time_s;
        fresh.started = 1;
        fresh.pressure.value = pressure_pa;
        fresh.length.value = length_m;
        contraction_m = PAM_REST_LENGTH_M - length_m;
        fresh.farthest_m = fresh.contraction.position = fresh.slide.position = contraction_m;
        *o = fresh;
        pam_restart_still(o, contraction_m);
        step_s = 0.0;
    } else {
        o->time_s += step_s;
        pam_filter_follow(&o->pressure, step_s, pressure_pa);
        pam_filter_follow(&o->length, step_s, length_m);
        contraction_m = PAM_REST_LENGTH_M - o->length.value;
    }
    pressure_step_pa = step_s > 0.0 ? o->pressure.value - before_pa : 0.0;
    o->still_low_m = fmin(o->still_low_m, contraction_m);
    o->still_high_m = fmax(o->still_high_m, contraction_m);
    if (o->still_high_m - o->still_low_m > PAM_TURN_THRESHOLD_M) {
        if (o->resting) {
            pam_turned(o, contraction_m < o->still_high_m ? -1.0 : 1.0, contraction_m, PAM_TURN_THRESHOLD_M);
        }
        pam_restart_still(o, contraction_m);
    } else {
        pam_still_follow(o, step_s, pressure_step_pa);
    }
    if ((PAM_STANDSTILL_SLIDES || PAM_STANDSTILL_STICKS || PAM_STANDSTILL_RELAXES) && o->time_s - o->still_s >= PAM_STANDSTILL_S
        && (o->resting || PAM_STANDSTILL_RELAXES || o->still_high_pa - o->still_low_pa > PAM_PRESSURE_THRESHOLD_PA)) {
        o->resting = 1;
        o->state = o->still_state;
    } else {
        pam_direction_follow(o, contraction_m);
    }
    at_rest = o->time_s - o->still_s >= 0.1 && fabs(o->length.rate) * PAM_RATE_WINDOW_S < PAM_TURN_THRESHOLD_M;
    slide_m_per_pa = PAM_STRETCH_PER_PA_M * o->length.value * o->length.value;
    o->by_pressure_m += at_rest ? slide_m_per_pa * pressure_step_pa : 0.0;
    now.time_s = o->time_s;
    now.step_s = step_s;
    now.pressure_pa = pressure_pa;
    now.pressure_rate_pa_per_s = o->pressure.rate;
    now.length_m = length_m;
    now.contraction_ratio = pam_backlash_follow(&o->contraction, noise * PAM_TURN_THRESHOLD_M, contraction_m,
                                                -o->length.rate) / PAM_REST_LENGTH_M;
    now.speed_m_per_s = -o->length.rate;
    now.slide_speed_m_per_s = at_rest ? slide_m_per_pa * o->pressure.rate : -o->length.rate;
    now.acceleration_m_per_s2 = -o->length.acceleration;
    now.direction = o->state;
    now.slide_m = pam_backlash_follow(&o->slide, noise * (PAM_TURN_THRESHOLD_M + PAM_REST_SLIDE_THRESHOLD_M),
                                      contraction_m + o->by_pressure_m, now.slide_speed_m_per_s);
    now.rest_slide_m = pam_backlash_follow(&o->rest_slide, noise * PAM_REST_SLIDE_THRESHOLD_M, o->by_pressure_m,
                                           at_rest ? now.slide_speed_m_per_s : 0.0);
    return now;
}
