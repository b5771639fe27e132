#include "tests/benchmarks/peers/flying_edges.h"

#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "tests/benchmarks/peers/one_thread.h"
#include "tests/benchmarks/peers/vtk_samples.h"
#include "tests/benchmarks/peers/vtk_surface.h"

namespace adamas::bench {
namespace {

void read_all(const FlyingEdges& peer, std::byte* samples, std::size_t size) {
  std::FILE* file = std::fopen(peer.raw.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error(peer.raw.string() + ": cannot be opened");
  const std::size_t found = std::fread(samples, 1, size, file);
  std::fclose(file);
  if (found != size) throw std::runtime_error(peer.raw.string() + ": ends too soon");
}

void contour(const FlyingEdges& peer, vtkFlyingEdges3D& edges) {
  keep_vtk_on_one_thread();
  vtkNew<vtkImageData> image;
  image->SetSpacing(peer.stride, peer.stride, peer.stride);
  std::byte* const samples = make_room(*image, peer.dimensions, peer.type, peer.stride);
  const std::size_t size =
      sample_bytes(peer.type) * peer.dimensions[0] * peer.dimensions[1] * peer.dimensions[2];
  if (peer.stride == 1) {
    read_all(peer, samples, size);
  } else {
    std::vector<std::byte> all(size);
    read_all(peer, all.data(), all.size());
    copy_strided(all, peer.dimensions, peer.type, peer.stride, samples);
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
