#include "core/picture/picture_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/base/error.h"
#include "core/base/output_file.h"

namespace adamas::picture {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

PictureFormat picture_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".png") return PictureFormat::kPng;
  if (extension == ".svg") return PictureFormat::kSvg;
  if (extension == ".pdf") return PictureFormat::kPdf;
  fail("{}: expected a picture file name ending in .png, .svg or .pdf, found '{}'", path.string(), extension);
}

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  OutputFile output(path);
  std::FILE* file = std::fopen(output.temporary().c_str(), "wb");
  if (file == nullptr) fail("{}: could not be opened for writing: {}", path.string(), std::strerror(errno));
  errno = 0;
  const bool written =
      std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
  const int reason = errno;
  if (std::fclose(file) != 0 || !written) {
    fail_as(writing_failure(reason != 0 ? reason : errno), "{}: could not be written: {}", path.string(),
            std::strerror(reason != 0 ? reason : errno));
  }
  output.commit();
}

}  // namespace adamas::picture
