#include "core/data/cell_contacts.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "core/base/sort_unique.h"

namespace adamas::inline core {

namespace {

constexpr std::uint64_t kNoFunction = ContactBuffer::kNoFunction;

template <class T>
std::array<T, 4> in_order(const std::array<T, 4>& values, const std::array<std::size_t, 4>& order) {
  return {values[order[0]], values[order[1]], values[order[2]], values[order[3]]};
}

/// Where functions are equal on a face of a tetrahedron.
struct Feature {
  std::array<std::uint64_t, 4> functions;  ///< the last ones may be kNoFunction
  /// Bit i is set if the vertex with the i-th id is opposite to a face that the feature lies on.
  std::uint8_t zeros;
  bool operator==(const Feature&) const = default;

  [[nodiscard]] ContactBuffer::Key digest(const std::array<std::uint64_t, 4>& ids) const {
    return ContactBuffer::digest(ids, zeros, functions);
  }
};

/// A corner of a contact polygon whose vertices are in the order of their ids.
struct FeatureCorner {
  Feature point, leaving;
  Weights weights;
  Vec3 position;
  bool crowded;
};

/// The contact polygons of a tetrahedron, with features as they are in all tetrahedra that share them.
class FeaturePolygons {
 public:
  FeaturePolygons(const std::array<std::uint64_t, 4>& vertex_ids, const std::array<Vec3, 4>& positions,
                  const OwnershipProblem& problem, const std::vector<ContactPolygon>& contacts)
      : contacts_(contacts),
        order_(ContactBuffer::ascending(vertex_ids)),
        positions_(in_order(positions, order_)),
        mirrored_(signed_volume(positions[0], positions[1], positions[2], positions[3]) < 0),
        crowded_(problem.candidates.size() > 2 || problem.functions.size() > 2) {}

  /// Calls visit(polygon, corners) for each polygon, with its corners counter-clockwise seen from its front.
  template <class Visit>
  void for_each(Visit&& visit) const {
    thread_local std::vector<FeatureCorner> corners;
    for (const ContactPolygon& polygon : contacts_) {
      find_corners(polygon, corners);
      visit(polygon, std::as_const(corners));
    }
  }

 private:
  void find_corners(const ContactPolygon& polygon, std::vector<FeatureCorner>& result) const {
    result.clear();
    const std::size_t count = polygon.corners.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto& corner = polygon.corners[mirrored_ ? count - 1 - i : i];
      // In a mirrored polygon the edge to the next corner is the one that arrived at this corner before.
      const auto& edge = mirrored_ ? polygon.corners[(2 * count - 2 - i) % count] : corner;
      const auto& [f, g, h] = edge.line_functions;
      FeatureCorner& found = result.emplace_back();
      found.point = {corner.functions, zeros_in_order(corner.zero_weights)};
      found.leaving = {{f, g, h, kNoFunction}, zeros_in_order(edge.line_zero_weights)};
      found.weights = in_order(corner.weights, order_);
      found.crowded = crowded_;
      for (std::size_t v = 0; v < 4; ++v) {
        found.position += found.weights[v] * positions_[v];
        if ((found.point.zeros >> v & 1u) == 0 && found.weights[v] < ContactBuffer::kSmallWeight)
          found.crowded = true;
      }
    }
  }
  [[nodiscard]] std::uint8_t zeros_in_order(unsigned zeros) const {
    unsigned result = 0;
    for (std::size_t i = 0; i < 4; ++i) result |= (zeros >> order_[i] & 1u) << i;
    return static_cast<std::uint8_t>(result);
  }

