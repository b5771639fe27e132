#include "tests/fuzz/targets.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

/// Runs a fuzz target on every seed and on every truncation of it; returns how many seeds are good input.
std::size_t replay(const std::string& name, void (*target)(std::string_view)) {
  const auto folder = std::filesystem::path(ADAMAS_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / name;
  std::size_t good = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string bytes = test::bytes_of(entry.path());
    for (std::size_t length = 0; length <= bytes.size(); ++length) {
      try {
        target(std::string_view(bytes).substr(0, length));
        good += length == bytes.size();
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  return good;
}

TEST(FuzzCorpus, NetworkText) { EXPECT_EQ(replay("network_text", fuzz::network_text), 4u); }
TEST(FuzzCorpus, RegionNames) { EXPECT_EQ(replay("region_names", fuzz::region_names), 1u); }
TEST(FuzzCorpus, NrrdHeader) { EXPECT_EQ(replay("nrrd_header", fuzz::nrrd_header), 3u); }
TEST(FuzzCorpus, Inflate) { EXPECT_EQ(replay("inflate", fuzz::inflate), 3u); }
TEST(FuzzCorpus, LegacyVtk) { EXPECT_EQ(replay("legacy_vtk", fuzz::legacy_vtk), 4u); }
TEST(FuzzCorpus, MetaImage) { EXPECT_EQ(replay("meta_image", fuzz::meta_image), 2u); }

}  // namespace
}  // namespace adamas
