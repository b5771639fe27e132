#pragma once

/// Marks names that the shared library exports: those of its public headers.
#define ADAMAS_API __attribute__((visibility("default")))