  const std::vector<ContactPolygon>& contacts_;
  std::array<std::size_t, 4> order_;
  std::array<Vec3, 4> positions_;
  bool mirrored_, crowded_;
};

using Block = std::unique_ptr<std::byte[]>;

/// How the polygons of a cell are held.
enum class Form : std::uint8_t {
  kSection,  ///< as a Section
  kNarrow,   ///< as Parts<std::uint16_t>
  kWide      ///< as Parts<std::uint32_t>
};

/// What each block begins with.
struct Head {
  std::uint32_t bytes;  ///< the size of the block
  std::uint32_t polygons, corners;
  Form form;
};

Head head(const Block& block) {
  Head result;
  std::memcpy(&result, block.get(), sizeof result);
  return result;
}

/// The polygon of two functions that own the cell alone: its corners are on edges of the tetrahedron.
struct Section {
  /// A corner, by vertices in the order of their ids.
  struct Corner {
    std::uint8_t low : 2;   ///< the ends of the edge
    std::uint8_t high : 2;  ///< the ends of the edge
    std::uint8_t face : 2;  ///< the vertex opposite to the face along which the next corner is reached
    std::uint8_t weight_of_low : 1;  ///< whether the weight that is held is that of `low`
    std::uint8_t crowded : 1;
  };
  static constexpr std::size_t kMostCorners = 4;

  Head head;
  std::uint32_t front, back;
  std::array<Corner, kMostCorners> corners;
  std::array<std::uint64_t, 2> functions;  ///< ascending
  /// The weight of each corner at an end of its edge; a block has only those of its corners.
  std::array<double, kMostCorners> weights;
};

/// Adds a corner to a section; returns false if it has another form than those of sections.
bool add_corner(Section& section, const FeatureCorner& corner) {
  const auto& [f, g] = section.functions;
  const std::array<std::uint64_t, 4> two{f, g, kNoFunction, kNoFunction};
  const unsigned ends = ~unsigned{corner.point.zeros} & 0xfu;
  if (section.head.corners == Section::kMostCorners || std::popcount(ends) != 2 ||
      std::popcount(corner.leaving.zeros) != 1 || corner.point.functions != two ||
      corner.leaving.functions != two)
    return false;
  const auto low = static_cast<std::size_t>(std::countr_zero(ends)),
             high = static_cast<std::size_t>(std::bit_width(ends)) - 1;
  const double of_low = corner.weights[low], of_high = corner.weights[high];
  for (std::size_t v = 0; v < 4; ++v) {
    if (v != low && v != high && corner.weights[v] != 0) return false;
  }
  if (of_low != 1 - of_high && of_high != 1 - of_low) return false;
  Section::Corner code{};
  code.low = low & 3u;
  code.high = high & 3u;
  code.face = static_cast<unsigned>(std::countr_zero(corner.leaving.zeros)) & 3u;
  code.weight_of_low = of_low == 1 - of_high ? 0 : 1;
  code.crowded = corner.crowded ? 1 : 0;
  section.corners[section.head.corners] = code;
  section.weights[section.head.corners++] = code.weight_of_low != 0 ? of_low : of_high;
  return true;
}

/// Returns the block of a section; null if the polygons have another form.
Block section_block(const FeaturePolygons& polygons, const std::vector<ContactPolygon>& contacts) {
  if (contacts.size() != 1) return nullptr;
  Section section{};
  section.head.polygons = 1;
  section.head.form = Form::kSection;
  bool fits = true;
  polygons.for_each([&](const ContactPolygon& polygon, const std::vector<FeatureCorner>& corners) {
    section.front = polygon.front;
    section.back = polygon.back;
    for (const FeatureCorner& corner : corners) {
      if (section.head.corners == 0)
        section.functions = {corner.point.functions[0], corner.point.functions[1]};
      fits = fits && add_corner(section, corner);
    }
  });
  if (!fits) return nullptr;
  const std::size_t bytes = sizeof section - (Section::kMostCorners - section.head.corners) * sizeof(double);
  section.head.bytes = static_cast<std::uint32_t>(bytes);
  Block block = std::make_unique_for_overwrite<std::byte[]>(bytes);
  std::memcpy(block.get(), &section, bytes);
  return block;
}

/// Adds the polygon of a block to a buffer. `ids` are ascending, and the positions follow their order.
void add_section(const Block& block, ContactBuffer& buffer, const std::array<std::uint64_t, 4>& ids,
                 const std::array<Vec3, 4>& positions) {
  Section section;
  std::memcpy(&section, block.get(), head(block).bytes);
  std::array<ContactBuffer::Corner, Section::kMostCorners> corners;
  for (std::size_t i = 0; i < section.head.corners; ++i) {
    const Section::Corner code = section.corners[i];
    const double held = section.weights[i], other = 1 - held;
    const auto zeros = static_cast<std::uint8_t>(0xfu & ~(1u << code.low) & ~(1u << code.high));
    corners[i].key = ContactBuffer::digest(ids, zeros, section.functions);
    corners[i].leaving =
        ContactBuffer::digest(ids, static_cast<std::uint8_t>(1u << code.face), section.functions);
    corners[i].position = Vec3{} + (code.weight_of_low != 0 ? held : other) * positions[code.low];
    corners[i].position += (code.weight_of_low != 0 ? other : held) * positions[code.high];
    corners[i].crowded = code.crowded != 0;
  }
  buffer.add_polygon(section.front, section.back, std::span(corners).first(section.head.corners));
}

/// Numbers features from 0 in the order in which they come first. Its memory is reused.
class FeatureNumbers {
 public:
  /// `most`: the greatest number of features.
  void start(std::size_t most) {
    features_.clear();
    slots_.assign(std::bit_ceil(2 * most + 1), kFree);
  }

