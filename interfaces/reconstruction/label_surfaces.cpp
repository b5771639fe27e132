#include "interfaces/reconstruction/label_surfaces.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

#include "core/base/hash.h"
#include "core/geometry/triangulate.h"

namespace adamas::interfaces {

namespace {

using Index = LabelLattice::Index;
using Owners = std::array<std::uint16_t, 4>;
using Candidates = std::vector<LabelLattice::Candidate>;

constexpr std::size_t kPaths = MaterialLattice::kPaths.size();
/// A feature is named by its lowest lattice point and by its kind: first those in a plane of equal z, then
/// those between two planes.
constexpr std::size_t kKindsInPlane = 5, kKindsBetween = 20;
constexpr std::uint8_t kNoKind = 255;
constexpr std::size_t kFeaturesPerPoint = 32;

/// The kind of an edge by the bits of the axes along which it runs.
constexpr std::array<std::uint8_t, 8> kKindOfEdge{kNoKind, 0, 1, 2, 5, 6, 7, 8};

/// Returns the kind of a face by the bits of the way from its lowest corner to the middle one and the
/// highest.
constexpr std::uint8_t kind_of_face(unsigned middle, unsigned high) {
  if (high == 3) return middle == 1 ? 3 : 4;
  if (high == 5) return middle == 1 ? 9 : 10;
  if (high == 6) return middle == 2 ? 11 : 12;
  return static_cast<std::uint8_t>(12 + middle);  // 13 to 18
}
constexpr std::uint8_t kKindOfTetrahedron = 19;  // to 24

/// A feature of a tetrahedron in a cell: the bits of its lowest corner, and its kind.
struct CellFeature {
  std::uint8_t low, kind;
};

/// What is known of the six tetrahedra of each cell.
struct CellTables {
  std::array<std::array<std::uint8_t, 4>, kPaths> corners{};   ///< bits of corners
  std::array<std::array<CellFeature, 16>, kPaths> features{};  ///< by bits of the feature's corners
  std::array<bool, kPaths> mirrored{};
  /// The polygon between two owners by the bits of the first one's corners: the bits of the ends of the edge
  /// on which each of its corners lies.
  struct Section {
    std::uint8_t count = 0;
    std::array<std::uint8_t, 4> edges{};
  };
  std::array<Section, 16> sections{};

  CellTables() {
    for (std::size_t path = 0; path < kPaths; ++path) {
      auto& own = corners[path] = LabelLattice::cell_corners(path);
      std::array<Vec3, 4> places;
      for (std::size_t c = 0; c < 4; ++c)
        places[c] = {double(own[c] & 1u), double(own[c] >> 1 & 1u), double(own[c] >> 2)};
      mirrored[path] = signed_volume(places[0], places[1], places[2], places[3]) < 0;
      for (unsigned set = 1; set < 16; ++set) features[path][set] = find_feature(path, set);
    }
    for (unsigned set = 1; set < 15; ++set) sections[set] = find_section(set);
  }

 private:
  [[nodiscard]] CellFeature find_feature(std::size_t path, unsigned set) const {
    std::array<unsigned, 4> found{};
    unsigned count = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      if ((set >> c & 1u) != 0) found[count++] = corners[path][c];
    }
    const auto low = static_cast<std::uint8_t>(found[0]);
    if (count == 2) return {low, kKindOfEdge[found[1] ^ found[0]]};
    if (count == 3) return {low, kind_of_face(found[1] ^ found[0], found[2] ^ found[0])};
    if (count == 4) return {low, static_cast<std::uint8_t>(kKindOfTetrahedron + path)};
    return {low, kNoKind};
  }

