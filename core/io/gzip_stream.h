#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "core/io/output_stream.h"

namespace adamas {

/// Compresses bytes into a file as one gzip stream without a name or a time, so that equal bytes give equal
/// files.
class GzipStream {
 public:
  /// The stream must outlive this.
  explicit GzipStream(OutputStream& out);
  ~GzipStream();
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  /// These throw Error where the bytes cannot be written.
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// After the last byte.
  void finish();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace adamas
