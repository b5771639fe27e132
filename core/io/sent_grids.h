#pragma once

#include "adamas/file_summary.h"
#include "core/io/framed_bytes.h"
#include "core/io/grid_file.h"
#include "core/io/mesh_file.h"

namespace adamas::io {

template <>
inline constexpr auto kSentMembers<GridArray> = std::tuple{&GridArray::name,
                                                           &GridArray::type,
                                                           &GridArray::centering,
                                                           &GridArray::components,
                                                           &GridArray::component_names,
                                                           &GridArray::values,
                                                           &GridArray::slope,
                                                           &GridArray::intercept,
                                                           &GridArray::label_names};
template <>
inline constexpr auto kSentMembers<GridFile> =
    std::tuple{&GridFile::kind,  &GridFile::nodes,  &GridFile::arrays, &GridFile::material_names,
               &GridFile::faces, &GridFile::aslant, &GridFile::space,  &GridFile::remark};

template <>
inline constexpr auto kSentMembers<MeshSet> =
    std::tuple{&MeshSet::name, &MeshSet::of_nodes, &MeshSet::points, &MeshSet::side_ends};
template <>
inline constexpr auto kSentMembers<MeshFile> =
    std::tuple{&MeshFile::kind,      &MeshFile::points, &MeshFile::face_points,   &MeshFile::face_ends,
               &MeshFile::cell_ends, &MeshFile::arrays, &MeshFile::blocks,        &MeshFile::material_names,
               &MeshFile::remark,    &MeshFile::flat,   &MeshFile::block_of_cell, &MeshFile::sets,
               &MeshFile::times};

/// Hidden, since the library shows what is made of types that it declares.
template <>
[[gnu::visibility("hidden")]] inline constexpr auto kSentMembers<SeriesSummary> =
    std::tuple{&SeriesSummary::name, &SeriesSummary::uid, &SeriesSummary::kind, &SeriesSummary::files};

/// Converts names to the form in which they are shown: users ask for them in this form, and XML cannot hold
/// all characters.
void show_names(std::vector<GridArray>& arrays, std::vector<std::string>& material_names);

}  // namespace adamas::io
