#pragma once

#include <optional>
#include <string>
#include <vector>

namespace adamas::cli {

/// Estimates how long a stage still takes, from the parts of its work that were done at several times.
class TimeLeft {
 public:
  /// Starts with another stage. Times are in seconds, from any time on.
  void start(double now);
  /// Takes a part that is done, in [0, 1].
  void add(double now, double part);
  /// Returns the seconds that are left; none where too little is known yet: in the first seconds, before a
  /// twentieth is done, and where the part has not changed for longer than before.
  [[nodiscard]] std::optional<double> left(double now) const;

 private:
  struct Known {
    double time = 0, part = 0;
  };
  double start_ = 0;
  std::vector<Known> known_;  ///< the times at which the part changed
};

/// Returns a duration with at most two digits: "about 45 s", "about 3 min", "about 2.5 h".
std::string duration_text(double seconds);

}  // namespace adamas::cli
