// Tests volumes whose axes are turned, mirrored, exchanged or oblique: every output lies where the header
// says.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <sstream>

#include "adamas/geometry.h"
#include "program.h"

namespace adamas::test {

namespace {

/// The steps along the axes of an array and the place of its first sample.
struct Affine {
  std::array<Vec3, 3> steps;
  Vec3 origin;

  [[nodiscard]] Vec3 at(double i, double j, double k) const {
    return origin + i * steps[0] + j * steps[1] + k * steps[2];
  }
};

constexpr std::array<std::size_t, 3> kSizes{30, 26, 34};
constexpr double kRadius = 4;

/// Returns the place in the middle of the array.
Vec3 middle(const Affine& a) { return a.at(14.5, 12.5, 16.5); }

template <class T>
std::string raw(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

Affine with_middle_at(const std::array<Vec3, 3>& steps, const Vec3& middle_at) {
  Affine a{steps, {}};
  a.origin = middle_at - middle(a);
  return a;
}

constexpr Vec3 kMiddle{10, -20, 7};

const std::vector<Affine>& affines() {
  const double c = std::cos(0.0003), s = std::sin(0.0003);
  static const std::vector<Affine> kAll{
      with_middle_at({{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.4}}}, kMiddle),
      with_middle_at({{{-0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.4}}}, kMiddle),
      with_middle_at({{{0, 0, 0.5}, {0.5, 0, 0}, {0, -0.4, 0}}}, kMiddle),
      with_middle_at({{{0.5 * c, 0.5 * s, 0}, {-0.5 * s, 0.5 * c, 0}, {0, 0, 0.4}}}, kMiddle),
      with_middle_at({{{0.3, 0.4, 0}, {0.4, -0.3, 0}, {0, 0, 0.4}}}, kMiddle),
      with_middle_at({{{0.5, 0, 0}, {0.1, 0.5, 0}, {0.05, -0.1, 0.4}}}, kMiddle)};
  return kAll;
}

class VolumePlaces : public ProgramTest {
 protected:
  /// Writes a ball about the middle; the value of a sample is its depth in the ball.
  void write_ball(const std::string& name, const Affine& affine) const {
    std::string header(352, '\0');
    const auto put = [&header](std::size_t at, const std::string& bytes) {
      header.replace(at, bytes.size(), bytes);
    };
    put(0, raw(std::int32_t{348}));
    put(40, raw(std::int16_t{3}));
    for (std::size_t a = 0; a < 3; ++a) put(42 + 2 * a, raw(static_cast<std::int16_t>(kSizes[a])));
    put(70, raw(std::int16_t{16}) + raw(std::int16_t{32}));
    for (std::size_t a = 0; a < 4; ++a) put(76 + 4 * a, raw(1.0f));
    put(108, raw(352.0f));
    put(254, raw(std::int16_t{1}));
    for (int row = 0; row < 3; ++row) {
      std::string text;
      for (const Vec3& step : affine.steps) text += raw(static_cast<float>(step[row]));
      put(280 + 16 * static_cast<std::size_t>(row), text + raw(static_cast<float>(affine.origin[row])));
    }
    put(344, std::string("n+1\0", 4));
    write(name, header + samples(affine));
  }
  [[nodiscard]] std::string samples(const Affine& affine) const {
    std::string bytes;
    for (std::size_t k = 0; k < kSizes[2]; ++k) {
      for (std::size_t j = 0; j < kSizes[1]; ++j) {
        for (std::size_t i = 0; i < kSizes[0]; ++i) {
          const Vec3 p = affine.at(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
          bytes += raw(static_cast<float>(kRadius - distance(p, kMiddle)));
        }
      }
    }
    return bytes;
  }

  struct Surface {
    std::vector<Vec3> points, normals;
    std::vector<std::array<std::size_t, 3>> triangles;

    /// Returns the volume that the triangles enclose, which is positive where they face outwards.
    [[nodiscard]] double volume() const {
      double sum = 0;
      for (const auto& [a, b, c] : triangles) sum += signed_volume(kMiddle, points[a], points[b], points[c]);
      return sum;
    }
  };
  [[nodiscard]] Surface read_obj(const std::string& name) const {
    Surface surface;
    std::istringstream lines(read(name));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string kind;
      words >> kind;
      Vec3 v;
      if (kind == "v" || kind == "vn") {
        words >> v.x >> v.y >> v.z;
        (kind == "v" ? surface.points : surface.normals).push_back(v);
      } else if (kind == "f") {
        std::array<std::size_t, 3> corners{};
        for (std::size_t& c : corners) {
          std::string word;
          words >> word;
          c = std::stoul(word) - 1;
        }
        surface.triangles.push_back(corners);
      }
    }
    return surface;
  }
};

TEST_F(VolumePlaces, SurfacesLieWhereTheHeaderSays) {
  constexpr double kVolume = 4.0 / 3 * std::numbers::pi * kRadius * kRadius * kRadius;
  for (std::size_t n = 0; n < affines().size(); ++n) {
    write_ball("a.nii", affines()[n]);
    run_well({"store", "a.nii", "-o", "a.adm"});
    run_well({"isosurface", "a.adm", "--isovalue", "0", "-o", "a.obj", "--json", "j.json"});
    const Surface surface = read_obj("a.obj");
    ASSERT_GT(surface.triangles.size(), 1000u) << n;
    EXPECT_NEAR(surface.volume(), kVolume, 0.01 * kVolume) << n;
    // This is a bound of the error of linear interpolation along the longest diagonal of a cell.
    double off = 0;
    const auto& [a, b, c] = affines()[n].steps;
    for (const Vec3& diagonal : {a + b + c, a + b - c, a - b + c, a - b - c})
      off = std::max(off, squared_norm(diagonal) / (7.5 * kRadius));
    Vec3 centre;
    for (std::size_t p = 0; p < surface.points.size(); ++p) {
      const Vec3 way = surface.points[p] - kMiddle;
      ASSERT_NEAR(norm(way), kRadius, off) << n;
      ASSERT_GT(dot(normalized(way), surface.normals[p]), 0.99) << n;
      centre += 1.0 / static_cast<double>(surface.points.size()) * surface.points[p];
    }
    EXPECT_LT(distance(centre, kMiddle), 0.05) << n;
    EXPECT_EQ(read_json("j.json").at("space"), "RAS");
    // The error of a coarser surface is at most the stated one; lengths are those in space.
    run_well({"isosurface", "a.adm", "--isovalue", "0", "--error", "0.2", "-o", "b.obj", "--json", "j.json"});
    EXPECT_LE(read_json("j.json").at("isosurface_error_estimate").get<double>(), 0.2);
    const Surface coarse = read_obj("b.obj");
    EXPECT_LT(coarse.triangles.size(), surface.triangles.size());
    for (const Vec3& p : coarse.points) ASSERT_NEAR(distance(p, kMiddle), kRadius, 0.2) << n;
  }
}

TEST_F(VolumePlaces, RegionsAreInSpace) {
  for (std::size_t n = 0; n < affines().size(); ++n) {
    write_ball("a.nii", affines()[n]);
    run_well({"store", "a.nii", "-o", "a.adm"});
    run_well({"isosurface", "a.adm", "--isovalue", "0", "--region", "10,30,-40,-19,7.5,40", "-o", "a.obj"});
    const Surface part = read_obj("a.obj");
    ASSERT_GT(part.triangles.size(), 20u) << n;
    Box3 box;
    for (const Vec3& p : part.points) box.extend(p);
    EXPECT_NEAR(box.min.x, 10, 1e-4) << n;
    EXPECT_NEAR(box.max.y, -19, 1e-4) << n;
    EXPECT_NEAR(box.min.z, 7.5, 1e-4) << n;
    EXPECT_NEAR(box.max.x, 10 + std::sqrt(16 - 0.25), 0.02) << n;
    const RunResult result = run({"restore", "a.adm", "--region", "10,30,-40,-19,7.5,40", "-o", "r.nrrd"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err.find("aslant") != std::string::npos, n > 2) << n;
  }
  expect_failure({"isosurface", "a.adm", "--isovalue", "0", "--region", "100,130,0,1,0,1", "-o", "x.obj"},
                 {"a.adm: expected a region in", "found [100, 130]"});
}

/// The polygons of a slice cover the area of the section, and their corners have its bounding box.
TEST_F(VolumePlaces, SlicesOfVolumesAndStoresAreInSpace) {
  for (std::size_t n = 0; n < affines().size(); ++n) {
    write_ball("a.nii", affines()[n]);
    run_well({"store", "a.nii", "-o", "a.adm"});
    for (const std::vector<std::string>& plane : {std::vector<std::string>{"--plane", "z=8"},
                                                  {"--plane", "x=11"},
                                                  {"--origin", "10,-20,7", "--normal", "1,2,3"}}) {
      std::array<double, 2> areas{};
      for (const std::size_t stored : {0u, 1u}) {
        std::vector<std::string> all{"slice", stored == 1 ? "a.adm" : "a.nii"};
        all.insert(all.end(), plane.begin(), plane.end());
        const std::string json = stored == 1 ? "s.json" : "v.json";
        all.insert(all.end(), {"-o", stored == 1 ? "s.vtp" : "v.vtp", "--json", json});
        run_well(all);
        areas[stored] = read_json(json).at("area").get<double>();
      }
      EXPECT_NEAR(areas[0], areas[1], 1e-9 * areas[0]);
      if ((n == 0 || n >= 3) && plane[1] == "z=8") {
        EXPECT_NEAR(areas[0], 14.5 * 12.5, 1e-4);
      }
      EXPECT_GT(areas[0], 50) << n;
      // The values in the plane are those of the ball: the field at a corner is its depth.
      EXPECT_EQ(read("v.vtp"), read("s.vtp")) << n;
    }
    // Pictures are made for one volume only, since they take longer than all the rest.
    for (const char* input : {"a.nii", "a.adm"}) {
      if (n == 4) run_well({"slice", input, "--plane", "z=8", "-o", "s.png", "--size", "200,200"});
    }
    expect_failure({"slice", "a.nii", "--plane", "z=80", "-o", "x.png"},
                   {"a.nii: expected a plane that cuts [", "found z=80"});
  }
}

TEST_F(VolumePlaces, RestoredFilesSayWhereTheyAre) {
  const auto numbers = [](const nlohmann::json& figures) {
    std::vector<double> all;
    for (const char* key : {"spacing", "origin"}) {
      for (const auto& v : figures.at(key)) all.push_back(v.get<double>());
    }
    for (const auto& direction : figures.at("directions")) {
      for (const auto& v : direction) all.push_back(v.get<double>());
    }
    return all;
  };
  for (std::size_t n = 0; n < affines().size(); ++n) {
    write_ball("a.nii", affines()[n]);
    run_well({"store", "a.nii", "-o", "a.adm"});
    run_well({"info", "a.adm", "--json", "a.json"});
    const auto before = read_json("a.json");
    EXPECT_EQ(before.at("space"), "RAS");
    const Vec3 step = affines()[n].steps[0];
    EXPECT_NEAR(before.at("spacing")[0].get<double>(), norm(step), 1e-6);
    EXPECT_NEAR(before.at("directions")[0][1].get<double>(), step.y / norm(step), 1e-6);
    EXPECT_NEAR(before.at("origin")[2].get<double>(), affines()[n].origin.z, 1e-5);
    run_well({"info", "a.nii", "--json", "a.json"});
    EXPECT_EQ(numbers(read_json("a.json")), numbers(before)) << "of the volume itself";
    // Each format has three of the volumes.
    for (const std::string name : n % 2 == 0 ? std::vector{"b.nii", "b.nhdr", "b.mha", "b.vti"}
                                             : std::vector{"b.nii.gz", "b.nrrd", "b.mhd", "b.vti"}) {
      run_well({"restore", "a.adm", "-o", name});
      run_well({"store", name, "-o", "b.adm"});
      run_well({"info", "b.adm", "--json", "b.json"});
      auto after = read_json("b.json");
      const std::string space = name.starts_with("b.m") ? "LPS" : "RAS";
      EXPECT_EQ(after.at("space"), space) << name;
      const auto expected = numbers(before), found = numbers(after);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        // In LPS the x and y of the origin and of the directions have the opposite sign.
        const bool other = space == "LPS" && i >= 3 && i % 3 != 2;
        EXPECT_NEAR(found[i], (other ? -1 : 1) * expected[i], 1e-7 * std::max(1.0, std::abs(expected[i])))
            << name << " " << i;
      }
    }
  }
}

TEST_F(VolumePlaces, SamplesStayBitForBitAndHeadersNameTheSpace) {
  const Affine& turned = affines()[4];
  write_ball("a.nii", turned);
  run_well({"store", "a.nii", "-o", "a.adm"});
  const std::string bytes = samples(turned);
  run_well({"restore", "a.adm", "-o", "b.nii"});
  EXPECT_EQ(read("b.nii").substr(352), bytes);
  EXPECT_EQ(read("b.nii").substr(280, 48), read("a.nii").substr(280, 48)) << "the affine, bit for bit";
  run_well({"restore", "a.adm", "-o", "b.nhdr"});
  EXPECT_EQ(read("b.raw"), bytes);
  EXPECT_NE(read("b.nhdr").find("\nspace: right-anterior-superior\n"), std::string::npos) << read("b.nhdr");
  run_well({"restore", "a.adm", "-o", "b.mhd"});
  EXPECT_EQ(read("b.raw"), bytes);
  // The axis (0.3, 0.4, 0) in RAS leads mainly from the back to the front, and also from the left.
  EXPECT_NE(read("b.mhd").find("\nAnatomicalOrientation = PLI\n"), std::string::npos) << read("b.mhd");
  EXPECT_EQ(run({"restore", "a.adm", "-o", "b.nii.gz"}).status, 0);
  EXPECT_EQ(run({"restore", "a.adm", "-o", "c.nii.gz"}).status, 0);
  EXPECT_EQ(read("b.nii.gz"), read("c.nii.gz"));
  const RunResult bare = run({"restore", "a.adm", "-o", "d.raw"});
  EXPECT_NE(bare.err.find("d.raw: axes, origin and space of the volume are not kept"), std::string::npos);
  EXPECT_EQ(read("d.raw"), bytes);
}

TEST_F(VolumePlaces, TheSameFilesForInfoSliceAndStore) {
  const std::vector<std::string> about{"--dimensions", "30,26,34",    "--type",         "float32",
                                       "--spacing",    "0.5,0.5,0.4", "--first-sample", "1,2,3"};
  write("a.raw", samples(affines()[0]));
  const auto with = [&](std::vector<std::string> all) {
    all.insert(all.end(), about.begin(), about.end());
    return all;
  };
  run_well(with({"store", "a.raw", "-o", "a.adm"}));
  run_well(with({"info", "a.raw", "--json", "i.json"}));
  EXPECT_EQ(read_json("i.json").at("nodes"), nlohmann::json({30, 26, 34}));
  const std::array<double, 6> box{1, 15.5, 2, 14.5, 3, 16.2};
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(read_json("i.json").at("box")[i].get<double>(), box[i], 1e-9);
  EXPECT_NEAR(read_json("i.json").at("arrays")[0].at("max").get<double>(), kRadius, 0.5);
  run_well(with({"slice", "a.raw", "--plane", "z=8", "-o", "a.vtp"}));
  run_well({"slice", "a.adm", "--plane", "z=8", "-o", "b.vtp"});
  EXPECT_EQ(read("a.vtp"), read("b.vtp"));
  expect_failure(with({"slice", "a.raw", "--labels", "a.raw", "--cells", "--plane", "z=8", "-o", "x.png"}),
                 {"a.raw: labels 'a': expected whole numbers"});
  expect_wrong_usage({"slice", "a.adm", "--plane", "z=8", "--type", "uint8", "-o", "x.png"},
                     {"--type: expected a volume as INPUT, found a.adm"});
  expect_wrong_usage(with({"info", "a.raw", "--cells"}), {"--dimensions and --cells: expected one of them"});
  // The file has several times, of which one is chosen.
  write_ball("t.nii", affines()[0]);
  std::string times = read("t.nii");
  times.replace(40, 2, raw(std::int16_t{4}));
  times.replace(48, 2, raw(std::int16_t{2}));
  write("t.nii", times + std::string(times.size() - 352, '\0'));
  for (const char* command : {"info", "store", "slice"}) {
    const auto at = [&](const char* time) {
      std::vector<std::string> all{command, "t.nii", "--time", time, "--json", "t.json"};
      if (all[0] == "store") all.insert(all.end(), {"-o", "t.adm"});
      if (all[0] == "slice") all.insert(all.end(), {"--plane", "z=8", "-o", "t.vtp"});
      return all;
    };
    run_well(at("0"));
    run_well(at("1"));
    expect_failure(at("2"), {"t.nii: expected a time from 0 to 1, found 2"});
    auto none = at("0");
    none.erase(none.begin() + 2, none.begin() + 4);
    // Without --time, store takes all times, and info prints their number.
    if (none[0] == "slice")
      expect_failure(none, {"t.nii: expected one time, or which of them by --time (0 to 1), found 2 times"});
  }
  run_well({"info", "t.nii", "--time", "1", "--json", "t.json"});
  EXPECT_EQ(read_json("t.json").at("arrays")[0].at("max"), 0.0);
  run_well({"info", "t.adm", "--json", "t.json"});
  EXPECT_EQ(read_json("t.json").at("max"), 0.0);
  // The axes of this VTK image are oblique.
  write_ball("v.nii", affines()[4]);
  run_well({"store", "v.nii", "-o", "v.adm"});
  EXPECT_EQ(run({"restore", "v.adm", "-o", "v.vti"}).status, 0);
  run_well({"slice", "v.vti", "--plane", "z=8", "-o", "a.vtp", "--json", "a.json"});
  run_well({"slice", "v.vti", "--plane", "z=8", "--field", "samples", "-o", "b.vtp"});
  EXPECT_EQ(read("a.vtp"), read("b.vtp"));
  EXPECT_NEAR(read_json("a.json").at("area").get<double>(), 14.5 * 12.5, 1e-4);
  // Plain scalars of any grid can be shown, also on cells, and vectors by a component.
  make_scene("sphere", 6);
  write("s.vtk",
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 3\nORIGIN 0 0 0\n"
        "SPACING 1 1 1\nCELL_DATA 8\nSCALARS depth float 1\nLOOKUP_TABLE default\n"
        "1 0 1 0 1 0 1 0\nVECTORS speed float\n1 2 3 2 3 4 3 4 5 4 5 6 5 6 7 6 7 8 7 8 9 8 9 0\n");
  run_well({"slice", "s.vtk", "--plane", "x=0.5", "-o", "s.png", "--json", "s.json"});
  EXPECT_EQ(read_json("s.json").at("area"), 4.0);
  run_well({"slice", "s.vtk", "--plane", "x=0.5", "--field", "speed:y", "-o", "v.png"});
  EXPECT_FALSE(read("s.png") == read("v.png"));
}

/// Triangles that the sides of a region cut away do not count.
TEST_F(VolumePlaces, BudgetsAreUsedInRegionsOfAslantVolumes) {
  for (const std::size_t n : {0u, 4u}) {
    write_ball("a.nii", affines()[n]);
    run_well({"store", "a.nii", "-o", "a.adm"});
    run_well({"isosurface", "a.adm", "--isovalue", "0", "--region", "10,30,-40,-19,7.5,40", "--max-triangles",
              "300", "-o", "a.obj", "--json", "a.json"});
    const std::size_t found = read_obj("a.obj").triangles.size();
    EXPECT_LE(found, 300u) << n;
    EXPECT_GE(found, 298u) << n;
  }
}

}  // namespace

}  // namespace adamas::test
