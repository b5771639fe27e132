#pragma once

#include <cstdio>
#include <cstdlib>

/// Ends the program where an invariant of its own is broken; checked in debug and test builds only.
#ifdef NDEBUG
#define ADAMAS_ASSERT(condition) static_cast<void>(sizeof(!(condition)))
#else
#define ADAMAS_ASSERT(condition)                                                             \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::fprintf(stderr, "%s:%d: broken invariant: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                          \
    }                                                                                        \
  } while (false)
#endif
