#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>

namespace adamas::io {

/// Returns the header of a .ply up to its end, from the bytes that the file begins with; empty if there is
/// none.
std::string ply_header(const std::string& beginning);
/// Returns the header of a file; empty if there is none, or no such file.
std::string ply_header_of(const std::filesystem::path& path);

/// The elements that a header states, and how many bytes each takes.
struct PlyElements {
  std::size_t points = 0, point_bytes = 0, faces = 0, face_bytes = 0;
};

/// Throws Error, with the file's name, where so many bytes behind the header are not those of the elements.
void check_ply_bytes(const PlyElements& elements, std::size_t bytes, const std::string& name);

/// Takes numbers from the bytes of a file, one after another; there must be enough.
class ByteCursor {
 public:
  explicit ByteCursor(const char* at) : at_(at) {}
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

 private:
  const char* at_;
};

}  // namespace adamas::io
