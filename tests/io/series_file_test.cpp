// Tests lists of the files of a series: what is written is read back unchanged.

#include <fmt/format.h>

#include "adamas/series.h"
#include "tests/support/scratch.h"

namespace adamas {

namespace {

using test::error_of;
using test::says;

TEST(SeriesFile, IsReadAsItWasWritten) {
  const test::Scratch scratch;
  std::vector<SeriesEntry> entries;
  for (int step = 0; step < 20'000; ++step)
    entries.push_back({0.1 * step, step_file("run.pvd", static_cast<std::size_t>(step), ".vtu")});
  for (const char* name : {"a b.vtu", "a&<>\"'\t\n.vtu", "\xc3\xa9\xe2\x82\xac.vtu", "#%.vtu", "?.vtu"})
    entries.push_back({0.1 * static_cast<double>(entries.size()), name});
  write_series(scratch / "run.pvd", entries);
  const auto read = read_series(scratch / "run.pvd");
  ASSERT_EQ(read.size(), entries.size());
  for (std::size_t n = 0; n < read.size(); ++n) {
    EXPECT_EQ(read[n].time, entries[n].time);
    EXPECT_EQ(read[n].file, (scratch / entries[n].file).string());
  }
}

TEST(SeriesFile, NamesThatXmlCannotHold) {
  const test::Scratch scratch;
  for (const std::string name : {"a\x1b[1m", "a\x01", "\xff", "a\xc3", "\xef\xbf\xbe"}) {
    const std::string expected = "expected names of files of UTF-8 without control characters";
    EXPECT_TRUE(says(error_of([&] { write_series(scratch / "a.pvd", {{0, name}}); }), expected));
    EXPECT_TRUE(says(error_of([&] { step_file(scratch / (name + ".pvd"), 0, ".vtu"); }), expected));
  }
  EXPECT_EQ(scratch.entries(), 0);
}

/// A list that could not be read is not written.
TEST(SeriesFile, MoreStepsThanAreRead) {
  const test::Scratch scratch;
  const std::string name(250, '&');
  std::vector<SeriesEntry> entries;
  for (int step = 0; step < 14'000; ++step) entries.push_back({static_cast<double>(step), name});
  EXPECT_TRUE(says(error_of([&] { write_series(scratch / "a.pvd", entries); }),
                   "expected a list of at most 16777216 bytes, found"));
  EXPECT_EQ(scratch.entries(), 0);
}

}  // namespace
}  // namespace adamas
