#include "core/io/text_array.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/whole_pieces.h"

namespace adamas::io {

std::vector<std::string> read_texts(VolumeSource source) {
  source.grid.dimensions = {measure_vtk_array(source), 1, 1};
  if (source.grid.samples() == 0) return {};
  if (source.grid.samples() > kLongestHeader)
    fail("{}: expected material names of at most {} bytes, found {}", source.name, kLongestHeader,
         source.grid.samples());
  VolumeReader reader = open_in_memory(std::move(source));
  std::string text(static_cast<std::size_t>(reader.source().values()), '\0');
  reader.read_stored(0, std::as_writable_bytes(std::span(text)));
  std::vector<std::string> texts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\0', begin), text.size());
    texts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return texts;
}

}  // namespace adamas::io
