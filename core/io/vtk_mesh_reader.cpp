#include <fmt/format.h>
#include <vtkCGNSReader.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObjectTree.h>
#include <vtkDataObjectTreeIterator.h>
#include <vtkDataSet.h>
#include <vtkExodusIIReader.h>
#include <vtkFieldData.h>
#include <vtkHDFReader.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkOpenFOAMReader.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPStructuredGridReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUniformGridAMRReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/sort_unique.h"
#include "core/io/grid_numbers.h"
#include "core/io/input_file.h"
#include "core/io/mesh_builder.h"
#include "core/io/mesh_file.h"
#include "core/io/vtk_amr_reader.h"
#include "core/io/vtk_arrays.h"
#include "core/io/vtk_support.h"

namespace adamas::io {

namespace {

using Index = std::uint32_t;

/// A kind of cells: how many corners come first among its points, and its faces; cells of higher degree are
/// taken by their corners.
struct CellShape {
  std::size_t corners;
  const CellFaces* faces;
  bool higher_degree = false;
};

const CellFaces kVoxelFaces{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                            {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
const CellFaces kPentagonalPrismFaces{{0, 4, 3, 2, 1}, {5, 6, 7, 8, 9}, {0, 1, 6, 5}, {1, 2, 7, 6},
                                      {2, 3, 8, 7},    {3, 4, 9, 8},    {4, 0, 5, 9}};
const CellFaces kHexagonalPrismFaces{{0, 5, 4, 3, 2, 1}, {6, 7, 8, 9, 10, 11}, {0, 1, 7, 6},   {1, 2, 8, 7},
                                     {2, 3, 9, 8},       {3, 4, 10, 9},        {4, 5, 11, 10}, {5, 0, 6, 11}};

CellShape shape_of(int type) {
  switch (type) {
    case VTK_TETRA:
      return {4, &kTetrahedronFaces};
    case VTK_VOXEL:
      return {8, &kVoxelFaces};
    case VTK_HEXAHEDRON:
      return {8, &kHexahedronFaces};
    case VTK_WEDGE:
      return {6, &kWedgeFaces};
    case VTK_PYRAMID:
      return {5, &kPyramidFaces};
    case VTK_PENTAGONAL_PRISM:
      return {10, &kPentagonalPrismFaces};
    case VTK_HEXAGONAL_PRISM:
      return {12, &kHexagonalPrismFaces};
    case VTK_QUADRATIC_TETRA:
    case VTK_LAGRANGE_TETRAHEDRON:
      return {4, &kTetrahedronFaces, true};
    case VTK_QUADRATIC_HEXAHEDRON:
    case VTK_TRIQUADRATIC_HEXAHEDRON:
    case VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON:
    case VTK_LAGRANGE_HEXAHEDRON:
      return {8, &kHexahedronFaces, true};
    case VTK_QUADRATIC_WEDGE:
    case VTK_QUADRATIC_LINEAR_WEDGE:
    case VTK_BIQUADRATIC_QUADRATIC_WEDGE:
    case VTK_LAGRANGE_WEDGE:
      return {6, &kWedgeFaces, true};
    case VTK_QUADRATIC_PYRAMID:
    case VTK_TRIQUADRATIC_PYRAMID:
      return {5, &kPyramidFaces, true};
    default:
      return {0, nullptr};
  }
}

/// Returns how many corners a polygon of a type has; -1 for any number, 0 for other cells.
int polygon_corners(int type) {
  switch (type) {
    case VTK_TRIANGLE:
    case VTK_QUADRATIC_TRIANGLE:
      return 3;
    case VTK_PIXEL:
    case VTK_QUAD:
    case VTK_QUADRATIC_QUAD:
    case VTK_BIQUADRATIC_QUAD:
      return 4;
    case VTK_POLYGON:
      return -1;
    default:
      return 0;
  }
}

/// Returns whether cells of a type have no volume: points, lines, and cells of a surface.
bool is_flat(int type) {
  switch (type) {
    case VTK_EMPTY_CELL:
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
    case VTK_LINE:
    case VTK_POLY_LINE:
    case VTK_TRIANGLE:
    case VTK_TRIANGLE_STRIP:
    case VTK_POLYGON:
    case VTK_PIXEL:
    case VTK_QUAD:
    case VTK_QUADRATIC_EDGE:
    case VTK_QUADRATIC_TRIANGLE:
    case VTK_QUADRATIC_QUAD:
    case VTK_QUADRATIC_POLYGON:
    case VTK_QUADRATIC_LINEAR_QUAD:
    case VTK_BIQUADRATIC_QUAD:
    case VTK_BIQUADRATIC_TRIANGLE:
    case VTK_CUBIC_LINE:
    case VTK_LAGRANGE_CURVE:
    case VTK_LAGRANGE_TRIANGLE:
    case VTK_LAGRANGE_QUADRILATERAL:
      return true;
    default:
      return false;
  }
}

/// Returns how many points of a side of a cell are its corners; 0 for what is no side.
std::size_t side_corners(vtkDataSet& set, vtkIdType side) {
  const int type = set.GetCellType(side);
  if (type == VTK_LINE || type == VTK_QUADRATIC_EDGE) return 2;
  const int corners = polygon_corners(type);
  return corners < 0 ? static_cast<std::size_t>(set.GetCell(side)->GetNumberOfPoints())
                     : static_cast<std::size_t>(corners);
}

/// The name of a block of a file; empty where it has none.
std::string block_name(vtkMultiBlockDataSet& blocks, unsigned block) {
  const char* name =
      blocks.HasMetaData(block) != 0 ? blocks.GetMetaData(block)->Get(vtkCompositeDataSet::NAME()) : nullptr;
  return name != nullptr ? name : "";
}

/// Collects the cells of the data sets of a file.
class CellCollector {
 public:
  explicit CellCollector(std::string name) : name_(std::move(name)) {}

  void add(vtkDataObject* data, const std::string& block = {}) {
    if (auto* set = vtkDataSet::SafeDownCast(data)) {
      if (set->GetNumberOfCells() > 0) pieces_.push_back({set, block, {}, {}});
      return;
    }
    auto* tree = vtkDataObjectTree::SafeDownCast(data);
    if (tree == nullptr)
      fail("{}: expected cells of a mesh, found {}", name_, data ? data->GetClassName() : "nothing");
    const auto each = vtk::TakeSmartPointer(tree->NewTreeIterator());
    each->TraverseSubTreeOn();
    each->VisitOnlyLeavesOn();
    for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem()) {
      const bool named = each->HasCurrentMetaData() != 0 &&
                         each->GetCurrentMetaData()->Has(vtkCompositeDataSet::NAME()) != 0;
      const char* own = named ? each->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME()) : nullptr;
      add(each->GetCurrentDataObject(), own != nullptr ? own : fmt::format("block {}", pieces_.size() + 1));
    }
  }

  /// Takes the side sets and the node sets out of what is read of an ExodusII file, since they are no cells.
  void take_sets(vtkMultiBlockDataSet& file) {
    for (unsigned b = 0; b < file.GetNumberOfBlocks(); ++b) {
      const std::string kind = block_name(file, b);
      auto* const sets = vtkMultiBlockDataSet::SafeDownCast(file.GetBlock(b));
      if (sets == nullptr || (kind != "Side Sets" && kind != "Node Sets")) continue;
      const bool of_nodes = kind == "Node Sets";
      for (unsigned s = 0; s < sets->GetNumberOfBlocks(); ++s)
        sets_.push_back({vtkDataSet::SafeDownCast(sets->GetBlock(s)),
                         set_name(block_name(*sets, s), of_nodes), of_nodes});
      file.SetBlock(b, nullptr);
    }
  }

  MeshFile run() {
    choose_cells();
    number_points();
    add_cells();
    for (const SetPiece& set : sets_) add_set(set);
    if (unknown_ > 0)
      file_.add_remark(
          fmt::format("{} sides and nodes of sets that belong to no cell are left out", unknown_));
    add_arrays();
    add_blocks();
    return std::move(file_);
  }

 private:
  /// A side set or a node set of a file.
  struct SetPiece {
    vtkSmartPointer<vtkDataSet> set;  ///< polygons and lines, or vertices; null for an empty set
    std::string name;
    bool of_nodes;
  };

  /// The name of a set; VTK calls one that has none by a name of its own, which ends in its number.
  static std::string set_name(const std::string& name, bool of_nodes) {
    constexpr std::string_view kUnnamed = "Unnamed set ID: ";
    if (!name.starts_with(kUnnamed)) return name;
    return (of_nodes ? "node set " : "side set ") + name.substr(kUnnamed.size());
  }

  void add_set(const SetPiece& piece) {
    MeshSet& set = file_.sets.emplace_back();
    set.name = piece.name;
    set.of_nodes = piece.of_nodes;
    if (piece.set == nullptr) return;
    std::vector<std::optional<Index>> numbers;
    for (vtkIdType p = 0; p < piece.set->GetNumberOfPoints(); ++p) {
      std::array<double, 3> x{};
      piece.set->GetPoint(p, x.data());
      numbers.push_back(merger_->find({x[0], x[1], x[2]}));
    }
    piece.of_nodes ? add_nodes(numbers, set) : add_sides(*piece.set, numbers, set);
  }

  void add_nodes(const std::vector<std::optional<Index>>& numbers, MeshSet& set) {
    for (const std::optional<Index>& number : numbers) {
      if (number) set.points.push_back(*number);
    }
    unknown_ += numbers.size() - set.points.size();
    sort_unique(set.points);
  }

  void add_sides(vtkDataSet& sides, const std::vector<std::optional<Index>>& numbers, MeshSet& set) {
    std::vector<Index> own;
    for (vtkIdType s = 0; s < sides.GetNumberOfCells(); ++s) {
      own.clear();
      find_points(sides, s, side_corners(sides, s));
      for (std::size_t i = 0; i < side_corners(sides, s); ++i) {
        const auto p = static_cast<std::size_t>(ids_->GetId(static_cast<vtkIdType>(i)));
        // A side of a cell that has collapsed may have a point twice.
        if (p < numbers.size() && numbers[p] && std::ranges::find(own, *numbers[p]) == own.end())
          own.push_back(*numbers[p]);
      }
      if (file_.flat ? own.size() == 2 : own.size() >= 3) {
        set.add_side(own);
      } else {
        ++unknown_;
      }
    }
  }

  /// Finds the cells that have a volume, or polygons if there are none, and are no copies of those of another
  /// piece.
  void choose_cells() {
    std::map<int, std::size_t> refused;
    std::vector<std::vector<vtkIdType>> polygons(pieces_.size());
    for (std::size_t n = 0; n < pieces_.size(); ++n) {
      MeshPiece& piece = pieces_[n];
      const vtkUnsignedCharArray* ghosts = piece.set->GetCellGhostArray();
      for (vtkIdType c = 0; c < piece.set->GetNumberOfCells(); ++c) {
        const unsigned ghost = ghosts != nullptr && c < ghosts->GetNumberOfTuples()
                                   ? const_cast<vtkUnsignedCharArray*>(ghosts)->GetValue(c)
                                   : 0;
        if ((ghost & vtkDataSetAttributes::DUPLICATECELL) != 0) continue;
        if ((ghost & (vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL)) != 0) {
          ++hidden_;
          continue;
        }
        const int type = piece.set->GetCellType(c);
        if (type == VTK_POLYHEDRON || shape_of(type).faces != nullptr) {
          piece.cells.push_back(c);
        } else if (is_flat(type)) {
          ++flat_;
          if (polygon_corners(type) != 0) polygons[n].push_back(c);
        } else {
          ++refused[type];
        }
      }
    }
    if (!refused.empty()) {
      fail(
          "{}: expected tetrahedra, hexahedra, wedges, pyramids, prisms or polyhedra, found {} cells of "
          "VTK's "
          "type {}",
          name_, refused.begin()->second, refused.begin()->first);
    }
    file_.flat = std::ranges::all_of(pieces_, [](const MeshPiece& piece) { return piece.cells.empty(); });
    for (std::size_t n = 0; file_.flat && n < pieces_.size(); ++n) {
      flat_ -= polygons[n].size();
      pieces_[n].cells = std::move(polygons[n]);
    }
    std::erase_if(pieces_, [](const MeshPiece& piece) { return piece.cells.empty(); });
    if (pieces_.empty()) fail("{}: expected cells with a volume, found none", name_);
    for (const MeshPiece& piece : pieces_) {
      std::array<double, 6> bounds{};
      piece.set->GetBounds(bounds.data());
      const double size = std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
      if (file_.flat && !(bounds[5] - bounds[4] <= kFlat * size))
        fail("{}: expected cells with a volume, or cells in the plane of x and y, found those of a surface",
             name_);
    }
  }

  void number_points() {
    Box3 box;
    std::size_t count = 0;
    for (const MeshPiece& piece : pieces_) {
      count += static_cast<std::size_t>(piece.set->GetNumberOfPoints());
      std::array<double, 6> bounds{};
      piece.set->GetBounds(bounds.data());
      box.extend({bounds[0], bounds[2], bounds[4]});
      box.extend({bounds[1], bounds[3], bounds[5]});
    }
    if (count >= std::numeric_limits<Index>::max())
      fail("{}: expected fewer than {} points, found {}", name_, std::numeric_limits<Index>::max(), count);
    PointMerger& merger =
        merger_.emplace(PointMerger::kCoincident * std::max(box.diagonal(), 1e-300), file_.points);
    for (MeshPiece& piece : pieces_) {
      std::vector<Index>& numbers = numbers_.emplace_back();
      for (vtkIdType p = 0; p < piece.set->GetNumberOfPoints(); ++p) {
        std::array<double, 3> x{};
        piece.set->GetPoint(p, x.data());
        const Vec3 at{x[0], x[1], x[2]};
        const auto next = static_cast<Index>(file_.points.size());
        if (is_finite(at)) {
          numbers.push_back(merger.number(at));
        } else {
          numbers.push_back(next);
          file_.points.push_back(at);
        }
        if (numbers.back() == next) {
          piece.points.push_back(p);
        } else {
          ++merged_;
        }
      }
    }
  }

  /// Adds a face of a cell of a piece.
  void add_face(const std::vector<Index>& numbers, std::span<const vtkIdType> points) {
    std::vector<Index> face;
    for (const vtkIdType p : points) {
      if (p < 0 || static_cast<std::size_t>(p) >= numbers.size())
        fail("{}: expected cells of {} points, found a cell of point {}", name_, numbers.size(), p);
      face.push_back(numbers[static_cast<std::size_t>(p)]);
    }
    append_face(face, file_);
  }

  /// Finds the points of a cell, of which it must have as many as corners. Returns how many there are.
  std::size_t find_points(vtkDataSet& set, vtkIdType cell, std::size_t corners) {
    set.GetCellPoints(cell, ids_);
    const auto found = static_cast<std::size_t>(ids_->GetNumberOfIds());
    if (found < corners)
      fail("{}: expected a cell of {} points, found {} of cell {}", name_, corners, found, cell);
    return found;
  }

  void add_polygon(vtkDataSet& set, vtkIdType cell, const std::vector<Index>& numbers) {
    const int type = set.GetCellType(cell), corners = polygon_corners(type);
    const std::size_t found = find_points(set, cell, static_cast<std::size_t>(std::max(corners, 0)));
    const std::size_t count = corners < 0 ? found : static_cast<std::size_t>(corners);
    std::vector<vtkIdType> face(ids_->GetPointer(0), ids_->GetPointer(0) + count);
    if (type == VTK_PIXEL) std::swap(face[2], face[3]);
    higher_degree_ = higher_degree_ || found > count;
    add_face(numbers, face);
  }

  void add_polyhedron(vtkUnstructuredGrid& set, vtkIdType cell, const std::vector<Index>& numbers) {
    set.GetFaceStream(cell, ids_);
    vtkIdType at = 0;
    const auto next = [&] { return at < ids_->GetNumberOfIds() ? ids_->GetId(at++) : -1; };
    for (vtkIdType faces = next(); faces > 0; --faces) {
      const vtkIdType size = next();
      if (size < 0 || size > ids_->GetNumberOfIds() - at)
        fail("{}: expected a polyhedron with its faces, found cell {}", name_, cell);
      add_face(numbers, {ids_->GetPointer(at), static_cast<std::size_t>(size)});
      at += size;
    }
  }

  void add_common_cell(vtkDataSet& set, vtkIdType cell, const std::vector<Index>& numbers) {
    const CellShape shape = shape_of(set.GetCellType(cell));
    find_points(set, cell, shape.corners);
    higher_degree_ = higher_degree_ || shape.higher_degree;
    std::vector<vtkIdType> face;
    for (const auto& places : *shape.faces) {
      face.clear();
      for (const std::size_t place : places) face.push_back(ids_->GetId(static_cast<vtkIdType>(place)));
      add_face(numbers, face);
    }
  }

  void add_cells() {
    std::vector<vtkIdType> kept;
    for (std::size_t n = 0; n < pieces_.size(); ++n) {
      vtkDataSet& set = *pieces_[n].set;
      kept.clear();
      for (const vtkIdType c : pieces_[n].cells) {
        if (file_.flat) {
          add_polygon(set, c, numbers_[n]);
        } else if (set.GetCellType(c) == VTK_POLYHEDRON) {
          add_polyhedron(*vtkUnstructuredGrid::SafeDownCast(&set), c, numbers_[n]);
        } else {
          add_common_cell(set, c, numbers_[n]);
        }
        if (end_cell(file_)) kept.push_back(c);
      }
      collapsed_ += pieces_[n].cells.size() - kept.size();
      pieces_[n].cells = kept;
    }
    std::erase_if(pieces_,
                  [](const MeshPiece& piece) { return piece.cells.empty() && piece.points.empty(); });
    if (collapsed_ > 0)
      file_.add_remark(fmt::format("{} cells that have collapsed are left out", collapsed_));
    if (hidden_ > 0)
      file_.add_remark(fmt::format("{} cells that are hidden or refined are left out", hidden_));
    if (higher_degree_) file_.add_remark("cells of higher degree are taken by their corners");
    if (flat_ > 0) file_.add_remark(fmt::format("{} cells of surfaces and lines are not read", flat_));
  }

  void add_arrays() {
    add_arrays_of(name_, pieces_, file_);
    const bool on_points = std::ranges::any_of(
        file_.arrays, [](const GridArray& array) { return array.centering == Centering::kPoints; });
    if (merged_ > 0 && on_points)
      file_.add_remark(
          fmt::format("{} points at the places of others are left out with their values", merged_));
  }

  /// Sets the blocks, in the order in which their names come first, and that of each cell.
  void add_blocks() {
    for (const MeshPiece& piece : pieces_) {
      const auto found = std::ranges::find(file_.blocks, piece.block);
      const auto number = static_cast<std::int32_t>(found - file_.blocks.begin());
      if (found == file_.blocks.end()) file_.blocks.push_back(piece.block);
      file_.block_of_cell.insert(file_.block_of_cell.end(), piece.cells.size(), number);
    }
    if (file_.blocks.size() > 1) return;
    file_.blocks.clear();
    file_.block_of_cell.clear();
  }

  /// Cells lie in a plane if they leave it by at most this part of their extent.
  static constexpr double kFlat = 1e-9;

  std::string name_;
  std::vector<MeshPiece> pieces_;
  std::vector<std::vector<Index>> numbers_;                             // of the points of each piece
  vtkSmartPointer<vtkIdList> ids_ = vtkSmartPointer<vtkIdList>::New();  // of the points of one cell
  std::size_t flat_ = 0, hidden_ = 0, collapsed_ = 0, merged_ = 0;
  std::size_t unknown_ = 0;  // sides and nodes of sets that are not at the cells
  bool higher_degree_ = false;
  std::vector<SetPiece> sets_;
  std::optional<PointMerger> merger_;  // of the points of the file
  MeshFile file_;
};

constexpr const char* kExodus = "ExodusII";

/// Collects the cells of what a reader found; `remark`: what is to be said of it besides.
MeshFile collected(const std::string& name, const char* kind, vtkDataObject* data,
                   const std::string& remark = {}) {
  CellCollector collector(name);
  if (auto* const blocks = vtkMultiBlockDataSet::SafeDownCast(data);
      blocks != nullptr && kind == std::string_view(kExodus))
    collector.take_sets(*blocks);
  collector.add(data);
  MeshFile file = collector.run();
  file.kind = kind;
  if (!remark.empty()) {
    const std::string of_cells = std::exchange(file.remark, remark);
    if (!of_cells.empty()) file.add_remark(of_cells);
  }
  return file;
}

template <class Reader>
MeshFile read_xml(const std::string& name, const char* kind, const VtkMessages& messages) {
  const auto data = read_if_readable<Reader>(name, fmt::format("a {}", kind), messages);
  return collected(name, kind, data);
}

MeshFile read_amr(const std::string& name, const VtkMessages& messages) {
  const auto reader = vtkSmartPointer<vtkXMLUniformGridAMRReader>::New();
  if (reader->CanReadFile(name.c_str()) == 0)
    fail("{}: expected VTK XML AMR data, found something else", name);
  reader->SetMaximumLevelsToReadByDefault(0);  // all
  MeshFile file = cells_of_amr(name, *read_with_vtk(*reader, name, messages));
  file.kind = "VTK XML AMR";
  return file;
}

vtkSmartPointer<vtkAlgorithm> open_openfoam(const std::string& name) {
  const auto reader = vtkSmartPointer<vtkOpenFOAMReader>::New();
  reader->SetFileName(name.c_str());
  reader->DecomposePolyhedraOff();
  reader->CreateCellToPointOff();
  reader->SkipZeroTimeOff();
  reader->UpdateInformation();
  // Of a case with regions, the mesh of each is "REGION/internalMesh".
  for (int i = 0; i < reader->GetNumberOfPatchArrays(); ++i) {
    const std::string patch = reader->GetPatchArrayName(i);
    reader->SetPatchArrayStatus(patch.c_str(), patch.ends_with("internalMesh") ? 1 : 0);
  }
  return reader;
}

vtkSmartPointer<vtkAlgorithm> open_exodus(const std::string& name) {
  const auto reader = vtkSmartPointer<vtkExodusIIReader>::New();
  if (reader->CanReadFile(name.c_str()) == 0)
    fail("{}: expected an ExodusII file, found something else", name);
  reader->SetFileName(name.c_str());
  reader->UpdateInformation();
  for (const int type : {vtkExodusIIReader::ELEM_BLOCK, vtkExodusIIReader::NODAL})
    reader->SetAllArrayStatus(type, 1);
  for (const int type : {vtkExodusIIReader::SIDE_SET, vtkExodusIIReader::NODE_SET}) {
    for (int set = 0; set < reader->GetNumberOfObjects(type); ++set) reader->SetObjectStatus(type, set, 1);
  }
  return reader;
}

vtkSmartPointer<vtkAlgorithm> open_cgns(const std::string& name) {
  const auto reader = vtkSmartPointer<vtkCGNSReader>::New();
  reader->SetFileName(name.c_str());
  reader->UpdateInformation();
  reader->EnableAllBases();
  reader->EnableAllFamilies();
  reader->EnableAllCellArrays();
  reader->EnableAllPointArrays();
  return reader;
}

/// A format whose files may have several times, and its reader.
struct TimedFormat {
  const char* kind;
  vtkSmartPointer<vtkAlgorithm> (*open)(const std::string& name);
};

/// Returns the format of a file that may have several times; none for those of the other endings here.
std::optional<TimedFormat> timed_format(const std::string& extension) {
  if (extension == ".foam") return TimedFormat{"OpenFOAM case", open_openfoam};
  if (extension == ".cgns") return TimedFormat{"CGNS", open_cgns};
  for (const char* exodus : {".exo", ".e", ".ex2", ".exii", ".g", ".gen"}) {
    if (extension == exodus) return TimedFormat{kExodus, open_exodus};
  }
  return {};
}

std::vector<double> times_of(vtkAlgorithm& reader) {
  reader.UpdateInformation();
  vtkInformation& information = *reader.GetOutputInformation(0);
  auto* const key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  if (information.Has(key) == 0) return {};
  const double* first = information.Get(key);
  return {first, first + information.Length(key)};
}

MeshFile read_timed(const std::string& name, const TimedFormat& format, std::optional<std::uint64_t> time,
                    const VtkMessages& messages) {
  const auto reader = format.open(name);
  const std::vector<double> times = times_of(*reader);
  if (time.value_or(0) >= std::max<std::size_t>(times.size(), 1)) fail_for_time(name, times.size(), *time);
  std::string remark;
  if (times.empty()) {
    reader->Update();
  } else {
    const double chosen = times[time.value_or(times.size() - 1)];
    reader->UpdateTimeStep(chosen);
    if (!time && times.size() > 1) remark = last_time_remark(times.size(), chosen);
  }
  messages.check(name);
  MeshFile file = collected(name, format.kind, reader->GetOutputDataObject(0), remark);
  file.times = times;
  return file;
}

}  // namespace

MeshFile read_mesh_with_vtk(const std::filesystem::path& path, std::optional<std::uint64_t> time) {
  const VtkMessages messages;
  const std::string name = path.string(), extension = file_extension(path);
  if (const auto format = timed_format(extension)) return read_timed(name, *format, time, messages);
  if (time.value_or(0) != 0) fail_for_time(name, 1, *time);
  MeshFile file;
  if (extension == ".vth" || extension == ".vthb") {
    file = read_amr(name, messages);
  } else if (extension == ".vtu") {
    file = read_xml<vtkXMLUnstructuredGridReader>(name, "VTK XML unstructured grid", messages);
  } else if (extension == ".pvtu") {
    file = read_xml<vtkXMLPUnstructuredGridReader>(name, "VTK XML unstructured grid in pieces", messages);
  } else if (extension == ".vts") {
    file = read_xml<vtkXMLStructuredGridReader>(name, "VTK XML structured grid", messages);
  } else if (extension == ".pvts") {
    file = read_xml<vtkXMLPStructuredGridReader>(name, "VTK XML structured grid in pieces", messages);
  } else if (extension == ".vtm") {
    file = read_xml<vtkXMLMultiBlockDataReader>(name, "VTK XML multiblock file", messages);
  } else if (extension == ".vtkhdf") {
    file = collected(name, "VTKHDF", read_if_readable<vtkHDFReader>(name, "VTKHDF", messages));
  } else {
    file = collected(name, "legacy VTK mesh", read_legacy_vtk(name, messages));
  }
  messages.check(name);
  return file;
}

std::vector<double> mesh_times_with_vtk(const std::filesystem::path& path) {
  const VtkMessages messages;
  const auto format = timed_format(file_extension(path));
  if (!format) return {};
  const auto reader = format->open(path.string());
  const std::vector<double> times = times_of(*reader);
  messages.check(path.string());
  return times;
}

}  // namespace adamas::io
