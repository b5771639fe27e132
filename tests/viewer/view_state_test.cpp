#include "viewer/contents/view_state.h"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "core/base/error.h"
#include "tests/support/scratch.h"
#include "viewer/session/remembered_states.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;
using namespace viewer;

namespace {

ViewState some_state() {
  ViewState state;
  state.viewpoint.eye = {1.25, -3, 1e-7};
  state.viewpoint.up = {0, 0, 1};
  state.viewpoint.height = 2.5;
  state.camera_mode = CameraMode::kFly;
  state.shading = Shading::kSphere;
  state.colour_map = "cool-warm";
  state.has_edges = true;
  state.has_axes = false;
  state.pixels = 0.75;
  state.max_triangles = 123'456;
  state.frame_milliseconds = 16.5;
  state.cut = {true, {{1, 2, 3}, {0, 1, -1}}, false, true};
  state.bookmarks = {{"from \"above\"", state.viewpoint}, {"", Viewpoint{}}};
  DocumentState store, mesh;
  store.surfaces = {{80.5, {0.1, 0.2, 0.3}, 0.4, true}, {-1e5, {1, 1, 1}, 1, false}};
  mesh.hidden = {"air", "caf\xc3\xa9"};
  mesh.field = "velocity:1";
  mesh.range = {-2, 5.5};
  state.documents = {store, mesh};
  state.has_time = false;
  state.pace.steps_per_second = 4.5;
  state.pace.repeat = Repeat::kOnce;
  state.pace.is_backward = true;
  return state;
}

TEST(ViewState, IsTheSameAfterItsText) {
  const ViewState state = some_state(), again = view_state(to_text(state), "state");
  EXPECT_EQ(to_text(again), to_text(state));
  EXPECT_EQ(again.frame_milliseconds, 16.5);
  EXPECT_FALSE(again.has_time);
  EXPECT_EQ(again.pace, state.pace);
  EXPECT_EQ(again.documents, state.documents);
  EXPECT_EQ(again.viewpoint.eye, state.viewpoint.eye);
  EXPECT_EQ(again.bookmarks[0].name, state.bookmarks[0].name);
  EXPECT_EQ(again.cut.plane.normal, state.cut.plane.normal);
}

TEST(ViewState, OlderTextsSayNothingOfTimeAndPace) {
  nlohmann::json text = nlohmann::json::parse(to_text(some_state()));
  for (const char* key : {"time", "pace"}) ASSERT_EQ(text.erase(key), 1u);
  const ViewState old = view_state(text.dump(), "state");
  EXPECT_TRUE(old.has_time);
  EXPECT_EQ(old.pace, StepPace{});
  EXPECT_EQ(old.max_triangles, some_state().max_triangles);
}

TEST(ViewState, OtherTextsAreRefusedInALine) {
  const std::string good = to_text(some_state());
  const auto failure = [](const std::string& text) -> std::string {
    try {
      view_state(text, "s.json");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(failure("").find("s.json: expected a state"), std::string::npos);
  EXPECT_NE(failure("[1]").find("expected a state"), std::string::npos);
  EXPECT_NE(failure("{}").find("expected 'viewpoint'"), std::string::npos);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return failure(text.replace(at, from.size(), to));
  };
  EXPECT_NE(with("\"fly\"", "\"swim\"").find("unknown word \"swim\""), std::string::npos);
  EXPECT_NE(with("\"cool-warm\"", "\"rainbow\"").find("rainbow"), std::string::npos);
  EXPECT_NE(with("123456", "-4").find("max_triangles"), std::string::npos);
  EXPECT_NE(with("16.5", "-1").find("frame_milliseconds"), std::string::npos);
  EXPECT_NE(with("4.5", "0").find("speed: expected a number from 0.5 to 60"), std::string::npos);
  EXPECT_NE(with("\"once\"", "\"twice\"").find("unknown word \"twice\""), std::string::npos);
  EXPECT_NE(with("0.75", "1e999").find("s.json"), std::string::npos);
  EXPECT_NE(with("\"edges\": true", "\"edges\": 1").find("expected true or false"), std::string::npos);
  // Messages show what was found in a few words, however long and deep it is.
  const std::string many = std::string(100'000, '['), ends = std::string(100'000, ']');
  EXPECT_NE(with("\"fly\"", many + ends).find("expected lists within each other up to"), std::string::npos);
  const std::string list = "[" + fmt::format("{}", fmt::join(std::vector<int>(100'000, 7), ",")) + "]";
  EXPECT_NE(with("16.5", list).find("found a list of 100000"), std::string::npos);
  EXPECT_LT(with("\"fly\"", "\"" + std::string(100'000, 'x') + "\"").size(), 200u);
  // A text that is cut off, or changed anywhere, leads to an error or another state, never to a crash.
  for (std::size_t end = 0; end + 2 < good.size(); ++end) EXPECT_NE(failure(good.substr(0, end)), "") << end;
  std::mt19937 random(11);
  for (int n = 0; n < 2000; ++n) {
    std::string text = good;
    text[random() % text.size()] = static_cast<char>(random() % 256);
    failure(text);
  }
}

TEST(RememberedStates, AreThoseOfTheSameFiles) {
  const test::Scratch folder;
  const std::filesystem::path memory = folder / "deep" / "view.json";
  EXPECT_FALSE(remembered_state(memory, {"a"}));
  ViewState state = some_state();
  remember_state(memory, {"a"}, state);
  state.pixels = 3;
  remember_state(memory, {"a", "b"}, state);
  EXPECT_EQ(remembered_state(memory, {"a"})->pixels, 0.75);
  EXPECT_EQ(remembered_state(memory, {"./x/../a", "b"})->pixels, 3);
  EXPECT_FALSE(remembered_state(memory, {"b", "a"}));
  state.pixels = 4;
  remember_state(memory, {"a"}, state);
  EXPECT_EQ(remembered_state(memory, {"a"})->pixels, 4);
  for (int n = 0; n < 60; ++n) remember_state(memory, {std::to_string(n)}, state);
  EXPECT_FALSE(remembered_state(memory, {"a", "b"})) << "the oldest ones are forgotten";
  EXPECT_TRUE(remembered_state(memory, {"59"}));
  std::ofstream(memory) << std::string(100'000, '[') << std::string(100'000, ']');
  EXPECT_FALSE(remembered_state(memory, {"a"}));
  std::ofstream(memory) << "[{\"files\": 3}, 7, {\"files\": [\"a\"], \"state\": {}}]";
  EXPECT_FALSE(remembered_state(memory, {"a"}));
  remember_state(memory, {"a"}, state);
  EXPECT_TRUE(remembered_state(memory, {"a"}));
}

}  // namespace
}  // namespace adamas
