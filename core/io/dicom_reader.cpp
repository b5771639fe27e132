#include "core/io/dicom_reader.h"

#include <fmt/format.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmStringFilter.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <span>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/io/file_handle.h"
#include "core/io/grid_axes.h"
#include "core/io/grid_numbers.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/volume_import.h"

namespace adamas::io {

namespace {

const gdcm::Tag kSopClass(0x0008, 0x0016), kSeriesText(0x0008, 0x103e), kSeries(0x0020, 0x000e),
    kPosition(0x0020, 0x0032), kPerFrame(0x5200, 0x9230), kPlanePosition(0x0020, 0x9113),
    kSegmentOfFrame(0x0062, 0x000a), kReferencedSegment(0x0062, 0x000b), kSegments(0x0062, 0x0002),
    kSegmentNumber(0x0062, 0x0004), kSegmentLabel(0x0062, 0x0005), kSegmentationType(0x0062, 0x0001),
    kMostFraction(0x0062, 0x000e);
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

/// A picture of a file, or one of its frames.
struct Slice {
  std::string file;
  Vec3 origin;
  bool whole = true;           ///< whether its values are whole numbers
  std::vector<double> values;  ///< one row behind the other
  int segment = -1;            ///< the number of the segment that it is of
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
    take_kind(path, image, header);
    const std::vector<double> values = values_of(path, image);
    const std::size_t frames = image.GetNumberOfDimensions() > 2 ? image.GetDimension(2) : 1,
                      size = size_[0] * size_[1];
    const auto per_frame = items_of(header, kPerFrame);
    const Vec3 first{image.GetOrigin(0), image.GetOrigin(1), image.GetOrigin(2)};
    for (std::size_t f = 0; f < frames; ++f) {
      Slice slice;
      slice.file = path;
      slice.origin = first + static_cast<double>(f) * image.GetSpacing(2) * normal_;
      slice.values.assign(values.begin() + static_cast<std::ptrdiff_t>(f * size),
                          values.begin() + static_cast<std::ptrdiff_t>((f + 1) * size));
      slice.whole = std::ranges::all_of(slice.values, [](double v) { return v == std::round(v); });
      if (per_frame != nullptr && f < per_frame->GetNumberOfItems())
        take_frame(per_frame->GetItem(f + 1).GetNestedDataSet(), slice);
      slices_.push_back(std::move(slice));
    }
    if (frames > 1 && per_frame == nullptr && !(image.GetSpacing(2) > 0))
      fail("{}: expected frames with their places, found none", path);
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
  void take_kind(const std::string& path, const gdcm::Image& image, const gdcm::DataSet& header) {
    const std::array<std::size_t, 2> size{image.GetDimension(0), image.GetDimension(1)};
    const double* cosines = image.GetDirectionCosines();
    const Vec3 row{cosines[0], cosines[1], cosines[2]}, column{cosines[3], cosines[4], cosines[5]};
    if (image.GetPixelFormat().GetSamplesPerPixel() != 1)
      fail("{}: expected one value per pixel, found {}", path, image.GetPixelFormat().GetSamplesPerPixel());
    if (slices_.empty()) {
      first_file_ = path;
      size_ = size;
      spacing_ = {image.GetSpacing(0), image.GetSpacing(1)};
      row_ = row;
      column_ = column;
      normal_ = normalized(cross(row, column));
      is_segmentation_ = text_of(header, kSopClass) == kSegmentationStorage;
      if (!is_finite(normal_) || !(spacing_[0] > 0 && spacing_[1] > 0))
        fail("{}: expected the orientation of a picture and the distances of its pixels, found none", path);
    }
    if (size != size_)
      fail("{}: expected {} x {} pixels as in {}, found {} x {}", path, size_[0], size_[1], first_file_,
           size[0], size[1]);
    if (!(distance(row, row_) <= kParallelAxes && distance(column, column_) <= kParallelAxes))
      fail("{}: expected the orientation of {}, found another", path, first_file_);
    if (!(std::abs(image.GetSpacing(0) - spacing_[0]) <= kParallelAxes * spacing_[0] &&
          std::abs(image.GetSpacing(1) - spacing_[1]) <= kParallelAxes * spacing_[1]))
      fail("{}: expected pixels of {:g} x {:g} as in {}, found {:g} x {:g}", path, spacing_[0], spacing_[1],
           first_file_, image.GetSpacing(0), image.GetSpacing(1));
  }

