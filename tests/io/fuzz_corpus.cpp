#include "core/io/network_text.h"
#include "core/io/nrrd_header.h"
#include "scratch.h"

namespace adamas {
namespace {

/// Runs a parser on every seed and on every truncation of it; returns how many seeds are good input.
template <class Parse>
std::size_t replay(const std::string& name, Parse&& parse) {
  const auto folder = std::filesystem::path(ADAMAS_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / name;
  std::size_t good = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string bytes = test::bytes_of(entry.path());
    for (std::size_t length = 0; length <= bytes.size(); ++length) {
      try {
        parse(std::string_view(bytes).substr(0, length));
        good += length == bytes.size();
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
  return good;
}

TEST(FuzzCorpus, NetworkText) {
  EXPECT_EQ(replay("network_text",
                   [](std::string_view text) {
                     to_interface_mesh(parse_labelled_network(text, "seed"), {}, "seed");
                   }),
            4u);
}

TEST(FuzzCorpus, NrrdHeader) {
  EXPECT_EQ(
      replay("nrrd_header",
             [](std::string_view text) { EXPECT_GT(parse_nrrd_header(text, "seed").value_count(), 0u); }),
      3u);
}

}  // namespace
}  // namespace adamas
