// Tests of --memory: what exceeds it ends with one line, as early as it can be known.

#include <string>
#include <utility>
#include <vector>

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

TEST_F(MemoryLimit, HeadersOfMeshesSayWhatIsTooMuch) {
  // There is nothing behind these headers.
  write("cells.vtu",
        "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>"
        "<Piece NumberOfPoints=\"20000000\" NumberOfCells=\"90000000\"><CellData>");
  write("block.vts",
        "<?xml version=\"1.0\"?><VTKFile type=\"StructuredGrid\"><StructuredGrid "
        "WholeExtent=\"0 1000 0 300 0 300\">");
  write("old.vtk",
        "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 90000000 float\n");
  write("parts.exo", std::string("CDF\1\0\0\0\0\0\0\0\012\0\0\0\2\0\0\0\011num_nodes\0\0\0", 32) +
                         std::string("\1\61\55\0\0\0\0\10num_elem\5\135\112\200", 20));
  const std::vector<std::pair<std::string, std::string>> found{{"cells.vtu", "found 90000000 cells"},
                                                               {"block.vts", "found 90000000 cells"},
                                                               {"old.vtk", "found 90000000 points"},
                                                               {"parts.exo", "found 90000000 cells"}};
  for (const auto& [file, cells] : found)
    expect_failure({"reconstruct", file, "--labels", "material", "-o", "i.vtp", "--memory", "1G"},
                   {file + ": ", "expected data that take at most 1.0 GiB of memory", cells, "at least",
                    "coarser data, or another limit by --memory"});
}

TEST_F(MemoryLimit, MeshesSayWhatReconstructionTakes) {
  std::string points, cells, labels, types, ends;
  constexpr int kCells = 12, kPoints = kCells + 1;
  for (int k = 0; k < kPoints; ++k)
    for (int j = 0; j < kPoints; ++j)
      for (int i = 0; i < kPoints; ++i)
        points += std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(k) + "\n";
  for (int n = 0; n < kCells * kCells * kCells; ++n) {
    const int first = n % kCells + kPoints * (n / kCells % kCells + kPoints * (n / kCells / kCells));
    constexpr int kUp = kPoints * kPoints;
    for (const int corner : {0, 1, kPoints + 1, kPoints, kUp, kUp + 1, kUp + kPoints + 1, kUp + kPoints})
      cells += std::to_string(first + corner) + " ";
    // Every cell has another label than its neighbours.
    labels += std::to_string((n + n / kCells + n / kCells / kCells) % 2) + " ";
    types += "12 ";
    ends += std::to_string(8 * (n + 1)) + " ";
  }
  const auto array = [](const std::string& type, const std::string& name, const std::string& values) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\"" +
           (name == "Points" ? " NumberOfComponents=\"3\">" : ">") + values + "</DataArray>";
  };
  write("cells.vtu",
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
        "<Piece NumberOfPoints=\"2197\" NumberOfCells=\"1728\"><CellData>" +
            array("Int32", "material", labels) + "</CellData><Points>" + array("Float64", "Points", points) +
            "</Points><Cells>" + array("Int32", "connectivity", cells) + array("Int32", "offsets", ends) +
            array("UInt8", "types", types) + "</Cells></Piece></UnstructuredGrid></VTKFile>");
  // 4752 faces between cells of different labels take more than all else.
  expect_failure({"reconstruct", "cells.vtu", "--labels", "material", "-o", "i.vtp", "--memory", "48M"},
                 {"cells.vtu: ", "at most 48.0 MiB of memory", "found 1728 cells", "about", "--memory"});
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
