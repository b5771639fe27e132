#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/page_reads.h"
#include "adamas/progress.h"
#include "adamas/steps.h"
#include "adamas/volume.h"

namespace adamas::timevarying {
struct StoreAccess;
}

namespace adamas ADAMAS_API {

/// Options that say how a volume or a series is made into a store; the defaults are those of `adamas store`.
struct BuildOptions {
  /// The prediction of samples.
  enum class Prediction : std::uint8_t {
    kInterpolation,  ///< prediction from all neighbours that are known already
    kSplitEdge,      ///< prediction from the two ends of the edge with this midpoint: larger files
    kNone,           ///< no prediction: samples and gradients are stored as they are, for comparison
  };
  /// The smoothing of gradients.
  enum class Smoothing : std::uint8_t {
    kNone,
    kFirstPhase,  ///< regions without gradients are filled from their borders
    kBothPhases,
  };

  /// The prediction; none: kInterpolation, or that of the store that steps are added to.
  std::optional<Prediction> prediction{};
  /// Keep the directions of gradients too, for the normals of surfaces.
  bool gradients = false;
  std::optional<Smoothing> smoothing{};  ///< needs `gradients`; none: kBothPhases
  /// Smooth gradients of a series along time too, within a block, if they are smoothed by both phases.
  bool smooth_along_time = true;
  /// The number of steps of a series that each page has side by side in the file, from 1 to 256.
  std::uint32_t block_steps = 32;
  /// The number of neighbouring pages of a series that lie together step by step, a power of two up to 512.
  /// With 1, playing is fast; with many, reading one step is. None: 1, or that of the store that steps are
  /// added to.
  std::optional<std::uint32_t> group_pages{};
  /// A folder for temporary files of up to four times the bytes of the samples, and four bytes for each
  /// gradient; empty: the system's folder for temporary files.
  std::filesystem::path scratch{};
};

/// A series of volumes on one grid.
struct SeriesSource {
  VolumeGrid grid;
  std::vector<double> times;  ///< times of the steps, ascending
  /// Returns the function that fills the samples of plane k of a step (VolumeStore::PlaneSource). Steps are
  /// asked for in ascending order.
  std::function<std::function<void(std::uint64_t k, std::span<std::byte> samples)>(std::uint32_t step)>
      planes;
  /// The type of the numbers that samples are read from, where it is none that samples have: int8, which
  /// become int16, and whole numbers of four and eight bytes and float64, which become float32. Restoring
  /// returns these numbers, bit for bit.
  std::optional<StoredType> numbers{};
  /// Fills these numbers of plane k of the step whose planes were asked for last, in the machine's byte
  /// order.
  std::function<void(std::uint64_t k, std::span<std::byte> numbers)> number_planes{};
  std::string array{};  ///< the name of the array; empty where it has none
};

/// Numbers of bytes of a store by the parts of pages, without second copies of coarse pages.
struct StoredBytes {
  std::uint64_t samples = 0;
  std::uint64_t bounds = 0;  ///< errors and ranges
  std::uint64_t gradients = 0;
  std::uint64_t remainders = 0;  ///< what numbers are more than their samples (SeriesSource::numbers)
};

/// The result of building a store or of adding steps to it.
struct BuildReport {
  StoredBytes bytes;
  std::uint64_t pages = 0;       ///< pages of all steps
  std::uint64_t file_bytes = 0;  ///< size of the whole file
};

/// The default number of bytes that the decoded pages of a store may take.
inline constexpr std::size_t kDefaultPageMemory = std::size_t{256} << 20;

/// Options that say how a store is opened.
struct OpenOptions {
  std::size_t memory = kDefaultPageMemory;  ///< bytes that decoded pages may take
  bool mapped = false;                      ///< read by a memory mapping of the file
};

/// Options that say which surface of a store is wanted.
struct IsosurfaceRequest {
  double isovalue = 0;  ///< a value (VolumeGrid::slope)
  /// The number of the step, from 0 on; none: the first one, which a note says where there are several.
  std::optional<std::uint64_t> step{};
  /// The greatest isosurface error, an estimate of the distance to the surface of all samples: a length, a
  /// part of the data's diagonal, or in voxels, that is, in the least spacing. 0: all that the samples say.
  ErrorTarget error{};
  /// The greatest number of triangles, whatever the error: a finer surface is decimated (quadric error
  /// metric, topology kept); a plain one is refined where its errors are greatest.
  std::optional<std::uint64_t> max_triangles{};
  /// Extract only the surface in this box, in space, which must meet the data's box.
  std::optional<Box3> region{};
  /// Return the contour of the tetrahedra as it is: three times the triangles, many of them narrow. Otherwise
  /// points next to a vertex of the mesh are joined, where that changes no topology.
  bool plain = false;
  bool normals = true;  ///< compute normals of points from gradients of the samples
  /// Measure the distance to the surface of all samples, and refine until it is within the error; takes the
  /// time of that surface several times.
  bool certify = false;
  /// Throw Error for damaged pages, in place of returning a coarser surface round them.
  bool strict = false;
};

/// A closed surface of equal value, or several surfaces of one step, with figures.
struct Isosurface {
  /// Triangles face values below the isovalue, and so do normals; a normal is zero where nothing changes.
  TriangleSurface surface;
  /// For several isovalues, in the order in which they were asked for: isosurface n has the triangles from
  /// `ends[n - 1]` to `ends[n]` - 1.
  std::vector<std::size_t> ends;
  /// The greatest isosurface error that is left plus the error of decimation, in units of length: an
  /// estimate.
  double max_error = 0;
  /// The distance to the surface of all samples, if it was asked for: neither surface has a point farther
  /// from the other than `certified`, and some point is as far as `found`. Infinite where one of them is
  /// empty.
  struct Distance {
    double certified = 0, found = 0;
  };
  std::optional<Distance> distance{};
  std::uint64_t bodies_left_out = 0;  ///< small bodies for which there were too few triangles
  /// Tetrahedra of the mesh that the surface is from; where every diamond is split, those in the cells of
  /// samples that the surface crosses.
  std::uint64_t tetrahedra = 0;
  std::uint64_t diamonds = 0;  ///< its split diamonds; 0 where all are split
  /// Pages of the file that could not be read: the surface is coarser round them, or normals are less exact.
  std::size_t damaged_pages = 0;
  /// Reads for the surfaces of this step, by this call and those before it.
  PageReads reads;
};

/// Options that say which samples of a store are restored.
struct VolumePart {
  std::optional<Box3> region{};  ///< only the samples in this box, in space; none: all
  int lod = 0;                   ///< the level of detail. 0: every sample; N: every 2^N-th along each axis
};

/// Whether a file has the name of a store (.adm).
bool is_store(const std::filesystem::path& path);

/// A problem of pages.
struct PageProblem {
  std::string what;                  ///< "the page of LOD 0 at 1, 1, 1 is damaged"
  std::vector<std::uint32_t> steps;  ///< steps at which it occurs, ascending
};

/// The result of a check of a store.
struct VerifiedStore {
  std::uint64_t pages = 0;
  /// Pages that are damaged, in both copies where there are two, or predicted from such pages.
  std::uint64_t bad_pages = 0;
  std::uint64_t bad_copies = 0;          ///< pages one of whose two copies is damaged
  std::vector<std::uint32_t> bad_steps;  ///< steps with bad pages, ascending
  std::vector<PageProblem> problems;     ///< the first problems
  std::uint64_t further_problems = 0;    ///< number of further problems, counted per page and step
};

/// Describes a store.
struct StoreFacts {
  /// The coding of samples in the file.
  enum class Coding : std::uint8_t {
    kInterpolation,  ///< predicted from all neighbours that are known already
    kRanks,          ///< predicted in the same way, as ranks among the few different values of the samples
    kSplitEdge,      ///< predicted from the ends of the edge with this midpoint
    kNone,           ///< stored as they are
  };
  Coding coding = Coding::kInterpolation;
  bool gradients = false;              ///< whether there are directions of gradients
  std::uint64_t pages = 0;             ///< pages of each step
  std::size_t blocks = 0;              ///< blocks of steps that were stored together
  std::uint32_t group_pages = 1;       ///< BuildOptions::group_pages
  std::uint64_t number_bytes = 0;      ///< uncompressed bytes of the numbers of all steps
  StoredBytes bytes;                   ///< bytes of all steps
  std::uint64_t file_bytes = 0;        ///< size of the file
  std::uint64_t unfinished_bytes = 0;  ///< bytes at the end of the file of steps that were never finished
};

/// A volume, or a series of volumes on one grid, in one compressed file (`.adm`, docs/file_formats.md). Calls
/// read only the parts that they need, and keep decoded pages for later calls. One thread at a time may use
/// an object; several objects may be used at once, even for one file.
class VolumeStore {
 public:
  /// Opens a store. Throws Error, which names the file, where it is missing, no store, cut off, or damaged in
  /// its directory.
  static VolumeStore open(const std::filesystem::path& path, const OpenOptions& options = {});

