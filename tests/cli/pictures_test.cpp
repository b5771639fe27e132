// Tests pictures of interfaces: the camera, the choice of interfaces, the colours of materials.

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "program.h"

namespace adamas::test {

namespace {

using Pixel = std::array<int, 3>;

struct Picture {
  int width = 0, height = 0;
  std::vector<Pixel> pixels;
};

/// Returns whether a pixel shows a surface: the page, lines and text have no colour.
bool coloured(const Pixel& p) {
  const auto [low, high] = std::minmax({p[0], p[1], p[2]});
  return high - low > 40;
}

/// Returns the hue as a number from 0 to 6, which shading changes little.
double hue(const Pixel& p) {
  const int high = std::max({p[0], p[1], p[2]}), range = high - std::min({p[0], p[1], p[2]});
  if (high == p[0]) return std::fmod(6 + static_cast<double>(p[1] - p[2]) / range, 6);
  if (high == p[1]) return 2 + static_cast<double>(p[2] - p[0]) / range;
  return 4 + static_cast<double>(p[0] - p[1]) / range;
}

class Pictures : public ProgramTest {
 protected:
  Pictures() { make_scene("voronoi10", 7); }

  [[nodiscard]] Picture picture(const std::string& name) const {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName((folder() / name).c_str());
    reader->Update();
    const vtkImageData* image = reader->GetOutput();
    Picture result;
    const int* n = const_cast<vtkImageData*>(image)->GetDimensions();
    result.width = n[0], result.height = n[1];
    for (int y = 0; y < n[1]; ++y) {
      for (int x = 0; x < n[0]; ++x) {
        Pixel pixel{};
        for (int c = 0; c < 3; ++c)
          pixel[static_cast<std::size_t>(c)] =
              static_cast<int>(const_cast<vtkImageData*>(image)->GetScalarComponentAsDouble(x, y, 0, c));
        result.pixels.push_back(pixel);
      }
    }
    return result;
  }
};

TEST_F(Pictures, AnInterfaceHasOneColourInInputAndMesh) {
  // The mesh is coarse, so that the volumes which its materials enclose differ from the input's.
  const RunResult result = run({"experiment", "scene.vtr", "--interface-error", "5%", "-o", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  run_well({"reconstruct", "scene.vtr", "-o", "r.vtp", "--picture", "r.png"});
  const Picture input = picture("out/input-interfaces.png"), mesh = picture("out/mesh-interfaces.png"),
                alone = picture("r.png");
  ASSERT_EQ(input.pixels.size(), mesh.pixels.size());
  std::size_t both = 0, differ = 0;
  for (std::size_t i = 0; i < input.pixels.size(); ++i) {
    if (!coloured(input.pixels[i]) || !coloured(mesh.pixels[i])) continue;
    ++both;
    const double apart = std::abs(hue(input.pixels[i]) - hue(mesh.pixels[i]));
    if (std::min(apart, 6 - apart) > 0.4) ++differ;
  }
  EXPECT_GT(both, input.pixels.size() / 8);
  // Near junctions the mesh differs from the input by its error.
  EXPECT_LT(differ, both / 10);
  // Both commands draw the same picture.
  EXPECT_EQ(input.pixels, alone.pixels);
}

TEST_F(Pictures, TheCameraAndTheChoiceOfInterfaces) {
  const auto draw = [this](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments{"reconstruct", "scene.vtr", "-o", "r.vtp", "--picture", name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--size") == more.end())
      arguments.insert(arguments.end(), {"--size", "320,240"});
    run_well(arguments);
    return picture(name);
  };
  const auto count = [](const Picture& p) {
    return std::count_if(p.pixels.begin(), p.pixels.end(), coloured);
  };
  const Picture all = draw("all.png", {});
  const Picture from_above = draw("above.png", {"--direction", "0,0,-1", "--projection", "orthographic"});
  EXPECT_NE(all.pixels, from_above.pixels);
  const Picture near = draw("near.png", {"--focus", "0.4,0.6,0.4,0.6,0.4,0.6"});
  EXPECT_GT(count(near), count(all));
  const Picture small = draw("small.png", {"--size", "280,210"});
  EXPECT_EQ(small.width, 280);
  EXPECT_EQ(small.height, 210);
  const Picture one = draw("one.png", {"--show-interface", "cell0"});
  EXPECT_LT(count(one), count(all));
  EXPECT_GT(count(one), 0);
  run_well({"resample", "scene.vtr", "--interface-error", "6%", "--picture", "mesh.svg", "--show-interface",
            "cell0 | cell1"});
  EXPECT_NE(read("mesh.svg").find("</svg>"), std::string::npos);

  const std::vector<std::string> draws{"reconstruct", "scene.vtr", "-o", "n.vtp"};
  const auto with = [&draws](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = draws;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect_failure(with({"--picture", "n.png", "--show-interface", "cell99"}),
                 {"scene.vtr", "--show-interface", "'cell0'", "'cell99'"});
  expect_wrong_usage(with({"--picture", "n.png", "--show-interface", "cell1|"}), {"--show-interface"});
  expect_wrong_usage(with({"--picture", "n.png", "--direction", "0,0,0"}), {"--direction", "length"});
  expect_wrong_usage(with({"--picture", "n.png", "--size", "4,4"}), {"--size"});
  expect_wrong_usage(with({"--direction", "0,0,1"}), {"--picture"});
  expect_wrong_usage(with({"--show-interface", "cell1"}), {"--show-interface", "--picture"});
}

}  // namespace
}  // namespace adamas::test
