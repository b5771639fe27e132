
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/extraction/surface_extractor.h"
#include "isosurface/extraction/surface_normals.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/gradients/plane_gradients.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/restore.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/storage/store_file_writer.h"
#include "isosurface/storage/store_format.h"
#include "isosurface/storage/store_options.h"
#include "isosurface/storage/stored_pages.h"
#include "tests/support/build_store.h"
#include "tests/support/restored.h"
#include "tests/support/scratch.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

template <class Sample>
constexpr SampleType kType = std::is_same_v<Sample, std::uint8_t>   ? SampleType::kUint8
                             : std::is_same_v<Sample, std::int16_t> ? SampleType::kInt16
                             : std::is_same_v<Sample, float>        ? SampleType::kFloat32
                                                                    : SampleType::kUint16;

/// A volume and its stores.
template <class Sample>
struct Stored {
  VolumeGrid grid;
  std::vector<Sample> samples;
  test::Scratch folder;

  template <class Fn>
  Stored(const std::array<std::uint64_t, 3>& dimensions, const Vec3& spacing, Fn&& fn) {
    grid.dimensions = dimensions;
    grid.type = kType<Sample>;
    grid.spacing = spacing;
    for (std::uint64_t k = 0; k < dimensions[2]; ++k)
      for (std::uint64_t j = 0; j < dimensions[1]; ++j)
        for (std::uint64_t i = 0; i < dimensions[0]; ++i)
          samples.push_back(static_cast<Sample>(
              fn(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k))));
  }

  [[nodiscard]] std::filesystem::path path() const { return folder / "a.adm"; }
  StoreFigures build(bool gradients = true, SampleCoding coding = SampleCoding::kInterpolation) const {
    StoreOptions options;
    options.coding = coding;
    options.gradients = gradients;
    options.smoothing.reset();
    options.scratch = folder / "";
    const auto planes = [this](std::uint64_t k, std::span<std::byte> to) {
      std::memcpy(to.data(), samples.data() + k * grid.plane_samples(), to.size());
    };
    return test::build_store(path(), "a.adm", grid, planes, options);
  }

  /// Returns the gradients of all samples as PlaneGradients computes them.
  [[nodiscard]] std::vector<OctahedralCode> codes() const {
    const std::uint64_t nx = grid.dimensions[0], ny = grid.dimensions[1], nz = grid.dimensions[2];
    const PlaneGradients gradients(grid.spacing, nx, ny);
    std::vector<OctahedralCode> codes(grid.samples());
    const auto plane = [&](std::uint64_t k) { return k < nz ? samples.data() + k * nx * ny : nullptr; };
    for (std::uint64_t k = 0; k < nz; ++k) {
      gradients(std::array<const Sample*, 3>{plane(k - 1), plane(k), plane(k + 1)},
                std::span(codes).subspan(k * nx * ny, nx * ny));
    }
    return codes;
  }
};

template <class Sample>
Stored<Sample> rough(const std::array<std::uint64_t, 3>& dimensions) {
  std::mt19937 random(static_cast<unsigned>(dimensions[0] + 20 * dimensions[1] + 400 * dimensions[2]));
  return {dimensions, {1, 1.5, 0.75}, [&](double i, double j, double k) {
            // A part of the volume has no gradient.
            const double noise = static_cast<double>(random() >> 28);
            return i + j + k < 12 ? 50 : 60 + 40 * std::sin(0.3 * i) * std::cos(0.2 * j + 0.1 * k) + noise;
          }};
}

/// Expects the right gradient at every point of every page, those of coarser LODs and virtual ones included.
template <class Sample>
void expect_stored(const Stored<Sample>& volume) {
  StoreFile file(volume.path());
  ASSERT_TRUE(file.header().gradients);
  StoredGradients gradients(file, 0, 0);
  const std::vector<OctahedralCode> codes = volume.codes();
  const PageGrid& grid = file.grid();
  const auto code_at = [&](LatticePoint p) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::min(p[axis], grid.last()[axis]);
    const auto [nx, ny, nz] = volume.grid.dimensions;
    const auto at = [&p](int axis) { return static_cast<std::size_t>(p[axis]); };
    return codes[at(0) + nx * (at(1) + ny * at(2))];
  };
  std::size_t wrong = 0;
  for (int lod = 0; lod <= grid.top(); ++lod) {
    const LatticePoint n = grid.extent(lod);
    LatticePoint q{};
    for (q.k = 0; q.k <= n.k; ++q.k)
      for (q.j = 0; q.j <= n.j; ++q.j)
        for (q.i = 0; q.i <= n.i; ++q.i) {
          const PageId id{lod, {q.i / 16, q.j / 16, q.k / 16}};
          if (!grid.contains(id)) continue;
          const PageSamples<std::uint16_t>* page = gradients.samples(id);
          ASSERT_NE(page, nullptr);
          const auto [first, second] = code_at((1 << lod) * q);
          wrong += page->samples[PageGrid::place(q, 0)] != (first | second << 8) ? 1 : 0;
          if ((q.i + q.j + q.k) % 7 != 0) continue;
          const Vec3 expected = decode_octahedral({first, second});
          const auto found = gradients.direction((1 << lod) * q);
          ASSERT_TRUE(found && norm(*found - expected) == 0);
        }
  }
  EXPECT_EQ(wrong, 0u);
  const VerifiedStore verified = verify_store(file, 0, SilentProgress::instance());
  EXPECT_EQ(verified.bad_pages + verified.bad_copies, 0u) << verified.problems.front().what;
}