  /// Fills the samples of plane k: grid.plane_bytes() bytes, in the machine's byte order.
  using PlaneSource = std::function<void(std::uint64_t k, std::span<std::byte> samples)>;
  /// Makes a store at `path`, without loss, of samples that come plane by plane; planes are asked for several
  /// times, in any order. Needs 1 GiB of memory and 64 bytes for each sample of a plane. The file gets its
  /// name when it is whole and does not depend on the number of threads. Throws Error for an invalid grid
  /// (VolumeGrid::check) and where the file cannot be written, and Error (kUsage) for options that are
  /// invalid or contradict each other.
  static BuildReport build(const std::filesystem::path& path, const VolumeGrid& grid,
                           const PlaneSource& planes, const BuildOptions& options = {},
                           Progress& progress = SilentProgress::instance());
  /// Makes a store of samples in memory, which are read in place: i fastest, then j. Throws Error too where
  /// `samples` does not have grid.bytes() bytes.
  static BuildReport build(const std::filesystem::path& path, const VolumeGrid& grid,
                           std::span<const std::byte> samples, const BuildOptions& options = {},
                           Progress& progress = SilentProgress::instance());
  /// Makes a store of a series; pages may be coded with those of the steps before. Throws Error too where
  /// there is no step or times do not ascend.
  static BuildReport build(const std::filesystem::path& path, const SeriesSource& series,
                           const BuildOptions& options = {}, Progress& progress = SilentProgress::instance());
  /// Adds steps behind the last one of a store, which stays whole even if this fails. Stores that are open do
  /// not see the steps. Throws Error where the steps are on another grid, have numbers of another type or an
  /// array of another name, or are not later, and where another process adds steps; and Error (kUsage) for
  /// options that are not those of the store.
  static BuildReport append(const std::filesystem::path& path, const SeriesSource& series,
                            const BuildOptions& options = {},
                            Progress& progress = SilentProgress::instance());

