/* peers.h - what public renderers reached, for the comparison that bench prints
 *
 * Measured by running each project's own source: one thread of an AVX-512 Xeon virtual machine at
 * about 3.6 GHz, gcc 12 -O3 -march=native, 65,536 random directions, medians of 15 rounds, one run;
 * float32, ns per call and instructions per call. On that machine and in that run the hand-written
 * kernel took PEER_REFERENCE ns per element. Times do not carry over to another machine: compare
 * ratios to the hand-written kernel. */
#ifndef ASP_BENCH_PEERS_H
#define ASP_BENCH_PEERS_H

#define PEER_REFERENCE 3.7

/* The peer whose walks those are takes this for GGX's D. */
#define PEER_WALK_D 8.6

typedef struct peer_row {
    const char *model, *function;       /* our row: the model's name and the function's */
    int    batch;                       /* 1: vectorised over arrays */
    const char *peer;                   /* the fastest that was found */
    double ns, instructions;            /* instructions 0: not counted */
} peer_row;

static const peer_row peer_rows[] = {
    { "ggx", "D", 0, "Cycles", 2.0, 17 },
    { "ggx", "G1", 0, "Cycles", 2.1, 21 },
    { "ggx", "visible", 0, "Cycles", 25, 168 },
    { "ggx", "eval", 0, "Mitsuba 3 scalar", 23, 192 },
    { "ggx", "sample", 0, "Mitsuba 3 scalar", 83, 423 },
    { "beckmann", "visible", 0, "appleseed", 153, 737 },
    { "beckmann", "sample", 0, "Cycles", 274, 1086 },
    { "student_t", "D", 0, "appleseed", 18.5, 250 },
    { "student_t", "G1", 0, "appleseed", 82, 955 },
    { "student_t", "visible", 0, "facet-forge", 594, 4002 },
    { "student_t", "eval", 0, "appleseed", 183, 2192 },
    { "dielectric ggx", "eval", 0, "pbrt-v4", 38, 0 },
    { "dielectric ggx", "sample", 0, "pbrt-v4", 106, 0 },
    { "conductor ggx", "walk eval", 0, "facet-forge", 572, 0 },
    { "conductor ggx", "walk eval", 1, "facet-forge", 572, 0 },
    { "conductor ggx", "walk sample", 0, "facet-forge", 380, 0 },
    { "conductor ggx", "walk sample", 1, "facet-forge", 380, 0 },
    { "ggx", "D", 1, "Mitsuba 3 LLVM", 0.70, 0 },
    { "ggx", "G1", 1, "Mitsuba 3 LLVM", 0.76, 0 },
    { "ggx", "visible", 1, "Mitsuba 3 LLVM", 4.9, 0 },
    { "ggx", "eval", 1, "Mitsuba 3 LLVM", 5.3, 0 },
    { "ggx", "sample", 1, "Mitsuba 3 LLVM", 9.9, 0 },
};

#endif
