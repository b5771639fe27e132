#pragma once

/// Before a function: it is compiled for several sets of vector instructions, and the widest that the machine
/// has is taken. Results are the same, for no operations are fused. Not with sanitizers, which cannot follow
/// the choice at the start of the program.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ADAMAS_VECTOR_CLONES [[gnu::flatten, gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define ADAMAS_VECTOR_CLONES
#endif

/// Before a loop over lanes, for the compiler that needs to be told: no turn writes what another one reads.
#ifdef __clang__
#define ADAMAS_INDEPENDENT_LANES
#else
#define ADAMAS_INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif
