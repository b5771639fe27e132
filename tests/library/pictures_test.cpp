#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "adamas/generate.h"
#include "adamas/reconstruct.h"
#include "adamas/turning_picture.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

using test::Scratch;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Interfaces of a scene, and the bytes of their pictures.
class Pictures : public testing::Test {
 protected:
  Pictures() { small_.width = small_.height = 200; }

  std::string drawn(const DrawingOptions& options, const char* name = "a.png") {
    write_picture(scratch_ / name, interfaces_, options);
    return bytes_of(scratch_ / name);
  }

  const Scratch scratch_;
  const GeneratedScene scene_ = generate_scene("voronoi10", {8, 8, 8});
  const InterfaceTriangles interfaces_ = reconstruct(scene_.data.view()).mesh;
  DrawingOptions small_;
};

TEST_F(Pictures, ShowWhatOptionsSay) {
  const std::string all = drawn(small_);
  EXPECT_EQ(drawn(small_), all);
  DrawingOptions other = small_;
  other.shown = {{interfaces_.materials[0]}};
  const std::string of_one = drawn(other);
  EXPECT_NE(of_one, all);
  other.shown = {{interfaces_.materials[0], interfaces_.materials[1]}};
  EXPECT_NE(drawn(other), of_one);
  for (const auto& change : std::vector<std::function<void(DrawingOptions&)>>{
           [](DrawingOptions& options) { options.projection = Projection::kOrthographic; },
           [](DrawingOptions& options) {
             options.direction = {1, 0, 0};
           },
           [](DrawingOptions& options) {
             options.focus = Box3{{0, 0, 0}, {0.5, 0.5, 0.5}};
           },
           [](DrawingOptions& options) {
             options.domain = Box3{{0, 0, 0}, {1, 1, 1}};
           },
           [](DrawingOptions& options) { options.triangle_edges = true; }}) {
    other = small_;
    change(other);
    EXPECT_NE(drawn(other), all);
  }
}

TEST_F(Pictures, RefuseWhatCannotBeShown) {
  const auto refused = [this](const DrawingOptions& options, const std::string& expected) {
    EXPECT_NE(test::error_of([&] { drawn(options); }).find(expected), std::string::npos) << expected;
  };
  DrawingOptions wrong = small_;
  wrong.shown = {{"steel"}};
  refused(wrong, "--show-interface: expected materials of '" + interfaces_.materials[0] + "'");
  EXPECT_NE(test::error_of([&] {
              check_shown_interfaces(wrong.shown, {"a"}, "b.vtr");
            }).find("b.vtr: --show-interface: expected materials of 'a', found 'steel'"),
            std::string::npos);
  wrong.shown = {{"a", "a"}};
  refused(wrong, "expected A or 'A|B' with two materials, found 'a|a'");
  wrong = small_;
  wrong.direction = {};
  refused(wrong, "--direction: expected a vector with a length, found 0");
  wrong = small_;
  wrong.height = 100;
  refused(wrong, "--size: expected a width and a height from 200 to 8000, found '200,100'");
}

TEST_F(Pictures, ThatTurnShowFieldsOfAMesh) {
  const AdaptiveMesh mesh = resample(scene_.data.view(), {.interface_error = 0.2});
  write_picture(scratch_ / "a.html", mesh.interfaces(), mesh);
  EXPECT_NE(bytes_of(scratch_ / "a.html").find("\"smooth"), std::string::npos);
  write_picture(scratch_ / "with.png", interfaces_, mesh, small_);
  EXPECT_EQ(bytes_of(scratch_ / "with.png"), drawn(small_));
}

TEST_F(Pictures, OfIsosurfacesHaveTheirColours) {
  TriangleSurface surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  surface.triangles = {{0, 1, 2}, {3, 4, 5}};
  write_picture(scratch_ / "one.png", surface, {"a.adm", {1}, {2}}, small_);
  write_picture(scratch_ / "two.png", surface, {"a.adm", {1, 2}, {1, 2}}, small_);
  EXPECT_NE(bytes_of(scratch_ / "one.png"), bytes_of(scratch_ / "two.png"));
  EXPECT_NE(test::error_of([&] {
              write_picture(scratch_ / "x.png", surface, {"a.adm", {1, 2}, {2}}, small_);
            }).find("expected the ends of 2 isosurfaces, found 1"),
            std::string::npos);
}

}  // namespace
}  // namespace adamas