  VolumeStore(VolumeStore&&) noexcept;
  VolumeStore& operator=(VolumeStore&&) noexcept;
  ~VolumeStore();

  /// Returns dimensions, type of samples, spacing, origin, directions of the axes and the name of the space.
  [[nodiscard]] const VolumeGrid& grid() const;
  /// Returns the type of the numbers that samples were read from: that of samples, or SeriesSource::numbers.
  [[nodiscard]] StoredType number_type() const;
  /// Returns the name of the array; empty where it had none.
  [[nodiscard]] const std::string& array() const;
  /// Returns the number of steps: 1 for a single volume.
  [[nodiscard]] std::uint32_t steps() const;
  /// Returns the time of each step, ascending.
  [[nodiscard]] std::vector<double> times() const;
  /// Returns the number of LODs that restore() knows: LOD 0 has every sample, LOD N every 2^N-th along
  /// each axis.
  [[nodiscard]] int lods() const;
  /// Returns the least and the greatest finite sample of all steps, as values (VolumeGrid::slope); none where
  /// there is no finite one. Throws Error where the ranges in the file are damaged.
  [[nodiscard]] std::optional<std::array<double, 2>> range();
  /// Returns whether the ranges in the file are whole.
  [[nodiscard]] bool has_range();
  /// Returns the number of bytes of the file.
  [[nodiscard]] std::uint64_t file_bytes() const;
  [[nodiscard]] StoreFacts facts() const;

