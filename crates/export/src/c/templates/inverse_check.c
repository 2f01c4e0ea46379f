/* Force in N, length in m, direction, pressure in Pa, outside. */
static const double inverse_vectors[][5] = {
@VECTORS@
};
static int check_inverse(void)
{
    const size_t n = sizeof inverse_vectors / sizeof inverse_vectors[0];
    double largest_pa = 0.0, highest_pa = 0.0, sum_pa = 0.0;
    size_t i, n_wrong = 0;
    int round, failed;
    clock_t begin;
    for (i = 0; i < n; i++) {
        const double *row = inverse_vectors[i];
        const pam_pressure found = pam_inverse(row[0], row[1], row[2]);
        largest_pa = fmax(largest_pa, fabs(found.pressure_pa - row[3]));
        highest_pa = fmax(highest_pa, fabs(row[3]));
        n_wrong += found.outside != (int)row[4];
    }
    failed = !(largest_pa <= 1e-9 * highest_pa) || n_wrong > 0;
    printf("inverse: %lu points, largest difference %.3g Pa, domain wrong at %lu: %s\n", (unsigned long)n, largest_pa,
           (unsigned long)n_wrong, failed ? "FAILED" : "ok");
    begin = clock();
    for (round = 0; round < 2000; round++) {
        for (i = 0; i < n; i++) {
            sum_pa += pam_inverse(inverse_vectors[i][0], inverse_vectors[i][1], inverse_vectors[i][2]).pressure_pa;
        }
    }
    printf("inverse: %.0f ns per evaluation (mean %.0f Pa)\n",
           1e9 * (double)(clock() - begin) / CLOCKS_PER_SEC / (2000.0 * (double)n), sum_pa / (2000.0 * (double)n));
    return failed;
}
