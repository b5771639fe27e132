#include "workflow/stores/stored_steps.h"

#include <cmath>
#include <cstring>
#include <utility>

#include "adamas/notes.h"
#include "core/base/error.h"
#include "core/base/notes.h"
#include "core/data/stored_type.h"
#include "core/io/volume_input.h"
#include "isosurface/volume/page_grid.h"
#include "isosurface/volume/samples.h"

namespace adamas::workflow {

using namespace io;
using namespace isosurface;
using namespace timevarying;

void refuse_grid(const std::string& name, const VolumeGrid& found, const std::string& first,
                 const VolumeGrid& wanted) {
  const auto text = [](const VolumeGrid& grid) {
    return fmt::format("{} x {} x {} {}", grid.dimensions[0], grid.dimensions[1], grid.dimensions[2],
                       sample_name(grid.type));
  };
  if (text(found) != text(wanted))
    fail("{}: expected {} samples as {} has, found {}", name, text(wanted), first, text(found));
  const auto refuse = [&](const char* what, const std::string& of_found, const std::string& of_wanted) {
    if (of_found != of_wanted)
      fail("{}: expected the {} of {}, {}, found {}", name, what, first, of_wanted, of_found);
  };
  const auto vector = [](const Vec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); };
  refuse("first sample's place", vector(found.origin), vector(wanted.origin));
  refuse("spacing", vector(found.spacing), vector(wanted.spacing));
  for (std::size_t axis = 0; axis < 3; ++axis)
    refuse("direction of an axis", vector(found.directions[axis]), vector(wanted.directions[axis]));
  const auto scale = [](const VolumeGrid& grid) {
    return fmt::format("{} times the sample plus {}", grid.slope, grid.intercept);
  };
  refuse("scale", scale(found), scale(wanted));
  refuse("unit of lengths", '\'' + found.length_unit + '\'', '\'' + wanted.length_unit + '\'');
  refuse("unit of values", '\'' + found.value_unit + '\'', '\'' + wanted.value_unit + '\'');
  fail("{}: expected coordinates in the space of {}, '{}', found '{}'", name, first, wanted.space,
       found.space);
}

/// A step that is being read: planes for the builder, which asks for some of them twice. It counts the
/// samples that are no finite numbers.
class StoredSteps::Open {
 public:
  explicit Open(VolumeReader reader) : reader_(std::move(reader)), counted_(reader_.grid().dimensions[2]) {}

  void read(std::uint64_t k, std::span<std::byte> samples) {
    reader_.read_plane(k, samples);
    if (reader_.grid().type != SampleType::kFloat32 || counted_[k]) return;
    counted_[k] = true;
    for (std::size_t at = 0; at < samples.size(); at += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, samples.data() + at, sizeof(value));
      infinite_ += std::isfinite(value) ? 0 : 1;
    }
  }
  void read_numbers(std::uint64_t k, std::span<std::byte> numbers) {
    reader_.read_stored(k * reader_.grid().plane_samples(), numbers);
  }
  [[nodiscard]] const VolumeReader& reader() const { return reader_; }
  [[nodiscard]] std::uint64_t infinite() const { return infinite_; }

 private:
  VolumeReader reader_;
  std::vector<bool> counted_;
  std::uint64_t infinite_ = 0;
};

StoredSteps::StoredSteps(std::vector<VolumeInputStep> steps, OutputSet& outputs, Progress& progress)
    : steps_(std::move(steps)), outputs_(outputs), progress_(progress) {
  open(0);
  grid_ = open_->reader().grid();
  const VolumeSource& source = open_->reader().source();
  number_type_ = source.scaled() ? stored_type(grid_.type) : source.stored;
}

StoredSteps::~StoredSteps() = default;

bool StoredSteps::keeps_numbers() const { return number_type_ != stored_type(grid_.type); }

SeriesSource StoredSteps::source() {
  SeriesSource series{grid_, {}, [this](std::uint32_t n) -> PlaneSource {
                        if (n != opened_) open(n);
                        return [this](std::uint64_t k, std::span<std::byte> samples) {
                          open_->read(k, samples);
                        };
                      }};
  for (const VolumeInputStep& step : steps_) series.times.push_back(step.time);
  series.array = array_;
  if (keeps_numbers()) series.numbers = number_type_;
  series.number_planes = [this](std::uint64_t k, std::span<std::byte> numbers) {
    open_->read_numbers(k, numbers);
  };
  return series;
}

void StoredSteps::close() {
  if (open_ == nullptr) return;
  input_bytes_ += open_->reader().source().sample_file_bytes();
  // The notes about the times of one file are mostly the same.
  std::string note = open_->reader().note();
  if (keeps_numbers() && open_->reader().loses_digits())
    note += ": surfaces and pictures show these, and 'restore' gives the numbers back as they are";
  if (note != last_note_) {
    if (open_->reader().loses_digits()) {
      changes_.emplace_back(open_->reader().greatest_change(), note);
    } else if (!note.empty()) {
      progress_.note(NoteKind::kRemark, note);
    }
  }
  last_note_ = note;
  if (const std::uint64_t infinite = open_->infinite(); infinite > 0) infinite_[opened_] = infinite;
  open_.reset();
}

void StoredSteps::finish() {
  close();
  std::vector<std::pair<double, std::string>> notes;
  for (const auto& [step, samples] : infinite_)
    notes.emplace_back(static_cast<double>(samples),
                       fmt::format("{}: {} not finite: surfaces have holes there", steps_[step].name,
                                   samples == 1 ? "1 sample is" : fmt::format("{} samples are", samples)));
  note_several(worst_first(std::move(notes)), {"step", "steps"}, progress_);
  note_several(worst_first(std::move(changes_)), {"step", "steps"}, progress_,
               keeps_numbers() ? NoteKind::kRemark : NoteKind::kLoss);
}

void StoredSteps::note_array(const VolumeInputStep& step, const VolumeSource& source) {
  if (array_.empty()) array_ = step.group.empty() ? source.array : step.group;
  if (source.other_arrays.empty() || source.array == noted_array_) return;
  noted_array_ = source.array;
  note(progress_, "{}: the array '{}' is taken, not '{}': --array names another", step.name, source.array,
       fmt::format("{}", fmt::join(source.other_arrays, "', '")));
}

void StoredSteps::open(std::uint32_t n) {
  close();
  const VolumeInputStep& step = steps_[n];
  open_ = std::make_unique<Open>(open_volume_input(step.input, outputs_, progress_, true));
  opened_ = n;
  note_array(step, open_->reader().source());
  const VolumeGrid& grid = open_->reader().grid();
  check_volume_dimensions(step.name, grid);
  if (n == 0) return;
  if (grid != grid_) refuse_grid(step.name, grid, steps_.front().name, grid_);
  const VolumeSource& source = open_->reader().source();
  if (keeps_numbers() && (source.scaled() || source.stored != number_type_))
    fail("{}: expected numbers of type {} as {} has, found {}", step.name, to_string(number_type_),
         steps_.front().name, source.scaled() ? "some with a scale" : to_string(source.stored));
}

}  // namespace adamas::workflow
