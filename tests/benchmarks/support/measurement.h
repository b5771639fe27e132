#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace adamas::bench {

/// Returns the processor seconds of this thread, which other programs do not affect.
double thread_seconds();

/// The result of a piece of work.
struct Outcome {
  std::uint64_t triangles = 0;
  double error = 0;  ///< error that the maker states
};

/// The cost of a piece of work.
struct Cost {
  double seconds = 0;
  double processor_seconds = 0;
  std::uint64_t peak_bytes = 0;  ///< resident memory beyond that before the work
  Outcome outcome;
};

/// Does the work in a process of its own, so that nothing is left over from the work before. Throws
/// std::runtime_error where it fails.
Cost measure_in_child(const std::function<Outcome()>& work);

/// Returns the cost with the median of seconds.
Cost median(std::vector<Cost> costs);
/// Returns the value that this part of the values does not exceed; 0 where there are none.
double quantile(std::vector<double> values, double part);

/// Makes the system drop a file's pages from memory.
void forget_pages(const std::filesystem::path& path);

}  // namespace adamas::bench
