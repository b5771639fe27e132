#include "isosurface/extraction/surface_certificate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/isosurface/contour_checks.h"
#include "tests/support/surface_distance.h"
#include "tests/support/volume_store.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::MemoryVolume;
using test::OpenStore;

constexpr Box3 kEverywhere{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};

/// Returns hills with noise, for which estimates of errors are too small.
MemoryVolume<std::uint8_t> rough_hills(unsigned seed) {
  return {{25, 22, 20},
          [seed](LatticePoint p) {
            return 100 + 50 * std::sin(0.3 * p.i + 0.1 * p.k) * std::cos(0.25 * p.j) +
                   30 * test::random_value(p, seed);
          },
          {1, 0.8, 1.3}};
}

/// Returns the greatest distance of sampled points of either surface from the other.
double sampled(const Contour& a, const Contour& b) {
  return test::sampled_distance(a.points, a.triangles, b.points, b.triangles, kEverywhere, 3000, 1);
}

template <class Sample>
Contour full_surface(OpenStore<Sample>& store, const SurfaceRequest& like) {
  SurfaceRequest request = like;
  request.error = 0;
  request.max_triangles.reset();
  request.join = false;
  request.least_parameter = 0;
  return store.extract(request).contour;
}

TEST(SurfaceCertificate, HoldsForSampledPoints) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    OpenStore<std::uint8_t> store(rough_hills(seed));
    for (const bool join : {false, true}) {
      for (const double error : {0.0, 1.0}) {
        SurfaceRequest request;
        request.isovalue = 115;
        request.error = error;
        request.join = join;
        if (seed == 1) request.max_triangles = 800;
        if (seed == 2) request.region = Box3{{3, 4, 5}, {20, 14, 19}};
        const Contour surface = store.extract(request).contour;
        const double distance = sampled(surface, full_surface(store, request));
        // The surface of all samples is made in one block, and in many.
        for (const int block : {9, kCertificateBlock}) {
          const SurfaceCertificate found =
              certify_surface(store.extractor(), request, surface, SilentProgress::instance(), block);
          EXPECT_GE(found.certified, distance);
          EXPECT_LE(found.found, found.certified);
          EXPECT_LE(found.certified, std::max({1.06 * found.found, 0.5 * error, 0.01}) + 1e-9);
          // The samples are dense enough to come near the distance that was found.
          EXPECT_GE(distance, 0.7 * found.found - 0.05);
        }
      }
    }
  }
}

/// Returns one of several volumes: smooth, rough, of noise alone, of steps, of thin features; spacing and
/// size differ too.
template <class Sample>
MemoryVolume<Sample> any_volume(unsigned n) {
  const Vec3 spacing{1, n % 3 == 0 ? 0.7 : 1, n % 4 == 1 ? 2.2 : 1};
  const test::Dimensions size{18 + n % 5, 24 - n % 7, 17 + n % 3};
  return {size,
          [n](LatticePoint p) {
            const double wave =
                std::sin(0.3 * p.i + 0.1 * n) * std::cos(0.25 * p.j) + std::sin(0.2 * p.k + n);
            const double noise = test::random_value(p, n);
            switch (n % 5) {
              case 0:
                return 100 + 40 * wave;
              case 1:
                return 100 + 40 * wave + 30 * noise;
              case 2:
                return 90 + 60 * noise;
              case 3:
                return wave + 0.1 * noise > 0.3 ? 140.0 : 60.0;
              default:
                return noise > 0.9 || (p.i + 2 * p.j) % 9 == 0 ? 160.0 : 40.0;
            }
          },
          spacing};
}

template <class Sample>
void expect_true_bounds(unsigned n) {
  SCOPED_TRACE(testing::Message() << "volume " << n);
  OpenStore<Sample> store(any_volume<Sample>(n));
  SurfaceRequest request;
  request.isovalue = 105.5;
  request.error = 0.7;
  request.join = n % 2 == 0;
  if (n % 3 == 1) request.max_triangles = 900;
  const ExtractedSurface surface = store.extract(request);
  ASSERT_FALSE(surface.contour.triangles.empty());
  const Contour full = full_surface(store, request);
  EXPECT_GE(certify_surface(store.extractor(), request, surface.contour).certified,
            sampled(surface.contour, full));
  request.max_triangles.reset();
  const CertifiedSurface certified = extract_certified(store.extractor(), request);
  EXPECT_GE(certified.certificate.certified, sampled(certified.surface.contour, full));
  EXPECT_LE(certified.certificate.certified, request.error);
}

/// The certified distance is never below the measured one.
TEST(LongSurfaceCertificate, HoldsForEightVolumes) {
  for (unsigned n = 0; n < 8; n += 4) {
    expect_true_bounds<std::uint8_t>(n);
    expect_true_bounds<std::uint16_t>(n + 1);
    expect_true_bounds<std::int16_t>(n + 2);
    expect_true_bounds<float>(n + 3);
  }
}

TEST(SurfaceCertificate, IsTheShiftOfAPlane) {
  const MemoryVolume<float> ramp({20, 20, 20}, [](LatticePoint p) { return p.k; });
  OpenStore<float> store(ramp);
  SurfaceRequest request;
  request.isovalue = 7.25;
  Contour surface = store.extract(request).contour;
  for (Vec3& p : surface.points) p.z += 0.625;
  const SurfaceCertificate found = certify_surface(store.extractor(), request, surface);
  EXPECT_NEAR(found.found, 0.625, 1e-9);
  EXPECT_GE(found.certified, 0.625);
  EXPECT_LE(found.certified, 1.05 * 0.625);
}

TEST(SurfaceCertificate, KnowsOfBodiesThatAreMissing) {
  // There are two balls; the second one lies about 20 samples from the first.
  const auto ball = [](LatticePoint p, double i, double radius) {
    return radius - std::sqrt((p.i - i) * (p.i - i) + (p.j - 10.) * (p.j - 10.) + (p.k - 10.) * (p.k - 10.));
  };
  const MemoryVolume<float> volume(
      {50, 21, 21}, [&](LatticePoint p) { return std::max(ball(p, 10, 6.3), ball(p, 40, 3.3)); });
  OpenStore<float> store(volume);
  SurfaceRequest request;
  Contour surface = store.extract(request).contour;
  std::erase_if(surface.triangles, [&](const auto& t) { return surface.points[t[0]].x > 25; });
  const SurfaceCertificate found = certify_surface(store.extractor(), request, surface);
  EXPECT_NEAR(found.found, 43.3 - 16.3, 0.5);
  EXPECT_GE(found.certified, found.found);
  surface.triangles.clear();
  EXPECT_EQ(certify_surface(store.extractor(), request, surface).certified,
            std::numeric_limits<double>::infinity());
}

TEST(SurfaceCertificate, IsReachedByRefinement) {
  OpenStore<std::uint8_t> store(rough_hills(4));
  bool was_exceeded = false;
  for (const double error : {0.05, 1.0}) {
    for (const bool join : {false, true}) {
      SurfaceRequest request;
      request.isovalue = 115;
      request.error = error;
      request.join = join;
      const CertifiedSurface found = extract_certified(store.extractor(), request);
      EXPECT_LE(found.certificate.certified, error);
      EXPECT_LE(sampled(found.surface.contour, full_surface(store, request)), error);
      const Contour first = store.extract(request).contour;
      was_exceeded = was_exceeded || certify_surface(store.extractor(), request, first).found > error;
    }
  }
  EXPECT_TRUE(was_exceeded) << "the estimate alone would have done";
}

}  // namespace
}  // namespace adamas