  std::uint32_t number(const Feature& feature) {
    std::size_t at = feature.digest({0, 1, 2, 3}).low & (slots_.size() - 1);
    while (slots_[at] != kFree && features_[slots_[at]] != feature) at = (at + 1) & (slots_.size() - 1);
    if (slots_[at] == kFree) {
      slots_[at] = static_cast<std::uint32_t>(features_.size());
      features_.push_back(feature);
    }
    return slots_[at];
  }
  [[nodiscard]] const std::vector<Feature>& features() const { return features_; }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffu;
  std::vector<Feature> features_;
  std::vector<std::uint32_t> slots_;
};

struct PartPolygon {
  std::uint32_t front, back, count;
};

/// Polygons before they go into a block. Its memory is reused.
struct LooseParts {
  /// `most`: the number of corners.
  void start(std::size_t most) {
    points.start(most);
    lines.start(most);
    positions.clear();
    polygons.clear();
    corners.clear();
    crowded.clear();
    functions.clear();
  }

  void add(const FeatureCorner& corner) {
    const std::uint32_t point = points.number(corner.point);
    if (point == positions.size()) positions.push_back(corner.position);
    corners.push_back({point, lines.number(corner.leaving)});
    crowded.push_back(corner.crowded ? 1 : 0);
  }
  void find_functions() {
    for (const FeatureNumbers* numbers : {&points, &lines}) {
      for (const Feature& feature : numbers->features())
        functions.insert(functions.end(), feature.functions.begin(), feature.functions.end());
    }
    sort_unique(functions);
    if (functions.back() == kNoFunction) functions.pop_back();
  }

  FeatureNumbers points, lines;
  std::vector<Vec3> positions;  ///< of points
  std::vector<PartPolygon> polygons;
  std::vector<std::array<std::uint32_t, 2>> corners;  ///< the point and the line of each
  std::vector<std::uint8_t> crowded;                  ///< by corner
  std::vector<std::uint64_t> functions;               ///< those of the features, ascending
};

/// The polygons of a cell in a block: its counts, then arrays.
template <class Index>
struct Parts {
  static constexpr Form kForm = sizeof(Index) == sizeof(std::uint16_t) ? Form::kNarrow : Form::kWide;
  static constexpr Index kNone = std::numeric_limits<Index>::max();
  struct Counts {
    Head head;
    std::uint32_t functions, points, lines;
  };
  /// A feature, with functions by their places.
  struct Place {
    std::array<Index, 4> functions;
    Index zeros;
  };
  struct Corner {
    Index point, line;
  };

