#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <utility>

#include "core/io/named_colours.h"
#include "core/picture/material_colours.h"
#include "viewer/contents/document.h"
#include "viewer/contents/material_contents.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

constexpr Colour kCellEdges{0.25, 0.25, 0.28}, kInterfaceEdges{0.05, 0.05, 0.05};

/// The data on which a cross section depends.
struct SectionKey {
  Plane plane;
  std::optional<std::size_t> field;

  bool operator==(const SectionKey& other) const {
    return plane.origin == other.plane.origin && plane.normal == other.plane.normal && field == other.field;
  }
};

struct FoundSection {
  SectionKey key;
  MaterialContents::Section section;
  double seconds = 0;
  std::string problem;
};

class MaterialDocument final : public Document {
 public:
  MaterialDocument(const std::string& path, Progress& progress)
      : contents_(MaterialContents::open(path, progress)) {
    facts_.name = path;
    facts_.summary = contents_->summary();
    facts_.box = contents_->box();
    facts_.materials = contents_->materials();
    const io::NamedColours own = io::find_named_colours(path, {});
    for (std::size_t m = 0; m < facts_.materials.size(); ++m) {
      const auto found = own.find(facts_.materials[m]);
      facts_.material_colours.push_back(found == own.end()
                                            ? material_colour(m)
                                            : Colour{found->second[0], found->second[1], found->second[2]});
    }
    facts_.fields = contents_->fields();
    set_field(std::nullopt);
  }
  MaterialDocument(const MaterialDocument&) = delete;
  MaterialDocument& operator=(const MaterialDocument&) = delete;
  ~MaterialDocument() override {
    if (running_.valid()) running_.wait();
  }

  [[nodiscard]] const DocumentFacts& facts() const override { return facts_; }

  std::vector<DrawnPart> parts(const ViewState& view, const DocumentState& state) override {
    const std::optional<std::size_t> field = field_number(state);
    if (field != field_) set_field(field);
    take_section();
    if (view.cut.has_section()) ask_section({view.cut.plane, field});
    std::vector<DrawnPart> result;
    add_interfaces(view, state, result);
    if (view.cut.has_section() && section_) add_section(view, state, result);
    return result;
  }

  [[nodiscard]] bool shows_surfaces_of(const DocumentState&) const override { return true; }

  void finish(const ViewState& view, const DocumentState& state) override {
    static_cast<void>(parts(view, state));
    while (running_.valid()) {
      running_.wait();
      static_cast<void>(parts(view, state));
    }
  }

  [[nodiscard]] UpdateReport report() const override {
    UpdateReport result;
    for (const MaterialContents::Interface& each : interfaces_)
      result.triangles += each.mesh->indices.size() / 3;
    result.is_current = !running_.valid();
    if (section_) {
      result.seconds = section_->seconds;
      result.problem = section_->problem;
    }
    return result;
  }

  [[nodiscard]] std::optional<std::array<double, 2>> colour_range(const ViewState&,
                                                                  const DocumentState& state) const override {
    return range_of(state);
  }

  [[nodiscard]] Reading at(const Vec3& place, const DocumentState& state, std::size_t) override {
    const MaterialContents::Reading found = contents_->at(place, field_number(state));
    Reading result;
    if (found.material) result.material = facts_.materials[*found.material];
    if (std::isfinite(found.value)) result.value = found.value;
    if (std::isfinite(found.interface_error)) result.error = found.interface_error;
    return result;
  }

  [[nodiscard]] DocumentState first_state() const override { return {}; }

 private:
  [[nodiscard]] std::optional<std::size_t> field_number(const DocumentState& state) const {
    const auto found = std::ranges::find(facts_.fields, state.field);
    if (found == facts_.fields.end()) return std::nullopt;
    return static_cast<std::size_t>(found - facts_.fields.begin());
  }

  void set_field(std::optional<std::size_t> field) {
    field_ = field;
    interfaces_ = contents_->interfaces(field);
  }

  /// The values at the ends of the colour map if a field is chosen.
  [[nodiscard]] std::optional<std::array<double, 2>> range_of(const DocumentState& state) const {
    const std::optional<std::size_t> field = field_number(state);
    if (!field) return std::nullopt;
    if (state.range) return state.range;
    const auto [low, high] = contents_->field_range(*field);
    return std::array{low, high};
  }

  void ask_section(const SectionKey& key) {
    if (running_.valid() || (section_ && section_->key == key)) return;
    running_ = std::async(std::launch::async, [this, key] {
      FoundSection found{key, {}, 0, {}};
      const auto before = std::chrono::steady_clock::now();
      try {
        found.section = contents_->section(key.plane, key.field);
      } catch (const std::exception& error) {
        found.problem = error.what();
      }
      found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
      return found;
    });
  }

  void take_section() {
    if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    section_ = running_.get();
  }

  void colour_by_field(const DocumentState& state, PartStyle& style) const {
    const auto range = range_of(state);
    style.is_coloured_by_value = range.has_value();
    if (range) std::tie(style.low, style.high) = std::pair((*range)[0], (*range)[1]);
  }

  void add_interfaces(const ViewState& view, const DocumentState& state,
                      std::vector<DrawnPart>& parts) const {
    for (const MaterialContents::Interface& each : interfaces_) {
      // An interface is hidden if both of its materials are.
      if (state.hidden.contains(facts_.materials[each.front]) &&
          state.hidden.contains(facts_.materials[each.back]))
        continue;
      PartStyle style;
      // From the front one sees the body behind the interface.
      style.front = facts_.material_colours[each.back];
      style.back = facts_.material_colours[each.front];
      style.is_clipped = true;
      style.has_edges = view.has_edges;
      colour_by_field(state, style);
      parts.push_back({each.mesh, style});
    }
  }

  void add_section(const ViewState& view, const DocumentState& state, std::vector<DrawnPart>& parts) const {
    const MaterialContents::Section& section = section_->section;
    PartStyle style;
    style.is_flat = true;
    for (std::size_t m = 0; m < section.materials.size(); ++m) {
      if (!section.materials[m] || state.hidden.contains(facts_.materials[m])) continue;
      style.front = style.back = facts_.material_colours[m];
      colour_by_field(state, style);
      parts.push_back({section.materials[m], style});
    }
    style.is_coloured_by_value = false;
    const auto lines = [&](const SharedMesh& mesh, const Colour& colour) {
      if (!mesh || mesh->indices.empty()) return;
      style.front = style.back = colour;
      parts.push_back({mesh, style});
    };
    if (view.has_edges) lines(section.cell_edges, kCellEdges);
    lines(section.interface_edges, kInterfaceEdges);
  }

  std::unique_ptr<MaterialContents> contents_;
  DocumentFacts facts_;
  std::optional<std::size_t> field_;
  std::vector<MaterialContents::Interface> interfaces_;
  std::optional<FoundSection> section_;
  std::future<FoundSection> running_;
};

}  // namespace

std::unique_ptr<Document> open_material_document(const std::string& path, Progress& progress) {
  return std::make_unique<MaterialDocument>(path, progress);
}

}  // namespace adamas::viewer
