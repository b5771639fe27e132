#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::test {

/// A block of cells in a dump of CTH, without the layer round it, which the writer adds.
struct SpyTestBlock {
  int level = 0;
  std::array<std::vector<float>, 3> nodes;  ///< evenly spaced or not; one node along z in two dimensions
};

/// A time of a dump.
struct SpyTestTime {
  double time = 0;
  std::vector<SpyTestBlock> blocks;
};

/// Writes the file of one processor of a dump of CTH: one variable of cells, "Pressure (Pa)", and of each of
/// `materials` fractions and "Mass (g)". `value(variable, p)`: 0 for pressure, 100 + m for fractions and
/// 200 + m for masses of the material m from 1 on, in a cell with the middle p; copies in the layer round a
/// block are given the value -7, which no cell has.
class SpyFileWriter {
 public:
  int version = 103, processor = 0, processors = 1, geometry = 30, materials = 2;
  std::function<float(int variable, const Vec3& p)> value;

  [[nodiscard]] std::string run(const std::vector<SpyTestTime>& times) {
    const bool flat =
        !times.empty() && !times.front().blocks.empty() && times.front().blocks.front().nodes[2].size() == 1;
    bytes_ = std::string("spydata\0", 8);
    text("a dump of a test", 128);
    whole(version);
    whole(64);
    for (const int n : {0, processor, processors, geometry, flat ? 2 : 3, materials, 20}) whole(n);
    for (const double at : {0.0, 0.0, 0.0, 1.0, 1.0, 1.0}) real(at);
    whole(1);
    if (version >= 105) whole(0);
    whole(2);
    if (version >= 105) {
      for (int i = 0; i < 5; ++i) whole(0);
    }
    fields({{"P", "Pressure (Pa)", 1}});
    fields({{"VOLM", "Material volume fraction", 100}, {"M", "Mass (g)", 200}});
    real(static_cast<double>(bytes_.size() + 8));
    constexpr std::size_t kInList = 100;
    whole(static_cast<int>(times.size()));
    for (std::size_t t = 0; t < kInList; ++t) whole(t < times.size() ? static_cast<int>(10 * t) : 0);
    for (std::size_t t = 0; t < kInList; ++t) real(t < times.size() ? times[t].time : 0);
    for (std::size_t t = 0; t < kInList; ++t) real(0.125);
    const std::size_t places = bytes_.size();
    for (std::size_t t = 0; t < kInList; ++t) real(0);
    for (std::size_t t = 0; t < times.size(); ++t) {
      put(places + 8 * t, real_bytes(static_cast<double>(bytes_.size())));
      add_time(times[t]);
    }
    return bytes_;
  }

 private:
  struct Name {
    std::string id, comment;
    int number;
  };

  template <class T>
  static std::string big_endian(T bits) {
    std::string result;
    for (int shift = 8 * static_cast<int>(sizeof(T)) - 8; shift >= 0; shift -= 8)
      result += static_cast<char>((bits >> shift) & 0xff);
    return result;
  }
  static std::string real_bytes(double number) { return big_endian(std::bit_cast<std::uint64_t>(number)); }
  static std::string float_bytes(float number) { return big_endian(std::bit_cast<std::uint32_t>(number)); }
  void whole(int number) { bytes_ += big_endian(static_cast<std::uint32_t>(number)); }
  void real(double number) { bytes_ += real_bytes(number); }
  void put(std::size_t at, const std::string& bytes) { bytes_.replace(at, bytes.size(), bytes); }
  void text(std::string text, std::size_t length) {
    text.resize(length, '\0');
    bytes_ += text;
  }
  void fields(const std::vector<Name>& names) {
    whole(static_cast<int>(names.size()));
    for (const Name& name : names) {
      text(name.id, 30);
      text(name.comment, 80);
      whole(name.number);
    }
  }

