/* Checks @HEADER@ against test vectors of pam-export.

       cc -std=c99 -O2 -Wall -Wextra -Werror -o check @PROGRAM@ -lm && ./check
       ./check vectors.csv     every instant of a recording, from pam-export run.csv --model MODEL.json --vectors vectors.csv

   Exit code 0 where all agree to 1e-9 N and 1e-9 of the largest pressure, 1 where they do not, 2 where a file cannot be read. */
#include "@HEADER@"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define COLUMNS 16
#define LINE 1024

/* The fields of pam_moment in their order, then the force, in N. */
static const double vectors[][COLUMNS] = {
@VECTORS@
};

typedef struct {
    pam_state state;
    pam_state causal_state;
    pam_observer observer;
    long n, n_turned;
    double largest_n, causal_square_sum;
} checked;

static void check(checked *c, const double *row)
{
    pam_moment now;
    double difference_n;
    now.time_s = row[0];
    now.step_s = row[1];
    now.pressure_pa = row[2];
    now.pressure_rate_pa_per_s = row[3];
    now.length_m = row[4];
    now.contraction_ratio = row[5];
    now.speed_m_per_s = row[6];
    now.slide_speed_m_per_s = row[7];
    now.acceleration_m_per_s2 = row[8];
    now.direction = row[9];
    now.came = row[10];
    now.slide_m = row[11];
    now.rest_slide_m = row[12];
    now.force_n = row[13];
    now.warmth_k = row[14];
    difference_n = fabs(pam_step(&c->state, &now) - row[15]);
    if (!(difference_n <= c->largest_n)) {
        c->largest_n = difference_n;
    }
    now = pam_observe(&c->observer, row[1], row[2], row[4]);
    c->n_turned += fabs(now.direction - row[9]) > 0.5;
    now.force_n = pam_own_force_n(&c->causal_state, &now);
    difference_n = pam_step(&c->causal_state, &now) - row[15];
    c->causal_square_sum += difference_n * difference_n;
    c->n++;
}

static int read_file(checked *c, const char *path)
{
    char line[LINE];
    FILE *file = fopen(path, "r");
    if (!file || !fgets(line, LINE, file)) {
        fprintf(stderr, "error: cannot read %s\n", path);
        return 0;
    }
    while (fgets(line, LINE, file)) {
        double row[COLUMNS];
        char *at = line;
        int i;
        for (i = 0; i < COLUMNS; i++) {
            char *end;
            row[i] = strtod(at, &end);
            if (end == at) {
                fprintf(stderr, "error: %s: line %ld has no %d columns\n", path, c->n + 2, COLUMNS);
                fclose(file);
                return 0;
            }
            at = *end == ',' ? end + 1 : end;
        }
        check(c, row);
    }
    fclose(file);
    return 1;
}

@INVERSE_CHECK@

int main(int argc, char **argv)
{
    static checked c;
    size_t i;
    int failed;
    pam_start(&c.state);
    pam_start(&c.causal_state);
    if (argc > 1) {
        if (!read_file(&c, argv[1])) {
            return 2;
        }
    } else {
        for (i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
            check(&c, vectors[i]);
        }
    }
    failed = !(c.largest_n <= 1e-9);
    printf("force: %ld instants, largest difference %.3g N: %s\n", c.n, c.largest_n, failed ? "FAILED" : "ok");
    if (argc > 1) {
        const double n = (double)(c.n ? c.n : 1);
        printf("kinematics by pam_observe, without the future: RMS difference %.3f N, direction differs at %.1f %%\n",
               sqrt(c.causal_square_sum / n), 100.0 * (double)c.n_turned / n);
    }
@INVERSE_MAIN@
    return failed;
}
