// A program that is linked with the shared library alone.
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/error.h"
#include "adamas/resample.h"
#include "adamas/volume_store.h"

namespace {

/// Counts the stages that the library reports.
class CountedStages final : public adamas::Progress {
 public:
  void report(std::string_view, double) override { ++count_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  int count_ = 0;
};

}  // namespace

int main() {
  constexpr std::size_t kSide = 12;
  adamas::GridData data;
  data.grid = adamas::RectilinearGrid::uniform({kSide, kSide, kSide}, {0, 0, 0}, {1, 1, 1});
  std::vector<std::uint8_t> labels;
  for (std::size_t site = 0; site < data.grid.site_count(); ++site)
    labels.push_back(site / kSide % kSide < kSide / 2 ? 0 : 1);
  data.materials = {"below", "above"};
  data.labels = std::span<const std::uint8_t>(labels);
  CountedStages stages;
  const adamas::AdaptiveMesh mesh = adamas::resample(adamas::Input(data), {}, stages);
  std::printf("%zu tetrahedra, %zu materials, stages reported: %s\n", mesh.tetrahedra().size(),
              mesh.materials().size(), stages.count() > 0 ? "yes" : "no");
  // On this side errors of the library have the type of its header too.
  try {
    adamas::VolumeStore::open("no such file.adm");
  } catch (const adamas::Error& error) {
    std::printf("%s\n", error.what());
    return mesh.tetrahedra().empty() || stages.count() == 0 ? 1 : 0;
  }
  return 1;
}
