// Tests of --memory: what exceeds it ends with one line, as early as it can be known.

#include <string>

#include "core/base/sanitizers.h"
#include "program.h"

namespace adamas::test {

namespace {

class MemoryLimit : public ProgramTest {};

TEST_F(MemoryLimit, HeadersSayWhatIsTooMuch) {
  // There are no samples: headers alone are read.
  write("labels.nhdr",
        "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 2000 2000 2000\nspacings: 1 1 1\nencoding: raw\n"
        "data file: labels.raw\n");
  write("labels.raw", "x");
  for (const std::string command : {"reconstruct", "resample"}) {
    expect_failure({command, "labels.nhdr", "--labels", "labels.nhdr", "-o",
                    command == "resample" ? "m.vtu" : "i.vtp", "--memory", "1G"},
                   {"labels.nhdr: ", "expected data that take at most 1.0 GiB of memory",
                    "found 8000000000 cells", "at least", "--region", "--memory"});
  }
}

TEST_F(MemoryLimit, DataSayWhatReconstructionTakes) {
  make_scene("voronoi10", 40);
  expect_failure({"reconstruct", "scene.vtr", "-o", "i.vtp", "--memory", "60M"},
                 {"scene.vtr: ", "at most 60.0 MiB of memory", "found 64000 cells", "about", "--memory"});
  // A part of them takes less.
  run_well({"reconstruct", "scene.vtr", "--region", "0,0.2,0,0.2,0,0.2", "-o", "i.vtp", "--memory", "60M"});
}

#if !ADAMAS_HAS_SHADOW_MEMORY
TEST_F(MemoryLimit, WhatExceedsItEndsWithOneLine) {
  make_scene("voronoi10", 20);
  expect_failure({"resample", "scene.vtr", "--interface-error", "0.002%", "-o", "m.vtu", "--memory", "100M"},
                 {"scene.vtr: ", "refining", "expected to take at most 100.0 MiB of memory", "--memory"});
}
#endif

TEST_F(MemoryLimit, ResultsDoNotDependOnIt) {
  make_scene("sphere", 12);
  run_well({"resample", "scene.vtr", "--interface-error", "2%", "-o", "a.vtu"});
  run_well({"resample", "scene.vtr", "--interface-error", "2%", "-o", "b.vtu", "--memory", "1G"});
  EXPECT_EQ(read("a.vtu"), read("b.vtu"));
}

}  // namespace

}  // namespace adamas::test
