#include "isosurface/storage/store_builder.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "isosurface/compression/bounds_codec.h"
#include "isosurface/compression/gradient_codec.h"
#include "isosurface/compression/prevailing_sample.h"
#include "isosurface/compression/range_rounding.h"
#include "isosurface/compression/ranked_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/preprocessing/preprocess.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/scratch_pages.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/volume/samples.h"

namespace adamas {

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

/// A page with all that is known when it is coded.
template <class Word>
struct Job {
  std::uint64_t number = 0;
  PageShape shape{};
  Page<Word> page;
  Surroundings<Word> around;
  GradientCodes gradients;  ///< undefined, with those round it, where none are kept
  GradientCodesAround gradients_around;
};

/// What the tables are made from.
template <class Word>
struct Surveys {
  std::unique_ptr<SampleSurvey<Word>> samples;
  BoundsSurvey<Word> bounds;
  std::optional<GradientSurvey> gradients;

  /// `ranks`, `prevailing`: see sample_survey.
  Surveys(SampleCoding coding, std::shared_ptr<const SampleRanks> ranks, std::optional<Word> prevailing,
          bool with_gradients, const Vec3& spacing, const RangeRounding<Word>& rounding)
      : samples(sample_survey<Word>(coding, std::move(ranks), prevailing)), bounds(spacing, rounding) {
    if (with_gradients) gradients.emplace(coding_of_bytes(coding));
  }

  void add(const Job<Word>& job) {
    samples->add(job.shape, job.around.samples, job.page.samples);
    bounds.add(job.shape, job.around, job.page);
    if (gradients) gradients->add(job.shape, job.gradients_around, job.gradients);
  }
  void merge(const Surveys& other) {
    samples->merge(*other.samples);
    bounds.merge(other.bounds);
    if (gradients) gradients->merge(*other.gradients);
  }
};

/// The bytes of a page, and what the directory says of it.
struct CodedPage {
  std::vector<std::byte> samples, bounds, gradients;
  std::size_t along = 0;  ///< how many of the bounds the samples carry
  PageSummary summary;

  [[nodiscard]] PagePayload payload() const {
    return {samples, std::span(bounds).subspan(along), gradients, along};
  }
};

template <class Word>
struct Codecs {
  SampleCoding coding;
  std::unique_ptr<SampleCodec<Word>> samples;
  BoundsCodec<Word> bounds;
  std::optional<GradientCodec> gradients;

  Codecs(SampleCoding of_samples, const Surveys<Word>& surveys)
      : coding(of_samples), samples(surveys.samples->codec()), bounds(surveys.bounds) {
    if (surveys.gradients) gradients.emplace(surveys.gradients->codec());
  }

  void encode(const Job<Word>& job, CodedPage& coded) const {
    coded.samples.clear();
    coded.bounds.clear();
    coded.gradients.clear();
    bounds.encode(job.shape, job.around, job.page, coded.bounds);
    samples->encode_with(job.shape, job.around.samples, job.page.samples, coded.samples, coded.bounds);
    coded.along = carried_along(coding, coded.samples[0], coded.bounds.size());
    if (gradients) gradients->encode(job.shape, job.gradients_around, job.gradients, coded.gradients);
    coded.summary = summary(job.shape, job.page);
  }
};

template <class Sample>
class StoreBuilder {
 public:
  using Word = OrderedWord<Sample>;

  StoreBuilder(const VolumeGrid& volume, const StoreOptions& options, Progress& progress)
      : volume_(volume),
        grid_(volume.dimensions),
        options_(options),
        progress_(progress),
        scratch_(options.scratch, grid_, kMemory) {
    if (options.gradients)
      gradients_ =
          std::make_unique<ScratchPages<std::uint16_t>>(options.scratch, grid_, kMemory, PageParts::kSamples);
  }

  StoreFigures build(const std::filesystem::path& path, const std::string& shown, const PlaneSource& planes) {
    preprocess<Sample>(
        volume_, planes,
        [this](const PageId& id, const Page<Word>& page) {
          if (options_.coding == SampleCoding::kInterpolation)
            census_.add(page_shape(grid_, id), page.samples);
          scratch_.put(id, page);
        },
        progress_);
    if (gradients_ != nullptr) make_gradients(planes);
    ranks_ = census_.ranks();
    const std::vector<std::uint64_t> numbers = page_numbers(grid_);
    look_at_coarse(std::span(numbers).first(std::min(numbers.size(), kCoarsePages)));
    return write(numbers, survey(numbers), path, shown);
  }

