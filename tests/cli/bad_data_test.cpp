// Tests the answers to input that cannot be used: one line that names the file, what was expected and what
// was found, exit status 1, and no output.

#include <cmath>
#include <limits>

#include "program.h"

namespace adamas::test {

namespace {

class BadData : public ProgramTest {
 protected:
  /// Expects that every command that reads gridded data refuses the input.
  void expect_refused(std::vector<std::string> input, const std::vector<std::string>& parts) const {
    const auto with = [&input](std::vector<std::string> command, const std::vector<std::string>& rest) {
      command.insert(command.end(), input.begin(), input.end());
      command.insert(command.end(), rest.begin(), rest.end());
      return command;
    };
    expect_failure(with({"resample"}, {"-o", "m.vtu", "--interfaces-out", "i.vtp", "--json", "j.json"}),
                   parts);
    expect_failure(with({"reconstruct"}, {"-o", "r.vtp", "--picture", "r.png"}), parts);
    expect_failure(with({"slice"}, {"--plane", "x=1", "-o", "s.png"}), parts);
    expect_failure(with({"probe"}, {"--point", "1,1,1", "-o", "p.csv"}), parts);
  }
};

TEST_F(BadData, Missing) {
  expect_refused({"none.vtr"}, {"none.vtr"});
  expect_failure({"info", "none.vtr", "--json", "j.json"}, {"none.vtr"});
}

TEST_F(BadData, Empty) {
  for (const std::string name : {"empty.vtr", "empty.vti", "empty.nrrd"}) {
    write(name, "");
    expect_refused({name}, {name, "empty"});
    expect_failure({"info", name, "--json", "j.json"}, {name, "empty"});
  }
}

TEST_F(BadData, Truncated) {
  make_scene("sphere");
  const std::string whole = read("scene.vtr");
  for (const std::size_t part : {whole.size() / 2, whole.size() - 40, std::size_t{200}}) {
    write("cut.vtr", whole.substr(0, part));
    expect_failure({"resample", "cut.vtr", "-o", "m.vtu"}, {"cut.vtr"});
    expect_failure({"info", "cut.vtr", "--json", "j.json"}, {"cut.vtr"});
  }
}

TEST_F(BadData, WrongType) {
  write("text.vtr", "this is no grid\n");
  expect_refused({"text.vtr"}, {"text.vtr"});
  make_scene("sphere");
  write("name.nrrd", read("scene.vtr"));
  expect_failure({"resample", "name.nrrd", "-o", "m.vtu"}, {"name.nrrd"});
  write("name.xyz", "1 2 3\n");
  expect_failure({"info", "name.xyz"}, {"name.xyz"});
  // The command cannot use this kind of mesh.
  run_well({"resample", "scene.vtr", "--interface-error", "5%", "-o", "m.vtu"});
  expect_failure({"resample", "m.vtu", "-o", "n.vtu"}, {"m.vtu", "expected data on a grid", "found"});
  run_well({"generate", "scene", "sphere", "--interfaces", "s.vtp"});
  run_well({"generate", "scene", "sphere", "--interfaces", "s.stl"});
  expect_failure({"reconstruct", "s.stl", "-o", "r.vtp"}, {"s.stl", "expected data on a grid", "found"});
  expect_failure({"slice", "s.stl", "--plane", "x=0.5", "-o", "s.png"}, {"s.stl", "expected", "found"});
}

TEST_F(BadData, AFolder) { expect_refused({"."}, {".", "expected", "found"}); }

TEST_F(BadData, NoMaterial) {
  write_image("a.nrrd", 4, [](std::size_t i) { return static_cast<float>(i) + 0.5f; });
  const std::vector<std::string> parts{"a.nrrd", "expected", "Volume Fraction", "found"};
  expect_failure({"resample", "a.nrrd", "-o", "m.vtu"}, parts);
  expect_failure({"reconstruct", "a.nrrd", "-o", "r.vtp"}, parts);
  expect_failure({"probe", "a.nrrd", "--point", "1,1,1", "-o", "p.csv"}, parts);
  // A slice shows plain values too, but not where materials are asked for.
  run_well({"slice", "a.nrrd", "--plane", "x=1", "-o", "s.png"});
  expect_failure({"slice", "a.nrrd", "--rest", "b", "--plane", "x=1", "-o", "s2.png"}, parts);
}

TEST_F(BadData, UnknownArrays) {
  make_scene("sphere");
  expect_refused({"scene.vtr", "--fraction", "a=nothing"}, {"scene.vtr", "'nothing'", "expected", "found"});
  expect_refused({"scene.vtr", "--extensive", "nothing"}, {"scene.vtr", "nothing", "expected"});
  expect_failure({"resample", "scene.vtr", "-o", "m.vtu", "--field-error", "nothing=1"},
                 {"scene.vtr", "expected", "'mixed smooth'", "found 'nothing'"});
  expect_failure({"slice", "scene.vtr", "--plane", "x=0.5", "-o", "s.png", "--field", "nothing"},
                 {"scene.vtr", "expected", "mixed smooth", "found 'nothing'"});
}

TEST_F(BadData, FractionsThatDoNotAddUp) {
  write_image("a.nrrd", 4, [](std::size_t) { return 0.3f; });
  write_image("b.nrrd", 4, [](std::size_t i) { return i == 37 ? 0.2f : 0.7f; });
  expect_refused({"a.nrrd", "--fraction", "a=a.nrrd", "--fraction", "b=b.nrrd"},
                 {"a.nrrd", "expected a sum of 1", "found 0.5", "(1, 1, 2)"});
}

TEST_F(BadData, FractionsThatAreNoNumbers) {
  write_image("a.nrrd", 4,
              [](std::size_t i) { return i == 11 ? std::numeric_limits<float>::quiet_NaN() : 1.0f; });
  expect_refused({"a.nrrd", "--fraction", "a=a.nrrd", "--rest", "b"},
                 {"a.nrrd", "expected a number", "nan", "(3, 2, 0)"});
}

TEST_F(BadData, NegativeFractionsAreMendedOrRefused) {
  write_image("a.nrrd", 4, [](std::size_t i) { return i == 5 ? -0.01f : i < 32 ? 1.0f : 0.0f; });
  write_image("b.nrrd", 4, [](std::size_t i) { return i == 5 ? 1.01f : i < 32 ? 0.0f : 1.0f; });
  const RunResult mended =
      run({"reconstruct", "a.nrrd", "--fraction", "a=a.nrrd", "--fraction", "b=b.nrrd", "-o", "r.vtp"});
  EXPECT_EQ(mended.status, 0);
  EXPECT_EQ(
      mended.err,
      "adamas: note: a.nrrd and 1 more file: volume fractions were mended: 1 site scaled to 1, 1 negative "
      "fraction set to 0\n");
  write_image("a.nrrd", 4, [](std::size_t i) { return i == 5 ? -0.5f : 1.0f; });
  expect_refused({"a.nrrd", "--fraction", "a=a.nrrd", "--fraction", "b=b.nrrd"},
                 {"a.nrrd", "expected a sum of 1", "found"});
}

TEST_F(BadData, FieldsOfOtherLength) {
  write_image("a.nrrd", 4, [](std::size_t i) { return i < 32 ? 1.0f : 0.0f; });
  write_image("f.nrrd", 5, [](std::size_t) { return 1.0f; });
  expect_refused({"a.nrrd", "--fraction", "a=a.nrrd", "--rest", "b", "--field", "f=f.nrrd"},
                 {"f.nrrd", "expected the grid of a.nrrd", "4", "found 5"});
}

TEST_F(BadData, FieldsThatAreNoNumbers) {
  write_image("a.nrrd", 4, [](std::size_t i) { return i < 32 ? 1.0f : 0.0f; });
  write_image("f.nrrd", 4,
              [](std::size_t i) { return i == 9 ? std::numeric_limits<float>::infinity() : 1.0f; });
  expect_refused({"a.nrrd", "--fraction", "a=a.nrrd", "--rest", "b", "--field", "f=f.nrrd"},
                 {"a.nrrd", "'f'", "expected finite values", "inf", "9"});
}

TEST_F(BadData, DomainsWithoutVolume) {
  write_image("a.nrrd", 1, [](std::size_t) { return 1.0f; });
  expect_refused({"a.nrrd", "--fraction", "a=a.nrrd", "--rest", "b"}, {"a.nrrd", "expected", "found"});
  const std::string head =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 3 3\nX_COORDINATES 3 "
      "float\n";
  const std::string tail =
      "\nY_COORDINATES 3 float\n0 1 2\nZ_COORDINATES 3 float\n0 1 2\nCELL_DATA 8\n"
      "SCALARS volume_fraction_a float 1\nLOOKUP_TABLE default\n1 1 1 1 1 1 1 1\n";
  write("inverted.vtk", head + "2 1 0" + tail);
  expect_refused({"inverted.vtk"}, {"inverted.vtk", "expected ascending coordinates along x", "found"});
  write("flat.vtk", head + "1 1 1" + tail);
  expect_refused({"flat.vtk"}, {"flat.vtk", "expected ascending coordinates along x", "found"});
}

TEST_F(BadData, RegionsOutside) {
  make_scene("sphere");
  expect_refused({"scene.vtr", "--region", "5,6,5,6,5,6"}, {"scene.vtr", "expected", "found"});
}

TEST_F(BadData, PointsFiles) {
  make_scene("sphere");
  write("p.csv", "x,y,z\n0.5,0.5,0.5\n0.5,oops,0.5\n");
  expect_failure({"probe", "scene.vtr", "--points-file", "p.csv", "-o", "o.csv"},
                 {"p.csv:3", "expected", "oops"});
  write("p.csv", "x,y,z\n");
  expect_failure({"probe", "scene.vtr", "--points-file", "p.csv", "-o", "o.csv"},
                 {"p.csv", "expected", "found none"});
  expect_failure({"probe", "scene.vtr", "--points-file", "none.csv", "-o", "o.csv"}, {"none.csv"});
}

TEST_F(BadData, PointsFilesOfSpreadsheets) {
  make_scene("sphere");
  const std::string values = run_well({"probe", "scene.vtr", "--point", "0.25,0.5,0.5"}).out;
  for (const std::string content : {"\xEF\xBB\xBF"
                                    "0.25,0.5,0.5\n",
                                    "\xEF\xBB\xBFx;y;z\r\n0.25;0.5;0.5;7\r\n", "+0.25 0.5\t0.5\n",
                                    "# where\n\n\"x\",\"y\",\"z\"\n .25 , 5e-1, 0.5\n"}) {
    write("p.csv", content);
    EXPECT_EQ(run_well({"probe", "scene.vtr", "--points-file", "p.csv"}).out, values) << content;
  }
  // A decimal comma would make three numbers of one, and a bad first line would be taken for names.
  for (const std::string line :
       {"0,25;0,5;0,5", "0,25 0,5 0,5", ".5,oops,.5", "nan,0,0", "-,1,2", "1,,2,3"}) {
    write("p.csv", line + "\n0.5,0.5,0.5\n");
    expect_failure({"probe", "scene.vtr", "--points-file", "p.csv", "-o", "o.csv"},
                   {"p.csv:1", "expected", line});
  }
}

TEST_F(BadData, MendedFractionsAreNotedByAll) {
  write_image("a.nrrd", 4, [](std::size_t i) { return i == 5 ? 0.98f : i < 32 ? 1.0f : 0.0f; });
  write_image("b.nrrd", 4, [](std::size_t i) { return i < 32 ? 0.0f : 1.0f; });
  const std::vector<std::string> input{"a.nrrd", "--fraction", "a=a.nrrd", "--fraction", "b=b.nrrd"};
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"info"}, {"slice", "--plane", "x=1", "-o", "s.png"}, {"probe"}}) {
    auto all = command;
    all.insert(all.begin() + 1, input.begin(), input.end());
    EXPECT_EQ(
        run(all).err,
        "adamas: note: a.nrrd and 1 more file: volume fractions were mended: 1 site scaled to 1 (sums from "
        "0.98 to 1)\n");
  }
}

