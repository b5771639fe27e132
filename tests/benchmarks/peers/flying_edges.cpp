#include "tests/benchmarks/peers/flying_edges.h"

#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <stdexcept>

#include "tests/benchmarks/peers/one_thread.h"
#include "tests/benchmarks/peers/vtk_surface.h"

namespace adamas::bench {
namespace {

int vtk_type(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return VTK_UNSIGNED_CHAR;
    case SampleType::kUint16:
      return VTK_UNSIGNED_SHORT;
    case SampleType::kInt16:
      return VTK_SHORT;
    case SampleType::kFloat32:
      return VTK_FLOAT;
  }
  throw std::logic_error("a type of samples that is none");
}

void set_grid(vtkImageData& image, const FlyingEdges& peer) {
  const auto count = [&peer](int n) { return (n - 1) / peer.stride + 1; };
  image.SetDimensions(count(peer.dimensions[0]), count(peer.dimensions[1]), count(peer.dimensions[2]));
  image.SetSpacing(peer.stride, peer.stride, peer.stride);
  image.AllocateScalars(vtk_type(peer.type), 1);
}

void read_all(const FlyingEdges& peer, std::byte* samples, std::size_t size) {
  std::FILE* file = std::fopen(peer.raw.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error(peer.raw.string() + ": cannot be opened");
  const std::size_t found = std::fread(samples, 1, size, file);
  std::fclose(file);
  if (found != size) throw std::runtime_error(peer.raw.string() + ": ends too soon");
}

void read_strided(const FlyingEdges& peer, std::byte* to) {
  const auto [nx, ny, nz] = peer.dimensions;
  const std::size_t width = sample_bytes(peer.type);
  std::vector<std::byte> all(width * static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
                             static_cast<std::size_t>(nz));
  read_all(peer, all.data(), all.size());
  for (int k = 0; k < nz; k += peer.stride)
    for (int j = 0; j < ny; j += peer.stride)
      for (int i = 0; i < nx; i += peer.stride, to += width) {
        const std::size_t row =
            static_cast<std::size_t>(j) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(k);
        const std::size_t at = static_cast<std::size_t>(i) + static_cast<std::size_t>(nx) * row;
        std::copy_n(all.data() + width * at, width, to);
      }
}

void contour(const FlyingEdges& peer, vtkFlyingEdges3D& edges) {
  keep_vtk_on_one_thread();
  vtkNew<vtkImageData> image;
  set_grid(*image, peer);
  auto* samples = static_cast<std::byte*>(image->GetScalarPointer());
  if (peer.stride == 1) {
    read_all(peer, samples, sample_bytes(peer.type) * static_cast<std::size_t>(image->GetNumberOfPoints()));
  } else {
    read_strided(peer, samples);
  }
  edges.SetInputData(image);
  edges.SetValue(0, peer.isovalue);
  edges.SetComputeNormals(peer.normals);
  edges.ComputeGradientsOff();
  edges.ComputeScalarsOff();
  edges.Update();
}

}  // namespace

std::uint64_t FlyingEdges::count() const {
  vtkNew<vtkFlyingEdges3D> edges;
  contour(*this, *edges);
  return static_cast<std::uint64_t>(edges->GetOutput()->GetNumberOfPolys());
}

PeerSurface FlyingEdges::surface() const {
  vtkNew<vtkFlyingEdges3D> edges;
  contour(*this, *edges);
  return taken(*edges->GetOutput());
}

}  // namespace adamas::bench
