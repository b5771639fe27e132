#include "datasets/scene_sampling.h"

#include <unistd.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "datasets/fraction_blur.h"

namespace adamas::datasets {

namespace {

constexpr int kGreatestDepth = 8;
constexpr std::size_t kCellsPerChunk = 4096;
constexpr double kGibibyte = 1024.0 * 1024 * 1024;

void check_options(const Scene& scene, const std::array<std::size_t, 3>& dims,
                   const SamplingOptions& options) {
  if (dims[0] == 0 || dims[1] == 0 || dims[2] == 0) {
    fail("scene {}: expected at least one cell along each axis, found {}x{}x{}", scene.name(), dims[0],
         dims[1], dims[2]);
  }
  if (options.depth < 1 || options.depth > kGreatestDepth) {
    fail("scene {}: expected a depth from 1 to {}, found {}", scene.name(), kGreatestDepth, options.depth);
  }
  check(options.blur);
  double cells = 1;
  for (const std::size_t n : dims) cells *= static_cast<double>(n);
  const double materials = static_cast<double>(scene.materials().size());
  const double fields = options.fields ? static_cast<double>(scene_fields().size()) : 0;
  const double needed = cells * sizeof(float) * (materials + fields * (materials + 1));
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (needed > memory) {
    fail(
        "scene {}: expected dimensions that fit in memory ({:.0f} GiB), found {}x{}x{}, which need {:.0f} "
        "GiB",
        scene.name(), memory / kGibibyte, dims[0], dims[1], dims[2], needed / kGibibyte);
  }
}

/// The data under construction: it receives one cell at a time, from several threads.
class Sampler {
 public:
  Sampler(const Scene& scene, MultiMaterialData& data, bool fields) : scene_(scene), data_(data) {
    const std::size_t count = data.grid.site_count();
    data.fractions.assign(scene.materials().size(), SiteArray<float>(count));
    if (!fields) return;
    for (const auto& [field, name] : scene_fields()) {
      Field own;
      own.name = name;
      own.material_values.assign(scene.materials().size(), std::vector<float>(count));
      data.fields.push_back(std::move(own));
    }
    for (const auto& [field, name] : scene_fields()) {
      Field mixed;
      mixed.name = "mixed " + std::string(name);
      mixed.values = std::vector<float>(count);
      data.fields.push_back(std::move(mixed));
    }
  }

  /// Sets the fractions of a cell that `blur` will change later.
  void set_sharp(std::size_t site, const std::vector<double>& fractions) {
    for (std::size_t m = 0; m < fractions.size(); ++m)
      data_.fractions[MaterialId(m)][site] = static_cast<float>(fractions[m]);
  }

  void blur(const SamplingOptions& options, Progress& progress) {
    const RectilinearGrid& grid = data_.grid;
    const std::size_t materials = data_.fractions.size();
    for (MaterialId m(0); m.value < materials; ++m.value) {
      progress.step("blurring the fractions",
                    static_cast<double>(m.value) / static_cast<double>(materials + 1));
      blur_cells(data_.fractions[m].own(), {grid.sites(0), grid.sites(1), grid.sites(2)}, options.blur.blur);
    }
    progress.check();
    parallel_chunks(grid.site_count(), kCellsPerChunk, [&](std::size_t begin, std::size_t end) {
      std::vector<double> fractions(materials);
      for (std::size_t site = begin; site < end; ++site) {
        for (MaterialId m(0); m.value < materials; ++m.value)
          fractions[m.value] = static_cast<double>(data_.fraction(m, site));
        if (options.blur.noise > 0) add_noise(fractions, options.blur.noise, options.noise_seed, site);
        set(site, fractions);
      }
    });
    progress.step("blurring the fractions", 1);
  }

  void set(std::size_t site, const std::vector<double>& fractions) {
    double kept = 0;
    for (const double f : fractions) kept += is_trace(f) ? 0 : f;
    for (std::size_t m = 0; m < fractions.size(); ++m) {
      data_.fractions[MaterialId(m)][site] =
          is_trace(fractions[m]) ? 0.0f : static_cast<float>(fractions[m] / kept);
    }
    if (!data_.fields.empty()) set_fields(site, fractions);
  }

 private:
  /// Whether a fraction is a trace, with a margin for the rounding to float: normalise() must find nothing to
  /// correct.
  static bool is_trace(double fraction) { return fraction < 1.001 * static_cast<double>(kFractionTrace); }

  void set_fields(std::size_t site, const std::vector<double>& fractions) {
    const RectilinearGrid& grid = data_.grid;
    const std::size_t nx = grid.sites(0), ny = grid.sites(1);
    const Vec3 center = grid.site(site % nx, site / nx % ny, site / (nx * ny));
    const auto& fields = scene_fields();
    for (std::size_t f = 0; f < fields.size(); ++f) {
      double sum = 0, weights = 0;
      for (MaterialId m(0); m.value < fractions.size(); ++m.value) {
        if (is_trace(fractions[m.value])) continue;
        const double value = scene_.field(fields[f].first, m, center);
        data_.fields[f].material_values[m].set(site, value);
        sum += fractions[m.value] * value;
        weights += fractions[m.value];
      }
      data_.fields[fields.size() + f].values.set(site, sum / weights);
    }
  }

  const Scene& scene_;
  MultiMaterialData& data_;
};

}  // namespace

MultiMaterialData sample_scene(const Scene& scene, const std::array<std::size_t, 3>& dims,
                               const SamplingOptions& options, Progress& progress, SceneIntegral* integral) {
  check_options(scene, dims, options);
  MultiMaterialData data;
  data.source = "scene " + scene.name();
  data.grid = uniform_grid(scene.box(), dims);
  data.materials = scene.materials();
  Sampler sampler(scene, data, options.fields);
  const bool sharp = options.blur.blur == 0 && options.blur.noise == 0;
  SceneIntegral sums = integrate_scene(
      scene, data.grid, options.depth,
      [&sampler, sharp](std::size_t site, const std::vector<double>& fractions) {
        sharp ? sampler.set(site, fractions) : sampler.set_sharp(site, fractions);
      },
      progress);
  if (!sharp) sampler.blur(options, progress);
  if (integral != nullptr) *integral = std::move(sums);
  return data;
}

}  // namespace adamas::datasets
