#include "tests/io/vtk_xml_text.h"

#include <fmt/format.h>

#include "core/data/stored_type.h"
#include "tests/io/volume_files.h"

namespace adamas::test {

using namespace io;

namespace {

template <class T>
std::string xml_values(const std::vector<T>& values, XmlForm form) {
  const std::string bytes = bytes_of_values(values);
  const auto count = [](std::size_t n) { return bytes_of_values(std::vector<std::uint64_t>{n}); };
  if (form == XmlForm::kBase64) return base64(count(bytes.size()) + bytes);
  if (form == XmlForm::kZlib) {
    const std::string block = deflated(bytes, Wrapping::kZlib);
    return base64(count(1) + count(bytes.size()) + count(0) + count(block.size())) + base64(block);
  }
  std::string text;
  for (const T value : values) text += fmt::format("{}\n", +value);
  return text;
}

template <class T>
std::string array_of(const std::string& name, StoredType type, const std::vector<T>& values, XmlForm form,
                     int components = 1) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"{}\">\n{}</DataArray>\n",
      stored_name(type, TypeNames::kVtk), name, components, form == XmlForm::kText ? "ascii" : "binary",
      xml_values(values, form));
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    unsigned group = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      group = group << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += at + i <= bytes.size() ? kDigits[group >> (18 - 6 * i) & 63] : '=';
    }
  }
  return text;
}

std::string xml_array(const std::string& name, const std::vector<float>& values, XmlForm form,
                      int components) {
  return array_of(name, StoredType::kFloat32, values, form, components);
}

std::string xml_array(const std::string& name, const std::vector<double>& values, XmlForm form) {
  return array_of(name, StoredType::kFloat64, values, form);
}

std::string xml_array(const std::string& name, const std::vector<std::int32_t>& values, XmlForm form) {
  return array_of(name, StoredType::kInt32, values, form);
}

std::string xml_array(const std::string& name, const std::vector<std::uint8_t>& values, XmlForm form) {
  return array_of(name, StoredType::kUint8, values, form);
}

std::string xml_file(const std::string& kind, const std::string& attributes, const std::string& piece,
                     const std::string& content, XmlForm form) {
  return fmt::format(
      "<VTKFile type=\"{}\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{}>\n<{} {}>\n<Piece {}>\n{}"
      "</Piece>\n</{}>\n</VTKFile>\n",
      kind, form == XmlForm::kZlib ? " compressor=\"vtkZLibDataCompressor\"" : "", kind, attributes, piece,
      content, kind);
}

std::string xml_grid(const std::string& name, const std::array<int, 3>& nodes, Centering centering,
                     const std::vector<float>& values, XmlForm form) {
  const bool image = name.ends_with(".vti");
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", nodes[0] - 1, nodes[1] - 1, nodes[2] - 1);
  const char* place = centering == Centering::kCells ? "CellData" : "PointData";
  std::string content = fmt::format("<{}>\n{}</{}>\n", place, xml_array("v", values, form), place);
  if (!image) {
    content += "<Coordinates>\n";
    for (const int count : nodes) {
      std::vector<double> places;
      for (int i = 0; i < count; ++i) places.push_back(0.5 + i);
      content += xml_array("c", places, form);
    }
    content += "</Coordinates>\n";
  }
  return xml_file(image ? "ImageData" : "RectilinearGrid",
                  "WholeExtent=\"" + extent + (image ? "\" Origin=\"0 0 0\" Spacing=\"1 1 1\"" : "\""),
                  "Extent=\"" + extent + "\"", content, form);
}

}  // namespace adamas::test
