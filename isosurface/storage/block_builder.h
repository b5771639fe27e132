#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "isosurface/compression/bounds/range_rounding.h"
#include "isosurface/compression/gradients/gradient_codec.h"
#include "isosurface/compression/ranks/ranked_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/storage/scratch_pages.h"
#include "isosurface/storage/store_file_writer.h"
#include "isosurface/storage/store_options.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// A page at a step of a block, with all data that are known when it is coded.
template <class Word>
struct PageJob {
  std::uint64_t number = 0;
  std::size_t slot = 0;  ///< the job's place in its batch
  PageShape shape{};
  Page<Word> page;
  Surroundings<Word> around;
  GradientCodes gradients;  ///< undefined, with those round it, if none are stored
  GradientCodesAround gradients_around;
  bool has_earlier_bounds = false;  ///< whether the bounds are those of the step before, and not coded
};

/// Makes the samples of pages of a block into bytes. Several threads may use it at once.
template <class Word>
class BlockCodec {
 public:
  virtual ~BlockCodec() = default;

  /// Appends the samples of the page's own points; carries bytes along as SampleCodec::encode_with() does.
  virtual void encode(const PageJob<Word>& job, std::vector<std::byte>& out,
                      std::span<const std::byte> along) const = 0;
  /// Returns the tables, which go into StoreHeader::sample_tables and StoreHeader::time_tables.
  [[nodiscard]] virtual std::vector<std::byte> tables() const = 0;
  [[nodiscard]] virtual std::vector<std::byte> time_tables() const = 0;
};

/// Counts the samples of pages of a block, for the tables of a BlockCodec.
template <class Word>
class BlockSurvey {
 public:
  virtual ~BlockSurvey() = default;

  virtual void add(const PageJob<Word>& job) = 0;
  /// Adds the counts of a survey of the same builder. The order of pages and of merging does not matter.
  virtual void merge(const BlockSurvey& other) = 0;
  [[nodiscard]] virtual std::unique_ptr<BlockCodec<Word>> codec() const = 0;
};

/// The volumes of a block's steps.
struct BlockSource {
  std::uint32_t first_step = 0;  ///< the number of the first of them in the store
  std::vector<double> times;     ///< times of the steps, ascending
  std::function<PlaneSource(std::uint32_t n)> planes;
  StoredNumbers numbers;
  /// Where numbers have remainders, fills the numbers of a plane of the step whose planes were asked for
  /// last.
  PlaneSource number_planes;
};

/// Makes one block of a store: preprocesses its steps, chooses tables, compresses pages and writes them. The
/// derived class codes samples, and may do so with those of earlier steps and smooth gradients along time
/// (timevarying/series_builder.cpp).
template <class Sample>
class BlockBuilder {
 public:
  using Word = OrderedWord<Sample>;

  BlockBuilder(const VolumeGrid& volume, const StoreOptions& options, Progress& progress);
  virtual ~BlockBuilder();
  BlockBuilder(const BlockBuilder&) = delete;
  BlockBuilder& operator=(const BlockBuilder&) = delete;

  /// Writes the block, and adds to `figures`. A builder makes one block.
  void build(StoreFileWriter& writer, const BlockSource& source, StoreFigures& figures);

 protected:
  using Job = PageJob<Word>;

  /// Preprocesses all steps, by a call of prepare_step() for each, and finds their gradients if they are
  /// wanted.
  virtual void prepare_steps(const BlockSource& source);
  /// Finds the earlier samples and bounds that a job may be coded with. `n` is the job's step in the block;
  /// `before` is the job of the same page one step earlier, if n is not 0.
  virtual void find_earlier(const PageId& id, std::size_t n, const Job& before, Job& job) = 0;
  [[nodiscard]] virtual std::unique_ptr<BlockSurvey<Word>> sample_block_survey() const = 0;

  void prepare_step(const PlaneSource& planes);
  /// Writes the remainders of the step that was prepared last.
  void write_remainders(const PlaneSource& planes);
  /// Finds the gradients of the step that was prepared last.
  void find_gradients(const PlaneSource& planes);
  void put_gradients(std::size_t step, const PageId& id, const Page<std::uint16_t>& page);
  [[nodiscard]] GradientPageOptions gradient_options() const;
  [[nodiscard]] SampleCoding coding() const;
  /// Returns a survey of samples in space.
  [[nodiscard]] std::unique_ptr<SampleSurvey<Word>> space_survey() const;

  VolumeGrid volume_;
  PageGrid grid_;
  StoreOptions options_;
  Progress& progress_;
  std::uint32_t first_step_ = 0;
  std::size_t step_count_ = 0;

 private:
  struct Surveys;
  struct Codecs;
  /// The results of preprocessing of a step.
  struct Step {
    std::unique_ptr<ScratchPages<Word>> pages;
    std::unique_ptr<ScratchPages<std::uint16_t>> gradients;  ///< OctahedralCodes; null where none are kept
  };

  /// Finds the rounding of ranges and the prevailing sample, from the coarsest pages.
  void survey_coarse_pages();
  /// Calls fn(jobs) for all steps of the pages in batches, with their ranges rounded.
  template <class Fn>
  void for_each_batch(const std::vector<std::uint64_t>& numbers, const char* stage, Fn&& fn);
  void load(std::uint64_t number, std::size_t n, const Job& before, Job& job);
  [[nodiscard]] std::unique_ptr<Surveys> empty_surveys() const;
  Codecs survey();
  void write(StoreFileWriter& writer, const Codecs& codecs, StoreHeader& header);

  StoreFileWriter* writer_ = nullptr;
  const BlockSource* source_ = nullptr;
  StoreBytes bytes_;
  std::size_t step_memory_ = 0;  ///< bytes of scratch pages of each step that are kept in memory
  std::vector<Step> steps_;
  std::vector<std::uint64_t> numbers_;
  Surroundings<std::uint16_t> around_gradients_;
  std::vector<Job> jobs_;
  SampleCensus<Word> census_;
  std::shared_ptr<const SampleRanks> ranks_;  ///< null if samples are coded as they are
  RangeRounding<Word> rounding_;
  std::optional<Word> prevailing_;
};

}  // namespace adamas::isosurface
