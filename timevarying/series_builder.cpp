#include "timevarying/series_builder.h"

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/unnamed_file.h"
#include "core/data/stored_type.h"
#include "isosurface/storage/block_builder.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/storage/store_file_writer.h"
#include "timevarying/series_gradients.h"
#include "timevarying/step_pages.h"
#include "timevarying/time_codec.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

/// The memory, in bytes, for decoded pages of the steps before a block.
constexpr std::size_t kEarlierMemory = std::size_t{128} << 20;

/// The samples of the steps of a block in a scratch file, for code that reads all of them together while each
/// step's own file is opened only once.
class SampleSpool {
 public:
  /// Throws Error if `folder` cannot hold files.
  SampleSpool(const std::filesystem::path& folder, const VolumeGrid& grid) : grid_(grid), file_(folder) {}
  SampleSpool(const SampleSpool&) = delete;
  SampleSpool& operator=(const SampleSpool&) = delete;

  /// Adds the next step: returns planes that are also stored as they are read. They are valid as long as this
  /// object and `planes` are.
  PlaneSource add(const PlaneSource& planes) {
    return [this, &planes, step = steps_++](std::uint64_t k, std::span<std::byte> samples) {
      planes(k, samples);
      file_.write(step * grid_.bytes() + k * grid_.plane_bytes(), samples);
    };
  }
  /// The rows of each step, all planes of which have been read. They are valid as long as this object is.
  [[nodiscard]] std::vector<RowSource> rows() const {
    std::vector<RowSource> all;
    for (std::size_t step = 0; step < steps_; ++step) {
      all.emplace_back([this, step](std::uint64_t k, std::uint64_t row, std::span<std::byte> samples) {
        const std::uint64_t row_bytes = grid_.plane_bytes() / grid_.dimensions[1];
        file_.read(step * grid_.bytes() + k * grid_.plane_bytes() + row * row_bytes, samples);
      });
    }
    return all;
  }

 private:
  VolumeGrid grid_;
  ScratchFile file_;
  std::size_t steps_ = 0;
};

/// The pages with which the samples of a job may be coded: its page at the steps before, as far as there are
/// any.
template <class Word>
struct EarlierOfJob {
  std::array<EarlierPage<Word>, 2> pages;
  std::size_t count = 0;

  [[nodiscard]] std::span<const EarlierPage<Word>> before() const { return std::span(pages).first(count); }
};

/// The pages with which the jobs of a batch may be coded, by slot; references stay valid when it grows.
template <class Word>
using EarlierOfJobs = std::deque<EarlierOfJob<Word>>;

template <class Word>
class SeriesCodec final : public BlockCodec<Word> {
 public:
  SeriesCodec(const TimeSurvey<Word>& survey, const EarlierOfJobs<Word>& earlier)
      : codec_(survey), earlier_(earlier) {}

  void encode(const PageJob<Word>& job, std::vector<std::byte>& out,
              std::span<const std::byte> along) const override {
    codec_.encode(job.shape, job.around.samples, job.page.samples, earlier_[job.slot].before(), out, along);
  }
  [[nodiscard]] std::vector<std::byte> tables() const override { return codec_.tables(); }
  [[nodiscard]] std::vector<std::byte> time_tables() const override { return codec_.time_tables(); }

 private:
  TimeCodec<Word> codec_;
  const EarlierOfJobs<Word>& earlier_;
};

template <class Word>
class SeriesSurvey final : public BlockSurvey<Word> {
 public:
  SeriesSurvey(TimeSurvey<Word> survey, const EarlierOfJobs<Word>& earlier)
      : survey_(std::move(survey)), earlier_(earlier) {}

  void add(const PageJob<Word>& job) override {
    survey_.add(job.shape, job.around.samples, job.page.samples, earlier_[job.slot].before());
  }
  void merge(const BlockSurvey<Word>& other) override {
    survey_.merge(static_cast<const SeriesSurvey&>(other).survey_);
  }
  [[nodiscard]] std::unique_ptr<BlockCodec<Word>> codec() const override {
    return std::make_unique<SeriesCodec<Word>>(survey_, earlier_);
  }