 private:
  void make_gradients(const PlaneSource& planes) {
    GradientPageOptions options;
    options.smoothing = options_.smoothing;
    options.scratch = options_.scratch;
    gradient_pages<Sample>(
        volume_, planes,
        [this](const PageId& id, const Page<std::uint16_t>& page) { gradients_->put(id, page); }, options,
        progress_);
  }
  [[nodiscard]] SampleCoding coding() const {
    return ranks_ != nullptr ? SampleCoding::kRanks : options_.coding;
  }
  /// Finds the rounding of ranges and the prevailing sample, by the diamonds and the samples of these pages.
  void look_at_coarse(std::span<const std::uint64_t> numbers) {
    std::vector<Word> low, high;
    PrevailingSample<Word> prevailing(ranks_.get());
    Page<Word> page;
    for (const std::uint64_t number : numbers) {
      const PageId id = grid_.page(number);
      scratch_.copy(id, page);
      prevailing.add(page_shape(grid_, id), page.samples);
      for_each_own_place(page_shape(grid_, id), [&](std::size_t place) {
        if (page.low[place] > page.high[place]) return;
        low.push_back(page.low[place]);
        high.push_back(page.high[place]);
      });
    }
    rounding_ = find_rounding(std::move(low), std::move(high));
    prevailing_ = prevailing.found();
  }
  /// Calls fn(jobs) for the pages in batches, with their ranges rounded.
  template <class Fn>
  void for_each_batch(const std::vector<std::uint64_t>& numbers, const char* stage, Fn&& fn) {
    for (std::size_t begin = 0; begin < numbers.size(); begin += kBatch) {
      progress_.step(stage, static_cast<double>(begin) / static_cast<double>(numbers.size()));
      const std::size_t count = std::min(kBatch, numbers.size() - begin);
      if (jobs_.size() < count) jobs_.resize(count);
      for (std::size_t n = 0; n < count; ++n) {
        Job<Word>& job = jobs_[n];
        job.number = numbers[begin + n];
        const PageId id = grid_.page(job.number);
        job.shape = page_shape(grid_, id);
        scratch_.surroundings(id, job.around);
        scratch_.copy(id, job.page);
        rounding_.round(job.around.low, job.around.high);
        rounding_.round(job.page.low, job.page.high);
        if (gradients_ != nullptr) get_gradients(id, job);
      }
      fn(std::span<const Job<Word>>(jobs_).first(count));
    }
  }

  void get_gradients(const PageId& id, Job<Word>& job) {
    gradients_->surroundings(id, around_gradients_, PageParts::kSamples);
    job.gradients_around = around_gradients_.samples;
    job.gradients = gradients_->samples(id)->samples;
  }

  Codecs<Word> survey(const std::vector<std::uint64_t>& numbers) {
    std::vector<std::uint64_t> some;
    std::copy_if(numbers.begin(), numbers.end(), std::back_inserter(some), [&](std::uint64_t number) {
      return numbers.size() <= kSurveyed || grid_.page(number).lod > 0 || fibonacci_slot(number, 3) == 0;
    });
    const auto empty = [this] {
      return std::make_unique<Surveys<Word>>(coding(), ranks_, prevailing_, options_.gradients,
                                             volume_.spacing, rounding_);
    };
    const auto surveys = empty();
    for_each_batch(some, "surveying", [&](std::span<const Job<Word>> jobs) {
      constexpr std::size_t kPart = kBatch / 4;
      std::vector<std::unique_ptr<Surveys<Word>>> parts((jobs.size() + kPart - 1) / kPart);
      parallel_chunks(jobs.size(), kPart, [&](std::size_t begin, std::size_t end) {
        auto& part = parts[begin / kPart];
        part = empty();
        for (const Job<Word>& job : jobs.subspan(begin, end - begin)) part->add(job);
      });
      for (const auto& part : parts) surveys->merge(*part);
    });
    return Codecs<Word>(coding(), *surveys);
  }

  StoreFigures write(const std::vector<std::uint64_t>& numbers, const Codecs<Word>& codecs,
                     const std::filesystem::path& path, const std::string& shown) {
    StoreHeader header;
    header.grid = volume_;
    header.coding = coding();
    header.gradients = options_.gradients;
    StoreFileWriter writer(path, shown, header);
    std::vector<CodedPage> coded(kBatch);
    for_each_batch(numbers, "compressing", [&](std::span<const Job<Word>> jobs) {
      parallel_for(jobs.size(), kGrain, [&](std::size_t n) { codecs.encode(jobs[n], coded[n]); });
      for (std::size_t n = 0; n < jobs.size(); ++n) {
        const CodedPage& page = coded[n];
        const std::vector<std::byte> payload = join_payload(page.payload());
        writer.add_page(0, jobs[n].number, payload, page.summary);
        add_bytes(page, header.bytes);
      }
    });
    header.sample_tables = codecs.samples->tables();
    header.bounds_tables = codecs.bounds.tables();
    if (codecs.gradients) header.gradient_tables = codecs.gradients->tables();
    header.bytes.samples += header.sample_tables.size();
    header.bytes.bounds += header.bounds_tables.size();
    header.bytes.gradients += header.gradient_tables.size();
    const StoreBytes bytes = header.bytes;
    return {bytes, writer.finish(std::move(header)), numbers.size()};
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
  ScratchPages<Word> scratch_;
  std::unique_ptr<ScratchPages<std::uint16_t>> gradients_;  ///< OctahedralCodes; null where none are kept
  Surroundings<std::uint16_t> around_gradients_;
  std::vector<Job<Word>> jobs_;
  SampleCensus<Word> census_;
  std::shared_ptr<const SampleRanks> ranks_;  ///< null where samples are coded as they are
  RangeRounding<Word> rounding_;
  std::optional<Word> prevailing_;
};

}  // namespace

StoreFigures build_store(const std::filesystem::path& path, const std::string& shown, const VolumeGrid& grid,
                         const PlaneSource& planes, const StoreOptions& options, Progress& progress) {
  return with_sample_type(grid.type, [&](auto sample) {
    return StoreBuilder<decltype(sample)>(grid, options, progress).build(path, shown, planes);
  });
}

}  // namespace adamas
