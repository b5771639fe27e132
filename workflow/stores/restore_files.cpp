#include <limits>
#include <optional>
#include <utility>

#include "adamas/file_names.h"
#include "adamas/series.h"
#include "adamas/steps.h"
#include "adamas/store_files.h"
#include "adamas/volume_output.h"
#include "core/base/error.h"
#include "core/base/notes.h"
#include "core/data/volume_placement.h"
#include "core/io/zarr_array.h"
#include "isosurface/storage/store_file.h"
#include "timevarying/api/open_store.h"
#include "timevarying/restore_steps.h"
#include "workflow/stores/ome_zarr.h"
#include "workflow/stores/restored_steps.h"

namespace adamas {

using namespace io;
using namespace isosurface;
using namespace timevarying;
using namespace workflow;

namespace {

bool is_list(const std::filesystem::path& output) { return file_extension(output) == ".pvd"; }

/// Returns the name of a store's samples in files.
std::string array_name(const StoreFile& file) {
  const std::string& array = file.header().numbers.array;
  return array.empty() ? "samples" : array;
}

/// Throws Error (kUsage) where values contradict each other.
void check_request(const RestoreRequest& request) {
  if (is_zarr(request.output) || is_list(request.output)) return;
  if (request.overwrite)
    wrong_usage("--overwrite: expected a series or a folder, -o F.pvd or F.zarr, found '-o {}'",
                request.output.string());
  if (request.steps)
    wrong_usage("--steps: expected a series as well, -o F.pvd or F.zarr, found '-o {}'",
                request.output.string());
}

/// One run of restore_files().
class Restoration {
 public:
  Restoration(const RestoreRequest& request, OutputSet& outputs, Progress& progress)
      : request_(request), output_(request.output.string()), outputs_(outputs), progress_(progress) {}

  RestoreReport run();

 private:
  void open_store();
  /// Finds the part of each step that is restored, or for a .zarr the parts of all levels.
  void find_parts();
  /// Returns the one step that is named, otherwise those of the request.
  [[nodiscard]] StepRange wanted_steps() const;
  void write_step();
  /// Writes F.pvd, and F_0000.vti, F_0001.vti, ... beside it.
  void write_list();

  const RestoreRequest& request_;
  std::string output_;
  OutputSet& outputs_;
  Progress& progress_;
  std::unique_ptr<StoreFile> file_;
  std::vector<RestoredPart> parts_;
  PageReads counts_;
  RestoredSteps steps_;
  std::uint64_t bytes_ = 0;
};

/// Writes a list F.pvd and the files of its steps.
class PvdSeries {
 public:
  PvdSeries(const std::filesystem::path& list, StoreFile& file, const StepRange& steps,
            const RestoredPart& part, std::size_t memory, OutputSet& outputs, Progress& progress)
      : list_(list),
        file_(file),
        all_(steps),
        part_(part),
        memory_(memory),
        outputs_(outputs),
        progress_(progress) {}

  void declare(bool overwrite) {
    const std::vector<double> times = file_.times();
    for (std::uint32_t step = all_.first; step <= all_.last; ++step) {
      entries_.push_back({times[step], step_file(list_, step, ".vti")});
      if (!overwrite) refuse_existing(path(step));
      outputs_.declare("-o", path(step), {".vti"});
    }
  }

  /// Writes the files and the list, and returns the steps that were written.
  RestoredSteps write(PageReads& counts) {
    const auto write_all = [&](const StepNumbers& steps) {
      bytes_ = 0;
      counts = {};
      for (const StepRange& some : restored_groups(steps, restored_slab_bytes(part_), memory_))
        write_group(some, counts);
    };
    RestoredSteps steps = restore_what_can_be(file_, all_, part_, memory_, write_all, progress_);
    std::vector<SeriesEntry> entries;
    for (const std::uint32_t step : steps.kept) entries.push_back(entries_[step - all_.first]);
    for (const std::uint32_t step : steps.lost) outputs_.leave_out(path(step));
    const std::string list = list_.string();
    outputs_.write(list, [&entries](const auto& name) { write_series(name, entries); });
    bytes_ += outputs_.bytes(list);
    return steps;
  }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  /// Throws Error where the file exists: no option names the files of steps, so they may belong to another
  /// series, or be the source of the store.
  void refuse_existing(const std::string& file) const {
    std::error_code unknown;
    if (std::filesystem::exists(file, unknown))
      fail("{}: expected no file of a step there yet, found {}: --overwrite replaces such files",
           list_.string(), file);
  }
  [[nodiscard]] std::string path(std::uint32_t step) const {
    return (list_.parent_path() / entries_[step - all_.first].file).string();
  }

  /// Writes some steps. Throws DamagedPage for a damaged page, although outputs turn errors that pass through
  /// them into others.
  void write_group(const StepRange& some, PageReads& counts) {
    sinks_.clear();
    damage_.reset();
    try {
      write_rest(some, counts);
    } catch (const Error&) {
      if (damage_) throw *damage_;
      throw;
    }
  }

