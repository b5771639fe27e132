// What adamas-reader does. It is a source of its own, so that the libraries of its readers are linked for it
// alone.

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "adamas/files.h"
#include "core/base/error.h"
#include "core/io/framed_bytes.h"
#include "core/io/reader_program.h"

namespace adamas::io {

namespace {

void run_reader(const ReaderRequest& request, ByteSink& sink) {
  switch (request.reader) {
    case LibraryReader::kGrid:
    case LibraryReader::kHdf5Grid:
      return send_grid(request, sink);
    case LibraryReader::kDicomSeries:
      return send_dicom_series(request, sink);
    case LibraryReader::kMesh:
      return send_mesh(request, sink);
    case LibraryReader::kCells:
    case LibraryReader::kCellTimes:
      return send_cells(request, sink);
    case LibraryReader::kPolygons:
      return send_polygons(request, sink);
    case LibraryReader::kGridVolume:
      return send_grid_volume(request, sink);
    case LibraryReader::kHdf5Volume:
      return send_hdf5_volume(request, sink);
    case LibraryReader::kHdf5Steps:
      return send_hdf5_steps(request, sink);
    case LibraryReader::kStackVolume:
      return send_stack_volume(request, sink);
    case LibraryReader::kArrays:
      return send_arrays(request, sink);
  }
  fail("{}: expected a reader, found none of that number", request.name);
}

}  // namespace

int run_reader_program() {
  // What libraries print must not get into the data that are sent.
  ByteSink sink(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3));
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  ReaderRequest request;
  std::string failure;
  try {
    ByteSource source(STDIN_FILENO);
    if (const auto version = source.get<std::string>(); version != reader_version())
      fail("expected the program adamas-reader of version {}, found that of {}", version, reader_version());
    source.get(request);
    source.expect_end();
    set_hdf5_layout(request.layout);
    run_reader(request, sink);
    sink.finish();
    return 0;
  } catch (const TruncatedStream&) {
    std::fputs("adamas-reader: expected a request of adamas, found something else\n", stderr);
    return 1;
  } catch (const Error& error) {
    failure = error.what();
  } catch (const std::bad_alloc&) {
    failure = request.name + ": expected data that fit into memory, found more";
  } catch (const std::exception& error) {
    failure = request.name + ": could not be read: " + error.what();
  } catch (...) {
    failure = request.name + ": could not be read";
  }
  sink.finish_with_error(failure);
  return 0;
}

}  // namespace adamas::io
