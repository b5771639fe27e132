#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/data/interface_mesh.h"

namespace adamas::io {

/// A network of labelled triangles as text files hold it: "nv", nv lines "x y z", "nt", nt lines "a b c left
/// right", with indices from 0 (LosTopo's .arec; Da, Batty and Grinspun, ACM Trans. Graph. 33, 2014).
struct LabelledNetwork {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 2>> labels;
};

/// Reads a network from text. Throws Error with `name` and the line unless it is a complete network of finite
/// points and indices in range.
LabelledNetwork parse_labelled_network(std::string_view text, const std::string& name);

/// What a text says of regions, by their labels.
struct RegionTable {
  std::map<std::int64_t, std::string> names;
  std::map<std::int64_t, std::array<double, 3>> colours;  ///< red, green and blue from 0 to 1
};

/// Reads regions from lines "LABEL NAME", or from a table of labels of ITK-SNAP, whose names are in quotes
/// behind six numbers, the first three of them a colour; blank lines and those that begin with '#' or '(' are
/// skipped. Labels whose opacity is 0, and those of other lines, have no colour.
RegionTable parse_region_table(std::string_view text, const std::string& name);

/// Whether the first label of a triangle is the region that its right-hand normal points to. Sources differ,
/// so the data decide: the closed regions, or all if none is closed, have positive volumes except for the
/// unbounded one. If two regions leave it open, the one with the smaller label is taken to be unbounded.
bool first_label_is_front(const LabelledNetwork& network);

/// Converts a network. Its materials are the labels in ascending order, named by `names` or else by number.
/// Triangles with one label on both sides are no interfaces and are removed.
InterfaceMesh to_interface_mesh(const LabelledNetwork& network,
                                const std::map<std::int64_t, std::string>& names, const std::string& source);

}  // namespace adamas::io
