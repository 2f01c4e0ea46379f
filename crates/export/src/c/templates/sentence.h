/* Empirical terms: a driver, what is remembered of it, a curve of that, a factor, and a fade beyond what was seen. */
typedef struct {
    int started;
    unsigned long flips;                     /* of the direction, which cycles are counted by */
    double direction, turn_m, moved_s;       /* at the last turn, and when something last moved */
    double last, last_s, last_m;             /* driver, time and length at the last instant */
    double change, elapsed_s, travelled_m;   /* since then */
    double first, second;                    /* what the memory holds */
} pam_sentence;

static inline void pam_sentence_turn(pam_sentence *memory, const pam_moment *now)
{
    if (!memory->started || now->direction != memory->direction) {
        memory->flips += memory->direction != 0.0;
        memory->direction = now->direction;
        memory->turn_m = now->slide_m;
    }
}

/* Time since something last moved, which it does now or does not. */
static inline double pam_sentence_since(pam_sentence *memory, const pam_moment *now, int moves)
{
    if (!memory->started || moves) {
        memory->moved_s = now->time_s;
    }
    return now->time_s - memory->moved_s;
}

/* The driver has come to `value`; at the first instant it has long been there. */
static inline void pam_sentence_follow(pam_sentence *memory, const pam_moment *now, double value)
{
    if (memory->started) {
        memory->change = value - memory->last;
        memory->elapsed_s = now->step_s > 0.0 ? now->step_s : fmax(now->time_s - memory->last_s, 0.0);
        memory->travelled_m = fabs(now->length_m - memory->last_m);
    } else {
        memory->change = memory->elapsed_s = memory->travelled_m = 0.0;
    }
    memory->last = value;
    memory->last_s = now->time_s;
    memory->last_m = now->length_m;
}

/* Direction in which the muscle is known to have come; 0 where it is not known. */
static inline double pam_sentence_came(const pam_moment *now)
{
    return now->came != 0.0 ? now->direction : 0.0;
}

/* What has not followed after `ratio` time constants in which the driver changed evenly by `change`. */
static inline void pam_sentence_fall(double *missing, double change, double ratio)
{
    const double gain = ratio > 1e-9 ? -expm1(-ratio) / ratio : 1.0;
    *missing = *missing * exp(-ratio) + change * gain;
}

static inline double pam_sentence_lag(pam_sentence *memory, double time_constant_s)
{
    pam_sentence_fall(&memory->first, memory->change, memory->elapsed_s / time_constant_s);
    return memory->first;
}

static inline double pam_sentence_two_lags(pam_sentence *memory, double first_s, double second_s)
{
    const double before = memory->last - memory->change - memory->first;
    pam_sentence_fall(&memory->first, memory->change, memory->elapsed_s / first_s);
    pam_sentence_fall(&memory->second, memory->last - memory->first - before, memory->elapsed_s / second_s);
    return memory->first + memory->second;
}

static inline double pam_sentence_play(pam_sentence *memory, const pam_moment *now, double half_width)
{
    if (!memory->started) {
        memory->first = memory->last - pam_sentence_came(now) * half_width;
    }
    memory->first = fmin(fmax(memory->first, memory->last - half_width), memory->last + half_width);
    return memory->last - memory->first;
}

static inline double pam_sentence_dahl(pam_sentence *memory, const pam_moment *now, double distance)
{
    if (!memory->started) {
        memory->first = pam_sentence_came(now);
    }
    if (memory->change != 0.0) {
        const double sign = memory->change < 0.0 ? -1.0 : 1.0;
        memory->first = sign + (memory->first - sign) * exp(-fabs(memory->change) / distance);
    }
    return memory->first;
}

static inline double pam_sentence_largest(pam_sentence *memory)
{
    memory->first = memory->started ? fmax(memory->first, memory->last) : memory->last;
    return memory->first - memory->last;
}

static inline double pam_sentence_travelled(pam_sentence *memory)
{
    memory->first += fabs(memory->change);
    return memory->first;
}

static inline double pam_sentence_work(pam_sentence *memory, const pam_base *base)
{
    memory->first += fabs(base->static_force_n) * memory->travelled_m;
    return memory->first;
}

/* 1 in the range that was seen, falling evenly to 0 over a tenth of it beyond. */
static inline double pam_sentence_weight(double x, double low, double high)
{
    const double beyond = fmax(fmax(low - x, x - high), 0.0);
    return fmax(1.0 - beyond / (0.1 * (high - low)), 0.0);
}

static inline double pam_sentence_saturation(double x, double from, double over)
{
    const double rise = -expm1(-fabs(x - from) / over);
    return x < from ? -rise : rise;
}

static inline double pam_sentence_bump(double x, double center, double width)
{
    const double away = (x - center) / width;
    return exp(-away * away);
}

/* Sum of rises, one between every two of `n` knots. */
static inline double pam_sentence_monotone(double x, const double *knots, const double *rises, int n)
{
    double sum = 0.0;
    int i;
    for (i = 0; i + 1 < n; i++) {
        sum += rises[i] * fmin(fmax((x - knots[i]) / (knots[i + 1] - knots[i]), 0.0), 1.0);
    }
    return sum;
}

/* Cubic Hermite through values at `n` knots, with the slope at each from the knot before to the knot after. */
static inline double pam_sentence_spline(double x, const double *knots, const double *values, int n)
{
    int right = 1, left, before, after;
    double width, t, t2, t3, left_slope, right_slope;
    while (right < n - 1 && knots[right] <= x) {
        right++;
    }
    left = right - 1;
    before = left > 0 ? left - 1 : 0;
    after = right < n - 1 ? right + 1 : n - 1;
    width = knots[right] - knots[left];
    left_slope = (values[right] - values[before]) / (knots[right] - knots[before]);
    right_slope = (values[after] - values[left]) / (knots[after] - knots[left]);
    t = fmin(fmax((x - knots[left]) / width, 0.0), 1.0);
    t2 = t * t;
    t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * values[left] + (3.0 * t2 - 2.0 * t3) * values[right]
           + width * ((t3 - 2.0 * t2 + t) * left_slope + (t3 - t2) * right_slope);
}