 private:
  TimeSurvey<Word> survey_;
  const EarlierOfJobs<Word>& earlier_;
};

/// Builds a block whose pages may be coded with those of the steps before, in the block or in the store.
template <class Sample>
class SeriesBlockBuilder final : public BlockBuilder<Sample> {
 public:
  using Base = BlockBuilder<Sample>;
  using Word = typename Base::Word;

  /// `file`: the present store, whose last steps precede the block; null if pages may not be coded with them.
  SeriesBlockBuilder(const VolumeGrid& volume, const StoreOptions& options, std::uint32_t first_step,
                     StoreFile* file, Progress& progress)
      : Base(volume, options, progress) {
    if (file == nullptr) return;
    earlier_pages_ = std::make_unique<StepPages<Word>>(*file, kEarlierMemory);
    for (int n = steps_before(first_step); n > 0; --n)
      earlier_steps_.push_back(&earlier_pages_->at(first_step - static_cast<std::uint32_t>(n)));
    std::reverse(earlier_steps_.begin(), earlier_steps_.end());
  }

 private:
  using typename Base::Job;

  void prepare_steps(const BlockSource& source) override {
    const auto& options = this->options_;
    const bool in_time = options.gradients && options.smoothing && options.smoothing->is_along_time() &&
                         source.times.size() > 1;
    if (!in_time) return Base::prepare_steps(source);
    SampleSpool spool(options.scratch, this->volume_);
    for (std::uint32_t n = 0; n < source.times.size(); ++n) {
      const PlaneSource planes = source.planes(n);
      this->prepare_step(spool.add(planes));
    }
    const std::vector<RowSource> rows = spool.rows();
    series_gradient_pages<Sample>(
        this->volume_, rows,
        [this](std::size_t step, const PageId& id, const Page<std::uint16_t>& page) {
          this->put_gradients(step, id, page);
        },
        this->gradient_options(), this->progress_);
  }

  void find_earlier(const PageId& id, std::size_t n, const Job& before, Job& job) override {
    if (earlier_.size() <= job.slot) earlier_.resize(job.slot + 1);
    earlier_[job.slot].count = 0;
    const auto count =
        static_cast<std::size_t>(steps_before(this->first_step_ + static_cast<std::uint32_t>(n)));
    if (count == 0) return;
    if (n > 0) {
      take_earlier(before, count, job);
    } else {
      load_earlier(id, count, job);
    }
  }

  /// Takes the pages that the job of the same page one step before, in the same block, has.
  void take_earlier(const Job& before, std::size_t count, Job& job) {
    const EarlierOfJob<Word>& of_before = earlier_[before.slot];
    EarlierOfJob<Word>& earlier = earlier_[job.slot];
    earlier.pages[0] = {before.page.samples, before.around.samples};
    earlier.count = std::min(count, of_before.count + 1);
    if (earlier.count > 1) earlier.pages[1] = of_before.pages[0];
    job.has_earlier_bounds = are_same_bounds<Word>(job.shape, before.page, job.page);
  }

  /// Loads the page at the steps of earlier blocks, up to the first damaged one.
  void load_earlier(const PageId& id, std::size_t count, Job& job) {
    EarlierOfJob<Word>& earlier = earlier_[job.slot];
    for (std::size_t n = 0; n < std::min(count, earlier_steps_.size()); ++n) {
      const PageSamples<Word>* samples = earlier_steps_[n]->samples(id);
      if (samples == nullptr) return;
      earlier.pages[n].samples = samples->samples;
      if (!job.shape.complete) {
        if (!earlier_steps_[n]->surroundings(id, around_, PageParts::kSamples)) return;
        earlier.pages[n].around = around_.samples;
      }
      earlier.count = n + 1;
    }
  }