  [[nodiscard]] static Section find_section(unsigned set) {
    OwnershipProblem problem;
    for (std::uint32_t m = 0; m < 2; ++m) {
      std::array<double, 4> values{};
      for (unsigned c = 0; c < 4; ++c) values[c] = ((set >> c & 1u) != 0) == (m == 0) ? 1 : -1;
      problem.add_candidate(m);
      problem.add_function(values, m);
    }
    std::vector<ContactPolygon> contacts;
    contact_polygons(problem, contacts);
    Section section;
    for (const ContactPolygon::Corner& corner : contacts.front().corners)
      section.edges[section.count++] = static_cast<std::uint8_t>(~corner.zero_weights & 15u);
    return section;
  }
};

const CellTables& tables() {
  static const CellTables kTables;
  return kTables;
}

LatticeFeature feature_number(const LabelLattice& lattice, const Index& cell, const CellFeature& feature) {
  const std::size_t x = cell[0] + (feature.low & 1u), y = cell[1] + (feature.low >> 1 & 1u),
                    z = cell[2] + (feature.low >> 2u);
  return kFeaturesPerPoint * (x + lattice.points(0) * (y + lattice.points(1) * z)) + feature.kind;
}

std::size_t key_count(const ContactPolygon::Corner& corner) {
  return static_cast<std::size_t>(std::ranges::find(corner.functions, ~std::uint64_t{0}) -
                                  corner.functions.begin());
}

/// Returns the bits of the corners of the feature on which a polygon's corner lies, or 0 if the functions
/// that are equal there are not those of the owners of the feature's corners, each of which has another
/// owner.
unsigned canonical_feature(const ContactPolygon::Corner& corner, const Owners& owners) {
  const unsigned set = ~corner.zero_weights & 15u;
  const std::size_t count = key_count(corner);
  if (count != static_cast<std::size_t>(std::popcount(set))) return 0;
  unsigned seen = 0;
  for (unsigned c = 0; c < 4; ++c) {
    if ((set >> c & 1u) == 0) continue;
    const auto found = std::find(corner.functions.begin(),
                                 corner.functions.begin() + static_cast<std::ptrdiff_t>(count), owners[c]);
    seen |= 1u << static_cast<unsigned>(found - corner.functions.begin());
  }
  return seen == (1u << count) - 1 ? set : 0;
}

class SurfaceMaker {
 public:
  /// `cells`: those of a row to which the box is narrowed.
  SurfaceMaker(const LabelLattice& lattice, const Index& first, const Index& last,
               const std::function<CellsOfRow(std::uint32_t, std::uint32_t)>* cells = nullptr)
      : lattice_(lattice), first_(first), last_(last), cells_(cells) {
    width_ = last[0] - first[0] + 1;
    for (auto& plane : planes_) plane.resize(last[1] - first[1] + 1);
    for (auto& row : rows_) row.resize(kKindsBetween * width_);
  }

  LabelSurfaces run() {
    for (cell_[2] = first_[2]; cell_[2] < last_[2]; ++cell_[2]) {
      row_starts_ = {next(), next()};
      for (cell_[1] = first_[1]; cell_[1] < last_[1]; ++cell_[1]) {
        make_row();
        rows_[0].swap(rows_[1]);
        row_starts_ = {row_starts_[1], next()};
      }
      planes_[0].swap(planes_[1]);
      plane_starts_ = {plane_starts_[1], next()};
    }
    number_points();
    return std::move(result_);
  }

 private:
  /// Numbers points in the order of their first use by triangles, and others behind them.
  void number_points() {
    constexpr std::uint32_t kUnused = 0xffffffffu;
    std::vector<std::uint32_t> numbers(result_.points.size(), kUnused);
    std::vector<Vec3> points;
    std::vector<LatticeFeature> features;
    points.reserve(numbers.size()), features.reserve(numbers.size());
    const auto number = [&](std::uint32_t p) {
      if (numbers[p] != kUnused) return numbers[p];
      points.push_back(result_.points[p]);
      features.push_back(result_.features[p]);
      return numbers[p] = static_cast<std::uint32_t>(points.size() - 1);
    };
    for (InterfaceTriangle& triangle : result_.triangles) {
      for (std::uint32_t& p : triangle.points) p = number(p);
    }
    for (std::uint32_t p = 0; p < numbers.size(); ++p) number(p);
    result_.points = std::move(points);
    result_.features = std::move(features);
  }

  /// The number that the next point gets, from 1. Tables need no clearing: numbers from before a plane or a
  /// row began mean that there is no point.
  [[nodiscard]] std::uint32_t next() const { return static_cast<std::uint32_t>(result_.points.size()) + 1; }

  void make_row() {
    const CellsOfRow cells =
        cells_ == nullptr ? CellsOfRow{first_[0], last_[0]} : (*cells_)(cell_[1], cell_[2]);
    if (cells[0] >= cells[1]) return;
    bool begun = false;
    lattice_.for_each_cell(
        cell_[1], cell_[2], cells[0], cells[1],
        [&](std::uint32_t i, const std::array<std::uint32_t, 8>& runs) {
          if (!begun) make_tables();
          begun = true;
          cell_[0] = i;
          make_cell(runs);
        },
        [](std::uint32_t, std::uint32_t, std::uint16_t) {});
  }

  /// Makes the tables of the planes below and above the row, so that rows without surfaces take no memory.
  void make_tables() {
    for (auto& plane : planes_) {
      for (std::size_t y = 0; y < 2; ++y) plane[cell_[1] - first_[1] + y].resize(kKindsInPlane * width_);
    }
  }

