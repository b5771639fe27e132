#include "viewer/session/view_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <thread>

#include "ball_store.h"
#include "core/base/error.h"
#include "isosurface/view/flight.h"
#include "tests/support/scratch.h"
#include "viewer/session/picking.h"
#include "viewer/window/key_bindings.h"
#include "viewer/window/window_input.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;
using namespace picture;
using namespace viewer;

namespace {

/// Returns the parts with chunks of the same style merged, so that each surface is one part.
std::vector<DrawnPart> together(const std::vector<DrawnPart>& parts) {
  std::vector<DrawnPart> result;
  std::shared_ptr<DrawnMesh> mesh;
  for (const DrawnPart& part : parts) {
    if (!mesh || part.mesh->is_lines || !(result.back().style == part.style)) {
      mesh = std::make_shared<DrawnMesh>(*part.mesh);
      result.push_back({mesh, part.style});
      continue;
    }
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    const Vec3 offset = part.mesh->origin - mesh->origin;
    for (DrawnMesh::Vertex vertex : part.mesh->vertices) {
      for (int axis = 0; axis < 3; ++axis)
        vertex.place[static_cast<std::size_t>(axis)] += static_cast<float>(offset[axis]);
      mesh->vertices.push_back(vertex);
    }
    for (const std::uint32_t index : part.mesh->indices) mesh->indices.push_back(first + index);
    mesh->box.extend(part.mesh->box.min);
    mesh->box.extend(part.mesh->box.max);
  }
  return result;
}

std::vector<SharedMesh> meshes_of(const std::vector<DrawnPart>& parts) {
  std::vector<SharedMesh> meshes;
  for (const DrawnPart& part : parts) meshes.push_back(part.mesh);
  return meshes;
}

/// A session on a store of a ball, whose surface at isovalue 100 has the radius 10 about (16, 16, 16).
class Sessions : public testing::Test {
 protected:
  void SetUp() override {
    path = (folder / "ball.adm").string();
    test::make_ball_store(path);
    session.open(path, {}, SilentProgress::instance());
    session.state().documents[0].surfaces[0].isovalue = 100;
    session.state().has_box = false;
  }
  std::vector<DrawnPart> finished() {
    session.finish();
    return together(session.parts());
  }
  static double greatest_radius(const DrawnMesh& mesh) {
    double most = 0;
    for (const auto& vertex : mesh.vertices)
      most = std::max(most, norm(mesh.origin + Vec3{vertex.place[0], vertex.place[1], vertex.place[2]} -
                                 Vec3{16, 16, 16}));
    return most;
  }

  test::Scratch folder;
  std::string path;
  ViewSession session{640, 480};
};

TEST_F(Sessions, ShowTheSurfaceOfTheStateOnceItIsFinished) {
  std::vector<DrawnPart> parts = finished();
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(greatest_radius(*parts[0].mesh), 10, 0.5);
  EXPECT_TRUE(session.report().is_current);
  EXPECT_EQ(session.report().problem, "");
  EXPECT_EQ(meshes_of(session.parts()), meshes_of(session.parts()))
      << "nothing is made anew for the same picture";
  DocumentState& state = session.state().documents[0];
  state.surfaces[0].isovalue = 150;
  EXPECT_NEAR(greatest_radius(*finished()[0].mesh), 5, 0.5);
  // There are several surfaces, and one is transparent.
  state.surfaces.push_back(state.surfaces[0]);
  state.surfaces[1].isovalue = 60;
  state.surfaces[1].opacity = 0.3;
  parts = finished();
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(greatest_radius(*parts[1].mesh), 14, 0.5);
  EXPECT_EQ(parts[1].style.opacity, 0.3);
  state.surfaces[0].is_shown = false;
  parts = finished();
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(greatest_radius(*parts[0].mesh), 14, 0.5);
  session.state().max_triangles = 300;
  EXPECT_LE(finished()[0].mesh->indices.size(), 900u);
}

TEST_F(Sessions, ComeToTheLastWishWhateverWasWishedBefore) {
  finished();
  SurfaceState& surface = session.state().documents[0].surfaces[0];
  for (int n = 0; n < 300; ++n) {
    // The isovalue changes to and fro, mostly before anything is found.
    surface.isovalue = n % 2 == 0 ? 60 : 140;
    session.parts();
    if (n % 7 != 0) continue;
    surface.isovalue = n % 3 == 0 ? 60 : 100;
    const double radius = (200 - surface.isovalue) / 10;
    EXPECT_NEAR(greatest_radius(*finished()[0].mesh), radius, 0.5);
    EXPECT_TRUE(session.report().is_current);
  }
}

TEST_F(Sessions, NormalsPointOutwardsAsTheTrianglesDo) {
  const DrawnMesh mesh = *finished()[0].mesh;
  const auto at = [&](std::uint32_t n) {
    const auto& p = mesh.vertices[n].place;
    return mesh.origin + Vec3{p[0], p[1], p[2]};
  };
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const Vec3 a = at(mesh.indices[t]), b = at(mesh.indices[t + 1]), c = at(mesh.indices[t + 2]);
    EXPECT_GE(dot(cross(b - a, c - a), a - Vec3{16, 16, 16}), -1e-9);
    const auto& n = mesh.vertices[mesh.indices[t]].normal;
    EXPECT_GT(dot(Vec3{n[0], n[1], n[2]}, a - Vec3{16, 16, 16}), 0);
  }
}

