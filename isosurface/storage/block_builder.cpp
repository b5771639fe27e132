#include "isosurface/storage/block_builder.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "isosurface/compression/bounds/bounds_codec.h"
#include "isosurface/compression/ranks/prevailing_sample.h"
#include "isosurface/preprocessing/preprocess.h"
#include "isosurface/storage/number_remainders.h"
#include "isosurface/storage/page_payload.h"

namespace adamas::isosurface {

namespace {

/// The number of pages that all threads process together.
constexpr std::size_t kBatch = 256;
/// The number of pages that a thread takes at a time.
constexpr std::size_t kGrain = 16;
/// Bytes of scratch pages that are kept in memory.
constexpr std::size_t kMemory = std::size_t{256} << 20;
/// If there are more pages than these, one of eight finest pages is surveyed for the tables.
constexpr std::uint64_t kSurveyed = 4096;
/// The number of coarsest pages by which the rounding of ranges and the prevailing sample are chosen.
constexpr std::size_t kCoarsePages = 256;

/// Returns the numbers of all pages, in the order of the file.
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

/// The bytes of a page, and its summary in the directory.
struct CodedPage {
  std::vector<std::byte> samples, bounds, gradients;
  std::size_t along = 0;  ///< the number of bytes of bounds that the samples carry
  PageSummary summary;

  [[nodiscard]] PagePayload payload() const {
    return {samples, std::span(bounds).subspan(along), gradients, along};
  }
};

/// Counts the bytes of a page; a page that is in the file only because of its gradients counts as gradients.
void add_bytes(const CodedPage& page, StoreBytes& bytes) {
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

}  // namespace

/// The surveys for the tables.
template <class Sample>
struct BlockBuilder<Sample>::Surveys {
  std::unique_ptr<BlockSurvey<Word>> samples;
  BoundsSurvey<Word> bounds;
  std::optional<GradientSurvey> gradients;

  void add(const Job& job) {
    samples->add(job);
    if (!job.has_earlier_bounds) bounds.add(job.shape, job.around, job.page);
    if (gradients) gradients->add(job.shape, job.gradients_around, job.gradients);
  }
  void merge(const Surveys& other) {
    samples->merge(*other.samples);
    bounds.merge(other.bounds);
    if (gradients) gradients->merge(*other.gradients);
  }
};

template <class Sample>
struct BlockBuilder<Sample>::Codecs {
  SampleCoding coding;
  std::unique_ptr<BlockCodec<Word>> samples;
  BoundsCodec<Word> bounds;
  std::optional<GradientCodec> gradients;

  Codecs(SampleCoding of_samples, const Surveys& surveys)
      : coding(of_samples), samples(surveys.samples->codec()), bounds(surveys.bounds) {
    if (surveys.gradients) gradients.emplace(surveys.gradients->codec());
  }