template <class Sample>
class StoredGradientsOf : public testing::Test {};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(StoredGradientsOf, Samples);

TYPED_TEST(StoredGradientsOf, AreThoseOfTheSamples) {
  for (const std::array<std::uint64_t, 3>& dimensions : std::vector<std::array<std::uint64_t, 3>>{
           {1, 1, 1}, {2, 1, 3}, {9, 8, 5}, {33, 20, 18}, {40, 37, 50}}) {
    const auto volume = rough<TypeParam>(dimensions);
    for (const SampleCoding coding :
         {SampleCoding::kSplitEdge, SampleCoding::kInterpolation, SampleCoding::kPlain}) {
      const StoreFigures figures = volume.build(true, coding);
      EXPECT_GT(figures.bytes.gradients, 0u);
      if (coding == SampleCoding::kPlain) {
        EXPECT_GE(figures.bytes.gradients, 2 * volume.grid.samples());
      }
      expect_stored(volume);
    }
  }
}

TYPED_TEST(StoredGradientsOf, AreTheSameOnAnyNumberOfThreads) {
  const auto volume = rough<TypeParam>({40, 37, 50});
  set_thread_limit(1);
  volume.build();
  const std::string one = test::bytes_of(volume.path());
  set_thread_limit(2);
  volume.build();
  set_thread_limit(0);
  EXPECT_EQ(test::bytes_of(volume.path()), one);
}

TEST(StoredGradients, ChangeNothingElse) {
  const auto volume = rough<std::uint8_t>({40, 37, 50});
  std::array<StoreFigures, 2> figures;
  for (const bool gradients : {false, true}) {
    figures[gradients ? 1 : 0] = volume.build(gradients);
    StoreFile file(volume.path());
    EXPECT_EQ(file.header().gradients, gradients);
    EXPECT_EQ(file.header().gradient_tables.empty(), !gradients);
    std::vector<std::byte> samples;
    test::restore(
        file, restored_part(file.header().grid, 0, {}, "a"), 1 << 20,
        [&](std::span<const std::byte> plane) { samples.insert(samples.end(), plane.begin(), plane.end()); });
    EXPECT_EQ(std::memcmp(samples.data(), volume.samples.data(), samples.size()), 0);
    if (gradients) continue;
    EXPECT_THROW(StoredGradients(file, 0, 0), Error);
  }
  EXPECT_EQ(figures[0].bytes.samples, figures[1].bytes.samples);
  EXPECT_EQ(figures[0].bytes.bounds, figures[1].bytes.bounds);
  EXPECT_EQ(figures[0].bytes.gradients, 0u);
  EXPECT_GT(figures[1].file_bytes, figures[0].file_bytes + figures[1].bytes.gradients);
}

/// Writes a copy of a store in which `change` has edited the gradients of the finest pages.
void rewrite(const std::filesystem::path& from, const std::filesystem::path& to,
             const std::function<void(StoreHeader&, std::vector<std::byte>&)>& change) {
  StoreFile file(from);
  StoreHeader header = file.header();
  std::vector<std::byte> none;
  change(header, none);
  StoreFileWriter writer(to, "b.adm", header.grid);
  for (std::uint64_t first = 0; first < std::uint64_t{2} << (3 * file.grid().top());
       first += DirectoryChunk::kPages) {
    for (const std::uint64_t number : chunk_pages(file.grid(), first)) {
      const PageId id = file.grid().page(number);
      PagePayload parts;
      ASSERT_TRUE(split_payload(file.read(0, id).bytes, header.coding, parts));
      std::vector<std::byte> gradients(parts.gradients.begin(), parts.gradients.end());
      if (id.lod == 0) change(header, gradients);
      writer.add_page(number, join_payload({parts.samples, parts.bounds, gradients, parts.along}),
                      *file.entry(0, id));
    }
  }
  writer.finish_block(header);
}