TEST_F(Sessions, OtherVolumesColourSurfaces) {
  ViewSession coloured(320, 240);
  coloured.open(path, {std::size_t{64} << 20, path}, SilentProgress::instance());
  DocumentState& state = coloured.state().documents[0];
  ASSERT_EQ(state.field, "ball.adm");
  state.surfaces[0].isovalue = 120;
  coloured.finish();
  const SharedMesh mesh = together(coloured.parts())[0].mesh;
  for (const auto& vertex : mesh->vertices) EXPECT_NEAR(vertex.front_value, 120, 3);
  const auto field = coloured.shown_field();
  ASSERT_TRUE(field);
  EXPECT_EQ(field->range, (std::array<double, 2>{0, 200}));
  coloured.act(Action::kField);
  EXPECT_FALSE(coloured.shown_field());
  EXPECT_FALSE(coloured.parts()[0].style.is_coloured_by_value);
  coloured.act(Action::kField);
  EXPECT_TRUE(coloured.shown_field());
}

TEST_F(Sessions, OpenBadFilesWithoutAnyChange) {
  std::ofstream(folder / "text.adm") << "no store";
  std::ofstream(folder / "text.xyz") << "nothing";
  const auto failure = [&](const std::string& name) -> std::string {
    try {
      session.open((folder / name).string(), {}, SilentProgress::instance());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(failure("none.adm").find("none.adm"), std::string::npos);
  EXPECT_NE(failure("text.adm").find("expected a store"), std::string::npos);
  EXPECT_NE(failure("text.xyz").find("text.xyz: expected a store (.adm), a resampled mesh"),
            std::string::npos);
  EXPECT_EQ(session.documents().size(), 1u);
  EXPECT_EQ(session.state().documents.size(), 1u);
  EXPECT_EQ(finished().size(), 1u);
}

TEST_F(Sessions, StoresThatAreCutOffWhileTheyAreOpenAreAProblemNotACrash) {
  session.finish();
  const auto before = session.parts();
  std::filesystem::resize_file(path, 200);
  session.state().documents[0].surfaces[0].isovalue = 30;
  session.finish();
  const auto after = session.parts();
  EXPECT_NE(session.report().problem, "");
  EXPECT_NE(session.report().problem.find("ball.adm"), std::string::npos) << session.report().problem;
  EXPECT_EQ(meshes_of(after), meshes_of(before)) << "what there was stays to be seen";
}

TEST_F(Sessions, ObliqueGridsLieInSpace) {
  // The grid is turned about z by a quarter of a turn, and in one case it is left-handed.
  for (const bool is_left_handed : {false, true}) {
    VolumeGrid grid;
    grid.origin = {100, 0, 0};
    grid.directions = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, is_left_handed ? -1.0 : 1.0}}};
    const std::string turned = (folder / (is_left_handed ? "l.adm" : "r.adm")).string();
    test::make_ball_store(turned, grid);
    ViewSession there(320, 240);
    there.open(turned, {}, SilentProgress::instance());
    there.state().documents[0].surfaces[0].isovalue = 100;
    there.state().has_box = false;
    there.finish();
    const Vec3 middle{100 - 16, 16, is_left_handed ? -16.0 : 16.0};
    const DrawnMesh mesh = *together(there.parts())[0].mesh;
    EXPECT_LT(distance(mesh.box.center(), middle), 0.5);
    const auto picked = there.pick(160, 120);
    ASSERT_TRUE(picked);
    EXPECT_NEAR(distance(picked->place, middle), 10, 0.3);
    const auto hit = pick(there.parts(), ray_through(there.state().viewpoint, 160, 120), std::nullopt);
    EXPECT_TRUE(hit->is_front) << "from outside one sees the outside";
  }
}

