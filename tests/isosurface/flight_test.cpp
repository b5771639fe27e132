#include "isosurface/view/flight.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace isosurface;

namespace {

const Box3 kBox{{-1, 0, 2}, {3, 4, 10}};

TEST(Flight, OrbitsSeeAllOfTheBox) {
  for (const auto& [width, height] : {std::pair{800, 600}, std::pair{300, 900}}) {
    const std::vector<Viewpoint> all = flight(Orbit{7}, kBox, width, height);
    ASSERT_EQ(all.size(), 7u);
    for (const Viewpoint& viewpoint : all) {
      const View view(viewpoint);
      for (const Vec3& corner : kBox.corners()) EXPECT_TRUE(view.is_visible({corner, {}}));
      EXPECT_NEAR(distance(viewpoint.eye, viewpoint.target), distance(all[0].eye, all[0].target), 1e-9);
    }
  }
}

TEST(Flight, FilesHaveAViewpointOnEachLine) {
  const test::Scratch folder;
  const std::string path = (folder / "path.txt").string();
  std::ofstream(path) << "# eye, target, up\n1,2,3, 0 0 0, 0,0,1\n\n -4 5e0 6\t1,1,1 0 1 0 # the last\n";
  const std::vector<Viewpoint> all = flight(path, kBox, 640, 480);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(all[1].eye, (Vec3{-4, 5, 6}));
  EXPECT_EQ(all[1].target, (Vec3{1, 1, 1}));
  EXPECT_EQ(all[1].up, (Vec3{0, 1, 0}));
  EXPECT_EQ(all[1].width_pixels, 640);
}

std::string failure(const std::string& path) {
  try {
    flight(parse_camera_path(path), kBox, 640, 480);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Flight, TellsWhatIsWrong) {
  const test::Scratch folder;
  const std::string path = (folder / "path.txt").string();
  const auto file = [&](const std::string& text) {
    std::ofstream(path) << text;
    return failure(path);
  };
  EXPECT_NE(file("1 2 3 4\n").find("line 1: expected nine numbers, found 4"), std::string::npos);
  EXPECT_NE(file("\n1 2 3 0 0 0 0 x 1\n").find("line 2: expected nine finite numbers"), std::string::npos);
  EXPECT_NE(file("1 2 3 0 0 0 0 nan 1\n").find("finite"), std::string::npos);
  EXPECT_NE(file("1 2 3 1 2 3 0 0 1\n").find("not at the target"), std::string::npos);
  EXPECT_NE(file("# nothing\n").find("found none"), std::string::npos);
  EXPECT_NE(failure((folder / "none.txt").string()).find("no file that can be read"), std::string::npos);
  for (const char* orbit : {"orbit:", "orbit:0", "orbit:-1", "orbit:2x", "orbit:999999999999"})
    EXPECT_NE(failure(orbit).find("expected a number of frames"), std::string::npos) << orbit;
}

}  // namespace
}  // namespace adamas