  explicit Parts(const Block& block) {
    std::memcpy(&counts, block.get(), sizeof counts);
    std::byte* at = block.get() + kBytesOfCounts;
    functions = take<std::uint64_t>(at, counts.functions);
    positions = take<Vec3>(at, counts.points);
    polygons = take<PartPolygon>(at, counts.head.polygons);
    points = take<Place>(at, counts.points);
    lines = take<Place>(at, counts.lines);
    corners = take<Corner>(at, counts.head.corners);
    crowded = take<std::uint8_t>(at, counts.head.corners);
  }
  static std::size_t bytes(const Counts& counts) {
    return kBytesOfCounts + counts.functions * sizeof(std::uint64_t) +
           counts.points * (sizeof(Vec3) + sizeof(Place)) + counts.head.polygons * sizeof(PartPolygon) +
           counts.lines * sizeof(Place) + counts.head.corners * (sizeof(Corner) + 1);
  }

  Counts counts;
  std::span<std::uint64_t> functions;
  std::span<Vec3> positions;
  std::span<PartPolygon> polygons;
  std::span<Place> points, lines;
  std::span<Corner> corners;
  std::span<std::uint8_t> crowded;

 private:
  static constexpr std::size_t kBytesOfCounts = (sizeof(Counts) + 7) / 8 * 8;
  template <class T>
  static std::span<T> take(std::byte*& at, std::size_t count) {
    T* const first = reinterpret_cast<T*>(at);
    at += count * sizeof(T);
    return {first, count};
  }
};

template <class Index>
Block parts_block(const LooseParts& loose) {
  using PartsOfIndex = Parts<Index>;
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  typename PartsOfIndex::Counts counts{{0, count(loose.polygons), count(loose.corners), PartsOfIndex::kForm},
                                       count(loose.functions),
                                       count(loose.positions),
                                       count(loose.lines.features())};
  counts.head.bytes = static_cast<std::uint32_t>(PartsOfIndex::bytes(counts));
  Block block = std::make_unique_for_overwrite<std::byte[]>(counts.head.bytes);
  std::memcpy(block.get(), &counts, sizeof counts);
  const PartsOfIndex parts(block);
  const auto place = [&](const Feature& feature) {
    typename PartsOfIndex::Place result{{}, feature.zeros};
    for (std::size_t f = 0; f < feature.functions.size(); ++f) {
      const auto at = std::ranges::lower_bound(loose.functions, feature.functions[f]);
      result.functions[f] = feature.functions[f] == kNoFunction
                                ? PartsOfIndex::kNone
                                : static_cast<Index>(at - loose.functions.begin());
    }
    return result;
  };
  std::ranges::copy(loose.functions, parts.functions.begin());
  std::ranges::copy(loose.positions, parts.positions.begin());
  std::ranges::copy(loose.polygons, parts.polygons.begin());
  std::ranges::transform(loose.points.features(), parts.points.begin(), place);
  std::ranges::transform(loose.lines.features(), parts.lines.begin(), place);
  std::ranges::transform(loose.corners, parts.corners.begin(), [](const auto& corner) {
    return typename PartsOfIndex::Corner{static_cast<Index>(corner[0]), static_cast<Index>(corner[1])};
  });
  std::ranges::copy(loose.crowded, parts.crowded.begin());
  return block;
}

Block parts_block(const FeaturePolygons& polygons, const std::vector<ContactPolygon>& contacts) {
  std::size_t most = 0;
  for (const ContactPolygon& polygon : contacts) most += polygon.corners.size();
  thread_local LooseParts loose;
  loose.start(most);
  polygons.for_each([&](const ContactPolygon& polygon, const std::vector<FeatureCorner>& corners) {
    loose.polygons.push_back({polygon.front, polygon.back, static_cast<std::uint32_t>(corners.size())});
    for (const FeatureCorner& corner : corners) loose.add(corner);
  });
  loose.find_functions();
  const std::size_t greatest =
      std::max({loose.functions.size(), loose.positions.size(), loose.lines.features().size()});
  return greatest < Parts<std::uint16_t>::kNone ? parts_block<std::uint16_t>(loose)
                                                : parts_block<std::uint32_t>(loose);
}

/// Adds the polygons of a block to a buffer. `ids` are ascending.
template <class Index>
void add_parts(const Parts<Index>& parts, ContactBuffer& buffer, const std::array<std::uint64_t, 4>& ids) {
  const auto digest = [&](const auto& place) {
    Feature feature{{}, static_cast<std::uint8_t>(place.zeros)};
    for (std::size_t f = 0; f < feature.functions.size(); ++f)
      feature.functions[f] =
          place.functions[f] == Parts<Index>::kNone ? kNoFunction : parts.functions[place.functions[f]];
    return feature.digest(ids);
  };
  thread_local std::vector<ContactBuffer::Key> points, lines;
  points.clear();
  lines.clear();
  std::ranges::transform(parts.points, std::back_inserter(points), digest);
  std::ranges::transform(parts.lines, std::back_inserter(lines), digest);
  thread_local std::vector<ContactBuffer::Corner> corners;
  std::size_t at = 0;
  for (const auto& [front, back, count] : parts.polygons) {
    corners.clear();
    for (const std::size_t end = at + count; at < end; ++at) {
      const auto& [point, line] = parts.corners[at];
      corners.push_back({points[point], parts.positions[point], lines[line], parts.crowded[at] != 0});
    }
    buffer.add_polygon(front, back, corners);
  }
}

}  // namespace