TEST_F(Sessions, KeepTheMeshOfAView) {
  session.act(Action::kCulledFrom);
  session.finish();
  const std::vector<SharedMesh> before = meshes_of(session.parts());
  session.state().viewpoint.eye = session.state().viewpoint.target + Vec3{0, 0, 11};
  session.state().viewpoint.up = {0, 1, 0};
  session.finish();
  const std::vector<SharedMesh> after = meshes_of(session.parts());
  EXPECT_TRUE(after.back()->is_lines) << "the view that is kept is shown as lines";
  EXPECT_EQ(after, before);
  session.act(Action::kCulledFrom);
  session.finish();
  EXPECT_NE(meshes_of(session.parts()), before);
}

TEST_F(Sessions, LeaveCoarseWhatAPictureHides) {
  const auto triangles = [&] {
    std::size_t sum = 0;
    for (const DrawnPart& each : finished()) sum += each.mesh->indices.size() / 3;
    return sum;
  };
  session.state().pixels = 0.3;
  const std::size_t all = triangles();
  session.act(Action::kHidden);
  EXPECT_TRUE(session.wants_depths());
  const Viewpoint& from = session.state().viewpoint;
  const double middle = distance(from.eye, {16, 16, 16});
  const auto wall = [&](double depth) {
    session.set_depths(
        std::make_shared<const DepthPyramid>(from, std::vector<float>(640 * 480, static_cast<float>(depth))));
    EXPECT_FALSE(session.wants_depths());
    return triangles();
  };
  EXPECT_EQ(wall(middle + 30), all) << "behind the ball";
  EXPECT_EQ(session.report().hidden, 0u);
  EXPECT_LT(wall(middle), all * 9 / 10) << "through its middle";
  EXPECT_LT(wall(middle - 60), all / 10) << "in front of it";
  EXPECT_GT(session.report().hidden, 0u);
  // For another surface, or another view, that wall hides nothing.
  session.state().documents[0].surfaces[0].isovalue = 101;
  EXPECT_GT(triangles(), all * 9 / 10);
  EXPECT_EQ(session.report().hidden, 0u);
  EXPECT_TRUE(session.wants_depths());
  session.act(Action::kHidden);
  EXPECT_FALSE(session.wants_depths());
}

TEST_F(Sessions, RestoreAStateForTheFilesThatAreOpen) {
  ViewState state = session.state();
  state.pixels = 7;
  state.documents.resize(3);
  state.documents[0].hidden = {"a material of another file"};
  state.documents[0].field = "no field";
  session.restore(state);
  EXPECT_EQ(session.state().pixels, 7);
  ASSERT_EQ(session.state().documents.size(), 1u);
  EXPECT_TRUE(session.state().documents[0].hidden.empty());
  EXPECT_EQ(session.state().documents[0].field, "");
  state.documents.clear();
  session.restore(state);
  EXPECT_EQ(session.state().documents[0].surfaces.size(), 1u) << "a store has a surface";
}

TEST_F(Sessions, PlayARecordedPath) {
  session.act(Action::kRecord);
  const Viewpoint first = session.state().viewpoint;
  for (int n = 0; n < 10; ++n) {
    session.advance(0.1);
    session.state().viewpoint.eye += Vec3{1, 0, 0};
  }
  session.act(Action::kRecord);
  ASSERT_EQ(session.path().size(), 10u);
  // The text of a path is read as a flight.
  std::ofstream(folder / "path.txt") << path_text(session.path());
  const auto flown = flight(folder / "path.txt", session.box(), 640, 480);
  ASSERT_EQ(flown.size(), 10u);
  EXPECT_EQ(flown[3].eye, session.path()[3].eye);
  session.act(Action::kPlay);
  session.advance(1.0 / 30);
  EXPECT_LT(distance(session.state().viewpoint.eye, first.eye + Vec3{1, 0, 0}), 0.2);
  for (int n = 0; n < 100 && session.is_playing(); ++n) session.advance(0.05);
  EXPECT_FALSE(session.is_playing()) << "it ends";
  EXPECT_LT(distance(session.state().viewpoint.eye, session.path().back().eye), 1e-9);
}

