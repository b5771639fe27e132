// A program that keeps a mesh in a file, reads it back and asks what the file holds.
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include "adamas/error.h"
#include "adamas/files.h"
#include "adamas/mesh_files.h"
#include "adamas/resample.h"
#include "adamas/summary.h"

int main() {
  adamas::set_reader_program(READER_PROGRAM);
  constexpr std::size_t kSide = 12;
  adamas::GridData data;
  data.grid = adamas::RectilinearGrid::uniform({kSide, kSide, kSide}, {0, 0, 0}, {1, 1, 1});
  std::vector<std::uint8_t> labels;
  for (std::size_t site = 0; site < data.grid.site_count(); ++site)
    labels.push_back(site / kSide % kSide < kSide / 2 ? 0 : 1);
  data.materials = {"below", "above"};
  data.labels = std::span<const std::uint8_t>(labels);
  try {
    const adamas::AdaptiveMesh mesh = adamas::resample(adamas::Input(data));
    adamas::write_mesh("mesh.vtu", mesh);
    const adamas::AdaptiveMesh again = adamas::read_adaptive_mesh("mesh.vtu");
    const auto summary = adamas::summarize_mesh("mesh.vtu");
    std::printf("%zu tetrahedra, %zu read back, %zu bodies\n", mesh.tetrahedra().size(),
                again.tetrahedra().size(), summary ? summary->bodies : 0);
    return summary && summary->bodies == 2 && again.tetrahedra().size() == mesh.tetrahedra().size() ? 0 : 1;
  } catch (const adamas::Error& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
