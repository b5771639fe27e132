#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "isosurface/storage/store_file.h"
#include "timevarying/shared_pages.h"

namespace adamas::viewer {

/// An open store, once for everything that is shown of it: one file, one memory of decoded pages, and the
/// values at places, interpolated linearly along each axis between samples. Several threads may use it.
class OpenStore {
 public:
  /// `memory`: bytes for decoded pages. `step`: one that the store has; a store of one step ignores it.
  /// Throws Error if the file is no store, has no such step, or tables of that step are damaged.
  static std::unique_ptr<OpenStore> open(const std::string& path, std::size_t memory, std::uint32_t step);
  OpenStore(const OpenStore&) = delete;
  OpenStore& operator=(const OpenStore&) = delete;
  virtual ~OpenStore() = default;

  /// The file with its header, which can be read without the lock.
  [[nodiscard]] const isosurface::StoreFile& file() const { return *file_; }
  [[nodiscard]] const VolumeGrid& grid() const { return file_->header().grid; }
  [[nodiscard]] timevarying::SharedPages& pages() { return *pages_; }

  /// The values of one step, for the thread that owns this object, which holds the lock of the pages.
  class Values {
   public:
    /// The value at a place; NaN if it lies outside the samples or a page cannot be loaded. `lod`: the
    /// samples used, one of 2^lod along each axis.
    [[nodiscard]] double at(const Vec3& in_space, int lod = 0) const { return store_.value(in_space, lod); }

   private:
    friend class OpenStore;
    Values(OpenStore& store, std::uint32_t step);
    OpenStore& store_;
    timevarying::SharedPages::Lock lock_;
  };
  /// Waits for the lock. A store of one step has its values at all steps. Throws Error if tables of the step
  /// are damaged.
  [[nodiscard]] Values values(std::uint32_t step) { return {*this, step}; }
  /// The coarsest LOD in which samples differ from place to place.
  [[nodiscard]] virtual int coarsest() const = 0;

  /// The finite values among one sample of every cube of side 2^N of a step, where N is as small as a limit
  /// of a million values allows. They are read from the file again, and do not become part of the pages.
  [[nodiscard]] virtual std::vector<double> some_values(std::uint32_t step) const = 0;
  /// The union of `range` and the range of the values of all steps of a series, by the directory, rounded
  /// outwards. A store of one step returns `range`.
  [[nodiscard]] virtual std::array<double, 2> extended_by_steps(std::array<double, 2> range) const = 0;

 protected:
  OpenStore(std::unique_ptr<isosurface::StoreFile> file, std::size_t memory);
  /// Opens the file again, for reading independently of the pages.
  [[nodiscard]] std::unique_ptr<isosurface::StoreFile> another_file() const;

  std::unique_ptr<isosurface::StoreFile> file_;
  std::size_t memory_;
  std::unique_ptr<timevarying::SharedPages> pages_;

 private:
  /// Changes to another step, and returns a value there, while the lock is held.
  virtual void set_step(std::uint32_t step) = 0;
  [[nodiscard]] virtual double value(const Vec3& in_space, int lod) = 0;
};

}  // namespace adamas::viewer