  void encode(const Job& job, CodedPage& coded) const {
    coded.samples.clear();
    coded.bounds.clear();
    coded.gradients.clear();
    if (!job.has_earlier_bounds) bounds.encode(job.shape, job.around, job.page, coded.bounds);
    samples->encode(job, coded.samples, coded.bounds);
    coded.along = carried_along(coding, coded.samples[0], coded.bounds.size());
    if (gradients) gradients->encode(job.shape, job.gradients_around, job.gradients, coded.gradients);
    coded.summary = summary(job.shape, job.page);
  }
};

template <class Sample>
BlockBuilder<Sample>::BlockBuilder(const VolumeGrid& volume, const StoreOptions& options, Progress& progress)
    : volume_(volume), grid_(volume.dimensions), options_(options), progress_(progress) {}

template <class Sample>
BlockBuilder<Sample>::~BlockBuilder() = default;

template <class Sample>
void BlockBuilder<Sample>::build(StoreFileWriter& writer, const BlockSource& source, StoreFigures& figures) {
  writer_ = &writer;
  source_ = &source;
  first_step_ = source.first_step;
  step_count_ = source.times.size();
  step_memory_ = kMemory / step_count_;
  prepare_steps(source);
  ranks_ = census_.ranks();
  numbers_ = page_numbers(grid_);
  survey_coarse_pages();
  const Codecs codecs = survey();
  StoreHeader header;
  header.grid = volume_;
  header.numbers = source.numbers;
  header.bytes = bytes_;
  header.coding = coding_in_files(coding());
  header.gradients = options_.gradients;
  header.first_step = first_step_;
  header.times = source.times;
  write(writer, codecs, header);
  figures.bytes += header.bytes;
  figures.file_bytes = writer.finish_block(header);
  figures.pages += numbers_.size() * steps_.size();
}

template <class Sample>
void BlockBuilder<Sample>::prepare_steps(const BlockSource& source) {
  for (std::uint32_t n = 0; n < source.times.size(); ++n) {
    const PlaneSource planes = source.planes(n);
    prepare_step(planes);
    if (options_.gradients) find_gradients(planes);
  }
}

template <class Sample>
void BlockBuilder<Sample>::prepare_step(const PlaneSource& planes) {
  Step& step = steps_.emplace_back();
  step.pages = std::make_unique<ScratchPages<Word>>(options_.scratch, grid_, step_memory_);
  if (options_.gradients)
    step.gradients = std::make_unique<ScratchPages<std::uint16_t>>(options_.scratch, grid_, step_memory_,
                                                                   PageParts::kSamples);
  preprocess<Sample>(
      volume_, planes,
      [&](const PageId& id, const Page<Word>& page) {
        if (options_.coding == SampleCoding::kInterpolation) census_.add(page_shape(grid_, id), page.samples);
        step.pages->put(id, page);
      },
      progress_);
  if (has_remainders(source_->numbers.type)) write_remainders(planes);
}

template <class Sample>
void BlockBuilder<Sample>::write_remainders(const PlaneSource& planes) {
  const std::size_t width = stored_bytes(source_->numbers.type), samples = volume_.plane_samples();
  const std::uint64_t per_record = remainder_planes(volume_);
  std::vector<float> values;
  std::vector<std::byte> numbers;
  for (std::uint64_t k = 0; k < volume_.dimensions[2]; k += per_record) {
    progress_.step("keeping digits", static_cast<double>(k) / static_cast<double>(volume_.dimensions[2]));
    const std::size_t count = std::min(per_record, volume_.dimensions[2] - k);
    values.resize(count * samples);
    numbers.resize(count * samples * width);
    for (std::size_t n = 0; n < count; ++n) {
      planes(k + n, std::as_writable_bytes(std::span(values).subspan(n * samples, samples)));
      source_->number_planes(k + n, std::span(numbers).subspan(n * samples * width, samples * width));
    }
    const std::vector<std::byte> record = encode_remainders(source_->numbers.type, numbers, values);
    bytes_.remainders += record.size();
    writer_->add_remainders(record);
  }
}

template <class Sample>
void BlockBuilder<Sample>::find_gradients(const PlaneSource& planes) {
  const std::size_t step = steps_.size() - 1;
  gradient_pages<Sample>(
      volume_, planes,
      [&](const PageId& id, const Page<std::uint16_t>& page) { put_gradients(step, id, page); },
      gradient_options(), progress_);
}

template <class Sample>
void BlockBuilder<Sample>::put_gradients(std::size_t step, const PageId& id,
                                         const Page<std::uint16_t>& page) {
  steps_[step].gradients->put(id, page);
}

template <class Sample>
GradientPageOptions BlockBuilder<Sample>::gradient_options() const {
  GradientPageOptions options;
  options.smoothing = options_.smoothing;
  options.scratch = options_.scratch;
  return options;
}

template <class Sample>
SampleCoding BlockBuilder<Sample>::coding() const {
  return ranks_ != nullptr ? SampleCoding::kRanks : options_.coding;
}

template <class Sample>
std::unique_ptr<SampleSurvey<OrderedWord<Sample>>> BlockBuilder<Sample>::space_survey() const {
  return sample_survey<Word>(coding(), ranks_, prevailing_);
}

template <class Sample>
void BlockBuilder<Sample>::survey_coarse_pages() {
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

template <class Sample>
template <class Fn>
void BlockBuilder<Sample>::for_each_batch(const std::vector<std::uint64_t>& numbers, const char* stage,
                                          Fn&& fn) {
  const std::size_t all = numbers.size() * steps_.size();
  for (std::size_t begin = 0; begin < all; begin += kBatch) {
    progress_.step(stage, static_cast<double>(begin) / static_cast<double>(all));
    const std::size_t count = std::min(kBatch, all - begin);
    if (jobs_.size() < count) jobs_.resize(count);
    // The page of the step before belongs to the job before; for a batch's first job, that is the last one of
    // the batch before.
    for (std::size_t n = 0; n < count; ++n) {
      jobs_[n].slot = n;
      load(numbers[(begin + n) / steps_.size()], (begin + n) % steps_.size(),
           jobs_[n == 0 ? jobs_.size() - 1 : n - 1], jobs_[n]);
    }
    fn(std::span<const Job>(jobs_).first(count));
  }
}

template <class Sample>
void BlockBuilder<Sample>::load(std::uint64_t number, std::size_t n, const Job& before, Job& job) {
  const Step& step = steps_[n];
  job.number = number;
  const PageId id = grid_.page(job.number);
  job.shape = page_shape(grid_, id);
  step.pages->surroundings(id, job.around);
  step.pages->copy(id, job.page);
  rounding_.round(job.around.low, job.around.high);
  rounding_.round(job.page.low, job.page.high);
  job.has_earlier_bounds = false;
  find_earlier(id, n, before, job);
  if (step.gradients == nullptr) return;
  step.gradients->surroundings(id, around_gradients_, PageParts::kSamples);
  job.gradients_around = around_gradients_.samples;
  job.gradients = step.gradients->samples(id)->samples;
}

template <class Sample>
std::unique_ptr<typename BlockBuilder<Sample>::Surveys> BlockBuilder<Sample>::empty_surveys() const {
  std::optional<GradientSurvey> gradients;
  if (options_.gradients) gradients.emplace(coding_of_bytes(coding()));
  return std::unique_ptr<Surveys>(new Surveys{
      sample_block_survey(), BoundsSurvey<Word>(volume_.spacing, rounding_), std::move(gradients)});
}

template <class Sample>
typename BlockBuilder<Sample>::Codecs BlockBuilder<Sample>::survey() {
  std::vector<std::uint64_t> some;
  const std::size_t all = numbers_.size() * steps_.size();
  std::copy_if(numbers_.begin(), numbers_.end(), std::back_inserter(some), [&](std::uint64_t number) {
    return all <= kSurveyed || grid_.page(number).lod > 0 || fibonacci_slot(number, 3) == 0;
  });
  const auto surveys = empty_surveys();
  for_each_batch(some, "surveying", [&](std::span<const Job> jobs) {
    constexpr std::size_t kPart = kBatch / 4;
    std::vector<std::unique_ptr<Surveys>> parts((jobs.size() + kPart - 1) / kPart);
    parallel_chunks(jobs.size(), kPart, [&](std::size_t begin, std::size_t end) {
      auto& part = parts[begin / kPart];
      part = empty_surveys();
      for (const Job& job : jobs.subspan(begin, end - begin)) part->add(job);
    });
    for (const auto& part : parts) surveys->merge(*part);
  });
  return Codecs(coding(), *surveys);
}

template <class Sample>
void BlockBuilder<Sample>::write(StoreFileWriter& writer, const Codecs& codecs, StoreHeader& header) {
  std::vector<CodedPage> coded(kBatch);
  for_each_batch(numbers_, "compressing", [&](std::span<const Job> jobs) {
    parallel_for(jobs.size(), kGrain, [&](std::size_t n) { codecs.encode(jobs[n], coded[n]); });
    for (std::size_t n = 0; n < jobs.size(); ++n) {
      const CodedPage& page = coded[n];
      const std::vector<std::byte> payload = join_payload(page.payload());
      writer.add_page(jobs[n].number, payload, page.summary);
      add_bytes(page, header.bytes);
    }
  });
  header.sample_tables = codecs.samples->tables();
  header.time_tables = codecs.samples->time_tables();
  header.bounds_tables = codecs.bounds.tables();
  if (codecs.gradients) header.gradient_tables = codecs.gradients->tables();
  header.bytes.samples += header.sample_tables.size() + header.time_tables.size();
  header.bytes.bounds += header.bounds_tables.size();
  header.bytes.gradients += header.gradient_tables.size();
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(BlockBuilder);

}  // namespace adamas::isosurface
