#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

/// Options of `adamas store`, with the same defaults: how a volume is made into a store.
struct BuildOptions {
  /// Samples are predicted from all neighbours that are known, or only from the two ends of the edge whose
  /// middle they are: larger files.
  bool by_split_edges = false;
  bool gradients = false;        ///< keep the directions of gradients too, for the normals of surfaces
  bool smooth_gradients = true;  ///< smooth these first, and fill regions without any from their borders
  /// A folder for up to four times the bytes of the samples, and four for each gradient; empty: the system's
  /// for temporary files.
  std::filesystem::path scratch{};
};

/// Options that say how a store is opened.
struct OpenOptions {
  std::size_t memory = std::size_t{256} << 20;  ///< bytes that decoded pages may take
  bool mapped = false;                          ///< read by a mapping of the file, which the system pages
};

/// Options that say which surface of a store is wanted.
struct IsosurfaceRequest {
  double isovalue = 0;  ///< a value (VolumeGrid::slope)
  /// The greatest isosurface error, an estimate of the distance to the surface of all samples, in units of
  /// length; 0: all that the samples say.
  double error = 0;
  /// Never more triangles, whatever the error: a finer surface is decimated (quadric error metric, topology
  /// kept); a plain one is refined where its errors are greatest.
  std::optional<std::uint64_t> max_triangles{};
  /// Only the surface in this box, in space, which must meet the data's.
  std::optional<Box3> region{};
  /// The contour of the tetrahedra as it is: three times the triangles, many of them narrow. Otherwise points
  /// next to a vertex of the mesh are joined, where that changes no topology.
  bool plain = false;
  bool normals = true;  ///< of points, from gradients of the samples
  /// Measure the distance to the surface of all samples, and refine until it is within the error; takes the
  /// time of that surface several times.
  bool certify = false;
  /// Damaged pages are an Error, not a coarser surface round them.
  bool strict = false;
};

/// A closed surface of equal value, and what it took.
struct Isosurface {
  /// Triangles face values below the isovalue, and so do normals; a normal is zero where nothing changes.
  TriangleSurface surface;
  /// The greatest isosurface error that is left and the greatest of decimation, in units of length: an
  /// estimate.
  double max_error = 0;
  /// Set if it was asked for: neither this surface nor that of all samples has a point farther from the other
  /// than `certified`, and some point is as far as `found`. Infinite where one of them is empty.
  struct Distance {
    double certified = 0, found = 0;
  };
  std::optional<Distance> distance{};
  std::uint64_t bodies_left_out = 0;  ///< small ones for which there were too few triangles
  /// Tetrahedra of the mesh that the surface is from; where everything in it is split, those in the cells of
  /// samples that the surface crosses.
  std::uint64_t tetrahedra = 0;
  std::uint64_t diamonds = 0;  ///< of it that are split; 0 where all are
  /// Pages of the file that could not be had: the surface is coarser round them, or normals less exact.
  std::size_t damaged_pages = 0;
};

/// A volume in one compressed file (`.adm`, docs/file_formats.md), of which calls read only what they need.
/// Decoded pages are kept for later calls. A store is for one thread at a time; several objects may be used
/// at once, of one file too.
class VolumeStore {
 public:
  /// Throws Error, which names the file, where it is missing, no store, cut off, or damaged in what says
  /// where things lie.
  static VolumeStore open(const std::filesystem::path& path, const OpenOptions& options = {});

  /// Fills the samples of plane k: grid.plane_bytes() of them, in the machine's byte order.
  using PlaneSource = std::function<void(std::uint64_t k, std::span<std::byte> samples)>;
  /// Makes a store at `path`, without loss, of samples that come plane by plane; planes are asked for several
  /// times, in any order. Needs 1 GiB of memory and 64 bytes for each sample of a plane. The file gets its
  /// name when it is whole and is the same whatever the number of threads. Throws Error for a grid that is
  /// none (VolumeGrid::check), options that are none, and where the file cannot be written.
  static void build(const std::filesystem::path& path, const VolumeGrid& grid, const PlaneSource& planes,
                    const BuildOptions& options = {}, Progress& progress = SilentProgress::instance());
  /// Makes a store of samples in memory, which are read where they are: i fastest, then j. Throws Error too
  /// where there are not grid.bytes() of them.
  static void build(const std::filesystem::path& path, const VolumeGrid& grid,
                    std::span<const std::byte> samples, const BuildOptions& options = {},
                    Progress& progress = SilentProgress::instance());

  VolumeStore(VolumeStore&&) noexcept;
  VolumeStore& operator=(VolumeStore&&) noexcept;
  ~VolumeStore();

  /// Dimensions, type of samples, spacing, origin, directions of the axes and the name of the space.
  [[nodiscard]] const VolumeGrid& grid() const;
  /// Levels that restore() knows: 0 is every sample, level N every 2^N-th along each axis.
  [[nodiscard]] int levels() const;
  /// The least and the greatest finite sample, as values (VolumeGrid::slope); none where there is no finite
  /// one. Throws Error where the part of the file that tells of them is damaged.
  [[nodiscard]] std::optional<std::array<double, 2>> range();
  /// Bytes of the file.
  [[nodiscard]] std::uint64_t file_bytes() const;

  /// Throws Error for errors and isovalues that are not finite or negative errors, a region apart from the
  /// data, data of one plane of samples, and damage (see IsosurfaceRequest); Cancelled where the progress
  /// says so.
  Isosurface isosurface(const IsosurfaceRequest& request, Progress& progress = SilentProgress::instance());

  /// Samples bit for bit: of a level, in a box in space or everywhere. The grid says where they lie. Throws
  /// Error where there is no such level, no sample in the region, or a page is damaged.
  Volume restore(const std::optional<Box3>& region = {}, int level = 0,
                 Progress& progress = SilentProgress::instance());

 private:
  class Contents;
  template <class Sample>
  class ContentsOf;
  explicit VolumeStore(std::unique_ptr<Contents> contents);
  std::unique_ptr<Contents> contents_;
};

}  // namespace adamas
