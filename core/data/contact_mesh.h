#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/digest_numbers.h"
#include "core/data/contact_buffer.h"
#include "core/data/interface_mesh.h"

namespace adamas::inline core {

/// A tolerance that serves ContactMeshBuilder, in relation to the diagonal of the domain.
inline constexpr double kWeldTolerance = 1e-11;

/// Welds the contact polygons of a conforming tetrahedral mesh into a network of triangles. It is closed, by
/// combinatorics alone: the polygons fit together but for points of one polygon that lie on the edge of
/// another. Such edges run on one line, which is known by the functions that are equal there, and are divided
/// at all the points of their line in one order. Then points that coincide become one, and triangles that
/// this brings onto each other, with nothing between them, go.
class ContactMeshBuilder {
 public:
  /// `tolerance`: points nearer than this that stem from different features are one (a length; far below any
  /// cell).
  explicit ContactMeshBuilder(double tolerance) : tolerance_(tolerance) {}

  /// Makes room for so many polygons and corners of them.
  void reserve(std::size_t polygons, std::size_t corners);
  /// Appends buffers in their order.
  void append(std::span<const ContactBuffer* const> buffers);
  void append(const ContactBuffer& buffer) {
    const ContactBuffer* const one = &buffer;
    append({&one, 1});
  }
  /// Returns the network; `front` and `back` of its triangles are the owners of the problems. The builder is
  /// empty afterwards. Sets `keys`, unless it is null, to the digests of the points' features.
  InterfaceMesh finish(std::vector<Digest>* keys = nullptr);

 private:
  struct Polygon {
    std::uint32_t front, back;
    std::uint32_t first, count;
  };
  /// An edge that runs along a line.
  struct LineUse {
    std::uint32_t line;
    std::array<std::uint32_t, 2> ends;  ///< ascending
  };
  /// The points on a line in the order of their positions along it.
  struct Line {
    Vec3 origin, direction;
    std::vector<std::pair<double, std::uint32_t>> points;
    [[nodiscard]] std::pair<double, std::uint32_t> place(std::uint32_t point, const Vec3& position) const {
      return {dot(position - origin, direction), point};
    }
  };
  using Key = ContactBuffer::Key;
  /// Loops of consecutive polygons.
  struct Loops {
    std::vector<std::uint32_t> corners;
    std::vector<std::size_t> ends;  ///< the end of each loop in `corners`

    void add(const std::vector<std::uint32_t>& loop) {
      corners.insert(corners.end(), loop.begin(), loop.end());
      ends.push_back(corners.size());
    }
    template <class Visit>
    void for_each(Visit&& visit) const {
      for (std::size_t i = 0, begin = 0; i < ends.size(); begin = ends[i++])
        visit(i, std::span(corners).subspan(begin, ends[i] - begin));
    }
  };

  /// The places of the first polygon and corner of a buffer that is appended.
  struct Place {
    std::size_t polygon, corner;
  };
  void add_points(std::span<const ContactBuffer* const> buffers, const std::vector<Place>& places);
  void add_line_uses(std::span<const ContactBuffer* const> buffers, const std::vector<Place>& places);
  [[nodiscard]] Line ordered_line(std::vector<std::uint32_t> points) const;
  void order_lines();
  void add_passed(const Line& line, std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& loop) const;
  void weld_crowded_points();
  /// Welded corners of a polygon and the points that its edges pass; empty where none is left.
  void find_loop(const Polygon& polygon, std::vector<std::uint32_t>& loop) const;
  [[nodiscard]] std::vector<Loops> find_loops() const;
  static void drop_repeated(std::vector<std::uint32_t>& loop);
  /// Whether p lies on the edge from a to b, away from its ends.
  [[nodiscard]] bool passes(std::uint32_t a, std::uint32_t b, std::uint32_t p) const;
  /// Closes spikes, where a loop turns back on itself: divides the longer edge, in all loops, at the end of
  /// the shorter one, so that parts of loops without area vanish.
  void close_spikes(std::vector<Loops>& parts) const;
  [[nodiscard]] std::vector<InterfaceTriangle> triangulate(const std::vector<Loops>& parts) const;
  void cancel_coinciding(InterfaceMesh& mesh) const;
  void number_points(InterfaceMesh& mesh, std::vector<Digest>* keys) const;

  static constexpr std::uint32_t kManyPoints = 0xffffffffu;

  double tolerance_;
  std::vector<Vec3> points_;
  std::vector<char> crowded_;          ///< whether each point may coincide with others
  std::vector<std::uint32_t> welded_;  ///< point -> the point it became
  std::vector<std::uint32_t> corners_;
  std::vector<Key> leaving_;
  std::vector<Polygon> polygons_;
  DigestNumbers point_by_key_;
  DigestNumbers line_by_key_;  ///< the lines of crowded edges
  std::vector<LineUse> line_uses_;
  /// By line: its two points if these are all, or {kManyPoints, a place in lines_}.
  std::vector<std::array<std::uint32_t, 2>> line_points_;
  std::vector<Line> lines_;
};

}  // namespace adamas::inline core
