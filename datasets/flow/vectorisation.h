#pragma once

/// Put before a function, this compiles it for several sets of vector instructions, of which the machine's
/// widest one is used. Results are the same, since no operations are fused. It is empty with sanitizers,
/// which cannot follow the choice at the start of the program.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ADAMAS_VECTOR_CLONES [[gnu::flatten, gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define ADAMAS_VECTOR_CLONES
#endif

/// Put before a loop over lanes, this tells the compiler that its iterations are independent of each other,
/// which it cannot see.
#ifdef __clang__
#define ADAMAS_INDEPENDENT_LANES
#else
#define ADAMAS_INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif
