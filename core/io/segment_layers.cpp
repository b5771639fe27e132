#include "core/io/segment_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/io/whole_pieces.h"

namespace adamas::io {

namespace {

/// What is counted while layers are merged.
struct LayerCounts {
  std::uint64_t overlaps = 0;       ///< samples in several segments
  std::uint64_t strangers = 0;      ///< samples with numbers that belong to no segment
  std::vector<std::uint64_t> lost;  ///< by segment: samples that later segments have

  [[nodiscard]] std::string text(const std::vector<LayerSegment>& segments) const {
    std::string text;
    if (overlaps > 0) {
      text = fmt::format("segments overlap in {}, each of which goes to the one listed last",
                         counted(overlaps, "voxel"));
      const char* before = ": ";
      for (std::size_t s = 0; s < lost.size(); ++s) {
        if (lost[s] == 0) continue;
        text += fmt::format("{}'{}' loses {}", before, visible_text(segments[s].name), lost[s]);
        before = ", ";
      }
    }
    if (strangers > 0)
      text += fmt::format("{}numbers in the layers of {} belong to no segment and are left out",
                          text.empty() ? "" : "; ", counted(strangers, "voxel"));
    return text;
  }
};

/// Merges the numbers of layers, which arrive sample by sample, into labels.
template <class Number>
class LayerMerger {
 public:
  LayerMerger(const VolumeSource& source, const std::vector<LayerSegment>& segments)
      : length_(source.grid.dimensions[0]),
        builder_(length_, source.grid.dimensions[1] * source.grid.dimensions[2]),
        sample_(source.components),
        used_(segments.size() + 1, false) {
    counts_.lost.resize(segments.size(), 0);
    for (std::size_t s = 0; s < segments.size(); ++s)
      members_[{segments[s].layer, segments[s].value}].push_back(s);
  }

  /// Takes the next numbers; the last sample may be completed by the next ones.
  void take(std::span<const Number> numbers) {
    for (const Number number : numbers) {
      sample_[filled_++] = number;
      if (filled_ < sample_.size()) continue;
      filled_ = 0;
      add_sample();
    }
  }

  const LayerCounts& counts() {
    count_alike();
    return counts_;
  }

  WholeRuns finish() && {
    std::vector<std::uint16_t> places(used_.size());
    WholeRuns result;
    for (std::size_t label = 0; label < used_.size(); ++label) {
      if (!used_[label]) continue;
      places[label] = static_cast<std::uint16_t>(result.numbers.size());
      result.numbers.push_back(static_cast<std::int64_t>(label));
    }
    result.index = std::move(builder_).finish(places);
    return result;
  }

 private:
  void add_sample() {
    const std::uint16_t before = label_;
    if (sample_ != last_) {
      count_alike();
      find_segments();
      last_ = sample_;
    }
    ++alike_;
    if (column_ == 0 || label_ != before) builder_.add(static_cast<std::uint32_t>(column_), label_);
    column_ = (column_ + 1) % length_;
  }

  /// Finds the segments of the sample, in ascending order.
  void find_segments() {
    found_.clear();
    stranger_ = false;
    for (std::size_t layer = 0; layer < sample_.size(); ++layer) {
      const auto members = members_.find({layer, static_cast<std::int64_t>(sample_[layer])});
      if (members != members_.end()) {
        found_.insert(found_.end(), members->second.begin(), members->second.end());
      } else {
        stranger_ = stranger_ || sample_[layer] != 0;
      }
    }
    std::sort(found_.begin(), found_.end());
    label_ = found_.empty() ? std::uint16_t{0} : static_cast<std::uint16_t>(found_.back() + 1);
    used_[label_] = true;
  }

  /// Counts the last samples, which were all alike.
  void count_alike() {
    if (stranger_) counts_.strangers += alike_;
    if (found_.size() > 1) counts_.overlaps += alike_;
    for (std::size_t i = 0; i + 1 < found_.size(); ++i) counts_.lost[found_[i]] += alike_;
    alike_ = 0;
  }

  std::size_t length_, column_ = 0, filled_ = 0;
  LabelBuilder builder_;
  std::map<std::pair<std::size_t, std::int64_t>, std::vector<std::size_t>> members_;
  std::vector<Number> sample_, last_;  ///< the numbers of all layers
  std::vector<std::size_t> found_;     ///< the segments of the last sample
  bool stranger_ = false;              ///< whether a number of it belongs to no segment
  std::uint16_t label_ = 0;
  std::uint64_t alike_ = 0;
  std::vector<bool> used_;
  LayerCounts counts_;
};

/// Gives the numbers of layers that follow each other sample by sample.
template <class Number>
void take_planes(const VolumeSource& source, LayerMerger<Number>& merger) {
  VolumeReader reader = open_in_memory(source);
  const std::uint64_t samples = source.grid.samples();
  const std::size_t layers = source.components,
                    most = std::max<std::size_t>(kWholePiece / sizeof(Number) / layers, 1);
  std::vector<Number> of_layer, piece;
  for (std::uint64_t first = 0; first < samples; first += of_layer.size()) {
    of_layer.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most, samples - first)));
    piece.resize(of_layer.size() * layers);
    for (std::size_t layer = 0; layer < layers; ++layer) {
      reader.read_stored(layer * samples + first, std::as_writable_bytes(std::span(of_layer)));
      for (std::size_t i = 0; i < of_layer.size(); ++i) piece[i * layers + layer] = of_layer[i];
    }
    merger.take(piece);
  }
}

}  // namespace

WholeRuns read_segment_layers(const VolumeSource& source, bool planar,
                              const std::vector<LayerSegment>& segments, std::string& remark) {
  WholeRuns result;
  const bool whole = visit_whole_type(source.stored, [&]<class Number>(Number) {
    LayerMerger<Number> merger(source, segments);
    if (planar) {
      take_planes(source, merger);
    } else {
      remark = for_each_piece<Number>(source,
                                      [&merger](std::span<const Number> numbers) { merger.take(numbers); });
    }
    const std::string found = merger.counts().text(segments);
    if (!found.empty()) remark = remark.empty() ? found : remark + "; " + found;
    result = std::move(merger).finish();
  });
  if (!whole)
    fail("{}: expected segments in layers as whole numbers, found {}", source.name,
         stored_name(source.stored));
  return result;
}

}  // namespace adamas::io
