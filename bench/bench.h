/* bench.h - the cases that bench measures, for those who print them */
#ifndef ASP_BENCH_H
#define ASP_BENCH_H

enum { COUNT = 65536, MAX_ROUNDS = 99 };

typedef void run_function(const void *context);

typedef struct bench_case {
    const char *model, *function;
    int    bits, batch, material;     /* material: not of a distribution alone */
    run_function *run;
    const void *context;
    double ns[MAX_ROUNDS];
    double median, instructions;      /* per element; instructions NaN where they can't be counted */
} bench_case;

extern bench_case bench_cases[];
extern int bench_case_count;

/* The columns of a distribution, and of a material; both end with NULL. */
extern const char *const bench_functions[], *const bench_scattering[];

const bench_case *bench_find(const char *model, const char *function, int bits, int batch);   /* NULL: no such case */
double bench_median(const char *model, const char *function, int bits, int batch);   /* NaN: no such case */

/* "n/a" for a NaN; returns buffer. */
const char *bench_number(double x, char *buffer, size_t size);

/* print.c: all tables and goals, then the file; reference: ns of the kernel written by hand. */
void bench_print(double reference);
int bench_write(const char *path, int rounds, double reference);

#endif