CellContacts::CellContacts(const std::array<std::uint64_t, 4>& vertex_ids,
                           const std::array<Vec3, 4>& positions, const OwnershipProblem& problem,
                           const std::vector<ContactPolygon>& contacts) {
  if (contacts.empty()) return;
  const FeaturePolygons polygons(vertex_ids, positions, problem, contacts);
  block_ = section_block(polygons, contacts);
  if (block_ == nullptr) block_ = parts_block(polygons, contacts);
}

CellContacts::CellContacts(const CellContacts& other) {
  if (other.empty()) return;
  const std::size_t bytes = head(other.block_).bytes;
  block_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
  std::memcpy(block_.get(), other.block_.get(), bytes);
}

std::size_t CellContacts::polygon_count() const { return empty() ? 0 : head(block_).polygons; }

std::size_t CellContacts::corner_count() const { return empty() ? 0 : head(block_).corners; }

void CellContacts::add_to(ContactBuffer& buffer, const std::array<std::uint64_t, 4>& vertex_ids,
                          const std::array<Vec3, 4>& positions) const {
  if (empty()) return;
  const std::array<std::size_t, 4> order = ContactBuffer::ascending(vertex_ids);
  const std::array<std::uint64_t, 4> ids = in_order(vertex_ids, order);
  switch (head(block_).form) {
    case Form::kSection:
      return add_section(block_, buffer, ids, in_order(positions, order));
    case Form::kNarrow:
      return add_parts(Parts<std::uint16_t>(block_), buffer, ids);
    case Form::kWide:
      return add_parts(Parts<std::uint32_t>(block_), buffer, ids);
  }
}

bool CellContacts::has_polygons_of(const CellContacts& other) const {
  std::array<ContactBuffer, 2> buffers;
  const std::array<std::uint64_t, 4> ids{0, 1, 2, 3};
  add_to(buffers[0], ids, {});
  other.add_to(buffers[1], ids, {});
  return buffers[0].has_polygons_of(buffers[1]);
}

}  // namespace adamas::inline core