TEST(StoredGradients, ThoseThatAreNoneAreFound) {
  const auto volume = rough<std::uint8_t>({40, 37, 50});
  volume.build();
  const auto path = volume.folder / "b.adm";
  const auto verified = [&path] {
    StoreFile file(path);
    return verify_store(file, 0, SilentProgress::instance());
  };
  rewrite(volume.path(), path, [](StoreHeader&, std::vector<std::byte>&) {});
  EXPECT_EQ(test::bytes_of(path), test::bytes_of(volume.path()));
  rewrite(volume.path(), path, [](StoreHeader&, std::vector<std::byte>& gradients) {
    if (!gradients.empty()) gradients.pop_back();
  });
  VerifiedStore found = verified();
  EXPECT_GT(found.bad_pages, 0u);
  EXPECT_LT(found.bad_pages, found.pages);
  EXPECT_NE(found.problems.front().what.find("has gradients that are damaged"), std::string::npos);
  StoreFile file(path);
  StoredGradients gradients(file, 0, 0);
  EXPECT_FALSE(gradients.direction({1, 1, 1}));
  EXPECT_TRUE(gradients.direction({2, 2, 2}));
  rewrite(volume.path(), path,
          [](StoreHeader& header, std::vector<std::byte>&) { header.gradients = false; });
  found = verified();
  EXPECT_EQ(found.bad_pages, found.pages);
  EXPECT_NE(found.problems.front().what.find("has gradients, which the store does not have"),
            std::string::npos);
  rewrite(volume.path(), path,
          [](StoreHeader& header, std::vector<std::byte>&) { header.gradient_tables.clear(); });
  EXPECT_THROW(verified(), Error);
}

Stored<float> sphere() {
  return {{48, 48, 48}, {0.5, 0.5, 0.5}, [](double i, double j, double k) {
            return std::sqrt((i - 20) * (i - 20) + (j - 24) * (j - 24) + (k - 27) * (k - 27));
          }};
}

TEST(StoredGradients, GiveSurfacesTheirNormals) {
  const auto volume = sphere();
  volume.build();
  StoreFile file(volume.path());
  StoredPages<std::uint32_t> pages(file, 0, 1 << 24);
  SurfaceExtractor<float> extractor(pages);
  const Vec3 centre{10, 12, 13.5};
  for (const double error : {0.0, 0.05, 0.5}) {
    SurfaceRequest request;
    request.isovalue = 17.3;
    request.error = error;
    const ExtractedSurface found = extractor.extract(request);
    const std::vector<Vec3> normals = surface_normals<float>(pages, found.contour).normals;
    ASSERT_EQ(normals.size(), found.contour.points.size());
    ASSERT_GT(normals.size(), 50u);
    double worst = 1;
    for (std::size_t n = 0; n < normals.size(); ++n) {
      const Vec3 out = found.contour.points[n] - centre;
      EXPECT_NEAR(norm(normals[n]), 1, 1e-12);
      worst = std::min(worst, -dot(normals[n], out) / norm(out));
    }
    // Coarse edges are long chords, along which the direction turns.
    EXPECT_GT(worst, std::cos((error < 0.1 ? 1.5 : 6) * M_PI / 180)) << error;
  }
}

TEST(StoredGradients, NormalsAreTheSameHoweverPagesCome) {
  const auto volume = sphere();
  volume.build();
  std::vector<std::vector<Vec3>> normals;
  for (const bool before : {false, true}) {
    StoreFile file(volume.path());
    StoredPages<std::uint32_t> pages(file, 0, before ? 0 : std::size_t{1} << 26);
    SurfaceExtractor<float> extractor(pages);
    SurfaceRequest request;
    request.isovalue = 17.3;
    const ExtractedSurface found = extractor.extract(request);
    if (before) {
      request.isovalue = 9;
      surface_normals<float>(pages, extractor.extract(request).contour);
    }
    normals.push_back(surface_normals<float>(pages, found.contour).normals);
  }
  ASSERT_EQ(normals[0].size(), normals[1].size());
  for (std::size_t n = 0; n < normals[0].size(); ++n) ASSERT_EQ(norm(normals[0][n] - normals[1][n]), 0);
}

TEST(StoredGradients, MayBeAskedForInAnyOrder) {
  const auto volume = rough<std::uint8_t>({70, 50, 40});
  volume.build();
  StoreFile file(volume.path());
  StoredGradients in_order(file, 0, std::size_t{1} << 26), at_random(file, 0, 0);
  std::mt19937 random(4);
  for (int n = 0; n < 5000; ++n) {
    const LatticePoint p{static_cast<std::int32_t>(random() % 80), static_cast<std::int32_t>(random() % 60),
                         static_cast<std::int32_t>(random() % 50)};
    const auto a = in_order.direction(p), b = at_random.direction(p);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(norm(*a - *b), 0);
  }
}

}  // namespace
}  // namespace adamas
