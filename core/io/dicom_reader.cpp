#include "core/io/dicom_reader.h"

#include <fmt/format.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/data/stored_type.h"
#include "core/io/grid_axes.h"
#include "core/io/input_file.h"
#include "core/io/material_arrays.h"

namespace adamas::io {

namespace {

const gdcm::Tag kSopClass(0x0008, 0x0016), kModality(0x0008, 0x0060), kSeriesText(0x0008, 0x103e),
    kPixelSpacing(0x0028, 0x0030), kDetectorSpacing(0x0018, 0x1164), kSliceSpacing(0x0018, 0x0088),
    kSeries(0x0020, 0x000e), kPosition(0x0020, 0x0032), kOrientation(0x0020, 0x0037),
    kOffsets(0x3004, 0x000c), kIntercept(0x0028, 0x1052), kSlope(0x0028, 0x1053), kPixels(0x7fe0, 0x0010),
    kShared(0x5200, 0x9229), kPerFrame(0x5200, 0x9230), kPlanePosition(0x0020, 0x9113),
    kPlaneOrientation(0x0020, 0x9116), kMeasures(0x0028, 0x9110), kTransformation(0x0028, 0x9145),
    kSegmentOfFrame(0x0062, 0x000a), kReferencedSegment(0x0062, 0x000b), kSegments(0x0062, 0x0002),
    kSegmentNumber(0x0062, 0x0004), kSegmentLabel(0x0062, 0x0005), kSegmentationType(0x0062, 0x0001),
    kMostFraction(0x0062, 0x000e), kStorage(0x0002, 0x0002);
constexpr const char* kSegmentationStorage = "1.2.840.10008.5.1.4.1.1.66.4";
constexpr const char* kDirectoryStorage = "1.2.840.10008.1.3.10";

/// The text of an element, without the blanks round it; empty if there is none.
std::string text_of(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  if (!set.FindDataElement(tag)) return {};
  const gdcm::ByteValue* bytes = set.GetDataElement(tag).GetByteValue();
  if (bytes == nullptr) return {};
  std::string text(bytes->GetPointer(), bytes->GetLength());
  const auto is_blank = [](char c) { return c == ' ' || c == '\0'; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  text.erase(0, static_cast<std::size_t>(std::ranges::find_if_not(text, is_blank) - text.begin()));
  return text;
}

/// The whole number of an element of two bytes; -1 if there is none.
int number_of(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  if (!set.FindDataElement(tag)) return -1;
  const gdcm::ByteValue* bytes = set.GetDataElement(tag).GetByteValue();
  if (bytes == nullptr || bytes->GetLength() < 2) return -1;
  const char* at = bytes->GetPointer();
  return static_cast<unsigned char>(at[0]) | (static_cast<unsigned char>(at[1]) << 8);
}

/// The items of a sequence; null if there is none.
gdcm::SmartPointer<gdcm::SequenceOfItems> items_of(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  return set.FindDataElement(tag) ? set.GetDataElement(tag).GetValueAsSQ() : nullptr;
}

/// The first item of a sequence; null if there is none.
const gdcm::DataSet* first_item(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  const auto items = items_of(set, tag);
  return items != nullptr && items->GetNumberOfItems() > 0 ? &items->GetItem(1).GetNestedDataSet() : nullptr;
}

/// The numbers of an element that has them as text, between backslashes; empty if one is none.
std::vector<double> numbers_of(const gdcm::DataSet& set, const gdcm::Tag& tag) {
  std::vector<double> numbers;
  std::istringstream text(text_of(set, tag));
  for (std::string item; std::getline(text, item, '\\');) {
    std::istringstream word(item);
    double number = 0;
    if (!(word >> number) || !std::isfinite(number)) return {};
    numbers.push_back(number);
  }
  return numbers;
}

/// The pixels of a file, of all frames.
struct Pixels {
  std::vector<char> bytes;
  std::optional<StoredType> type;  ///< none: single bits
};

/// The type of pixels; none for single bits and for types that are no numbers of 8 to 64 bits.
std::optional<StoredType> pixel_type(gdcm::PixelFormat::ScalarType type) {
  switch (type) {
    case gdcm::PixelFormat::UINT8:
      return StoredType::kUint8;
    case gdcm::PixelFormat::INT8:
      return StoredType::kInt8;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16:
      return StoredType::kUint16;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16:
      return StoredType::kInt16;
    case gdcm::PixelFormat::UINT32:
      return StoredType::kUint32;
    case gdcm::PixelFormat::INT32:
      return StoredType::kInt32;
    case gdcm::PixelFormat::FLOAT32:
      return StoredType::kFloat32;
    case gdcm::PixelFormat::FLOAT64:
      return StoredType::kFloat64;
    default:
      return {};
  }
}

/// What headers say of a picture: that of the file, and those of all frames and of each frame.
struct Frame {
  std::optional<Vec3> position, row, column;
  std::optional<std::array<double, 2>> spacing;  ///< of columns, and of rows
  double slope = 1, intercept = 0;
  int segment = -1;  ///< the number of the segment that it is of

  /// Takes the elements of a data set.
  void take(const gdcm::DataSet& set) {
    if (const auto p = numbers_of(set, kPosition); p.size() == 3) position = Vec3{p[0], p[1], p[2]};
    if (const auto o = numbers_of(set, kOrientation); o.size() == 6) {
      row = Vec3{o[0], o[1], o[2]};
      column = Vec3{o[3], o[4], o[5]};
    }
    // The first number is the distance of rows.
    for (const gdcm::Tag& tag : {kDetectorSpacing, kPixelSpacing}) {
      if (const auto s = numbers_of(set, tag); s.size() == 2) spacing = std::array{s[1], s[0]};
    }
    if (const auto s = numbers_of(set, kSlope); s.size() == 1) slope = s[0];
    if (const auto i = numbers_of(set, kIntercept); i.size() == 1) intercept = i[0];
  }

  /// Takes what the sequences of frames say.
  void take_groups(const gdcm::DataSet& groups) {
    for (const gdcm::Tag& tag : {kPlanePosition, kPlaneOrientation, kMeasures, kTransformation}) {
      if (const gdcm::DataSet* own = first_item(groups, tag)) take(*own);
    }
    if (const gdcm::DataSet* own = first_item(groups, kSegmentOfFrame))
      segment = number_of(*own, kReferencedSegment);
  }
};

/// A picture of a file, or one of its frames.
struct Slice {
  std::string file;
  Frame frame;
  Vec3 origin;
  std::shared_ptr<const Pixels> pixels;
  std::size_t first = 0;  ///< the first of its pixels among those of the file
};

/// Reads the slices of files, which have to be of one kind.
class SliceReader {
 public:
  void add(const std::string& path) {
    gdcm::ImageReader reader;
    reader.SetFileName(path.c_str());
    if (!reader.Read()) fail("{}: expected a picture of DICOM, found something else", path);
    const gdcm::Image& image = reader.GetImage();
    const gdcm::DataSet& header = reader.GetFile().GetDataSet();
    if (image.GetPixelFormat().GetSamplesPerPixel() != 1)
      fail("{}: expected one value per pixel, found {}", path, image.GetPixelFormat().GetSamplesPerPixel());
    const std::size_t frames = image.GetNumberOfDimensions() > 2 ? image.GetDimension(2) : 1;
    Frame whole;
    // What is no rescaling in the header, such as the scale of a dose.
    whole.slope = image.GetSlope();
    whole.intercept = image.GetIntercept();
    whole.take(header);
    if (const gdcm::DataSet* shared = first_item(header, kShared)) whole.take_groups(*shared);
    const auto pixels = std::make_shared<const Pixels>(pixels_of(path, image, header));
    const auto per_frame = items_of(header, kPerFrame);
    const std::vector<double> offsets = offsets_of(path, header, frames, per_frame != nullptr);
    for (std::size_t f = 0; f < frames; ++f) {
      Slice slice{path, whole, {}, pixels, f * image.GetDimension(0) * image.GetDimension(1)};
      if (per_frame != nullptr && f < per_frame->GetNumberOfItems())
        slice.frame.take_groups(per_frame->GetItem(f + 1).GetNestedDataSet());
      take_kind(slice, {image.GetDimension(0), image.GetDimension(1)}, header);
      slice.origin = *slice.frame.position + offsets[f] * normal_;
      slices_.push_back(std::move(slice));
    }
    if (is_segmentation_) take_segments(header);
  }

  /// Returns the slices as one grid.
  GridFile grid() {
    sort();
    GridFile file;
    file.kind = "DICOM";
    file.space = "left-posterior-superior";
    add_axes(file);
    is_segmentation_ ? add_segments(file) : add_values(file);
    GridAxes axes;
    axes.directions = {row_, column_, normal_};
    axes.origin = slices_.front().origin - along(slices_.front()) * normal_;
    lay_out(axes, file);
    return file;
  }

  void name_values(const std::string& name) { name_ = name; }

 private:
  /// Takes the size, the orientation and the distances of the first picture, and compares others.
  void take_kind(const Slice& slice, const std::array<std::size_t, 2>& size, const gdcm::DataSet& header) {
    const std::string& path = slice.file;
    const Frame& frame = slice.frame;
    if (!frame.position || !frame.row)
      fail("{}: expected a picture with its place and its orientation in space, found none", path);
    if (!frame.spacing || !((*frame.spacing)[0] > 0 && (*frame.spacing)[1] > 0))
      fail("{}: expected a picture with the distances of its pixels, found none", path);
    if (slices_.empty()) {
      first_file_ = path;
      size_ = size;
      spacing_ = *frame.spacing;
      row_ = *frame.row;
      column_ = *frame.column;
      normal_ = normalized(cross(row_, column_));
      is_segmentation_ = text_of(header, kSopClass) == kSegmentationStorage;
      if (!(std::abs(norm(row_) - 1) <= 1e-3 && std::abs(norm(column_) - 1) <= 1e-3 &&
            std::abs(dot(row_, column_)) <= 1e-3))
        fail("{}: expected rows and columns at right angles, found others", path);
    }
    if (size != size_)
      fail("{}: expected {} x {} pixels as in {}, found {} x {}", path, size_[0], size_[1], first_file_,
           size[0], size[1]);
    if (!(distance(*frame.row, row_) <= kParallelAxes && distance(*frame.column, column_) <= kParallelAxes))
      fail("{}: expected the orientation of {}, found another", path, first_file_);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (!(std::abs((*frame.spacing)[axis] - spacing_[axis]) <= kParallelAxes * spacing_[axis]))
        fail("{}: expected pixels {:g} apart as in {}, found {:g}", path, spacing_[axis], first_file_,
             (*frame.spacing)[axis]);
    }
  }

  /// How far each frame lies from the place that the file states, along the normal.
  static std::vector<double> offsets_of(const std::string& path, const gdcm::DataSet& header,
                                        std::size_t frames, bool has_places) {
    if (frames < 2 || has_places) return std::vector<double>(frames, 0.0);
    std::vector<double> offsets = numbers_of(header, kOffsets);
    if (offsets.size() == frames) {
      const double first = offsets[0];
      for (double& offset : offsets) offset -= first;
      return offsets;
    }
    const std::vector<double> step = numbers_of(header, kSliceSpacing);
    if (step.size() != 1 || !(step[0] > 0))
      fail("{}: expected frames with their places in space, found none", path);
    offsets.resize(frames);
    for (std::size_t f = 0; f < frames; ++f) offsets[f] = step[0] * static_cast<double>(f);
    return offsets;
  }

  /// Reads all pixels of a file.
  static Pixels pixels_of(const std::string& path, const gdcm::Image& image, const gdcm::DataSet& header) {
    constexpr std::size_t kGreatestExpansion = 2000;
    Pixels pixels;
    const gdcm::PixelFormat::ScalarType type = image.GetPixelFormat().GetScalarType();
    pixels.type = pixel_type(type);
    if (!pixels.type && type != gdcm::PixelFormat::SINGLEBIT)
      fail("{}: expected pixels that can be unpacked, found others", path);
    std::size_t count = 1;
    for (unsigned axis = 0; axis < image.GetNumberOfDimensions(); ++axis) count *= image.GetDimension(axis);
    const std::size_t least = pixels.type ? count * stored_bytes(*pixels.type) : (count + 7) / 8;
    const std::size_t bytes = image.GetBufferLength();
    // GDCM takes pixels that a file lacks for zeros.
    const gdcm::ByteValue* raw =
        header.FindDataElement(kPixels) ? header.GetDataElement(kPixels).GetByteValue() : nullptr;
    if (raw != nullptr ? raw->GetLength() < bytes : bytes > kGreatestExpansion * check_input_file(path))
      fail("{}: expected {} bytes of pixels, found {}", path, bytes,
           raw != nullptr ? std::to_string(raw->GetLength()) : "a file that cannot hold them");
    pixels.bytes.resize(bytes);
    if (bytes == 0 || bytes < least || !image.GetBuffer(pixels.bytes.data()))
      fail("{}: expected pixels that can be unpacked, found others", path);
    return pixels;
  }

  /// Calls `use` with the number of each pixel of a slice and what is stored there.
  template <class Use>
  void for_each_stored(const Slice& slice, const Use& use) const {
    const std::size_t count = size_[0] * size_[1];
    const char* bytes = slice.pixels->bytes.data();
    if (!slice.pixels->type) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = slice.first + i;
        use(i, static_cast<double>((static_cast<unsigned char>(bytes[at / 8]) >> (at % 8)) & 1));
      }
      return;
    }
    visit_stored_type(*slice.pixels->type, [&]<class Stored>(Stored stored) {
      for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(&stored, bytes + (slice.first + i) * sizeof(Stored), sizeof(Stored));
        use(i, static_cast<double>(stored));
      }
    });
  }

  /// The value of what is stored in a slice. Single bits are never scaled.
  static double scaled(const Slice& slice, double stored) {
    return slice.pixels->type ? slice.frame.slope * stored + slice.frame.intercept : stored;
  }

  /// Calls `use` with the number of each pixel of a slice and its scaled value.
  template <class Use>
  void for_each_pixel(const Slice& slice, const Use& use) const {
    for_each_stored(slice, [&](std::size_t i, double stored) { use(i, scaled(slice, stored)); });
  }

  void take_segments(const gdcm::DataSet& header) {
    const auto segments = items_of(header, kSegments);
    for (std::size_t s = 1; segments != nullptr && s <= segments->GetNumberOfItems(); ++s) {
      const gdcm::DataSet& own = segments->GetItem(s).GetNestedDataSet();
      const int number = number_of(own, kSegmentNumber);
      std::string label = text_of(own, kSegmentLabel);
      if (number >= 0) labels_[number] = label.empty() ? fmt::format("segment {}", number) : std::move(label);
    }
    if (text_of(header, kSegmentationType) == "FRACTIONAL")
      most_fraction_ = std::max(number_of(header, kMostFraction), 1);
    if (labels_.empty()) fail("{}: expected segments, found none", first_file_);
  }

  /// How far a slice lies along the normal.
  [[nodiscard]] double along(const Slice& slice) const { return dot(slice.origin, normal_); }

  /// Orders slices by their places and finds the distinct ones of these.
  void sort() {
    std::ranges::stable_sort(slices_, {}, [this](const Slice& slice) { return along(slice); });
    const double tolerance = 1e-3 * std::min(spacing_[0], spacing_[1]);
    for (const Slice& slice : slices_) {
      const Vec3 shift = slice.origin - slices_.front().origin;
      const double aside = norm(shift - dot(shift, normal_) * normal_);
      if (!(aside <= 0.02 * std::max(dot(shift, normal_), spacing_[0])))
        fail("{}: expected slices that lie above each other, found one {:g} aside", slice.file, aside);
      if (places_.empty() || along(slice) - places_.back() > tolerance) {
        places_.push_back(along(slice));
      } else if (!is_segmentation_) {
        fail("{}: expected one slice for each place, found two at {:g} (a folder of its own for each time)",
             slice.file, along(slice));
      }
    }
    if (places_.size() < 2)
      fail("{}: expected several slices, found one: give the folder of its series", first_file_);
  }

  void add_axes(GridFile& file) const {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t i = 0; i <= size_[axis]; ++i) {
        const auto at = static_cast<double>(i);
        if (i < size_[axis]) file.nodes[axis].push_back(at * spacing_[axis]);
        file.faces[axis].push_back((at - 0.5) * spacing_[axis]);
      }
    }
    file.nodes[2] = places_;
    const std::size_t count = places_.size();
    std::vector<double>& faces = file.faces[2];
    faces.push_back(1.5 * places_[0] - 0.5 * places_[1]);
    double least = places_[1] - places_[0], most = least;
    for (std::size_t k = 1; k < count; ++k) {
      faces.push_back(0.5 * (places_[k - 1] + places_[k]));
      least = std::min(least, places_[k] - places_[k - 1]);
      most = std::max(most, places_[k] - places_[k - 1]);
    }
    faces.push_back(1.5 * places_[count - 1] - 0.5 * places_[count - 2]);
    if (most - least > 1e-2 * most) file.remark = fmt::format("slices are {:g} to {:g} apart", least, most);
  }

  /// The range of numbers, and whether they are all whole.
  struct Range {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    bool whole = true;
    void add(double number) {
      least = std::min(least, number);
      most = std::max(most, number);
      whole = whole && number == std::round(number);
    }
    /// The smallest type that has all whole numbers of the range; none if there is none.
    [[nodiscard]] std::optional<StoredType> type() const {
      constexpr double kBeyond = 9007199254740992.0;  // beyond this, a double has gaps between whole numbers
      if (!whole) return {};
      if (least >= 0 && most <= 255) return StoredType::kUint8;
      if (least >= 0 && most <= 65535) return StoredType::kUint16;
      if (least >= -32768 && most <= 32767) return StoredType::kInt16;
      if (least >= -2147483648.0 && most <= 2147483647.0) return StoredType::kInt32;
      if (least >= 0 && most <= 4294967295.0) return StoredType::kUint32;
      if (least >= -kBeyond && most <= kBeyond) return StoredType::kInt64;
      return {};
    }
  };

  /// Adds the values of all slices: whole ones as such, and whole numbers of which one scale makes broken
  /// ones with the scale.
  void add_values(GridFile& file) {
    Range values, stored;
    const Frame& first = slices_.front().frame;
    bool one_scale = true, fit_floats = true;
    for (const Slice& slice : slices_) {
      one_scale = one_scale && slice.frame.slope == first.slope && slice.frame.intercept == first.intercept;
      for_each_stored(slice, [&](std::size_t, double number) {
        stored.add(number);
        values.add(scaled(slice, number));
      });
      // A float has room for what two bytes tell.
      const std::optional<StoredType> type = slice.pixels->type;
      fit_floats = fit_floats && (!type || *type == StoredType::kFloat32 || stored_bytes(*type) <= 2);
    }
    GridArray array;
    array.name = name_;
    std::optional<StoredType> type = values.type();
    const bool has_scale =
        one_scale && first.slope != 0 && std::isfinite(first.slope) && std::isfinite(first.intercept);
    if (!type && has_scale && stored.type()) {
      type = stored.type();
      array.slope = first.slope;
      array.intercept = first.intercept;
    }
    array.type = stored_name(type.value_or(fit_floats ? StoredType::kFloat32 : StoredType::kFloat64));
    if (!type) {
      fit_floats ? move_values<float>(array) : move_values<double>(array);
    } else if (*type == StoredType::kUint32 || *type == StoredType::kInt64) {
      move_values<std::int64_t>(array);
    } else {
      move_values<std::int32_t>(array);
    }
    file.arrays.push_back(std::move(array));
  }

  /// Moves the values of all slices into an array, or what is stored if the array has a scale.
  template <class Number>
  void move_values(GridArray& array) {
    std::vector<Number> numbers;
    numbers.reserve(size_[0] * size_[1] * slices_.size());
    const auto add = [&](std::size_t, double value) { numbers.push_back(static_cast<Number>(value)); };
    for (Slice& slice : slices_) {
      array.scaled() ? for_each_stored(slice, add) : for_each_pixel(slice, add);
      slice.pixels.reset();
    }
    array.values = std::move(numbers);
  }

  /// The number of a slice's place.
  [[nodiscard]] std::size_t place_of(const Slice& slice) const {
    const auto after = std::ranges::upper_bound(places_, along(slice) + 1e-3 * spacing_[0]);
    return static_cast<std::size_t>(after - places_.begin()) - 1;
  }

  void add_segments(GridFile& file) {
    const std::size_t plane = size_[0] * size_[1], count = plane * places_.size();
    for (const Slice& slice : slices_) {
      if (!labels_.contains(slice.frame.segment))
        fail("{}: expected frames of segments, found one of segment {}", slice.file, slice.frame.segment);
    }
    if (most_fraction_ == 0) return add_labels(file, plane, count);
    for (const auto& [number, label] : labels_) {
      std::vector<float> values(count, 0.0f);
      for (const Slice& slice : slices_) {
        if (slice.frame.segment != number) continue;
        float* to = values.data() + place_of(slice) * plane;
        for_each_pixel(
            slice, [&](std::size_t i, double value) { to[i] = static_cast<float>(value / most_fraction_); });
      }
      GridArray array;
      array.name = "volume fraction " + label;
      array.type = "float32";
      array.values = std::move(values);
      file.arrays.push_back(std::move(array));
    }
  }

  void add_labels(GridFile& file, std::size_t plane, std::size_t count) {
    std::vector<std::int32_t> values(count, 0);
    std::size_t shared = 0;
    for (const auto& each : labels_) {
      const std::int64_t number = each.first;
      for (const Slice& slice : slices_) {
        if (slice.frame.segment != number) continue;
        std::int32_t* to = values.data() + place_of(slice) * plane;
        for_each_pixel(slice, [&](std::size_t i, double value) {
          if (value == 0) return;
          if (to[i] != 0) ++shared;
          to[i] = static_cast<std::int32_t>(number);
        });
      }
    }
    file.material_names = listed_names(labels_);
    if (shared > 0)
      file.remark += fmt::format("{}{} voxels are in several segments, of which the last one has them",
                                 file.remark.empty() ? "" : "; ", shared);
    GridArray array;
    array.name = "labels";
    array.type = "int32";
    array.values = std::move(values);
    file.arrays.push_back(std::move(array));
  }

  std::string first_file_, name_;
  std::array<std::size_t, 2> size_{};
  std::array<double, 2> spacing_{};
  Vec3 row_, column_, normal_;
  std::vector<Slice> slices_;
  std::vector<double> places_;  // of the slices along the normal
  bool is_segmentation_ = false;
  std::map<std::int64_t, std::string> labels_;  // of the segments
  int most_fraction_ = 0;                       // the number that means 1; 0: segments have no fractions
};

