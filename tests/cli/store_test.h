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
};

}  // namespace adamas::test
