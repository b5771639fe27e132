#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace adamas::bench {

/// Seconds of this thread, which other programs do not count in.
double thread_seconds();

/// What a piece of work has made.
struct Outcome {
  std::uint64_t triangles = 0;
  double error = 0;  ///< what the maker says of it
};

/// What a piece of work has taken.
struct Cost {
  double seconds = 0;
  double processor_seconds = 0;
  std::uint64_t peak_bytes = 0;  ///< resident memory above that before the work
  Outcome outcome;
};

/// Does the work in a process of its own, so that nothing is left over from the work before. Throws
/// std::runtime_error where it fails.
Cost measure_in_child(const std::function<Outcome()>& work);

/// By seconds.
Cost median(std::vector<Cost> costs);
/// The value that this part of the values does not exceed; 0 of none.
double quantile(std::vector<double> values, double part);

/// Has the system forget what it holds of a file in memory.
void forget_pages(const std::filesystem::path& path);

}  // namespace adamas::bench
