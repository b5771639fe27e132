// Tests the contents of slices.

#include "program.h"

namespace adamas::test {

namespace {

class Slices : public ProgramTest {};

TEST_F(Slices, SlicesOfAllModes) {
  make_scene("sphere", 8);
  run_well({"resample", "scene.vtr", "--interface-error", "3%", "-o", "m.vtu"});
  for (const std::string mode : {"input", "plain", "materials", "all"}) {
    run_well({"slice", "m.vtu", "--original", "scene.vtr", "--plane", "y=0.5", "--field", "smooth", "--mode",
              mode, "-o", mode + ".svg"});
  }
  EXPECT_FALSE(read("all.svg") == read("materials.svg"));
  EXPECT_FALSE(read("plain.svg") == read("materials.svg"));
  expect_wrong_usage({"slice", "m.vtu", "--plane", "y=0.5", "--mode", "input", "-o", "x.png"},
                     {"--original"});
}

TEST_F(Slices, MaterialsHaveTheColoursOfTheFilesUpToTheMeshAndBack) {
  std::string labels;
  for (int site = 0; site < 8 * 8 * 8; ++site) labels += static_cast<char>(site % 8 / 3);
  write("parts.seg.nrrd",
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n"
        "Segment0_Name:=bone\nSegment0_LabelValue:=1\nSegment0_Color:=0.5 0.25 0.75\n"
        "Segment1_Name:=skin\nSegment1_LabelValue:=2\n\n" +
            labels);
  write("table.txt", "1 255 0 51 1 1 1 \"marrow\"\n2 0 102 0 1 1 1 \"fat\"\n");
  const auto slice = [this](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "slice");
    for (const std::string more : {"--plane", "z=3.7", "--no-interfaces", "--quiet", "-o", "s.svg"})
      arguments.push_back(more);
    run_well(arguments);
    return read("s.svg");
  };
  const auto has = [](const std::string& picture, const std::string& colour) {
    return picture.find("rgb(" + colour + ")") != std::string::npos;
  };
  const std::string bone = "50%,25%,75%", marrow = "100%,0%,20%", fat = "0%,40%,0%";
  EXPECT_TRUE(has(slice({"parts.seg.nrrd", "--cells"}), bone));
  run_well({"resample", "parts.seg.nrrd", "--cells", "--interface-error", "20%", "-o", "m.vtu",
            "--interfaces-out", "i.vtp"});
  run_well({"reconstruct", "parts.seg.nrrd", "--cells", "-o", "r.vtp"});
  for (const std::string file : {"m.vtu", "i.vtp", "r.vtp"}) EXPECT_TRUE(has(slice({file}), bone)) << file;
  // Cut meshes, saved hierarchies and what is selected from these have them too, and pictures in space.
  run_well({"resample", "parts.seg.nrrd", "--cells", "--interface-error", "20%", "--cut-mesh", "cut.vtu",
            "--save", "h.h5", "--picture", "r.svg"});
  run_well({"select", "h.h5", "-o", "s.vtu", "--cut-mesh", "cut2.vtu", "--picture", "p.svg"});
  EXPECT_TRUE(has(slice({"s.vtu"}), bone));
  EXPECT_TRUE(has(slice({"h.h5"}), bone));
  for (const std::string file : {"cut.vtu", "cut2.vtu"})
    EXPECT_NE(read(file).find("\"material_colors\""), std::string::npos) << file;
  EXPECT_EQ(run({"reconstruct", "i.vtp", "--picture", "i.svg"}).status, 0);
  for (const std::string file : {"r.svg", "p.svg", "i.svg"}) EXPECT_TRUE(has(read(file), bone)) << file;
  // The table has other names, and comes before the file's colours; a label of opacity 0 has none.
  const std::string named =
      slice({"parts.seg.nrrd", "--cells", "--labels", "labels", "--region-names", "table.txt"});
  EXPECT_TRUE(has(named, marrow));
  EXPECT_FALSE(has(named, bone));
  EXPECT_TRUE(has(named, fat));
  write("clear.txt", "1 255 0 51 0 1 1 \"marrow\"\n");
  EXPECT_FALSE(
      has(slice({"parts.seg.nrrd", "--cells", "--labels", "labels", "--region-names", "clear.txt"}), marrow));
}

TEST_F(Slices, APanelAloneHasNoTitleThatTellsNothing) {
  make_scene("sphere", 8);
  run_well({"slice", "scene.vtr", "--plane", "y=0.5", "-o", "s.svg"});
  EXPECT_EQ(read("s.svg").find("input"), std::string::npos);
  EXPECT_EQ(read("s.svg").find("original"), std::string::npos);
  run_well({"resample", "scene.vtr", "--interface-error", "3%", "-o", "m.vtu"});
  run_well({"slice", "m.vtu", "--original", "scene.vtr", "--plane", "y=0.5", "--mode", "all", "-o", "s.svg"});
  EXPECT_NE(read("s.svg").find("input"), std::string::npos);
  EXPECT_NE(read("s.svg").find("original interfaces"), std::string::npos);
}

TEST_F(Slices, LinesOfSlicesCanBeTold) {
  make_scene("sphere", 24);
  run_well({"resample", "scene.vtr", "--interface-error", "3%", "-o", "m.vtu"});
  const auto slice = [this](const std::string& size, const std::string& mode, const std::string& more) {
    std::vector<std::string> all{"slice", "m.vtu",   "--original", "scene.vtr", "--plane", "z=0.5", "--mode",
                                 mode,    "--field", "smooth",     "--size",    size,      "-o",    "s.svg"};
    if (!more.empty()) all.push_back(more);
    run_well(all);
    return read("s.svg");
  };
  // The input's cells are 5 pixels wide in the small picture and 17 in the large one.
  EXPECT_FALSE(slice("400,400", "all", "") == slice("400,400", "all", "--draw-cells"));
  EXPECT_TRUE(slice("1200,1200", "all", "") == slice("1200,1200", "all", "--draw-cells"));
  // Red is drawn over grey.
  const std::string picture = slice("1200,1200", "materials", "");
  const std::size_t grey = picture.find("rgb(60%,60%,60%)"), red = picture.find("rgb(86%,8%,24%)");
  ASSERT_NE(red, std::string::npos);
  EXPECT_LT(grey, red);
}

TEST_F(Slices, SlicesMatchMaterialsByName) {
  write_image("f.nrrd", 6, [](std::size_t i) { return i % 6 < 3 ? 1.0f : 0.0f; });
  run_well({"resample", "f.nrrd", "--fraction", "a=f.nrrd", "--rest", "b", "--interface-error", "5%", "-o",
            "m.vtu"});
  write_image("g.nrrd", 6, [](std::size_t i) { return i % 6 < 3 ? 0.0f : 1.0f; });
  const auto slice = [this](const std::vector<std::string>& original) {
    std::vector<std::string> all{"slice", "m.vtu", "--plane", "Z=2.5", "--mode", "all", "-o", "s.svg"};
    all.insert(all.end(), original.begin(), original.end());
    run_well(all);
    return read("s.svg");
  };
  // Both are the same data, with the materials exchanged.
  EXPECT_TRUE(slice({"--original", "f.nrrd", "--fraction", "a=f.nrrd", "--rest", "b"}) ==
              slice({"--original", "g.nrrd", "--fraction", "b=g.nrrd", "--rest", "a"}));
}

TEST_F(Slices, ComponentsOfVectorsGoByTheirAxes) {
  write("v.vtk",
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 3\nORIGIN 0 0 0\n"
        "SPACING 1 1 1\nCELL_DATA 8\nSCALARS volume_fraction_a float 1\nLOOKUP_TABLE default\n"
        "1 0 1 0 1 0 1 0\nVECTORS speed float\n1 2 3 2 3 4 3 4 5 4 5 6 5 6 7 6 7 8 7 8 9 8 9 0\n");
  for (const std::string component : {"1", "y"}) {
    run_well({"slice", "v.vtk", "--rest", "b", "--plane", "x=0.5", "--field", "speed:" + component, "-o",
              component + ".svg"});
  }
  EXPECT_TRUE(read("1.svg") == read("y.svg"));
}

TEST_F(Slices, TheirInterfacesAreThoseOfTheWhole) {
  const auto compare = [this](const std::vector<std::string>& input, const std::vector<std::string>& planes) {
    const auto run_on_input = [&](std::vector<std::string> command, const std::vector<std::string>& more) {
      command.insert(command.end(), input.begin(), input.end());
      command.insert(command.end(), more.begin(), more.end());
      run_well(command);
    };
    run_on_input({"resample"}, {"--interface-error", "5%", "-o", "m.vtu"});
    run_on_input({"reconstruct"}, {"-o", "r.vtp"});
    for (const std::string& plane : planes) {
      run_on_input({"slice", "m.vtu", "--original"}, {"--plane", plane, "-o", "near.png"});
      run_well({"slice", "m.vtu", "--original", "r.vtp", "--plane", plane, "-o", "whole.png"});
      EXPECT_TRUE(read("near.png") == read("whole.png")) << input.front() << " " << plane;
    }
  };
  make_scene("reflex", 12);
  compare({"scene.vtr"}, {"x=0.02", "y=0.5", "z=0.71", "z=1"});
  std::string labels(1000, '\0');
  for (std::size_t i = 0; i < labels.size(); ++i)
    labels[i] = i % 10 + i / 100 > 8 ? '\1' : i / 10 % 10 < 4 ? '\2' : '\0';
  write("l.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 10 10 10\nencoding: raw\n\n" + labels);
  compare({"l.nrrd", "--labels", "l.nrrd", "--points"}, {"x=0.02", "y=4", "z=3.3", "z=9"});
}

}  // namespace

}  // namespace adamas::test