  void make_cell(const std::array<std::uint32_t, 8>& runs) {
    std::array<std::uint16_t, 8> numbers{};
    for (std::size_t c = 0; c < 8; ++c) numbers[c] = lattice_.runs().number(runs[c]);
    corner_runs_ = runs;
    for (std::size_t c = 0; c < 8; ++c) {
      const auto bits = static_cast<std::uint32_t>(c);
      places_[c] =
          lattice_.position({cell_[0] + (bits & 1u), cell_[1] + (bits >> 1 & 1u), cell_[2] + (bits >> 2)});
    }
    plain_ = lattice_.is_plain(cell_);
    if (!plain_) lattice_.find_materials(cell_, cell_materials_);
    for (path_ = 0; path_ < kPaths; ++path_) {
      const auto& corners = tables().corners[path_];
      for (std::size_t c = 0; c < 4; ++c) owners_[c] = numbers[corners[c]];
      unsigned first = 0, second = 0;  // bits of the corners of the first owner, and of another one
      std::uint16_t other = owners_[0];
      for (unsigned c = 0; c < 4; ++c) {
        if (owners_[c] == owners_[0]) {
          first |= 1u << c;
        } else if (second == 0 || owners_[c] == other) {
          other = owners_[c];
          second |= 1u << c;
        }
      }
      if (first == 15) continue;
      if ((first | second) == 15) {
        make_section(first, other);
      } else {
        make_contacts();
      }
    }
  }

  [[nodiscard]] const Vec3& place(std::size_t corner) const {
    return places_[tables().corners[path_][corner]];
  }

  /// Makes the polygon between two owners, the first of which has the corners `first`.
  void make_section(unsigned first, std::uint16_t other) {
    std::uint16_t f = owners_[0], g = other;
    if (g < f) std::swap(f, g), first = ~first & 15u;
    LabelLattice::Values difference{};
    if (plain_) {
      for (std::size_t c = 0; c < 4; ++c)
        difference[c] = (first >> c & 1u) != 0 ? lattice_.inside(f) - lattice_.outside(g)
                                               : lattice_.outside(f) - lattice_.inside(g);
    } else {
      lattice_.find_candidates(cell_materials_, tables().corners[path_], owners_, candidates_);
      if (candidates_.size() > 2) return make_contacts();
      for (std::size_t c = 0; c < 4; ++c) difference[c] = candidates_[0].values[c] - candidates_[1].values[c];
    }
    const CellTables::Section& section = tables().sections[first];
    loop_.clear();
    for (std::size_t n = 0; n < section.count; ++n) {
      const unsigned edge = section.edges[n];
      loop_.push_back(point(edge, [&] {
        const auto i = static_cast<std::size_t>(std::countr_zero(edge)),
                   j = static_cast<std::size_t>(std::bit_width(edge)) - 1;
        const double t = difference[i] / (difference[i] - difference[j]);
        Vec3 position;
        position += (1 - t) * place(i);
        position += t * place(j);
        return position;
      }));
    }
    add_polygon(static_cast<std::size_t>(std::countr_zero(first)),
                static_cast<std::size_t>(std::countr_zero(~first & 15u)));
  }

  /// Makes the polygons of a tetrahedron with more than two owners, or with others that may own a part.
  void make_contacts() {
    const std::vector<ContactPolygon>& contacts = plain_ ? known_contacts() : find_contacts();
    const bool is_left_out = std::ranges::any_of(contacts, [&](const ContactPolygon& contact) {
      return std::ranges::any_of(contact.corners, [&](const ContactPolygon::Corner& corner) {
        return canonical_feature(corner, owners_) == 0;
      });
    });
    if (is_left_out) result_.left_out.push_back({cell_, path_});
    for (const ContactPolygon& contact : contacts) {
      loop_.clear();
      for (const ContactPolygon::Corner& corner : contact.corners) {
        const unsigned feature = canonical_feature(corner, owners_);
        if (feature == 0) continue;
        loop_.push_back(point(feature, [&] {
          Vec3 position;
          for (std::size_t v = 0; v < 4; ++v) position += corner.weights[v] * place(v);
          return position;
        }));
      }
      if (is_left_out) continue;
      const auto corner_of = [&](std::uint32_t owner) {
        return static_cast<std::size_t>(std::ranges::find(owners_, owner) - owners_.begin());
      };
      add_polygon(corner_of(contact.front), corner_of(contact.back));
    }
  }

  const std::vector<ContactPolygon>& find_contacts() {
    if (plain_) {
      lattice_.find_owners(owners_, candidates_);
    } else {
      lattice_.find_candidates(cell_materials_, tables().corners[path_], owners_, candidates_);
    }
    LabelLattice::set_problem(candidates_, problem_);
    keep_owners(problem_);
    contacts_.clear();
    contact_polygons(problem_, contacts_);
    return contacts_;
  }

