#include "adamas/play.h"

#include <gtest/gtest.h>

#include "adamas/generate.h"
#include "tests/support/scratch.h"

namespace adamas {
namespace {

/// A store of one step.
class PlayedStore : public testing::Test {
 protected:
  PlayedStore() {
    const Volume ball = generate_buckyball({24, 24, 24});
    VolumeStore::build(store_, ball.grid, ball.samples);
    options_.isovalue = 90;
  }

  const test::Scratch scratch_;
  const std::filesystem::path store_ = scratch_ / "ball.adm";
  PlayOptions options_;
};

TEST_F(PlayedStore, HasTheSurfaceOfEachFrame) {
  EXPECT_EQ(stored_steps(store_), 1u);
  options_.times = 3;
  options_.motion = true;
  const PlayReport all = play(store_, options_);
  ASSERT_EQ(all.frames.size(), 3u);
  EXPECT_EQ(all.file_bytes, std::filesystem::file_size(store_));
  EXPECT_TRUE(all.damaged_steps.empty());
  EXPECT_EQ(all.motion->transitions, 2u);
  const Isosurface surface = VolumeStore::open(store_).isosurface({.isovalue = 90, .plain = true});
  for (const PlayedFrame& frame : all.frames) {
    EXPECT_EQ(frame.triangles, surface.surface.triangles.size());
    EXPECT_EQ(frame.largest_error, 0);
  }
  EXPECT_EQ(all.frames[1].motion->certified, 0);
  options_.error = ErrorTarget(1, ErrorTarget::Unit::kVoxels);
  const PlayReport coarse = play(store_, options_);
  EXPECT_LT(coarse.frames[0].triangles, all.frames[0].triangles);
  EXPECT_LE(coarse.frames[0].largest_error, 1);
  options_.error.reset();
  options_.camera_path = Orbit{3};
  EXPECT_EQ(play(store_, options_).frames.size(), 3u);
}

TEST_F(PlayedStore, RefusesWhatContradictsItself) {
  const auto refused = [this](const std::string& expected) {
    EXPECT_NE(test::error_of([this] { play(store_, options_); }).find(expected), std::string::npos)
        << expected;
  };
  options_.pixels = 2;
  refused("--pixels: expected a --camera-path");
  options_.camera_path = Orbit{0};
  refused("orbit: expected a number of frames");
  options_ = {};
  options_.steps = {0, 1};
  refused("--steps: expected two of the 1 steps of " + store_.string());
  EXPECT_NE(test::error_of([this] { stored_steps(scratch_ / "none.adm"); }).find("none.adm"),
            std::string::npos);
}

}  // namespace
}  // namespace adamas
