// Tests interface meshes that cannot be used.

#include "program.h"

namespace adamas::test {

namespace {

/// Returns a tetrahedron with outward normals, moved along x.
std::string tetrahedron(double x, int first = 1) {
  const auto at = [x](double a, const char* rest) { return "v " + std::to_string(x + a) + rest; };
  std::string text = at(0, " 0 0\n") + at(1, " 0 0\n") + at(0, " 1 0\n") + at(0, " 0 1\n");
  const auto face = [first](int a, int b, int c) {
    return "f " + std::to_string(first + a) + " " + std::to_string(first + b) + " " +
           std::to_string(first + c) + "\n";
  };
  return text + face(0, 2, 1) + face(0, 1, 3) + face(0, 3, 2) + face(1, 2, 3);
}

class BadInterfaces : public ProgramTest {
 protected:
  void expect_refused(const std::string& file, const std::vector<std::string>& parts) const {
    expect_failure({"resample", "--interface", file + "=air,metal", "-o", "m.vtu", "--json", "j.json"},
                   parts);
  }
};

TEST_F(BadInterfaces, SoundOnesWork) {
  write("t.obj", tetrahedron(0));
  run_well({"resample", "--interface", "t.obj=air,metal", "-o", "m.vtu", "--json", "j.json",
            "--interface-error", "2%"});
  const auto figures = read_json("j.json");
  ASSERT_EQ(figures["materials"].size(), 2u);
  for (const auto& material : figures["materials"]) {
    const double truth = material["name"] == "metal" ? 1.0 / 6 : 1.1 * 1.1 * 1.1 - 1.0 / 6;
    EXPECT_NEAR(material["volume_input"].get<double>(), truth, 1e-9);
    if (material["name"] == "metal") {
      EXPECT_NEAR(material["volume_mesh"].get<double>(), 1.0 / 6, 0.02);
    } else {
      EXPECT_NEAR(material["volume_mesh"].get<double>(), 1.1 * 1.1 * 1.1 - 1.0 / 6, 0.02);
    }
  }
  EXPECT_LE(figures["interface_error"].get<double>(), figures["interface_error_target"].get<double>());
}

TEST_F(BadInterfaces, MissingAndEmpty) {
  expect_refused("none.obj", {"none.obj"});
  write("empty.obj", "");
  expect_refused("empty.obj", {"empty.obj", "empty"});
  write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  expect_refused("points.obj", {"points.obj", "expected", "found"});
  write("t.dat", tetrahedron(0));
  expect_refused("t.dat", {"t.dat", "expected a surface", "found"});
}

TEST_F(BadInterfaces, WithoutArea) {
  write("line.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n");
  expect_refused("line.obj", {"line.obj", "expected triangles with an area", "found none"});
}

TEST_F(BadInterfaces, NonManifold) {
  write("fin.obj", tetrahedron(0) + "v 2 2 2\nf 1 2 5\n");
  expect_refused("fin.obj", {"fin.obj", "expected the same material", "found"});
}

TEST_F(BadInterfaces, SelfIntersecting) {
  write("two.obj", tetrahedron(0) + tetrahedron(0.2, 5));
  expect_refused("two.obj", {"two.obj", "expected triangles that meet at common points only", "found"});
}

TEST_F(BadInterfaces, BadlyOriented) {
  // Where half of the faces have each orientation, neither can be called the right one.
  std::string text = tetrahedron(0);
  text.replace(text.find("f 2 3 4"), 7, "f 2 4 3");
  std::string half = text;
  half.replace(half.find("f 1 2 4"), 7, "f 1 4 2");
  write("half.obj", half);
  expect_refused("half.obj", {"half.obj", "turned the wrong way", "found", "--tolerant"});
  // One of four faces is turned back, so that the volume is the tetrahedron's.
  write("turned.obj", text);
  const RunResult result = run({"probe", "--interface", "turned.obj=air,metal", "--json", "j.json"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(
      result.err,
      "adamas: note: turned.obj: triangles turned that faced the other way than their neighbours: 1, the "
      "first at (0.333333, 0.333333, 0.333333)\n");
  EXPECT_NEAR(read_json("j.json").at("materials")[1].at("volume").get<double>(), 1.0 / 6, 1e-12);
}

TEST_F(BadInterfaces, TrianglesOnTheSamePoints) {
  const std::string once = tetrahedron(0);
  write("twice.obj", once + "f 2 3 4\n");
  const RunResult twice = run({"probe", "--interface", "twice.obj=air,metal", "--json", "j.json"});
  EXPECT_EQ(twice.status, 0) << twice.err;
  EXPECT_EQ(twice.err,
            "adamas: note: twice.obj: triangles that are there twice, which count once: 1, the first at "
            "(0.333333, 0.333333, 0.333333)\n");
  EXPECT_NEAR(read_json("j.json").at("materials")[1].at("volume").get<double>(), 1.0 / 6, 1e-12);
  write("opposite.obj", once + "f 2 4 3\n");
  expect_refused("opposite.obj", {"opposite.obj", "expected one triangle on the three points round (0.333333",
                                  "found opposite faces, 3: ", "4: ", "--tolerant"});
  const RunResult taken = run({"probe", "--interface", "opposite.obj=air,metal", "--tolerant"});
  EXPECT_EQ(taken.status, 0) << taken.err;
  EXPECT_NE(taken.err.find("opposite faces, which cancel each other: 2, the first at"), std::string::npos)
      << taken.err;
}

TEST_F(BadInterfaces, SmallGapsAreClosed) {
  // The last face has corners of its own, displaced by 1e-7.
  std::string text = tetrahedron(0);
  text.replace(text.find("f 2 3 4"), 7, "v 1.0000001 0 0\nv 0 1 0.0000001\nv 0 0 1\nf 5 6 7");
  write("crack.obj", text);
  const std::vector<std::string> probe{"probe", "--interface", "crack.obj=air,metal", "--json", "j.json"};
  const RunResult closed = run(probe);
  EXPECT_EQ(closed.status, 0) << closed.err;
  EXPECT_EQ(closed.err.find("adamas: note: crack.obj: points welded to others close by: 2, the first at "),
            0u)
      << closed.err;
  EXPECT_NEAR(read_json("j.json").at("materials")[1].at("volume").get<double>(), 1.0 / 6, 1e-6);
  const auto with_weld = [&](const std::string& width) {
    std::vector<std::string> arguments = probe;
    arguments.insert(arguments.end(), {"--weld", width});
    return arguments;
  };
  for (const std::string width : {"0", "1e-8", "1e-7%"}) {
    const RunResult open = run(with_weld(width));
    EXPECT_EQ(open.status, 0) << open.err;
    EXPECT_NE(open.err.find("edges are open borders"), std::string::npos) << open.err;
  }
  EXPECT_EQ(run(with_weld("0.001%")).err, closed.err);
  for (const std::string width : {"-1", "nan", "a", "50%", "1"})
    expect_wrong_usage(with_weld(width), {"--weld", "expected", width});
  make_scene("sphere");
  expect_wrong_usage({"resample", "scene.vtr", "--weld", "1%", "-o", "m.vtu"},
                     {"--weld", "given interfaces"});
}

TEST_F(BadInterfaces, OpenOnesAreNoted) {
  std::string text = tetrahedron(0);
  text.erase(text.find("f 2 3 4"));
  write("open.obj", text);
  const RunResult result =
      run({"resample", "--interface", "open.obj=air,metal", "--max-tetrahedra", "500", "-o", "m.vtu"});
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_NE(result.err.find("adamas: note: open.obj: 3 edges are open borders"), std::string::npos)
      << result.err;
}

TEST_F(BadInterfaces, MaterialsOfTheOption) {
  write("t.obj", tetrahedron(0));
  for (const std::string pair : {"air", "air,air", ",metal", "air,"}) {
    expect_wrong_usage({"resample", "--interface", "t.obj=" + pair, "-o", "m.vtu"},
                       {"--interface", "expected"});
  }
  expect_wrong_usage({"resample", "--interface", "t.obj", "-o", "m.vtu"},
                     {"--interface", "expected", "t.obj"});
  make_scene("sphere");
  expect_failure({"resample", "scene.vtr", "--interface", "t.obj=air,inside", "-o", "m.vtu"},
                 {"t.obj", "expected the materials of scene.vtr (outside, inside)", "found 'air'"});
}

TEST_F(BadInterfaces, Boxes) {
  write("t.obj", tetrahedron(0));
  for (const std::string box : {"0,0,0,1,0,1", "1,0,0,1,0,1", "0,1,0,1,0", "0,1,0,1,0,nan", "a"}) {
    expect_wrong_usage({"resample", "--interface", "t.obj=air,metal", "--box", box, "-o", "m.vtu"},
                       {"--box", "expected", box});
  }
}

TEST_F(BadInterfaces, BesideTheDomain) {
  write("t.obj", tetrahedron(0));
  expect_failure({"resample", "--interface", "t.obj=air,metal", "--box", "5,6,5,6,5,6", "-o", "m.vtu"},
                 {"t.obj", "expected interfaces inside the box [5, 6]", "found them in [0, 1]"});
  // The interfaces surround the domain, and none is in it.
  expect_failure(
      {"resample", "--interface", "t.obj=air,metal", "--box", "0.1,0.2,0.1,0.2,0.1,0.2", "-o", "m.vtu"},
      {"expected interfaces inside the box"});
}

TEST_F(BadInterfaces, Networks) {
  write("cut.arec", "4\n0 0 0\n1 0 0\n0 1 0\n");
  expect_failure({"resample", "cut.arec", "-o", "m.vtu"}, {"cut.arec", "expected"});
  write("index.arec", "3\n0 0 0\n1 0 0\n0 1 0\n1\n0 1 7 0 1\n");
  expect_failure({"resample", "index.arec", "-o", "m.vtu"}, {"index.arec", "expected", "7"});
}

}  // namespace

}  // namespace adamas::test