  /// Returns the polygons of a tetrahedron where these depend on its owners alone.
  const std::vector<ContactPolygon>& known_contacts() {
    std::uint64_t key = 0;
    for (const std::uint16_t owner : owners_) key = key << 16 | owner;
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    return known_[key] = find_contacts();
  }

  /// Returns the number, from 0, of the point on a feature of the tetrahedron, which is given by the bits of
  /// its corners.
  template <class Position>
  std::uint32_t point(unsigned set, Position&& position) {
    const CellFeature feature = tables().features[path_][set];
    const unsigned x = feature.low & 1u, y = feature.low >> 1 & 1u, z = feature.low >> 2;
    const std::size_t column = cell_[0] - first_[0] + x;
    const bool in_plane = feature.kind < kKindsInPlane;
    std::uint32_t& number = in_plane
                                ? planes_[z][cell_[1] - first_[1] + y][column * kKindsInPlane + feature.kind]
                                : rows_[y][column * kKindsBetween + feature.kind - kKindsInPlane];
    if (number < (in_plane ? plane_starts_[z] : row_starts_[y])) {
      number = next();
      result_.points.push_back(position());
      result_.features.push_back(feature_number(lattice_, cell_, feature));
    }
    return number - 1;
  }

  /// Adds the triangles of the present loop between the owners of two corners.
  void add_polygon(std::size_t front, std::size_t back) {
    if (tables().mirrored[path_]) std::reverse(loop_.begin(), loop_.end());
    const auto& corners = tables().corners[path_];
    const MaterialId front_run(corner_runs_[corners[front]]), back_run(corner_runs_[corners[back]]);
    triangulate_convex(result_.points, loop_, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      result_.triangles.push_back({{a, b, c}, front_run, back_run});
    });
  }

  const LabelLattice& lattice_;
  Index first_, last_, cell_{};
  const std::function<CellsOfRow(std::uint32_t, std::uint32_t)>* cells_;
  std::size_t width_;
  LabelSurfaces result_;
  // Numbers of points from 1: by plane and row, and by row.
  std::array<std::vector<std::vector<std::uint32_t>>, 2> planes_;
  std::array<std::vector<std::uint32_t>, 2> rows_;
  std::array<std::uint32_t, 2> plane_starts_{1, 1}, row_starts_{1, 1};
  std::array<std::uint32_t, 8> corner_runs_{};
  std::array<Vec3, 8> places_;
  bool plain_ = false;
  std::size_t path_ = 0;
  Owners owners_{};
  LabelLattice::CellMaterials cell_materials_;
  Candidates candidates_;
  OwnershipProblem problem_;
  std::vector<ContactPolygon> contacts_;
  std::unordered_map<std::uint64_t, std::vector<ContactPolygon>> known_;
  std::vector<std::uint32_t> loop_;
};

}  // namespace

LabelSurfaces label_surfaces(const LabelLattice& lattice, const Index& first, const Index& last) {
  return SurfaceMaker(lattice, first, last).run();
}

LabelSurfaces label_surfaces(const LabelLattice& lattice,
                             const std::function<CellsOfRow(std::uint32_t, std::uint32_t)>& cells) {
  const Index last{lattice.points(0) - 1, lattice.points(1) - 1, lattice.points(2) - 1};
  return SurfaceMaker(lattice, {0, 0, 0}, last, &cells).run();
}

bool is_in_plane(const LabelLattice& lattice, LatticeFeature feature, std::uint32_t k) {
  return feature % kFeaturesPerPoint < kKindsInPlane &&
         feature / kFeaturesPerPoint / lattice.points(0) / lattice.points(1) == k;
}

void add_features(const LabelLattice& lattice, const LatticeTetrahedron& tetrahedron,
                  std::vector<LatticeFeature>& features) {
  for (unsigned set = 1; set < 16; ++set) {
    if (std::popcount(set) > 1)
      features.push_back(feature_number(lattice, tetrahedron.cell, tables().features[tetrahedron.path][set]));
  }
}

std::pair<LatticeFeature, bool> feature_of(const LabelLattice& lattice, const LatticeTetrahedron& tetrahedron,
                                           const Owners& owners, const ContactPolygon::Corner& corner) {
  const unsigned set = canonical_feature(corner, owners);
  if (set == 0) return {0, false};
  return {feature_number(lattice, tetrahedron.cell, tables().features[tetrahedron.path][set]), true};
}

}  // namespace adamas::interfaces
