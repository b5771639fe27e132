#pragma once

#include "tests/cli/program.h"

namespace adamas::test {

/// Stores of a few volumes of 9^3 bytes: s_0.raw, s_1.raw, ...
class SeriesStores : public ProgramTest {
 protected:
  SeriesStores() {
    for (int step = 0; step < 5; ++step) write(file(step), samples(step));
  }

  static std::string file(int step) { return "s_" + std::to_string(step) + ".raw"; }
  static std::string samples(int step) {
    std::string bytes;
    for (int n = 0; n < 729; ++n)
      bytes += static_cast<char>(n % 9 * (n / 9 % 9) + (n / 81) * 3 + step * (n & 7));
    return bytes;
  }
  /// Returns the arguments of `store` for some inputs.
  static std::vector<std::string> store(std::vector<std::string> inputs, const std::string& output,
                                        const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"store"};
    all.insert(all.end(), inputs.begin(), inputs.end());
    for (const char* option : {"--dimensions", "9,9,9", "--type", "uint8", "-o"}) all.emplace_back(option);
    all.push_back(output);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void expect_step(const std::string& store, int step) const {
    run_well({"restore", store, "--step", std::to_string(step), "-o", "out.raw", "-q"});
    EXPECT_EQ(read("out.raw"), samples(step)) << store << " step " << step;
  }
  [[nodiscard]] nlohmann::json info(const std::string& store) const {
    run_well({"info", store, "--json", "info.json", "-q"});
    return read_json("info.json");
  }
};

}  // namespace adamas::test
