#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/grid_data.h"

namespace adamas::test {

/// How the values of an array are written between its tags.
enum class XmlForm { kText, kBase64, kZlib };

std::string base64(const std::string& bytes);

std::string xml_array(const std::string& name, const std::vector<float>& values, XmlForm form,
                      int components = 1);
std::string xml_array(const std::string& name, const std::vector<double>& values, XmlForm form);
std::string xml_array(const std::string& name, const std::vector<std::int32_t>& values, XmlForm form);
std::string xml_array(const std::string& name, const std::vector<std::uint8_t>& values, XmlForm form);

/// Returns a file of one piece; `attributes` and `piece` stand in the tags of the data set and of the piece.
std::string xml_file(const std::string& kind, const std::string& attributes, const std::string& piece,
                     const std::string& content, XmlForm form);

/// Returns a .vti or .vtr with one array 'v'.
std::string xml_grid(const std::string& name, const std::array<int, 3>& nodes, Centering centering,
                     const std::vector<float>& values, XmlForm form);

}  // namespace adamas::test