  /// Reads all pixels of a file and scales them.
  static std::vector<double> values_of(const std::string& path, const gdcm::Image& image) {
    const unsigned long bytes = image.GetBufferLength();
    std::vector<char> buffer(bytes);
    if (bytes == 0 || !image.GetBuffer(buffer.data()))
      fail("{}: expected pixels that can be unpacked, found others", path);
    std::size_t count = 1;
    for (unsigned axis = 0; axis < image.GetNumberOfDimensions(); ++axis) count *= image.GetDimension(axis);
    std::vector<double> values(count);
    const auto convert = [&]<class Stored>(Stored) {
      if (bytes < count * sizeof(Stored)) fail("{}: expected {} pixels, found fewer", path, count);
      for (std::size_t i = 0; i < count; ++i) {
        Stored stored;
        std::memcpy(&stored, buffer.data() + i * sizeof(Stored), sizeof(Stored));
        values[i] = image.GetSlope() * static_cast<double>(stored) + image.GetIntercept();
      }
    };
    switch (image.GetPixelFormat().GetScalarType()) {
      case gdcm::PixelFormat::SINGLEBIT:
        if (bytes < (count + 7) / 8) fail("{}: expected {} pixels, found fewer", path, count);
        for (std::size_t i = 0; i < count; ++i)
          values[i] = (static_cast<unsigned char>(buffer[i / 8]) >> (i % 8)) & 1;
        break;
      case gdcm::PixelFormat::UINT8:
        convert(std::uint8_t{});
        break;
      case gdcm::PixelFormat::INT8:
        convert(std::int8_t{});
        break;
      case gdcm::PixelFormat::UINT12:
      case gdcm::PixelFormat::UINT16:
        convert(std::uint16_t{});
        break;
      case gdcm::PixelFormat::INT12:
      case gdcm::PixelFormat::INT16:
        convert(std::int16_t{});
        break;
      case gdcm::PixelFormat::UINT32:
        convert(std::uint32_t{});
        break;
      case gdcm::PixelFormat::INT32:
        convert(std::int32_t{});
        break;
      case gdcm::PixelFormat::FLOAT32:
        convert(float{});
        break;
      case gdcm::PixelFormat::FLOAT64:
        convert(double{});
        break;
      default:
        fail("{}: expected pixels of 1 to 32 bits, found {}", path,
             image.GetPixelFormat().GetScalarTypeAsString());
    }
    return values;
  }

