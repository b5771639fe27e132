#pragma once

#include <algorithm>
#include <cmath>

#include "program.h"

namespace adamas::test {

/// A test with volumes and stores of them.
class StoreTest : public ProgramTest {
 protected:
  /// Makes a synthetic volume as ball.nhdr and ball.raw.
  void make_ball(const std::string& dimensions = "40", const std::string& type = "uint8") const {
    run_well({"generate", "buckyball", "--dimensions", dimensions, "--type", type, "-o", "ball.nhdr"});
  }
  /// Makes the store of ball.nhdr.
  void make_store(const std::vector<std::string>& more = {}, const std::string& name = "b.adm") const {
    std::vector<std::string> all{"store", "ball.nhdr", "-o", name};
    all.insert(all.end(), more.begin(), more.end());
    run_well(all);
  }
  /// Makes the store b.adm of a series of 40^3 bytes: the ball, cut off `cut` samples farther in from step to
  /// step.
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
