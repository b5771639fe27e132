#include "adamas/file_names.h"

#include <algorithm>
#include <cctype>

namespace adamas {

std::string file_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (extension == ".gz") extension = path.stem().extension().string() + extension;
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string file_stem(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  name.resize(name.size() - std::min(name.size(), file_extension(path).size()));
  return name;
}

}  // namespace adamas
