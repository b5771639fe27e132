#pragma once

/// What the shared library shows of itself: the names of its public headers.
#define ADAMAS_API __attribute__((visibility("default")))
