// Tests that colours of labels are those of the files, under the names that the labels get.

#include "core/io/named_colours.h"

#include "core/io/input_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/labelled_network.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::put_bytes;
using test::says;

const std::string kStart = "NRRD0004\ntype: uchar\nencoding: raw\n";
const std::string kTable =
    "################\n# ITK-SnAP Label Description File\n"
    "    0     0    0    0        0  0  0    \"Clear Label\"\n"
    "    1   255    0   51        1  1  1    \"the brain\"\n"
    "    4     0  255    0        1  0  0    \"shown green\"\n"
    "    5   300    0    0        1  1  1    \"out of range\"\n"
    "    6   1 plain line\n";

TEST(NamedColours, OfSegmentsHaveTheirNames) {
  const test::Scratch scratch;
  put_bytes(scratch / "a.seg.nrrd", kStart +
                                        "sizes: 2 1 1\nSegment0_Name:=bone\nSegment0_LabelValue:=4\n"
                                        "Segment0_Color:=0.5 0.25 1\nSegment1_Name:=skin\n"
                                        "Segment1_Color:=0 0 0.125\nSegment2_Name:=plain\n\n\1\2");
  EXPECT_EQ(find_named_colours(scratch / "a.seg.nrrd", {}),
            (NamedColours{{"bone", {0.5, 0.25, 1}}, {"skin", {0, 0, 0.125}}}));
  // A table comes first, with its names too.
  put_bytes(scratch / "labels.txt", kTable);
  EXPECT_EQ(find_named_colours(scratch / "a.seg.nrrd", scratch / "labels.txt"),
            (NamedColours{{"the brain", {1, 0, 0.2}}, {"shown green", {0, 1, 0}}, {"skin", {0, 0, 0.125}}}));
}

TEST(NamedColours, OfLayersBelongToTheSegmentsInTheirOrder) {
  const test::Scratch scratch;
  put_bytes(scratch / "a.seg.nrrd",
            kStart +
                "sizes: 2 1 1 1\nkinds: list domain domain domain\n"
                "Segment0_Name:=bone\nSegment0_Layer:=0\nSegment0_Color:=1 0 0\n"
                "Segment1_Name:=skin\nSegment1_Layer:=1\nSegment1_Color:=0 1 0\n\n\1\1");
  EXPECT_EQ(find_named_colours(scratch / "a.seg.nrrd", {}),
            (NamedColours{{"bone", {1, 0, 0}}, {"skin", {0, 1, 0}}}));
}

TEST(NamedColours, OfTablesLeaveOutClearLabelsAndOtherLines) {
  const auto colours = parse_region_table(kTable, "t").colours;
  EXPECT_EQ(colours, (std::map<std::int64_t, std::array<double, 3>>{{1, {1, 0, 0.2}}, {4, {0, 1, 0}}}));
  EXPECT_EQ(parse_region_table(kTable, "t").names.at(5), "out of range");
}

TEST(NamedColours, ThatAreNoneAreRefused) {
  const test::Scratch scratch;
  for (const std::string colour : {"1 0", "1 0 2", "red", "nan 0 0", "-1 0 0", "0 0 0 0"}) {
    put_bytes(scratch / "a.seg.nrrd",
              kStart + "sizes: 1 1 1\nSegment0_Name:=bone\nSegment0_Color:=" + colour + "\n\n\1");
    EXPECT_TRUE(says(error_of([&] { find_named_colours(scratch / "a.seg.nrrd", {}); }),
                     "expected three numbers of a colour from 0 to 1"))
        << colour;
  }
}

TEST(NamedColours, OfInterfacesComeBack) {
  const test::Scratch scratch;
  InterfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.materials = {"bone", "air & more", "skin"};
  mesh.triangles = {{{0, 1, 2}, MaterialId(0), MaterialId(1)}};
  const NamedColours colours{
      {"air & more", {0.125, 1, 0.1}}, {"skin", {0, 0, 1}}, {"no material", {1, 1, 1}}};
  write_interface_mesh(scratch / "a.vtp", InterfaceMesh(mesh), colours);
  EXPECT_EQ(find_named_colours(scratch / "a.vtp", {}),
            (NamedColours{{"air & more", {0.125, 1, 0.1}}, {"skin", {0, 0, 1}}}));
  EXPECT_EQ(read_interface_mesh(scratch / "a.vtp").materials, mesh.materials);
  // Materials without colours leave the file as it was.
  write_interface_mesh(scratch / "b.vtp", InterfaceMesh(mesh), {{"no material", {1, 1, 1}}});
  write_interface_mesh(scratch / "c.vtp", mesh);
  EXPECT_EQ(read_file(scratch / "b.vtp"), read_file(scratch / "c.vtp"));
  EXPECT_TRUE(find_named_colours(scratch / "b.vtp", {}).empty());
}

/// A mesh of another program may have more tags than headers of ours have: it has no colours, but can be
/// read.
TEST(NamedColours, OfFilesWithMoreTagsThanOursAreNone) {
  const test::Scratch scratch;
  std::string text = "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>";
  for (int n = 0; n < 60000; ++n) text += "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"></Piece>";
  put_bytes(scratch / "a.vtu", text + "</UnstructuredGrid></VTKFile>");
  EXPECT_TRUE(find_named_colours(scratch / "a.vtu", {}).empty());
}

}  // namespace

}  // namespace adamas
