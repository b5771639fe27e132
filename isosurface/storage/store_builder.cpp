#include "isosurface/storage/store_builder.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/compression/value_codec.h"
#include "isosurface/storage/page_summary.h"
#include "isosurface/storage/page_tree.h"
#include "isosurface/storage/sample_dispatch.h"
#include "isosurface/storage/scratch_pages.h"
#include "isosurface/storage/store_file_writer.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

namespace {

/// Pages that are worked on together, by as many threads as there are.
constexpr std::size_t kBatch = 256;
/// Pages that one thread takes at a time.
constexpr std::size_t kGrain = 16;
/// Bytes of pages kept in memory.
constexpr std::size_t kMemory = std::size_t{256} << 20;
/// Where a volume has more pages than these, not all of the finest ones are looked at for the tables.
constexpr std::uint64_t kSurveyed = 4096;

/// Numbers of all pages, in the order of the file.
std::vector<std::uint64_t> page_numbers(const PageGrid& grid) {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(grid.page_count());
  for (int level = grid.top(); level >= 0; --level) {
    const LatticePoint n = grid.blocks(level);
    for (std::int32_t k = 0; k < n.k; ++k) {
      for (std::int32_t j = 0; j < n.j; ++j) {
        for (std::int32_t i = 0; i < n.i; ++i) {
          const PageId id{level, {i, j, k}};
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
        scratch_(options.scratch, grid_),
        tree_(grid_, kMemory / sizeof(Page<Word>),
              [this](const PageId& id, const PageShape&, const Surroundings<Word>&, Page<Word>& page) {
                scratch_.get(id, page);
                return true;
              }) {}

  StoreFigures build(const std::filesystem::path& path, const std::string& shown, const PlaneSource& planes) {
    PreprocessOptions preprocessing;
    preprocessing.subtree_depth = options_.subtree_depth;
    preprocess<Sample>(
        volume_, planes, [this](const PageId& id, const Page<Word>& page) { scratch_.put(id, page); },
        preprocessing, progress_);
    const std::vector<std::uint64_t> numbers = page_numbers(grid_);
    survey(numbers);
    return write(numbers, path, shown);
  }

 private:
  /// Calls fn(jobs) for the pages in batches.
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
        job.shape = {grid_.count(id), grid_.is_complete(id), id.level};
        tree_.surroundings(id, job.around);
        job.page = *tree_.page(id);
      }
      fn(std::span<const Job<Word>>(jobs_).first(count));
    }
  }

  void survey(const std::vector<std::uint64_t>& numbers) {
    std::vector<std::uint64_t> some;
    std::copy_if(numbers.begin(), numbers.end(), std::back_inserter(some), [&](std::uint64_t number) {
      constexpr std::uint64_t kScatter = 0x9e3779b97f4a7c15ull;
      return numbers.size() <= kSurveyed || grid_.page(number).level > 0 || number * kScatter >> 61 == 0;
    });
    samples_ = sample_survey<Word>(options_.coding);
    for_each_batch(some, "surveying", [this](std::span<const Job<Word>> jobs) {
      const std::size_t parts = (jobs.size() + kBatch / 4 - 1) / (kBatch / 4);
      std::vector<std::unique_ptr<SampleSurvey<Word>>> samples(parts);
      std::vector<std::unique_ptr<ValueSurvey<Word>>> values(parts);
      parallel_chunks(jobs.size(), kBatch / 4, [&](std::size_t begin, std::size_t end) {
        const std::size_t part = begin / (kBatch / 4);
        samples[part] = sample_survey<Word>(options_.coding);
        values[part] = std::make_unique<ValueSurvey<Word>>();
        for (const Job<Word>& job : jobs.subspan(begin, end - begin)) {
          samples[part]->add(job.shape, job.around.samples, job.page.samples);
          values[part]->add(job.shape, job.around, job.page);
        }
      });
      for (std::size_t part = 0; part < parts; ++part) {
        samples_->merge(*samples[part]);
        values_.merge(*values[part]);
      }
    });
  }

  StoreFigures write(const std::vector<std::uint64_t>& numbers, const std::filesystem::path& path,
                     const std::string& shown) {
    StoreHeader header;
    header.grid = volume_;
    header.coding = options_.coding;
    header.subtree_depth = static_cast<std::uint8_t>(options_.subtree_depth);
    const std::unique_ptr<SampleCodec<Word>> samples = samples_->codec();
    const ValueCodec<Word> values(values_);
    StoreFileWriter writer(path, shown, header);
    struct Coded {
      std::vector<std::byte> samples, values;
    };
    std::vector<Coded> coded(kBatch);
    for_each_batch(numbers, "compressing", [&](std::span<const Job<Word>> jobs) {
      parallel_for(jobs.size(), kGrain, [&](std::size_t n) {
        coded[n].samples.clear();
        coded[n].values.clear();
        samples->encode(jobs[n].shape, jobs[n].around.samples, jobs[n].page.samples, coded[n].samples);
        values.encode(jobs[n].shape, jobs[n].around, jobs[n].page, coded[n].values);
      });
      for (std::size_t n = 0; n < jobs.size(); ++n) {
        header.bytes.samples += coded[n].samples.size();
        header.bytes.values += coded[n].values.size();
        writer.add_page(0, jobs[n].number, join_payload({coded[n].samples, coded[n].values, {}}),
                        summary(jobs[n].shape, jobs[n].page));
      }
    });
    header.sample_tables = samples->tables();
    header.value_tables = values.tables();
    header.bytes.samples += header.sample_tables.size();
    header.bytes.values += header.value_tables.size();
    const StoreBytes bytes = header.bytes;
    return {bytes, writer.finish(std::move(header)), numbers.size()};
  }

  VolumeGrid volume_;
  PageGrid grid_;
  StoreOptions options_;
  Progress& progress_;
  ScratchPages<Word> scratch_;
  PageTree<Word> tree_;
  std::vector<Job<Word>> jobs_;
  std::unique_ptr<SampleSurvey<Word>> samples_;
  ValueSurvey<Word> values_;
};

}  // namespace

StoreFigures build_store(const std::filesystem::path& path, const std::string& shown, const VolumeGrid& grid,
                         const PlaneSource& planes, const StoreOptions& options, Progress& progress) {
  return with_sample_type(grid.type, [&](auto sample) {
    return StoreBuilder<decltype(sample)>(grid, options, progress).build(path, shown, planes);
  });
}

}  // namespace adamas
