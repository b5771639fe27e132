#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/unstructured_mesh.h"
#include "core/io/framed_bytes.h"

namespace adamas::io {

/// The readers that use libraries which may crash on corrupt files. They run in a process of their own, the
/// program adamas-reader.
enum class LibraryReader : std::uint8_t {
  kGrid,         ///< a grid file by VTK or libtiff
  kHdf5Grid,     ///< all numeric data sets of a file by HDF5
  kDicomSeries,  ///< the series in a folder of DICOM
  kMesh,         ///< .vtu or .vtp by VTK
  kCells,        ///< the cells of a mesh by VTK, Silo or HDF5
  kCellTimes,    ///< the times of a file of cells
  kPolygons,     ///< a surface by CGAL
  kGridVolume,   ///< a volume on a grid by VTK
  kHdf5Volume,   ///< a volume by HDF5
  kHdf5Steps,    ///< the names of the volumes in HDF5 that are the steps of a series
  kStackVolume,  ///< pictures, one plane each, by libtiff and libpng
  kArrays,       ///< a file of named arrays by HDF5
};

/// A request to a reader.
struct ReaderRequest {
  LibraryReader reader = LibraryReader::kGrid;
  std::string name{};                   ///< begins messages
  std::uint64_t input_bytes = 0;        ///< size of all files; the time limit grows with them
  std::vector<std::string> paths{};     ///< the file, or the files of a stack
  std::string array{};                  ///< the name of a volume's array, or empty
  Vec3 spacing{1, 1, 1}, origin{};      ///< spacing and origin of a stack
  std::optional<std::uint64_t> time{};  ///< the number of a time, if a volume has several
  std::vector<std::string> arrays{};    ///< the names of the arrays in a file of arrays
  std::vector<std::string> layout{};    ///< of files of HDF5 (set_hdf5_layout())
};

template <>
inline constexpr auto kSentMembers<ReaderRequest> = std::tuple{
    &ReaderRequest::reader, &ReaderRequest::name,    &ReaderRequest::input_bytes, &ReaderRequest::paths,
    &ReaderRequest::array,  &ReaderRequest::spacing, &ReaderRequest::origin,      &ReaderRequest::time,
    &ReaderRequest::arrays, &ReaderRequest::layout};

template <>
inline constexpr auto kSentMembers<NamedArray> =
    std::tuple{&NamedArray::name, &NamedArray::components, &NamedArray::values};

/// A request to read one file, which is checked (check_input_file).
ReaderRequest request_of(LibraryReader reader, const std::filesystem::path& path);

/// The version of the program, which is compared, since one of another version may send other data.
std::string reader_version();

/// The environment variable that says where adamas-reader is.
inline constexpr const char* kReaderVariable = "ADAMAS_READER_PROGRAM";
/// The name of the program.
inline constexpr const char* kReaderProgram = "adamas-reader";

/// Lets adamas-reader run the reader, with limited memory and time, and calls `consume` here on its data
/// while they arrive. Its failures, including a crash of a library, are thrown here as an Error that begins
/// with the request's name; Cancelled if a signal that asks programs to end has ended it. Throws Error if the
/// program is not found (find_own_program; the variable is ADAMAS_READER_PROGRAM).
void read_in_child(const ReaderRequest& request, const std::function<void(ByteSource&)>& consume);

/// Lets adamas-reader run the reader, as read_in_child does, and returns the value that it sends.
template <class T>
T receive_from_child(const ReaderRequest& request) {
  T value;
  read_in_child(request, [&value](ByteSource& bytes) { bytes.get(value); });
  return value;
}

/// The main function of adamas-reader: takes a request from standard input and sends what the reader finds to
/// standard output. Returns the program's status.
int run_reader_program();

/// The readers, which run in adamas-reader. Those of grids and of cells are in senders.cpp, so that their
/// libraries are linked for it alone; each other one is in the file of the function that receives its data.
void send_grid(const ReaderRequest& request, ByteSink& sink);
void send_dicom_series(const ReaderRequest& request, ByteSink& sink);
void send_mesh(const ReaderRequest& request, ByteSink& sink);
void send_cells(const ReaderRequest& request, ByteSink& sink);
void send_polygons(const ReaderRequest& request, ByteSink& sink);
void send_grid_volume(const ReaderRequest& request, ByteSink& sink);
void send_hdf5_volume(const ReaderRequest& request, ByteSink& sink);
void send_hdf5_steps(const ReaderRequest& request, ByteSink& sink);
void send_stack_volume(const ReaderRequest& request, ByteSink& sink);
void send_arrays(const ReaderRequest& request, ByteSink& sink);

}  // namespace adamas::io