TEST_F(BadData, NamesOfFieldsAreExact) {
  make_scene("sphere", 6);
  expect_failure({"resample", "scene.vtr", "-o", "m.vtu", "--field-error", "Smooth=1"}, {"found 'Smooth'"});
  expect_failure({"slice", "scene.vtr", "--plane", "x=0.5", "-o", "s.png", "--field", "Smooth"},
                 {"found 'Smooth'"});
  expect_failure({"probe", "scene.vtr", "--extensive", "Smooth", "-o", "p.csv", "--point", "0.5,0.5,0.5"},
                 {"Smooth"});
  expect_failure({"slice", "scene.vtr", "--plane", "x=0.5", "-o", "s.png", "--field", "smooth:3"},
                 {"'smooth' alone, which has no components", "'smooth:3'"});
  // Fields are checked before the interfaces are reconstructed.
  const RunResult late =
      run({"resample", "scene.vtr", "-o", "m.vtu", "--field-error", "nothing=1", "--verbose"});
  EXPECT_EQ(late.err.find("reconstructing"), std::string::npos) << late.err;
}

TEST_F(BadData, OriginalsOfOtherMeshes) {
  make_scene("sphere", 6);
  run_well({"resample", "scene.vtr", "--interface-error", "5%", "-o", "m.vtu"});
  run_well({"generate", "scene", "tjunction", "--dimensions", "6", "-o", "other.vtr"});
  run_well({"generate", "scene", "sphere", "--dimensions", "6", "--box", "0,1,0,1,0,2", "-o", "tall.vtr"});
  const std::vector<std::string> slice{"slice", "m.vtu", "--plane", "z=0.5", "-o", "s.png", "--original"};
  const auto with = [&slice](const std::string& original) {
    auto all = slice;
    all.push_back(original);
    return all;
  };
  expect_failure(with("other.vtr"),
                 {"other.vtr", "expected the materials of the mesh (outside, inside)", "found 'a'"});
  expect_failure(with("tall.vtr"),
                 {"tall.vtr", "expected the box of m.vtu", "found [0, 1] x [0, 1] x [0, 2]"});
}

TEST_F(BadData, PlanesBesideTheDomain) {
  make_scene("sphere");
  run_well({"resample", "scene.vtr", "--interface-error", "5%", "-o", "m.vtu"});
  expect_failure({"slice", "m.vtu", "--plane", "x=7", "-o", "s.png"}, {"m.vtu", "expected a plane", "x=7"});
  expect_failure({"slice", "scene.vtr", "--plane", "x=7", "-o", "s.png"}, {"scene.vtr", "expected", "x=7"});
}

}  // namespace

}  // namespace adamas::test