  /// Takes the place and the segment that the header of a frame states.
  static void take_frame(const gdcm::DataSet& header, Slice& slice) {
    if (const gdcm::DataSet* place = first_item(header, kPlanePosition)) {
      std::istringstream text(text_of(*place, kPosition));
      Vec3 p;
      char separator = 0;
      if (text >> p.x >> separator >> p.y >> separator >> p.z) slice.origin = p;
    }
    if (const gdcm::DataSet* segment = first_item(header, kSegmentOfFrame))
      slice.segment = number_of(*segment, kReferencedSegment);
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

  void add_values(GridFile& file) {
    GridArray array;
    array.name = name_;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    bool whole = true;
    for (const Slice& slice : slices_) {
      const auto [low, high] = std::ranges::minmax(slice.values);
      least = std::min(least, low);
      most = std::max(most, high);
      whole = whole && slice.whole;
    }
    array.type = whole ? type_of(least, most) : "float32";
    array.type == "float32" ? move_values<float>(array) : move_values<std::int32_t>(array);
    file.arrays.push_back(std::move(array));
  }

  /// Moves the values of all slices into an array.
  template <class Number>
  void move_values(GridArray& array) {
    std::vector<Number> numbers;
    numbers.reserve(size_[0] * size_[1] * slices_.size());
    for (Slice& slice : slices_) {
      for (const double v : std::exchange(slice.values, {})) numbers.push_back(static_cast<Number>(v));
    }
    array.values = std::move(numbers);
  }

  /// The smallest type of samples that has all whole numbers of a range.
  static const char* type_of(double least, double most) {
    if (least >= 0 && most <= 255) return "uint8";
    if (least >= 0 && most <= 65535) return "uint16";
    if (least >= -32768 && most <= 32767) return "int16";
    return least >= -2147483648.0 && most <= 2147483647.0 ? "int32" : "float32";
  }

  /// The number of a slice's place.
  [[nodiscard]] std::size_t place_of(const Slice& slice) const {
    const auto after = std::ranges::upper_bound(places_, along(slice) + 1e-3 * spacing_[0]);
    return static_cast<std::size_t>(after - places_.begin()) - 1;
  }

  void add_segments(GridFile& file) {
    const std::size_t plane = size_[0] * size_[1], count = plane * places_.size();
    for (const Slice& slice : slices_) {
      if (!labels_.contains(slice.segment))
        fail("{}: expected frames of segments, found one of segment {}", slice.file, slice.segment);
    }
    if (most_fraction_ == 0) return add_labels(file, plane, count);
    for (const auto& [number, label] : labels_) {
      std::vector<float> values(count, 0.0f);
      for (const Slice& slice : slices_) {
        if (slice.segment != number) continue;
        float* to = values.data() + place_of(slice) * plane;
        for (std::size_t i = 0; i < plane; ++i) to[i] = static_cast<float>(slice.values[i] / most_fraction_);
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
    for (const auto& [number, label] : labels_) {
      for (const Slice& slice : slices_) {
        if (slice.segment != number) continue;
        std::int32_t* to = values.data() + place_of(slice) * plane;
        for (std::size_t i = 0; i < plane; ++i) {
          if (slice.values[i] == 0) continue;
          if (to[i] != 0) ++shared;
          to[i] = number;
        }
      }
    }
    file.material_names.emplace_back("background");
    for (const auto& [number, label] : labels_) {
      while (std::cmp_less(file.material_names.size(), number))
        file.material_names.push_back(fmt::format("segment {}", file.material_names.size()));
      file.material_names.push_back(label);
    }
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
  std::map<int, std::string> labels_;  // of the segments
  int most_fraction_ = 0;              // the number that means 1; 0: segments have no fractions
};

/// The files of a series in a folder.
struct Series {
  std::string text;
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
    if (!reader.ReadSelectedTags({gdcm::Tag(0x0002, 0x0002), kSopClass, kSeriesText, kSeries}))
      fail("{}: expected a file of DICOM, found a damaged one", file);
    const gdcm::DataSet& header = reader.GetFile().GetDataSet();
    if (text_of(reader.GetFile().GetHeader(), gdcm::Tag(0x0002, 0x0002)) == kDirectoryStorage) continue;
    Series& own = series[text_of(header, kSeries)];
    own.text = text_of(header, kSeriesText);
    own.files.push_back(file);
  }
  return series;
}

/// Chooses a series by its description or its UID.
Series choose(const std::string& name, std::map<std::string, Series> series, const std::string& wanted) {
  std::string list;
  std::vector<const Series*> found;
  for (const auto& [uid, own] : series) {
    list += fmt::format("{}'{}' ({} files)", list.empty() ? "" : ", ", own.text.empty() ? uid : own.text,
                        own.files.size());
    if (wanted.empty() || wanted == uid || wanted == own.text) found.push_back(&own);
  }
  if (found.size() == 1) return *found.front();
  fail("{}: expected one series of DICOM{}, found {}", name, wanted.empty() ? "" : " '" + wanted + "'",
       list.empty() ? "none" : list);
}

}  // namespace

bool is_dicom_file(const std::filesystem::path& path) {
  std::array<char, 132> bytes{};
  const std::size_t size = FileHandle::open(path)->read_some(0, std::as_writable_bytes(std::span(bytes)));
  return size == bytes.size() && std::string_view(bytes.data() + 128, 4) == "DICM";
}

bool is_dicom_folder(const std::filesystem::path& path) {
  std::error_code code;
  for (std::filesystem::directory_iterator at(path, code), end; !code && at != end; at.increment(code)) {
    if (at->is_regular_file(code) && is_dicom_file(at->path())) return true;
  }
  return false;
}

GridFile read_dicom(const std::filesystem::path& path, const std::string& series) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  SliceReader reader;
  std::string remark;
  if (!std::filesystem::is_directory(path)) {
    reader.name_values(file_stem(path));
    reader.add(path.string());
  } else {
    std::size_t others = 0;
    const Series own = choose(path.string(), series_in(path, others), series);
    if (others > 0) remark = fmt::format("{} files of the folder are none of DICOM", others);
    reader.name_values(own.text.empty() ? file_stem(path) : own.text);
    for (const std::string& file : own.files) reader.add(file);
  }
  GridFile file = reader.grid();
  if (!remark.empty()) file.remark += (file.remark.empty() ? "" : "; ") + remark;
  return file;
}

InputFormat dicom_format() {
  return {.name = "DICOM",
          .endings = ".dcm",
          .more_endings = ".dicom .ima",
          .shown_by =
              [](std::string_view bytes) { return bytes.size() >= 132 && bytes.substr(128, 4) == "DICM"; },
          .read_grid = read_grid_by_library,
          .find_volume = import_grid,
          .several_arrays = true,
          .of_folders = true};
}

}  // namespace adamas::io
