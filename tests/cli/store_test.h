#pragma once

#include <algorithm>
#include <cmath>

#include "program.h"

namespace adamas::test {

/// Volumes and stores of them.
class StoreTest : public ProgramTest {
 protected:
  /// A synthetic volume as ball.nhdr and ball.raw.
  void make_ball(const std::string& dimensions = "40", const std::string& type = "uint8") const {
    run_well({"generate", "buckyball", "--dimensions", dimensions, "--type", type, "-o", "ball.nhdr"});
  }
  /// The store of it.
  void make_store(const std::vector<std::string>& more = {}, const std::string& name = "b.adm") const {
    std::vector<std::string> all{"store", "ball.nhdr", "-o", name};
    all.insert(all.end(), more.begin(), more.end());
    run_well(all);
  }
  /// The store b.adm of a series of the ball of 40^3 samples of a byte: from step to step it is cut off
  /// `cut` samples farther in.
  void make_series(int steps, int cut) const {
    std::string samples = read("ball.raw");
    std::vector<std::string> all{"store"};
    for (int step = 0; step < steps; ++step) {
      for (std::size_t n = 0; n < samples.size(); ++n)
        samples[n] = n % 40 < static_cast<std::size_t>(40 - cut * step) ? samples[n] : '\0';
      const std::string name = "s" + std::to_string(step) + ".raw";
      write(name, samples);
      all.push_back(name);
    }
    all.insert(all.end(), {"--dimensions", "40", "--type", "uint8", "-o", "b.adm"});
    run_well(all);
  }
};

}  // namespace adamas::test