  [[nodiscard]] std::unique_ptr<BlockSurvey<Word>> sample_block_survey() const override {
    const bool in_time = this->options_.coding != SampleCoding::kPlain &&
                         (steps_before(this->first_step_) > 0 || this->step_count_ > 1);
    return std::make_unique<SeriesSurvey<Word>>(
        TimeSurvey<Word>(this->space_survey(), this->coding(), in_time), earlier_);
  }

  std::unique_ptr<StepPages<Word>> earlier_pages_;
  std::vector<StoredPages<Word>*> earlier_steps_;  ///< the steps before the block, the last one first
  EarlierOfJobs<Word> earlier_;
  Surroundings<Word> around_;
};

StoredNumbers numbers_of(const SeriesSource& series) {
  return {series.numbers.value_or(stored_type(series.grid.type)), series.array};
}

/// Adds all steps of a series, in blocks that end at multiples of `block_steps`.
void add_blocks(StoreFileWriter& writer, const std::filesystem::path& path, const SeriesSource& series,
                const StoredNumbers& numbers, const StoreOptions& options, std::uint32_t first,
                StoreFigures& figures, Progress& progress) {
  const auto count = static_cast<std::uint32_t>(series.times.size());
  for (std::uint32_t begin = 0; begin < count;) {
    const std::uint32_t step = first + begin;
    const std::uint32_t end = std::min(count, begin + options.block_steps - step % options.block_steps);
    const auto file = steps_before(step) > 0 ? std::make_unique<StoreFile>(path) : nullptr;
    const BlockSource source{step,
                             {series.times.begin() + begin, series.times.begin() + end},
                             [&](std::uint32_t n) { return series.planes(begin + n); },
                             numbers,
                             series.number_planes};
    with_sample_type(series.grid.type, [&](auto sample) {
      const auto builder = std::make_unique<SeriesBlockBuilder<decltype(sample)>>(series.grid, options, step,
                                                                                  file.get(), progress);
      builder->build(writer, source, figures);
    });
    begin = end;
  }
}

/// Throws Error where a store has numbers of another type, or both have names of arrays and these differ.
void check_numbers(const StoredNumbers& wanted, const StoredNumbers& found, const std::string& name) {
  if (wanted.type != found.type)
    fail("{}: expected numbers of type {} as it has, found {}", name, to_string(wanted.type),
         to_string(found.type));
  if (!wanted.array.empty() && !found.array.empty() && wanted.array != found.array)
    fail("{}: expected the array '{}' as it has, found '{}'", name, wanted.array, found.array);
}

}  // namespace

StoreFigures build_series(const std::filesystem::path& path, const std::string& shown,
                          const SeriesSource& series, const StoreOptions& options, Progress& progress) {
  StoreFigures figures;
  StoreFileWriter writer(path, shown, series.grid, options.group_pages);
  add_blocks(writer, path, series, numbers_of(series), options, 0, figures, progress);
  return figures;
}

StoreFigures append_series(const StoreLock& store, const SeriesSource& series, StoreOptions options,
                           Progress& progress) {
  StoreFigures figures;
  const std::filesystem::path& path = store.path();
  const StoreFile file(path);
  if (series.grid != file.header().grid) fail("{}: expected steps on its grid, found another", file.name());
  const StoredNumbers& numbers = file.header().numbers;
  check_numbers(numbers, numbers_of(series), file.name());
  const double last = file.times().back();
  if (series.times.empty() || series.times.front() <= last)
    fail("{}: expected steps after the time {}, found earlier ones", file.name(), last);
  if (options.coding != SampleCoding::kPlain) options.coding = coding_of_bytes(file.header().coding);
  options.gradients = file.header().gradients;
  StoreFileWriter writer(path, file);
  add_blocks(writer, path, series, numbers, options, file.steps(), figures, progress);
  return figures;
}

}  // namespace adamas::timevarying
