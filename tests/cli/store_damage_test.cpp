// Tests damaged stores: every command gives an answer, verify always finds the damage, and nothing wrong is
// presented as whole.

#include <random>

#include "store_test.h"

namespace adamas::test {

namespace {

class StoreDamage : public StoreTest {
 protected:
  /// Expects that the command ends with an answer: status 0; status 1 with one line that names the file; or
  /// status 3 with nothing but notes about missing parts, also with --quiet. Returns whether the status is 0.
  bool answered(const std::vector<std::string>& command, const std::string& what) const {
    const RunResult result = run(command);
    const auto lines = result.err_lines();
    if (result.status == 1) {
      EXPECT_EQ(lines.size(), 1u) << what << ": " << result.err;
      EXPECT_EQ(result.err.rfind("adamas: error: d.adm: ", 0), 0u) << what << ": " << result.err;
    } else if (result.status == 3) {
      EXPECT_FALSE(lines.empty()) << what;
      for (const std::string& line : lines) {
        EXPECT_EQ(line.rfind("adamas: note: ", 0), 0u) << what << ": " << line;
        EXPECT_NE(line.find("damaged"), std::string::npos) << what << ": " << line;
      }
    } else {
      EXPECT_EQ(result.status, 0) << what << ": " << result.err;
      EXPECT_EQ(result.err, "") << what;
    }
    return result.status == 0;
  }

  void expect_answers(const std::string& what) const {
    const auto answered = [&](const std::vector<std::string>& command) {
      return this->answered(command, what);
    };
    EXPECT_FALSE(answered({"verify", "d.adm"})) << what;
    if (answered({"restore", "d.adm", "-o", "r.raw", "--quiet"})) {
      EXPECT_EQ(read("r.raw"), read("ball.raw")) << what;
    }
    if (answered({"isosurface", "d.adm", "--isovalue", "80.5", "--error", "0.7voxels", "-o", "s.ply",
                  "--quiet"})) {
      EXPECT_EQ(read("s.ply"), read("whole.ply")) << what;
    }
    answered({"info", "d.adm", "--quiet"});
    if (answered({"isosurface", "d.adm", "--isovalue", "80.5", "--error", "0.7voxels", "--strict", "-o",
                  "strict.ply", "--quiet"})) {
      EXPECT_EQ(read("strict.ply"), read("whole.ply")) << what;
    }
  }

  /// Damages many copies of a store: one of every four is cut off, the others have a bit changed.
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

TEST_F(StoreDamage, SomeFlipsAndTruncations) { damage(8, 3); }

TEST_F(LongStoreDamage, FlipsAndTruncations) { damage(24, 5); }

TEST_F(StoreDamage, AddedBytesAreFound) {
  make_ball("20");
  make_store();
  write("d.adm", read("b.adm") + "a");
  expect_failure({"verify", "d.adm"}, {"d.adm", "expected", "found"});
}

/// A page of the finest level is damaged, and the pages round it are whole.
TEST_F(StoreDamage, APageOfTheFinestLevel) {
  make_ball("60");
  make_store();
  std::string bytes = read("b.adm");
  // Copies, directory and root are less than a third of the file; the finest pages are before them.
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write("d.adm", bytes);
  const RunResult verified = run({"verify", "d.adm", "--json", "f.json"});
  EXPECT_EQ(verified.status, 1);
  EXPECT_NE(verified.out.find("page of LOD 0 at "), std::string::npos) << verified.out;
  EXPECT_EQ(read_json("f.json")["bad_pages"], 1);
  expect_failure({"restore", "d.adm", "-o", "r.raw"}, {"d.adm", "the page of LOD 0 at ", "damaged"});
  expect_failure({"isosurface", "d.adm", "--isovalue", "10", "--strict", "-o", "s.ply"},
                 {"d.adm", "the page of LOD 0 at ", "damaged"});
  const RunResult surface =
      run({"isosurface", "d.adm", "--isovalue", "10", "-o", "s.ply", "--json", "f.json"});
  EXPECT_EQ(surface.status, 3);
  EXPECT_NE(surface.err.find("note: 1 damaged page: the surface at isovalue 10 is coarser there"),
            std::string::npos)
      << surface.err;
  EXPECT_EQ(read_json("f.json")["damaged_pages"], 1);
  EXPECT_GT(read_json("f.json")["triangles"], 1000);
  run_well({"restore", "d.adm", "--level", "1", "-o", "half.raw"});
  run_well({"restore", "b.adm", "--level", "1", "-o", "whole.raw"});
  EXPECT_EQ(read("half.raw"), read("whole.raw"));
}

/// A surface may lie beside pages that it does not cross; its normals depend on them.
TEST_F(StoreDamage, PagesThatNormalsAloneDependOn) {
  // On a slope with a few bumps the mesh is fine at the bumps alone, and its points have neighbours on other
  // pages.
  std::string samples;
  std::mt19937 random(1);
  for (int n = 0; n < 50 * 50 * 50; ++n) {
    const int bump = random() % 50 == 0 ? static_cast<int>(random() % 6) : 0;
    samples += static_cast<char>(std::min(255.0, 3 * (n % 50) + 2 * (n / 50 % 50) + 1.3 * (n / 2500) + bump));
  }
  write("ramp.raw", samples);
  run_well({"store", "ramp.raw", "--dimensions", "50", "--type", "uint8", "-o", "b.adm"});
  const auto surface = [this](const std::string& output, const std::string& option, const std::string& what) {
    return answered(
        // Ranges are rounded to this isovalue, so that few pages that it does not cross seem to be crossed.
        {"isosurface", "d.adm", "--isovalue", "64", "--error", "0.7", "--quiet", "-o", output, option}, what);
  };
  const std::string whole = read("b.adm");
  write("d.adm", whole);
  EXPECT_TRUE(surface("whole.ply", "--strict", "whole"));
  EXPECT_TRUE(surface("points.ply", "--no-normals", "whole"));
  int only_normals = 0, all = 0;
  constexpr int kPlaces = 20;
  for (int n = 1; n < kPlaces; ++n) {
    std::string bytes = whole;
    const std::size_t at = bytes.size() * static_cast<std::size_t>(n) / kPlaces;
    bytes[at] = static_cast<char>(bytes[at] ^ 16);
    write("d.adm", bytes);
    const std::string what = "flip at " + std::to_string(at);
    const bool is_whole = surface("s.ply", "--threads=1", what);
    EXPECT_EQ(surface("strict.ply", "--strict", what), is_whole) << what;
    const bool has_points = surface("p.ply", "--no-normals", what);
    EXPECT_TRUE(has_points || !is_whole) << what;
    if (is_whole) {
      EXPECT_EQ(read("s.ply"), read("whole.ply")) << what;
      EXPECT_EQ(read("strict.ply"), read("whole.ply")) << what;
    }
    if (has_points) {
      EXPECT_EQ(read("p.ply"), read("points.ply")) << what;
    }
    only_normals += has_points && !is_whole ? 1 : 0;
    all += is_whole ? 1 : 0;
  }
  EXPECT_GT(only_normals, 0);
  EXPECT_GT(all, 0);
}

/// Coarse pages are stored twice.
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
