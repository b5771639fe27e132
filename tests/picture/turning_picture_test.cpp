#include "core/picture/turning_picture.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/base/error.h"

namespace adamas {

using namespace picture;

namespace {

InterfacePicture two_triangles() {
  InterfacePicture picture;
  picture.title = "A <b>title</b> & more";
  picture.materials = {{"air </script><i>", {1, 0, 0}}, {"\"water\"\n", {0, 0, 1}}};
  picture.triangles = {{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {1, 0, 0}, Colour{0, 0, 1}},
                       {{{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {1, 0, 0}, Colour{0, 0, 1}}};
  picture.domain = {{0, 0, -1}, {1, 1, 1}};
  return picture;
}

TEST(TurningPicture, IsOnePageWithItsData) {
  const std::string page = turning_page(two_triangles());
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_NE(page.find("A &lt;b&gt;title"), std::string::npos);
  EXPECT_NE(page.find("\"front\":0,\"back\":1"), std::string::npos);
  // Two triangles share four points: 0 1 2 and 1 3 2.
  EXPECT_NE(page.find("\"triangles\":\"AAAAAAEAAAACAAAAAQAAAAMAAAACAAAA\""), std::string::npos);
  EXPECT_NE(page.find("\"box\":[[-0.5,-0.5,-1],[0.5,0.5,1]]"), std::string::npos);
  for (const char* script : {"THREE", "OrbitControls", "picture-data"})
    EXPECT_NE(page.find(script), std::string::npos) << script;
  EXPECT_EQ(page, turning_page(two_triangles()));
}

TEST(TurningPicture, NamesAreText) {
  const std::string page = turning_page(two_triangles());
  EXPECT_EQ(page.find("air </script>"), std::string::npos);
  EXPECT_NE(page.find("air \\u003c/script\\u003e\\u003ci\\u003e"), std::string::npos);
  EXPECT_NE(page.find("\\\"water\\\"\\u000a"), std::string::npos);
}

TEST(TurningPicture, TakesNothingAndRefusesWhatIsNotFinite) {
  InterfacePicture picture;
  EXPECT_NE(turning_page(picture).find("\"parts\":[]"), std::string::npos);
  picture = two_triangles();
  picture.triangles[0].points[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(turning_page(picture), Error);
}

}  // namespace
}  // namespace adamas
