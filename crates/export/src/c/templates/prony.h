/* Overstress of a generalized Maxwell body with three time constants, each ten times the one before; exact for a driver that
   moves evenly between the instants. */
typedef struct {
    int started;
    double time_s, driver_n, step_s;
    double overstress_n[3], decay[3], gain[3];
} pam_overstress;

static inline void pam_overstress_follow(pam_overstress *memory, const pam_moment *now, double time_constant_s,
                                         double driver_n)
{
    int i;
    if (memory->started && now->time_s >= memory->time_s) {
        const double step_s = now->step_s > 0.0 ? now->step_s : now->time_s - memory->time_s;
        const double change_n = driver_n - memory->driver_n;
        for (i = 0; i < 3 && step_s > 0.0 && step_s != memory->step_s; i++, time_constant_s *= 10.0) {
            const double ratio = step_s / time_constant_s;
            memory->decay[i] = exp(-ratio);
            memory->gain[i] = -expm1(-ratio) / ratio;
        }
        if (step_s > 0.0) {
            memory->step_s = step_s;
        }
        for (i = 0; i < 3; i++) {
            memory->overstress_n[i] = step_s > 0.0
                                          ? memory->overstress_n[i] * memory->decay[i] + change_n * memory->gain[i]
                                          : memory->overstress_n[i] + change_n;
        }
    } else {
        for (i = 0; i < 3; i++) {
            memory->overstress_n[i] = 0.0;
        }
    }
    memory->started = 1;
    memory->time_s = now->time_s;
    memory->driver_n = driver_n;
}
