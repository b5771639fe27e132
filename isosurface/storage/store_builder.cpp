#include "isosurface/storage/store_builder.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "isosurface/compression/bounds/bounds_codec.h"
#include "isosurface/compression/bounds/range_rounding.h"
#include "isosurface/compression/gradient_codec.h"
#include "isosurface/compression/ranked/prevailing_sample.h"
#include "isosurface/compression/ranked/ranked_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/compression/time_codec.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/preprocessing/preprocess.h"
#include "isosurface/storage/page_coding.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/sample_spool.h"
#include "isosurface/storage/scratch_pages.h"
#include "isosurface/storage/step_pages.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/storage/store_file_writer.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// How many pages are worked on together, by as many threads as there are.
constexpr std::size_t kBatch = 256;
/// How many pages a thread takes at a time.
constexpr std::size_t kGrain = 16;
/// Bytes of scratch pages that are kept in memory.
constexpr std::size_t kMemory = std::size_t{256} << 20;
/// In a volume of more pages than these one of eight finest pages is surveyed for the tables.
constexpr std::uint64_t kSurveyed = 4096;
/// How many of the coarsest pages tell how ranges are rounded, and whether a sample prevails.
constexpr std::size_t kCoarsePages = 256;

/// Numbers of all pages, in the order of the file.
std::vector<std::uint64_t> page_numbers(const PageGrid& grid) {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(grid.page_count());
  for (int lod = grid.top(); lod >= 0; --lod) {
    const LatticePoint n = grid.blocks(lod);
    for (std::int32_t k = 0; k < n.k; ++k) {
      for (std::int32_t j = 0; j < n.j; ++j) {
        for (std::int32_t i = 0; i < n.i; ++i) {
          const PageId id{lod, {i, j, k}};
          if (grid.contains(id)) numbers.push_back(grid.number(id));
        }
      }
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

/// Makes blocks of steps, each with tables of its own.
template <class Sample>
class StoreBuilder {
 public:
  using Word = OrderedWord<Sample>;

  StoreBuilder(const VolumeGrid& volume, const StoreOptions& options, Progress& progress)
      : volume_(volume), grid_(volume.dimensions), options_(options), progress_(progress) {}

  /// Adds a block of these steps of the series, the first of which is the step `first` of the store. `file`:
  /// the store as it is, for what its last steps hold; null where there are none before.
  void add_block(StoreFileWriter& writer, const SeriesSource& series, std::uint32_t begin, std::uint32_t end,
                 std::uint32_t first, StoreFile* file, StoreFigures& figures) {
    first_ = first;
    open_earlier(file);
    prepare_steps(series, begin, end, kMemory / (end - begin));
    ranks_ = census_.ranks();
    numbers_ = page_numbers(grid_);
    look_at_coarse();
    const Codecs<Word> codecs = survey();
    StoreHeader header;
    header.grid = volume_;
    header.coding = coding_in_files(coding());
    header.gradients = options_.gradients;
    header.first_step = first;
    header.times.assign(series.times.begin() + begin, series.times.begin() + end);
    write(writer, codecs, header);
    figures.bytes += header.bytes;
    figures.file_bytes = writer.finish_block(header);
    figures.pages += numbers_.size() * steps_.size();
  }

 private:
  /// What preprocessing has found of a step.
  struct Step {
    std::unique_ptr<ScratchPages<Word>> pages;
    std::unique_ptr<ScratchPages<std::uint16_t>> gradients;  ///< OctahedralCodes; null where none are kept
  };

  void open_earlier(StoreFile* file) {
    if (file == nullptr) return;
    earlier_pages_ = std::make_unique<StepPages<Word>>(*file, kMemory / 2);
    for (int n = steps_before(first_); n > 0; --n)
      earlier_.push_back(&earlier_pages_->at(first_ - static_cast<std::uint32_t>(n)));
    std::reverse(earlier_.begin(), earlier_.end());
  }

  /// `memory`: of scratch pages, for each step.
  void prepare_steps(const SeriesSource& series, std::uint32_t begin, std::uint32_t end, std::size_t memory) {
    const bool in_time =
        options_.gradients && options_.smoothing && options_.smoothing->is_along_time() && end - begin > 1;
    std::optional<SampleSpool> spool;
    if (in_time) spool.emplace(options_.scratch, volume_);
    for (std::uint32_t step = begin; step < end; ++step) {
      const PlaneSource planes = series.planes(step);
      prepare(in_time ? spool->add(planes) : planes, memory);
      if (options_.gradients && !in_time) find_gradients(planes);
    }
    if (!in_time) return;
    const std::vector<RowSource> rows = spool->rows();
    const auto put = [this](std::size_t step, const PageId& id, const Page<std::uint16_t>& page) {
      steps_[step].gradients->put(id, page);
    };
    series_gradient_pages<Sample>(volume_, rows, put, gradient_options(), progress_);
  }

  void prepare(const PlaneSource& planes, std::size_t memory) {
    Step& step = steps_.emplace_back();
    step.pages = std::make_unique<ScratchPages<Word>>(options_.scratch, grid_, memory);
    if (options_.gradients)
      step.gradients =
          std::make_unique<ScratchPages<std::uint16_t>>(options_.scratch, grid_, memory, PageParts::kSamples);
    preprocess<Sample>(
        volume_, planes,
        [&](const PageId& id, const Page<Word>& page) {
          if (options_.coding == SampleCoding::kInterpolation)
            census_.add(page_shape(grid_, id), page.samples);
          step.pages->put(id, page);
        },
        progress_);
  }

  [[nodiscard]] GradientPageOptions gradient_options() const {
    GradientPageOptions options;
    options.smoothing = options_.smoothing;
    options.scratch = options_.scratch;
    return options;
  }
  /// Of the last step.
  void find_gradients(const PlaneSource& planes) {
    Step& step = steps_.back();
    gradient_pages<Sample>(
        volume_, planes,
        [&](const PageId& id, const Page<std::uint16_t>& page) { step.gradients->put(id, page); },
        gradient_options(), progress_);
  }

  [[nodiscard]] SampleCoding coding() const {
    return ranks_ != nullptr ? SampleCoding::kRanks : options_.coding;
  }
  /// Finds the rounding of ranges and the prevailing sample, by the diamonds and the samples of the coarsest
  /// pages.
  void look_at_coarse() {
    std::vector<Word> low, high;
    PrevailingSample<Word> prevailing(ranks_.get());
    Page<Word> page;
    for (const std::uint64_t number : std::span(numbers_).first(std::min(numbers_.size(), kCoarsePages))) {
      const PageId id = grid_.page(number);
      for (const Step& step : steps_) {
        step.pages->copy(id, page);
        prevailing.add(page_shape(grid_, id), page.samples);
        for_each_own_place(page_shape(grid_, id), [&](std::size_t place) {
          if (page.low[place] > page.high[place]) return;
          low.push_back(page.low[place]);
          high.push_back(page.high[place]);
        });
      }
    }
    rounding_ = find_rounding(std::move(low), std::move(high));
    prevailing_ = prevailing.found();
  }

  /// Calls fn(jobs) for all steps of the pages in batches, with their ranges rounded.
  template <class Fn>
  void for_each_batch(const std::vector<std::uint64_t>& numbers, const char* stage, Fn&& fn) {
    const std::size_t all = numbers.size() * steps_.size();
    for (std::size_t begin = 0; begin < all; begin += kBatch) {
      progress_.step(stage, static_cast<double>(begin) / static_cast<double>(all));
      const std::size_t count = std::min(kBatch, all - begin);
      if (jobs_.size() < count) jobs_.resize(count);
      // The page of the step before is that of the job before, which of a batch's first job is the last one
      // of the batch before.
      for (std::size_t n = 0; n < count; ++n)
        load(numbers[(begin + n) / steps_.size()], (begin + n) % steps_.size(),
             jobs_[n == 0 ? jobs_.size() - 1 : n - 1], jobs_[n]);
      fn(std::span<const Job<Word>>(jobs_).first(count));
    }
  }

  /// `before`: the job of the same page one step before, if n is not 0.
  void load(std::uint64_t number, std::size_t n, const Job<Word>& before, Job<Word>& job) {
    const Step& step = steps_[n];
    job.number = number;
    const PageId id = grid_.page(job.number);
    job.shape = page_shape(grid_, id);
    step.pages->surroundings(id, job.around);
    step.pages->copy(id, job.page);
    rounding_.round(job.around.low, job.around.high);
    rounding_.round(job.page.low, job.page.high);
    job.earlier_count = 0;
    job.has_earlier_bounds = false;
    if (const int count = steps_before(first_ + static_cast<std::uint32_t>(n)); count > 0) {
      if (n > 0) {
        take_earlier(before, static_cast<std::size_t>(count), job);
      } else {
        load_earlier(id, static_cast<std::size_t>(count), job);
      }
    }
    if (step.gradients == nullptr) return;
    step.gradients->surroundings(id, around_gradients_, PageParts::kSamples);
    job.gradients_around = around_gradients_.samples;
    job.gradients = step.gradients->samples(id)->samples;
  }

  /// From the job of the page one step before, in the same block.
  static void take_earlier(const Job<Word>& before, std::size_t count, Job<Word>& job) {
    job.earlier[0] = {before.page.samples, before.around.samples};
    job.earlier_count = std::min(count, before.earlier_count + 1);
    if (job.earlier_count > 1) job.earlier[1] = before.earlier[0];
    job.has_earlier_bounds = are_same_bounds<Word>(job.shape, before.page, job.page);
  }

  /// From the steps of the blocks before. What is damaged is no help.
  void load_earlier(const PageId& id, std::size_t count, Job<Word>& job) {
    for (std::size_t n = 0; n < std::min(count, earlier_.size()); ++n) {
      const PageSamples<Word>* samples = earlier_[n]->samples(id);
      if (samples == nullptr) return;
      job.earlier[n].samples = samples->samples;
      if (!job.shape.complete) {
        if (!earlier_[n]->surroundings(id, around_, PageParts::kSamples)) return;
        job.earlier[n].around = around_.samples;
      }
      job.earlier_count = n + 1;
    }
  }

  [[nodiscard]] std::unique_ptr<Surveys<Word>> empty_surveys() const {
    const bool in_time =
        options_.coding != SampleCoding::kPlain && (steps_before(first_) > 0 || steps_.size() > 1);
    TimeSurvey<Word> samples(sample_survey<Word>(coding(), ranks_, prevailing_), coding(), in_time);
    return std::make_unique<Surveys<Word>>(std::move(samples), coding(), options_.gradients, volume_.spacing,
                                           rounding_);
  }

  Codecs<Word> survey() {
    std::vector<std::uint64_t> some;
    const std::size_t all = numbers_.size() * steps_.size();
    std::copy_if(numbers_.begin(), numbers_.end(), std::back_inserter(some), [&](std::uint64_t number) {
      return all <= kSurveyed || grid_.page(number).lod > 0 || fibonacci_slot(number, 3) == 0;
    });
    const auto surveys = empty_surveys();
    for_each_batch(some, "surveying", [&](std::span<const Job<Word>> jobs) {
      constexpr std::size_t kPart = kBatch / 4;
      std::vector<std::unique_ptr<Surveys<Word>>> parts((jobs.size() + kPart - 1) / kPart);
      parallel_chunks(jobs.size(), kPart, [&](std::size_t begin, std::size_t end) {
        auto& part = parts[begin / kPart];
        part = empty_surveys();
        for (const Job<Word>& job : jobs.subspan(begin, end - begin)) part->add(job);
      });
      for (const auto& part : parts) surveys->merge(*part);
    });
    return Codecs<Word>(coding(), *surveys);
  }

  void write(StoreFileWriter& writer, const Codecs<Word>& codecs, StoreHeader& header) {
    std::vector<CodedPage> coded(kBatch);
    for_each_batch(numbers_, "compressing", [&](std::span<const Job<Word>> jobs) {
      parallel_for(jobs.size(), kGrain, [&](std::size_t n) { codecs.encode(jobs[n], coded[n]); });
      for (std::size_t n = 0; n < jobs.size(); ++n) {
        const CodedPage& page = coded[n];
        const std::vector<std::byte> payload = join_payload(page.payload());
        writer.add_page(jobs[n].number, payload, page.summary);
        add_bytes(page, header.bytes);
      }
    });
    header.sample_tables = codecs.samples.tables();
    header.time_tables = codecs.samples.time_tables();
    header.bounds_tables = codecs.bounds.tables();
    if (codecs.gradients) header.gradient_tables = codecs.gradients->tables();
    header.bytes.samples += header.sample_tables.size() + header.time_tables.size();
    header.bytes.bounds += header.bounds_tables.size();
    header.bytes.gradients += header.gradient_tables.size();
  }

  /// Of a page that is in the file for its gradients alone all bytes are theirs.
  static void add_bytes(const CodedPage& page, StoreBytes& bytes) {
    PagePayload parts = page.payload();
    parts.gradients = {};
    const std::size_t bounds = parts.bounds.size(), gradients = page.gradients.size();
    if (!is_plain(join_payload(parts), page.summary)) {
      bytes.samples += page.samples.size();
      bytes.bounds += bounds;
      bytes.gradients += gradients;
    } else if (gradients > 0) {
      bytes.gradients += page.samples.size() + bounds + gradients;
    }
  }

  VolumeGrid volume_;
  PageGrid grid_;
  StoreOptions options_;
  Progress& progress_;
  std::uint32_t first_ = 0;  ///< the store's number of the block's first step
  std::vector<Step> steps_;
  std::unique_ptr<StepPages<Word>> earlier_pages_;
  std::vector<StoredPages<Word>*> earlier_;  ///< of the steps before, the last one first
  std::vector<std::uint64_t> numbers_;
  Surroundings<std::uint16_t> around_gradients_;
  Surroundings<Word> around_;
  std::vector<Job<Word>> jobs_;
  SampleCensus<Word> census_;
  std::shared_ptr<const SampleRanks> ranks_;  ///< null where samples are coded as they are
  RangeRounding<Word> rounding_;
  std::optional<Word> prevailing_;
};

/// Adds all steps of a series, in blocks that end where `block_steps` go into the number of steps.
void add_blocks(StoreFileWriter& writer, const std::filesystem::path& path, const SeriesSource& series,
                const StoreOptions& options, std::uint32_t first, StoreFigures& figures, Progress& progress) {
  const auto count = static_cast<std::uint32_t>(series.times.size());
  for (std::uint32_t begin = 0; begin < count;) {
    const std::uint32_t step = first + begin;
    const std::uint32_t end = std::min(count, begin + options.block_steps - step % options.block_steps);
    const auto file = steps_before(step) > 0 ? std::make_unique<StoreFile>(path) : nullptr;
    with_sample_type(series.grid.type, [&](auto sample) {
      const auto builder = std::make_unique<StoreBuilder<decltype(sample)>>(series.grid, options, progress);
      builder->add_block(writer, series, begin, end, step, file.get(), figures);
    });
    begin = end;
  }
}

}  // namespace

StoreFigures build_series(const std::filesystem::path& path, const std::string& shown,
                          const SeriesSource& series, const StoreOptions& options, Progress& progress) {
  StoreFigures figures;
  StoreFileWriter writer(path, shown, series.grid, options.group_pages);
  add_blocks(writer, path, series, options, 0, figures, progress);
  return figures;
}

StoreFigures append_series(const StoreLock& store, const SeriesSource& series, StoreOptions options,
                           Progress& progress) {
  StoreFigures figures;
  const std::filesystem::path& path = store.path();
  const StoreFile file(path);
  if (series.grid != file.header().grid) fail("{}: expected steps on its grid, found another", file.name());
  const double last = file.times().back();
  if (series.times.empty() || series.times.front() <= last)
    fail("{}: expected steps after the time {}, found earlier ones", file.name(), last);
  if (options.coding != SampleCoding::kPlain) options.coding = coding_of_bytes(file.header().coding);
  options.gradients = file.header().gradients;
  StoreFileWriter writer(path, file);
  add_blocks(writer, path, series, options, file.steps(), figures, progress);
  return figures;
}

StoreFigures build_store(const std::filesystem::path& path, const std::string& shown, const VolumeGrid& grid,
                         const PlaneSource& planes, const StoreOptions& options, Progress& progress) {
  return build_series(path, shown, {grid, {0}, [&planes](std::uint32_t) { return planes; }}, options,
                      progress);
}

}  // namespace adamas::isosurface