/// The files of a series in a folder.
struct Series {
  std::string text, kind;
  std::vector<std::string> files;
};

/// Finds the series of the files in a folder, by their UIDs.
std::map<std::string, Series> series_in(const std::filesystem::path& folder, std::size_t& others) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    is_dicom_file(entry.path()) ? files.push_back(entry.path().string()) : static_cast<void>(++others);
  }
  std::ranges::sort(files);
  std::map<std::string, Series> series;
  for (const std::string& file : files) {
    gdcm::Reader reader;
    reader.SetFileName(file.c_str());
    if (!reader.ReadSelectedTags({kStorage, kSopClass, kModality, kSeriesText, kSeries}))
      fail("{}: expected a file of DICOM, found a damaged one", file);
    const gdcm::DataSet& header = reader.GetFile().GetDataSet();
    if (text_of(reader.GetFile().GetHeader(), kStorage) == kDirectoryStorage) continue;
    Series& own = series[text_of(header, kSeries)];
    own.text = text_of(header, kSeriesText);
    own.kind = text_of(header, kModality);
    own.files.push_back(file);
  }
  return series;
}

/// The series of a folder as messages list them.
std::string text_of_series(const std::map<std::string, Series>& series) {
  std::string list;
  for (const auto& [uid, own] : series) {
    list += fmt::format("{}'{}' ({} files)", list.empty() ? "" : ", ", own.text.empty() ? uid : own.text,
                        own.files.size());
  }
  return list.empty() ? "none" : list;
}

