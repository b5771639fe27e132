// Tests that the one line of an error names the input, whatever goes wrong.

#include <sys/resource.h>

#include "core/base/sanitizers.h"
#include "store_test.h"

namespace adamas::test {

namespace {

class NamedInput : public StoreTest {
 protected:
  /// Makes a store of eight samples with this spacing.
  void make_eight(const std::string& spacing) const {
    write("eight.raw", "abcdefgh");
    run_well(
        {"store", "eight.raw", "--dimensions", "2", "--type", "uint8", "--spacing", spacing, "-o", "b.adm"});
  }
};

/// Volumes can be stored, described and restored whatever their spacing, but nothing can be computed with
/// such lengths.
TEST_F(NamedInput, LengthsOfVolumes) {
  for (const std::string spacing :
       {"1e-320,1e-320,1e-320", "1e-150,1e-150,1e-150", "1e100,1e100,1e100", "1,1,1e200"}) {
    make_eight(spacing);
    run_well({"info", "b.adm"});
    run_well({"restore", "b.adm", "-o", "r.raw"});
    EXPECT_EQ(read("r.raw"), "abcdefgh");
    for (const std::string output : {"s.png", "s.svg", "s.vtp"}) {
      expect_failure({"slice", "b.adm", "--plane", "x=" + spacing.substr(0, spacing.find(',')), "-o", output},
                     {"b.adm: expected", "coordinates below 1e+50", "found"});
    }
    expect_failure({"isosurface", "b.adm", "--isovalue", "100", "-o", "s.ply"},
                   {"b.adm: ", "expected", "found"});
  }
  make_eight("1e20,1,1");
  expect_failure({"isosurface", "b.adm", "--isovalue", "100", "-o", "s.ply"},
                 {"b.adm: ", "none is more than 1e+08 times as long", "found 1e+20 x 1 x 1"});
}

TEST_F(NamedInput, LengthsOfSurfaces) {
  for (const std::string side : {"1e100", "1e-150", "1e200"}) {
    write("s.obj", "v 0 0 0\nv " + side + " 0 0\nv 0 " + side + " 0\nv 0 0 " + side +
                       "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    expect_failure({"resample", "--interface", "s.obj=in,out", "-o", "m.vtu"},
                   {"s.obj", "expected", "found"});
  }
}

#if !ADAMAS_HAS_SHADOW_MEMORY
TEST_F(NamedInput, MemoryThatRunsOut) {
  make_scene("voronoi10", 20);
  RunOptions little;
  little.address_space = std::size_t{400} << 20;
  expect_failure({"resample", "scene.vtr", "--interface-error", "0.002%", "-o", "m.vtu"},
                 {"scene.vtr: ", "refining", "expected enough memory, found too little"}, little);
}
#endif

/// A file of options is not named as the input.
TEST_F(NamedInput, NotThatOfOptions) {
  make_eight("1e100,1,1");
  write("options.toml", "threads = 1\n");
  const RunResult result =
      run({"isosurface", "b.adm", "--isovalue", "100", "-o", "s.ply", "-c", "options.toml"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err.rfind("adamas: error: b.adm: ", 0), 0u) << result.err;
}

}  // namespace

}  // namespace adamas::test
