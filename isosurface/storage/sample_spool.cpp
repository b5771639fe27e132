#include "isosurface/storage/sample_spool.h"

namespace adamas::isosurface {

PlaneSource SampleSpool::add(const PlaneSource& planes) {
  return [this, &planes, step = steps_++](std::uint64_t k, std::span<std::byte> samples) {
    planes(k, samples);
    file_.write(step * grid_.bytes() + k * grid_.plane_bytes(), samples);
  };
}

std::vector<RowSource> SampleSpool::rows() const {
  std::vector<RowSource> all;
  for (std::size_t step = 0; step < steps_; ++step) {
    all.emplace_back([this, step](std::uint64_t k, std::uint64_t row, std::span<std::byte> samples) {
      const std::uint64_t rows = grid_.plane_bytes() / grid_.dimensions[1];
      file_.read(step * grid_.bytes() + k * grid_.plane_bytes() + row * rows, samples);
    });
  }
  return all;
}

}  // namespace adamas::isosurface
