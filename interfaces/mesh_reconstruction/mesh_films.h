#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interfaces/mesh_reconstruction/mesh_layer.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// Films: materials that are thinner than some cell and a half and separate what lies on their two sides. One
/// value of a material cannot stand for what it is on both sides of a cell, so that the sides are told apart.
class MeshFilms {
 public:
  using Index = MeshSubdivision::Index;

  /// No films.
  MeshFilms() = default;
  /// Finds films by fitting layers to the fractions round their cells. A material that lies on both sides of
  /// a film, in cells that do not hang together but through films, gets a number for each side in `values`,
  /// which are found again; values are not kept.
  explicit MeshFilms(MeshValues& values);

  [[nodiscard]] bool any() const { return !layers_.empty(); }
  /// Whether a cell holds a part of a film.
  [[nodiscard]] bool holds(Index cell) const { return !in_film_.empty() && in_film_[cell] != 0; }
  /// Sets values in and beside films to those of their layers: a film has half its thickness less the
  /// distance from its middle; what lies on a side differs from it by twice the distance from the film's
  /// face, so that differences are linear across an even layer.
  void set_values(MeshValues& values) const;

 private:
  class Search;
  struct Layer {
    MeshLayer layer;
    std::uint16_t film;                  ///< the number of the film's material
    std::array<std::uint16_t, 2> sides;  ///< those on the side to which the normal points, and on the other
  };

  std::vector<char> in_film_;  ///< by cell
  /// By cell in a film or beside one: its layer.
  std::vector<std::pair<Index, Layer>> layers_;
};

}  // namespace adamas::interfaces