  /// Extracts a surface. Notes tell why there is none, that the error was not reached, and of damage. Throws
  /// Error (kUsage) for errors and isovalues that are not finite, negative errors and an unknown step; Error
  /// for a region apart from the data, data of one plane of samples, and damage (see IsosurfaceRequest);
  /// Cancelled where the progress says so.
  Isosurface isosurface(const IsosurfaceRequest& request, Progress& progress = SilentProgress::instance());
  /// Extracts the surfaces of several isovalues into one, whose points have their isovalue as a value.
  /// `request.isovalue` is ignored; the greatest errors and the sums of numbers are returned. Throws Error
  /// (kUsage) too where two isovalues are equal, and Error where the surfaces have more than 2^32 - 1 points.
  Isosurface isosurfaces(std::span<const double> isovalues, const IsosurfaceRequest& request,
                         Progress& progress = SilentProgress::instance());

  /// Restores samples of a step bit for bit; without a step those of the first one, which a note says where
  /// there are several. The grid of the result says where the samples lie. Throws Error (kUsage) where there
  /// is no such step, and Error where there is no such LOD, no sample is in the region, or a page is
  /// damaged.
  Volume restore(const VolumePart& part = {}, const std::optional<std::uint64_t>& step = {},
                 Progress& progress = SilentProgress::instance());

  /// Returns the directions of the gradients of a part of a step, as BuildOptions::gradients keeps them: for
  /// each sample, i fastest, then j, a unit vector along the axes i, j and k of the grid, or zero where
  /// nothing changes. Throws Error as restore() does, and for a store without gradients.
  std::vector<Vec3> gradients(const VolumePart& part = {}, const std::optional<std::uint64_t>& step = {},
                              Progress& progress = SilentProgress::instance());

  /// The grid of a part. Throws Error where there is no such LOD or no sample in the region.
  [[nodiscard]] VolumeGrid part_grid(const VolumePart& part) const;
  /// Receives the next plane with equal k of a step: part_grid().plane_bytes() bytes in the machine's byte
  /// order.
  using StepSink = std::function<void(std::uint32_t step, std::span<const std::byte> samples)>;
  /// Restores several steps. The planes of a step come in ascending order of k; up to eight steps are
  /// restored side by side. Throws Error as restore() does.
  PageReads restore_steps(const StepRange& steps, const VolumePart& part, const StepSink& sink,
                          Progress& progress = SilentProgress::instance());
  /// Restores the numbers that samples were read from, bit for bit, in place of samples: planes of numbers of
  /// number_type(). Throws Error as restore() does, also where remainders are damaged.
  PageReads restore_numbers(const StepRange& steps, const VolumePart& part, const StepSink& sink,
                            Progress& progress = SilentProgress::instance());
  /// Returns the steps among these that cannot be restored, in ascending order; all steps are decoded for
  /// that.
  std::vector<std::uint32_t> damaged_steps(const StepRange& steps, const VolumePart& part = {},
                                           Progress& progress = SilentProgress::instance());

  /// Reads every byte of the file and checks checksums, that all pages can be decoded, and that errors and
  /// ranges are correct. Throws Error where the directory is damaged.
  VerifiedStore verify(Progress& progress = SilentProgress::instance());

 private:
  class Contents;
  template <class Sample>
  class ContentsOf;
  friend struct timevarying::StoreAccess;
  explicit VolumeStore(std::unique_ptr<Contents> contents);
  std::unique_ptr<Contents> contents_;
};

}  // namespace adamas