  /// Opens the files of some steps by recursion, and writes to all of them when the last is open.
  void write_rest(const StepRange& some, PageReads& counts) {
    const auto step = some.first + static_cast<std::uint32_t>(sinks_.size());
    if (step > some.last) {
      const auto sink = [this, &some](std::uint32_t n, std::span<const std::byte> plane) {
        sinks_[n - some.first](plane);
      };
      try {
        counts += restore_numbers(file_, some, part_, memory_, sink, progress_);
      } catch (const DamagedPage& damage) {
        damage_ = damage;
        throw;
      }
      return;
    }
    const auto make = [&](const PlaneSink& sink) {
      sinks_.push_back(sink);
      write_rest(some, counts);
    };
    bytes_ += write_volume_output(path(step), part_.grid, file_.header().numbers.type, array_name(file_),
                                  make, outputs_);
  }

  std::filesystem::path list_;
  StoreFile& file_;
  StepRange all_;
  const RestoredPart& part_;
  std::size_t memory_;
  OutputSet& outputs_;
  Progress& progress_;
  std::vector<SeriesEntry> entries_;
  std::vector<PlaneSink> sinks_;  ///< sinks of the open files
  std::optional<DamagedPage> damage_;
  std::size_t bytes_ = 0;
};

void Restoration::open_store() {
  outputs_.protect(request_.store);
  file_ = open_store_file(request_.store, request_.open);
}

void Restoration::find_parts() {
  const VolumeGrid& volume = file_->header().grid;
  std::optional<Box3> region;
  if (request_.part.region) {
    const FrameRegion found = region_in_frame(volume, *request_.part.region);
    region = found.box;
    if (!found.sides.empty())
      note(progress_, "{}: its axes run aslant: the samples round the region, in a box along them",
           file_->name());
  }
  // A level coarser than one of a single chunk would be no faster to show.
  const std::uint64_t enough =
      is_zarr(output_) ? ZarrArray::kSide : std::numeric_limits<std::uint64_t>::max();
  parts_ = restored_lods(volume, request_.part.lod, region, enough, file_->name());
}

StepRange Restoration::wanted_steps() const {
  if (request_.step) {
    if (request_.steps) wrong_usage("--step and --steps: expected one of them");
    const std::uint32_t step = wanted_step(request_.step, *file_, progress_);
    return {step, step};
  }
  if (!request_.steps) return {0, file_->steps() - 1};
  check_steps(*request_.steps, file_->steps(), file_->name());
  return *request_.steps;
}

void Restoration::write_step() {
  const std::uint32_t step = wanted_step(request_.step, *file_, progress_);
  const auto make = [&](const PlaneSink& sink) {
    const auto to_file = [&sink](std::uint32_t, std::span<const std::byte> plane) { sink(plane); };
    counts_ = restore_numbers(*file_, {step, step}, parts_.front(), request_.open.memory, to_file, progress_);
  };
  bytes_ = write_volume_output(output_, parts_.front().grid, file_->header().numbers.type, array_name(*file_),
                               make, outputs_);
  steps_.kept = {step};
}

void Restoration::write_list() {
  PvdSeries series(output_, *file_, wanted_steps(), parts_.front(), request_.open.memory, outputs_,
                   progress_);
  series.declare(request_.overwrite);
  steps_ = series.write(counts_);
  bytes_ = series.bytes();
}

RestoreReport Restoration::run() {
  check_request(request_);
  std::optional<OmeZarr> zarr;
  if (is_zarr(output_)) {
    outputs_.protect(request_.store);
    outputs_.check_outside("-o", output_);
    zarr.emplace(output_, request_.overwrite);
  } else if (is_list(output_)) {
    outputs_.declare("-o", output_, {".pvd"});
  } else {
    declare_volume_output(output_, outputs_);
  }
  open_store();
  find_parts();
  if (zarr) {
    const bool is_series = !request_.step && file_->steps() > 1;
    steps_ =
        zarr->write(*file_, {parts_, wanted_steps(), is_series, request_.open.memory}, counts_, progress_);
    bytes_ = zarr->bytes();
  } else {
    note_lost(output_, parts_.front().grid, progress_);
    if (is_list(output_)) {
      write_list();
    } else {
      write_step();
    }
  }
  RestoreReport report;
  report.grid = parts_.front().grid;
  report.written = written_type(output_, report.grid, file_->header().numbers.type);
  report.lod = parts_.front().lod;
  report.lods = parts_.size();
  report.steps = std::move(steps_.kept);
  report.damaged_steps = std::move(steps_.lost);
  report.bytes = bytes_;
  // The counter of each part of the work has counted the bytes of the whole file, so these are set here.
  report.reads = {counts_.pages, counts_.predictors, file_->bytes_read(), counts_.copies, counts_.damaged};
  if (zarr) report.folder = zarr->folder();
  return report;
}

}  // namespace

RestoreReport restore_files(const RestoreRequest& request, OutputSet& outputs, Progress& progress) {
  return Restoration(request, outputs, progress).run();
}

}  // namespace adamas