/// Chooses a series by its description or its UID.
Series choose(const std::string& name, const std::map<std::string, Series>& series,
              const std::string& wanted) {
  std::vector<const Series*> found;
  for (const auto& [uid, own] : series) {
    if (wanted.empty() || wanted == uid || wanted == own.text) found.push_back(&own);
  }
  if (found.size() == 1) return *found.front();
  if (wanted.empty() && !series.empty())
    fail(
        "{}: expected one series of DICOM, or the description or UID of one (--array of volumes, --labels or "
        "--fraction of materials), found {}",
        name, text_of_series(series));
  fail("{}: expected one series of DICOM{}, found {}", name, wanted.empty() ? "" : " '" + wanted + "'",
       text_of_series(series));
}

void silence_gdcm() {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
}

GridFile read_series(const Series& series, const std::string& name) {
  SliceReader reader;
  reader.name_values(name);
  for (const std::string& file : series.files) reader.add(file);
  return reader.grid();
}

std::string text_of_others(std::size_t others) {
  return others == 0 ? "" : fmt::format("{} files of the folder are none of DICOM", others);
}

void add_remark(const std::string& remark, GridFile& file) {
  if (!remark.empty()) file.remark += (file.remark.empty() ? "" : "; ") + remark;
}

/// Throws Error, which begins with `name`, unless two series lie on one grid, to a millionth of its size.
void check_same_places(const std::string& name, const GridFile& file, const GridFile& first) {
  const auto same = [](double a, double b, double size) { return std::abs(a - b) <= 1e-6 * size; };
  bool good = file.aslant.has_value() == first.aslant.has_value();
  double size = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto &a = file.nodes[axis], &b = first.nodes[axis];
    good = good && a.size() == b.size();
    if (!good) break;
    const double length = std::abs(b.back() - b.front());
    size = std::max(size, length);
    for (std::size_t i = 0; i < a.size(); ++i) good = good && same(a[i], b[i], length);
  }
  if (good && file.aslant) {
    for (int i = 0; i < 3; ++i) {
      good = good && same(file.aslant->origin[i], first.aslant->origin[i], size);
      for (std::size_t axis = 0; axis < 3; ++axis)
        good = good && same(file.aslant->directions[axis][i], first.aslant->directions[axis][i], 1);
    }
  }
  if (!good)
    fail("{}: expected series on one grid, found {} on another than {}", name, file.array_names(),
         first.array_names());
}

}  // namespace

