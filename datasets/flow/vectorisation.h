#pragma once

/// This stands before a function that is compiled for several sets of vector instructions, the widest of
/// which that the machine has is used. Results are the same, since no operations are fused. Sanitizers do
/// without, since they cannot follow the choice at the start of the program.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ADAMAS_VECTOR_CLONES [[gnu::flatten, gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define ADAMAS_VECTOR_CLONES
#endif

/// This stands before a loop over lanes whose turns are independent of each other, which the compiler does
/// not see.
#ifdef __clang__
#define ADAMAS_INDEPENDENT_LANES
#else
#define ADAMAS_INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif
