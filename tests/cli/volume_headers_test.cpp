// Tests headers of volumes with extreme numbers, and properties that output formats cannot express.

#include <cmath>
#include <cstring>

#include "program.h"

namespace adamas::test {

namespace {

class VolumeHeaders : public ProgramTest {};

std::string raw(float value) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

/// Axes are parallel to x, y and z up to round-off, as imaging tools write them.
TEST_F(VolumeHeaders, ImagesWithRoundOffInTheirAxesHaveMaterials) {
  std::string arrays;
  for (const char* name : {"volume fraction a", "volume fraction b"}) {
    arrays += std::string("<DataArray type=\"Float32\" Name=\"") + name + "\" format=\"ascii\">";
    for (int i = 0; i < 27; ++i) arrays += (i % 3 == 0) == (name[16] == 'a') ? " 1" : " 0";
    arrays += "</DataArray>";
  }
  for (const std::string direction : {"1 0 0 0 1 0 0 0 1", "1 6.1e-17 0 -6.1e-17 1 0 0 0 1"}) {
    write(
        "a.vti",
        "<VTKFile type=\"ImageData\" version=\"1.0\"><ImageData WholeExtent=\"0 3 0 3 0 3\" Origin=\"0 0 0\" "
        "Spacing=\"1 1 1\" Direction=\"" +
            direction + "\"><Piece Extent=\"0 3 0 3 0 3\"><PointData/><CellData>" + arrays +
            "</CellData></Piece></ImageData></VTKFile>\n");
    run_well({"slice", "a.vti", "--plane", "z=1.5", "-o", "a.vtp", "--json", "a.json"});
    EXPECT_NEAR(read_json("a.json").at("area").get<double>(), 9, 1e-9) << direction;
  }
}

TEST_F(VolumeHeaders, SamplesThatAreAllNoNumbersHaveNoRange) {
  std::string bytes;
  for (int i = 0; i < 1000; ++i) bytes += raw(std::nanf(""));
  write("a.raw", bytes);
  EXPECT_EQ(run({"store", "a.raw", "--dimensions", "10,10,10", "--type", "float32", "-o", "a.adm"}).status,
            0);
  const RunResult told = run({"info", "a.adm"});
  EXPECT_EQ(told.out.find("nan"), std::string::npos) << told.out;
  const RunResult result = run({"isosurface", "a.adm", "--isovalue", "1", "-o", "a.ply"});
  EXPECT_NE(result.err.find("no sample is a finite number"), std::string::npos) << result.err;
}

TEST_F(VolumeHeaders, WhatNiftiCannotSayIsTold) {
  write("a.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 3 3\nspace: scanner-xyz\nspace directions: (1,0,0) "
        "(0,1,0) "
        "(0,0,1)\nencoding: raw\n\n" +
            std::string(27, '\1'));
  run({"store", "a.nrrd", "-o", "a.adm"});
  const RunResult result = run({"restore", "a.adm", "-o", "b.nii"});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.err.find("b.nii: the space of coordinates is scanner-xyz"), std::string::npos)
      << result.err;
  // Single precision does not have such small lengths.
  write("c.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 3 3\nspacings: 1e-44 1e-44 1e-44\nencoding: raw\n\n" +
            std::string(27, '\1'));
  EXPECT_EQ(run({"store", "c.nrrd", "-o", "c.adm"}).status, 0);
  EXPECT_EQ(run({"restore", "c.adm", "-o", "d.nii"}).status, 0);
  run_well({"info", "d.nii", "--points", "--json", "d.json"});
  EXPECT_NEAR(read_json("d.json").at("box")[1].get<double>(), 2e-44, 1e-50);
}

TEST_F(VolumeHeaders, OptionsOfVolumesNeedOne) {
  expect_wrong_usage({"slice", "--dimensions", "3,3,3", "--type", "uint8", "--plane", "z=1", "-o", "x.png"},
                     {"--dimensions: expected a volume as INPUT, found none"});
}

}  // namespace

}  // namespace adamas::test
