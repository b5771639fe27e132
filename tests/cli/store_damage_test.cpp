// Damaged stores: every command answers, verify always says so, and nothing wrong is passed off as whole.

#include <random>

#include "store_test.h"

namespace adamas::test {

namespace {

class StoreDamage : public StoreTest {
 protected:
  /// Every command ends with an answer: 0 or 1, the latter with one line that names the file.
  void expect_answers(const std::string& what) const {
    const auto answered = [&](const std::vector<std::string>& command) {
      const RunResult result = run(command);
      EXPECT_TRUE(result.status == 0 || result.status == 1) << what << ": " << result.status << result.err;
      if (result.status == 1) {
        EXPECT_EQ(result.err_lines().size(), 1u) << what << ": " << result.err;
        EXPECT_EQ(result.err.rfind("adamas: error: d.adm: ", 0), 0u) << what << ": " << result.err;
      }
      return result.status == 0;
    };
    EXPECT_FALSE(answered({"verify", "d.adm"})) << what;
    if (answered({"restore", "d.adm", "-o", "r.raw", "--quiet"})) {
      EXPECT_EQ(read("r.raw"), read("ball.raw")) << what;
    }
    answered({"isosurface", "d.adm", "--isovalue", "80.5", "--error", "0.7voxels", "-o", "s.ply", "--quiet"});
    if (answered({"isosurface", "d.adm", "--isovalue", "80.5", "--error", "0.7voxels", "--strict", "-o",
                  "strict.ply", "--quiet"})) {
      EXPECT_EQ(read("strict.ply"), read("whole.ply")) << what;
    }
  }

  /// Of every four stores one is cut off, the others have a bit changed.
  void damage(int count, unsigned seed) const {
    make_ball("30");
    make_store();
    run_well({"isosurface", "b.adm", "--isovalue", "80.5", "--error", "0.7voxels", "-o", "whole.ply"});
    const std::string whole = read("b.adm");
    std::mt19937 random(seed);
    for (int n = 0; n < count; ++n) {
      std::string bytes = whole;
      const std::size_t at = random() % whole.size();
      if (n % 4 == 0) {
        bytes.resize(at);
      } else {
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      }
      write("d.adm", bytes);
      expect_answers((n % 4 == 0 ? "cut at " : "flip at ") + std::to_string(at));
    }
  }
};

class LongStoreDamage : public StoreDamage {};

TEST_F(StoreDamage, SomeFlipsAndTruncations) { damage(20, 3); }

TEST_F(LongStoreDamage, FlipsAndTruncations) { damage(200, 5); }

TEST_F(StoreDamage, AddedBytesAreFound) {
  make_ball("20");
  make_store();
  write("d.adm", read("b.adm") + "a");
  expect_failure({"verify", "d.adm"}, {"d.adm", "expected", "found"});
}

/// A damaged page of the finest level, whose surroundings stay as they are.
TEST_F(StoreDamage, APageOfTheFinestLevel) {
  make_ball("60");
  make_store();
  std::string bytes = read("b.adm");
  // Copies, directory and root are less than a third of the file; before them are the finest pages.
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write("d.adm", bytes);
  const RunResult verified = run({"verify", "d.adm", "--json", "f.json"});
  EXPECT_EQ(verified.status, 1);
  EXPECT_NE(verified.out.find("page of level 0 at "), std::string::npos) << verified.out;
  EXPECT_EQ(read_json("f.json")["bad_pages"], 1);
  expect_failure({"restore", "d.adm", "-o", "r.raw"}, {"d.adm", "the page of level 0 at ", "damaged"});
  expect_failure({"isosurface", "d.adm", "--isovalue", "10", "--strict", "-o", "s.ply"},
                 {"d.adm", "the page of level 0 at ", "damaged"});
  const RunResult surface =
      run({"isosurface", "d.adm", "--isovalue", "10", "-o", "s.ply", "--json", "f.json"});
  EXPECT_EQ(surface.status, 0);
  EXPECT_NE(surface.err.find("note: 1 damaged page: the surface at isovalue 10 is coarser there"),
            std::string::npos)
      << surface.err;
  EXPECT_EQ(read_json("f.json")["damaged_pages"], 1);
  EXPECT_GT(read_json("f.json")["triangles"], 1000);
  run_well({"restore", "d.adm", "--level", "1", "-o", "half.raw"});
  run_well({"restore", "b.adm", "--level", "1", "-o", "whole.raw"});
  EXPECT_EQ(read("half.raw"), read("whole.raw"));
}

/// Coarse pages are there twice.
TEST_F(StoreDamage, TheCoarsestPageHasACopy) {
  make_ball("60");
  make_store();
  std::string bytes = read("b.adm");
  bytes[40] = static_cast<char>(bytes[40] ^ 1);
  write("d.adm", bytes);
  const RunResult verified = run({"verify", "d.adm", "--json", "f.json"});
  EXPECT_EQ(verified.status, 1);
  EXPECT_NE(verified.out.find("one of its two copies is damaged"), std::string::npos) << verified.out;
  EXPECT_EQ(read_json("f.json")["bad_pages"], 0);
  EXPECT_EQ(read_json("f.json")["bad_copies"], 1);
  run_well({"restore", "d.adm", "-o", "r.raw", "--json", "f.json"});
  EXPECT_EQ(read("r.raw"), read("ball.raw"));
  EXPECT_EQ(read_json("f.json")["pages_from_copies"], 1);
}

}  // namespace

}  // namespace adamas::test
