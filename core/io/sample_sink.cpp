#include "core/io/sample_sink.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"

namespace adamas {

namespace {

constexpr std::string_view kStage = "unpacking";
/// Bytes from one report to the next.
constexpr std::uint64_t kStep = std::uint64_t{1} << 22;

}  // namespace

SampleSink::SampleSink(const VolumeSource& source, std::shared_ptr<FileHandle> scratch, Progress& progress)
    : source_(source), progress_(progress), file_(std::move(scratch)), expected_(source.sample_file_bytes()) {
  progress_.step(kStage, 0);
}

void SampleSink::take(std::span<const std::byte> bytes) {
  progress_.check();
  const std::uint64_t left = expected_ - found();
  file_->append(bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(left, bytes.size()))));
  if (found() - reported_ < kStep) return;
  reported_ = found();
  progress_.report(kStage, static_cast<double>(found()) / static_cast<double>(expected_));
}

VolumeSource SampleSink::finish() const {
  if (found() != expected_) {
    const auto& n = source_.grid.dimensions;
    fail("{}: expected {} bytes for {} x {} x {} samples of {}, found {} unpacked", source_.name, expected_,
         n[0], n[1], n[2], stored_name(source_.stored), found());
  }
  VolumeSource result = source_;
  result.scratch = file_;
  result.more_files.clear();
  result.header_bytes = result.skip_lines = result.skip_bytes = 0;
  result.count_bytes = 0;
  result.at_end = result.base64 = result.before_tag = false;
  result.exact = true;
  result.coding = SamplePacking::kRaw;
  progress_.report(kStage, 1);
  return result;
}

}  // namespace adamas
