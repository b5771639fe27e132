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

/// An open store, once for all that is shown of it: one file, one memory of decoded pages, and the values at
/// places, linear along each axis between samples. Several threads may use it.
class OpenStore {
 public:
  /// `memory`: bytes that decoded pages may take. `step`: one that the store has; a store of one step has
  /// that alone, whatever the number. Throws Error where the file is no store, has no such step, or tables of
  /// that step are damaged.
  static std::unique_ptr<OpenStore> open(const std::string& path, std::size_t memory, std::uint32_t step);
  OpenStore(const OpenStore&) = delete;
  OpenStore& operator=(const OpenStore&) = delete;
  virtual ~OpenStore() = default;

  /// What the file's header says, which needs no lock.
  [[nodiscard]] const isosurface::StoreFile& file() const { return *file_; }
  [[nodiscard]] const VolumeGrid& grid() const { return file_->header().grid; }
  [[nodiscard]] timevarying::SharedPages& pages() { return *pages_; }

  /// The values of one step, for the thread that has this: it holds the lock of the pages.
  class Values {
   public:
    /// NaN where a place lies outside of the samples, or a page cannot be had. `lod`: between which samples,
    /// one of 2^lod along each axis.
    [[nodiscard]] double at(const Vec3& in_space, int lod = 0) const { return store_.value(in_space, lod); }

   private:
    friend class OpenStore;
    Values(OpenStore& store, std::uint32_t step);
    OpenStore& store_;
    timevarying::SharedPages::Lock lock_;
  };
  /// Waits for the lock. A store of one step has its values at all steps. Throws Error where tables of the
  /// step are damaged.
  [[nodiscard]] Values values(std::uint32_t step) { return {*this, step}; }
  /// The coarsest LOD in which samples differ from place to place.
  [[nodiscard]] virtual int coarsest() const = 0;

  /// The finite values among one sample of every cube of 2^N a side of a step, N as small as there are a
  /// million at most. They are read from the file anew, and are not among the pages.
  [[nodiscard]] virtual std::vector<double> some_values(std::uint32_t step) const = 0;
  /// The range of the values of all steps of a series, by the directory, rounded outwards, and of `range`. A
  /// store of one step has `range` itself.
  [[nodiscard]] virtual std::array<double, 2> extended_by_steps(std::array<double, 2> range) const = 0;

 protected:
  OpenStore(std::unique_ptr<isosurface::StoreFile> file, std::size_t memory);
  /// Opens the file again, for what is read beside the pages.
  [[nodiscard]] std::unique_ptr<isosurface::StoreFile> another_file() const;

  std::unique_ptr<isosurface::StoreFile> file_;
  std::size_t memory_;
  std::unique_ptr<timevarying::SharedPages> pages_;

 private:
  /// Goes over to another step, and gives a value there, while the lock is held.
  virtual void set_step(std::uint32_t step) = 0;
  [[nodiscard]] virtual double value(const Vec3& in_space, int lod) = 0;
};

}  // namespace adamas::viewer