  /// Packs equal numbers behind each other as one, at most 127 of them, and others as they are.
  static std::string packed(const std::vector<float>& numbers) {
    std::string result, single;
    const auto end_single = [&] {
      if (!single.empty()) result += static_cast<char>(128 + single.size() / 4) + single;
      single.clear();
    };
    for (std::size_t at = 0; at < numbers.size();) {
      std::size_t end = at;
      while (end < numbers.size() && end - at < 127 && numbers[end] == numbers[at]) ++end;
      if (end - at > 1) {
        end_single();
        result += static_cast<char>(end - at) + float_bytes(numbers[at]);
      } else {
        single += float_bytes(numbers[at]);
        if (single.size() == 4 * 127) end_single();
      }
      at = end;
    }
    end_single();
    return result;
  }
  void add_packed(const std::string& bytes) {
    whole(static_cast<int>(bytes.size()));
    bytes_ += bytes;
  }

  /// The nodes of a block with those of the layer round it.
  static std::vector<float> with_layer(const std::vector<float>& nodes) {
    if (nodes.size() == 1) return {nodes[0], nodes[0]};
    std::vector<float> result{2 * nodes[0] - nodes[1]};
    result.insert(result.end(), nodes.begin(), nodes.end());
    result.push_back(2 * nodes.back() - nodes[nodes.size() - 2]);
    return result;
  }

  void add_time(const SpyTestTime& time) {
    std::vector<int> variables{1};
    for (int m = 1; m <= materials; ++m) variables.insert(variables.end(), {100 + m, 200 + m});
    whole(static_cast<int>(variables.size()));
    for (const int v : variables) whole(v);
    const std::size_t places = bytes_.size();
    for (std::size_t v = 0; v < variables.size(); ++v) real(0);
    whole(1);  // tracers, of which seven arrays tell
    for (int n = 0; n < 7; ++n) add_packed(packed({1}));
    whole(1);  // a histogram
    whole(0);
    whole(0);
    for (int n = 0; n < 6; ++n) real(0);
    whole(2);
    add_packed("bins");
    // A block without values comes first.
    whole(static_cast<int>(time.blocks.size()) + 1);
    for (const int n : {4, 4, 4, 0, 0, 3}) whole(n);
    add_neighbours();
    for (const SpyTestBlock& block : time.blocks) {
      for (const auto& nodes : block.nodes) whole(static_cast<int>(with_layer(nodes).size()) - 1);
      for (const int n : {1, 0, block.level}) whole(n);
      add_neighbours();
    }
    for (const SpyTestBlock& block : time.blocks) {
      for (const auto& own : block.nodes) {
        const std::vector<float> nodes = with_layer(own);
        const float step = nodes[1] - nodes[0];
        std::vector<float> rest;
        for (std::size_t i = 0; i < nodes.size(); ++i)
          rest.push_back(nodes[i] - static_cast<float>(i) * step);
        add_packed(float_bytes(nodes[0]) + float_bytes(step) + packed(rest));
      }
    }
    for (std::size_t v = 0; v < variables.size(); ++v) {
      put(places + 8 * v, real_bytes(static_cast<double>(bytes_.size())));
      for (const SpyTestBlock& block : time.blocks) add_values(block, variables[v]);
    }
  }

  void add_neighbours() {
    for (int n = 0; version >= 103 && n < 6; ++n) whole(0);
  }

  void add_values(const SpyTestBlock& block, int variable) {
    const std::vector<float> x = with_layer(block.nodes[0]), y = with_layer(block.nodes[1]),
                             z = with_layer(block.nodes[2]);
    const auto middle = [](const std::vector<float>& nodes, std::size_t i) {
      return 0.5 * (static_cast<double>(nodes[i]) + static_cast<double>(nodes[i + 1]));
    };
    const auto copy = [](const std::vector<float>& nodes, std::size_t i) {
      return nodes.size() > 2 && (i == 0 || i + 2 == nodes.size());
    };
    for (std::size_t k = 0; k + 1 < z.size(); ++k) {
      std::vector<float> plane;
      for (std::size_t j = 0; j + 1 < y.size(); ++j) {
        for (std::size_t i = 0; i + 1 < x.size(); ++i) {
          const bool is_copy = copy(x, i) || copy(y, j) || copy(z, k);
          plane.push_back(is_copy ? -7 : value(variable, {middle(x, i), middle(y, j), middle(z, k)}));
        }
      }
      add_packed(packed(plane));
    }
  }

  std::string bytes_;
};

}  // namespace adamas::test
