#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/camera_path.h"
#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/progress.h"
#include "adamas/steps.h"
#include "adamas/volume_store.h"

namespace adamas ADAMAS_API {

/// The order in which the steps of a series are played.
enum class PlayOrder : std::uint8_t {
  kForward,
  kBackward,
  kThereAndBack,
  kRandom,  ///< as many random steps as there are; some may come several times and others never
};

/// Options of `adamas play`, with the same defaults.
struct PlayOptions {
  OpenOptions store{};
  double isovalue = 0;  ///< a value (VolumeGrid::slope)
  /// Without a camera path: the greatest isosurface error everywhere, an estimate of the distance to the
  /// surface of all samples. It is a length, a part of the data's diagonal, or in voxels, that is, in the
  /// least spacing. None: 0.
  std::optional<ErrorTarget> error{};
  /// The path of a camera, which goes on from frame to frame and begins again at its end.
  std::optional<CameraPath> camera_path{};
  /// With a camera path: the greatest isosurface error in a picture of 1024 x 768 pixels, in pixels. None: 1.
  std::optional<double> pixels{};
  std::optional<std::uint64_t> max_triangles{};  ///< never more triangles, whatever the error
  std::optional<StepRange> steps{};              ///< none: all steps
  PlayOrder order = PlayOrder::kForward;
  std::uint32_t times = 1;  ///< number of times that the steps are played
  std::uint64_t seed = 0;   ///< chooses among random orders
  bool motion = false;      ///< measure how far the surface moves from each frame to the next
  /// The amount that is read at a time: the size of about this many steps of a page before compression, a
  /// quarter more or less.
  std::size_t read_steps = 10;
  std::size_t ahead = 2;  ///< number of following steps that other threads decode meanwhile
};

/// A frame that was played.
struct PlayedFrame {
  std::uint32_t step = 0;
  std::uint64_t triangles = 0;
  std::uint64_t splits = 0, merges = 0;  ///< changes of the mesh since the frame before
  /// The greatest isosurface error that is left, an estimate: in pixels with a camera path, in units of
  /// length without one.
  double largest_error = 0;
  std::uint64_t page_faults = 0, bytes_read = 0;  ///< page reads and bytes read of the file
  double seconds = 0;
  /// The distance that the surface of all samples has moved since the frame before; infinite where one of the
  /// two frames has no surface. None: it was not measured, or pages are damaged.
  std::optional<Isosurface::Distance> motion{};
};

/// Describes how far surfaces have moved from frame to frame.
struct PlayedMotion {
  Isosurface::Distance greatest;   ///< the greatest distance of all transitions between two surfaces
  std::size_t transitions = 0;     ///< transitions from a frame to the next
  std::size_t begins_or_ends = 0;  ///< transitions of which one frame has a surface and the other has none
  std::size_t damaged = 0;         ///< transitions that could not be measured
};

/// The result of playing.
struct PlayReport {
  std::vector<PlayedFrame> frames;           ///< the frames that could be shown
  std::uint64_t file_bytes = 0;              ///< the size of the store
  std::vector<std::uint32_t> damaged_steps;  ///< steps that were left out, in ascending order
  std::string damage;                        ///< the problem of the first of these; empty if there is none
  std::optional<PlayedMotion> motion{};      ///< the motion, if it was asked for
};

/// Plays a stored series without a window and measures it: the surface of each step in turn, each beginning
/// with the mesh of the last one. Damaged steps are left out. The progress gets a note where motion is not
/// known. Throws Error where the file is no store, no step can be played, an error is given beside a camera
/// path, pixels are given without one, or there are no such steps, and Cancelled where the progress says so.
PlayReport play(const std::filesystem::path& store, const PlayOptions& options,
                Progress& progress = SilentProgress::instance());

/// Returns the number of steps of a store. Throws Error where the file is no store.
std::uint32_t stored_steps(const std::filesystem::path& store);

}  // namespace adamas