TEST_F(Sessions, EveryKeyDoesSomethingAndIsGivenOnce) {
  std::set<std::string_view> keys;
  std::set<Action> actions;
  for (const KeyBinding& binding : kKeyBindings) {
    EXPECT_TRUE(keys.insert(binding.key).second) << binding.key;
    EXPECT_TRUE(actions.insert(binding.action).second) << binding.what;
  }
  WindowInput input(session);
  session.state().bookmarks.push_back({"there", session.state().viewpoint});
  session.state().bookmarks.back().viewpoint.eye += Vec3{1, 1, 1};
  for (const KeyBinding& binding : kKeyBindings) {
    // Without this move a key might ask for the present view, and nothing would change.
    session.state().viewpoint.eye += Vec3{0.1, 0.2, 0.3};
    const auto all = [&] {
      return to_text(session.state()) + std::to_string(session.has_panels) +
             std::to_string(session.has_help) + std::to_string(session.wants_screenshot) +
             std::to_string(session.wants_end) + std::to_string(session.is_playing()) +
             std::to_string(session.is_recording()) + std::to_string(session.state().culled_from.has_value());
    };
    const std::string before = all();
    EXPECT_TRUE(input.key(binding.key));
    // The store has no fields, and only one step.
    constexpr std::array kIdle{Action::kField,       Action::kPreviousStep, Action::kNextStep,
                               Action::kFirstStep,   Action::kLastStep,     Action::kExportFilm,
                               Action::kExportFrames};
    if (std::ranges::find(kIdle, binding.action) != kIdle.end()) continue;
    EXPECT_NE(all(), before) << binding.key;
  }
  EXPECT_FALSE(input.key("F3"));
}

TEST_F(Sessions, MouseTurnsMovesZoomsAndPicks) {
  finished();
  WindowInput input(session);
  const Viewpoint first = session.state().viewpoint;
  const auto drag = [&](MouseButton button, bool has_shift) {
    session.state().viewpoint = first;
    input.press(button, has_shift, 320, 240);
    input.move(340, 250);
    input.move(350, 260);
    input.release(350, 260);
    return session.state().viewpoint;
  };
  const Viewpoint turned = drag(MouseButton::kLeft, false);
  EXPECT_EQ(turned.target, first.target);
  EXPECT_GT(distance(turned.eye, first.eye), 0.1);
  EXPECT_NEAR(distance(turned.eye, turned.target), distance(first.eye, first.target), 1e-9);
  const Viewpoint moved = drag(MouseButton::kLeft, true);
  EXPECT_LT(distance(moved.target - first.target, moved.eye - first.eye), 1e-9);
  EXPECT_LT(distance(drag(MouseButton::kMiddle, false).eye, moved.eye), 1e-9);
  EXPECT_EQ(drag(MouseButton::kRight, false).target, first.target);
  EXPECT_FALSE(input.picked()) << "a drag picks nothing";
  session.state().viewpoint = first;
  input.move(10, 10);
  EXPECT_EQ(session.state().viewpoint, first) << "no button is pressed";
  input.press(MouseButton::kLeft, false, 320, 240);
  input.release(320, 240);
  ASSERT_TRUE(input.picked());
  EXPECT_NEAR(distance(input.picked()->place, {16, 16, 16}), 10, 0.3);
  while (input.complete_picked()) std::this_thread::yield();
  ASSERT_TRUE(input.picked()->reading.value);
  EXPECT_NEAR(*input.picked()->reading.value, 100, 3);
  input.press(MouseButton::kLeft, false, 3, 3);
  input.release(3, 3);
  EXPECT_FALSE(input.picked()) << "there is nothing";
}

TEST_F(Sessions, TheHandleOfThePlaneIsDragged) {
  session.act(Action::kViewRight);
  session.act(Action::kCut);
  session.state().cut.plane.normal = {0, 1, 0};
  WindowInput input(session);
  const auto handle = in_picture(session.state().viewpoint, session.cut_handle());
  const Viewpoint before = session.state().viewpoint;
  input.press(MouseButton::kLeft, false, (*handle)[0] + 3, (*handle)[1]);
  input.move((*handle)[0] + 33, (*handle)[1] + 5);
  input.release((*handle)[0] + 33, (*handle)[1] + 5);
  EXPECT_EQ(session.state().viewpoint, before);
  const auto after = in_picture(session.state().viewpoint, session.cut_handle());
  EXPECT_NEAR((*after)[0] - (*handle)[0], 30, 0.5) << "it follows the mouse";
  EXPECT_NEAR((*after)[1], (*handle)[1], 1e-6);
  for (int n = 0; n < 100; ++n) session.drag_cut(40, 0);
  EXPECT_TRUE(session.box().contains(session.cut_handle())) << "it stays in the data";
  // The normal points to the eye.
  session.state().cut.plane = {{16, 16, 16}, {1, 0, 0}};
  session.drag_cut(0, 20);
  EXPECT_LT(session.cut_handle().x, 16);
  EXPECT_TRUE(std::isfinite(session.cut_handle().x));
}

}  // namespace
}  // namespace adamas
