#include "viewer/contents/store_section.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/data/volume_placement.h"
#include "core/geometry/plane.h"
#include "viewer/contents/plane_mesh.h"

namespace adamas::viewer {

using namespace isosurface;

namespace {

constexpr double kMostPlaces = 1 << 20;
/// The factor by which the places of a first section are farther apart, while a plane is moved.
constexpr int kRough = 4;

struct Overtaken {};

}  // namespace

bool StoreSection::Wanted::operator==(const Wanted& other) const {
  return plane.origin == other.plane.origin && plane.normal == other.plane.normal &&
         coarseness == other.coarseness && is_of_colours == other.is_of_colours && step == other.step;
}

StoreSection::StoreSection(OpenStore& store, OpenStore* colours)
    : store_(store), colours_(colours), thread_([this] { run(); }) {}

StoreSection::~StoreSection() {
  {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

double StoreSection::least_step() const {
  const Vec3& spacing = store_.grid().spacing;
  return 0.5 * std::min({spacing.x, spacing.y, spacing.z});
}

StoreSection::Wanted StoreSection::wanted(const Plane& plane, const Viewpoint& viewpoint, bool is_of_colours,
                                          std::uint32_t step) const {
  Wanted result{plane, 0, is_of_colours, step};
  const std::vector<Vec3> corners = plane_in_samples(store_.grid(), plane);
  if (corners.empty()) return result;
  Box3 box;
  for (const Vec3& corner : corners) box.extend(corner);
  const double pixel = 1 / View(viewpoint).pixels(1, {box.center(), 0.5 * box.size()});
  const double least = std::sqrt(polygon_area(corners) / kMostPlaces), apart = std::max(pixel, least);
  // Spacings are powers of two, so that a section stays valid while a view moves a little.
  result.coarseness = std::max(0, static_cast<int>(std::floor(std::log2(apart / least_step()))));
  if (std::ldexp(least_step(), result.coarseness) < least) ++result.coarseness;
  return result;
}

void StoreSection::want(const Wanted& wanted) {
  const std::lock_guard lock(mutex_);
  if (wanted_ == wanted) return;
  wanted_ = wanted;
  changed_.notify_all();
}

std::shared_ptr<const StoreSection::Found> StoreSection::found() const {
  const std::lock_guard lock(mutex_);
  return found_;
}

bool StoreSection::is_current() const {
  const std::lock_guard lock(mutex_);
  return !wanted_ || (found_ && found_->wanted == *wanted_ && !found_->is_rough);
}

void StoreSection::wait_for(const Wanted& wanted) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return found_ && found_->wanted == wanted && !found_->is_rough; });
}

bool StoreSection::is_overtaken(const Wanted& wanted) const {
  const std::lock_guard lock(mutex_);
  return is_ended_ || !(wanted_ == wanted);
}

void StoreSection::run() {
  Wanted done;
  bool is_done = false;  // whether `done` was found completely; GCC 12 warns of an optional here
  while (true) {
    Wanted wanted;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_ended_ || (wanted_ && !(is_done && *wanted_ == done)); });
      if (is_ended_) return;
      wanted = *wanted_;
    }
    // The first section, and that of a moved plane or of another step, is computed roughly at first, and then
    // completely unless the plane has moved on.
    const bool is_moved = !is_done || done.step != wanted.step ||
                          !(done.plane.origin == wanted.plane.origin) ||
                          !(done.plane.normal == wanted.plane.normal);
    if (is_moved) find(wanted, kRough);
    is_done = false;
    if (is_overtaken(wanted)) continue;
    try {
      find(wanted, 1);
      done = wanted;
      is_done = true;
    } catch (const Overtaken&) {
      continue;
    }
  }
}

void StoreSection::find(const Wanted& wanted, int roughness) {
  auto found = std::make_shared<Found>(Found{wanted, nullptr, {}, roughness > 1});
  try {
    found->mesh = mesh_of(wanted, roughness);
  } catch (const std::exception& error) {
    found->problem = error.what();
  }
  const std::lock_guard lock(mutex_);
  found_ = std::move(found);
  changed_.notify_all();
}

SharedMesh StoreSection::mesh_of(const Wanted& wanted, int roughness) {
  OpenStore& store = wanted.is_of_colours && colours_ != nullptr ? *colours_ : store_;
  const double step = roughness * std::ldexp(least_step(), wanted.coarseness);
  const Vec3& spacing = store.grid().spacing;
  const double least_spacing = std::min({spacing.x, spacing.y, spacing.z});
  const int lod =
      std::clamp(static_cast<int>(std::floor(std::log2(step / least_spacing))), 0, store.coarsest());
  std::optional<OpenStore::Values> values;
  std::size_t asked = 0;
  const auto value = [&](const Vec3& place) {
    constexpr std::size_t kBetweenLooks = 4096, kBetweenTurns = 256;
    if (++asked % kBetweenLooks == 0 && roughness == 1 && is_overtaken(wanted)) throw Overtaken{};
    // Other threads that want the pages get their turn here.
    if (asked % kBetweenTurns == 0) values.reset();
    if (!values) values.emplace(store.values(wanted.step));
    return values->at(place, lod);
  };
  return plane_mesh(plane_in_samples(store_.grid(), wanted.plane), wanted.plane.normal, step, value);
}

}  // namespace adamas::viewer
