// Tests of --memory: what exceeds it ends with one line, as early as it can be known.

#include <string>

#include "core/base/sanitizers.h"
#include "program.h"

namespace adamas::test {

namespace {

class MemoryLimit : public ProgramTest {};

TEST_F(MemoryLimit, HeadersSayWhatIsTooMuch) {
  // There are no samples: headers alone are read. Labels take memory for rows at least, and fractions for
  // cells.
  const auto write_header = [&](const std::string& name, int size) {
    write(name, "NRRD0004\ntype: uint16\ndimension: 3\nsizes: " + std::to_string(size) + " " +
                    std::to_string(size) + " " + std::to_string(size) +
                    "\nspacings: 1 1 1\nencoding: raw\ndata file: labels.raw\n");
  };
  write_header("labels.nhdr", 20000);
  write_header("steel.nhdr", 2000);
  write("labels.raw", "x");
  for (const std::string command : {"reconstruct", "resample"}) {
    const std::string output = command == "resample" ? "m.vtu" : "i.vtp";
    expect_failure({command, "labels.nhdr", "--labels", "labels.nhdr", "-o", output, "--memory", "1G"},
                   {"labels.nhdr: ", "expected data that take at most 1.0 GiB of memory",
                    "found 8000000000000 cells", "at least", "--region", "--memory"});
    expect_failure({command, "steel.nhdr", "--fraction", "steel=steel.nhdr", "--rest", "air", "-o", output,
                    "--memory", "1G"},
                   {"steel.nhdr: ", "found 8000000000 cells", "at least"});
    // Those labels are not too many.
    expect_failure(
        {command, "steel.nhdr", "--labels", "steel.nhdr", "-o", output, "--memory", "1G"},
        {"steel.nhdr: ", "labels.raw: expected 16000000000 bytes for 2000 x 2000 x 2000 samples of uint16"});
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