GridFile read_dicom(const std::filesystem::path& path, const std::string& series) {
  silence_gdcm();
  if (std::filesystem::is_directory(path)) {
    std::size_t others = 0;
    const Series own = choose(path.string(), series_in(path, others), series);
    GridFile file = read_series(own, own.text.empty() ? file_stem(path) : own.text);
    add_remark(text_of_others(others), file);
    return file;
  }
  SliceReader reader;
  reader.name_values(file_stem(path));
  reader.add(path.string());
  return reader.grid();
}

std::vector<SeriesSummary> list_dicom_series(const std::filesystem::path& path) {
  silence_gdcm();
  std::size_t others = 0;
  const std::map<std::string, Series> all = series_in(path, others);
  std::vector<SeriesSummary> result;
  for (const auto& [uid, own] : all) {
    std::size_t same = 0;
    for (const auto& other : all) same += other.second.text == own.text ? 1 : 0;
    result.push_back({own.text.empty() || same > 1 ? uid : own.text, uid, own.kind, own.files.size()});
  }
  return result;
}

GridFile read_dicom_series(const std::filesystem::path& path, const std::vector<std::string>& wanted) {
  if (!std::filesystem::is_directory(path)) return read_dicom(path);
  silence_gdcm();
  std::size_t others = 0;
  const std::map<std::string, Series> all = series_in(path, others);
  if (all.size() == 1) return read_dicom(path);
  std::vector<GridFile> read;
  std::set<std::string> taken;
  for (const std::string& name : wanted) {
    const auto is_named = [&name](const auto& each) {
      return each.first == name || visible_text(each.second.text) == name;
    };
    if (std::ranges::none_of(all, is_named) || !taken.insert(name).second) continue;
    const bool by_uid = all.contains(name);
    const auto found = std::ranges::find_if(all, is_named);
    read.push_back(read_series(choose(path.string(), all, by_uid ? name : found->second.text), name));
    if (read.size() > 1) check_same_places(path.string(), read.back(), read.front());
  }
  if (read.empty()) static_cast<void>(choose(path.string(), all, {}));
  GridFile result = std::move(read.front());
  for (std::size_t i = 1; i < read.size(); ++i) {
    std::ranges::move(read[i].arrays, std::back_inserter(result.arrays));
    add_remark(read[i].remark == result.remark ? "" : read[i].remark, result);
  }
  add_remark(text_of_others(others), result);
  return result;
}

}  // namespace adamas::io
