#include <gtest/gtest.h>
#include <silo.h>

#include <array>
#include <cmath>
#include <random>

#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of;
using test::error_of;
using test::put_bytes;
using test::says;
using test::Scratch;

/// A quadrilateral mesh of 4 x 3 x 2 zones at x0, with two materials: "steel" has the first column and a part
/// of the second one, which is mixed, and "air" the rest; and a density that both have for themselves.
void write_block(DBfile* file, double x0, bool curvilinear) {
  constexpr std::array<int, 3> kNodes{5, 4, 3}, kZones{4, 3, 2};
  // Silo keeps the order of what it wrote before.
  int order = DB_ROWMAJOR;
  DBoptlist* const options = DBMakeOptlist(2);
  DBAddOption(options, DBOPT_MAJORORDER, &order);
  std::vector<double> x, y, z;
  for (int k = 0; k < kNodes[2]; ++k) {
    for (int j = 0; j < kNodes[1]; ++j) {
      for (int i = 0; i < kNodes[0]; ++i) {
        if (!curvilinear && (j > 0 || k > 0)) continue;
        x.push_back(x0 + i);
      }
    }
  }
  for (int k = 0; k < (curvilinear ? kNodes[2] : 1); ++k) {
    for (int j = 0; j < kNodes[1]; ++j) {
      for (int i = 0; i < (curvilinear ? kNodes[0] : 1); ++i) y.push_back(j);
    }
  }
  for (int k = 0; k < kNodes[2]; ++k) {
    for (int j = 0; j < (curvilinear ? kNodes[1] : 1); ++j) {
      for (int i = 0; i < (curvilinear ? kNodes[0] : 1); ++i) z.push_back(k);
    }
  }
  const std::array<void*, 3> coordinates{x.data(), y.data(), z.data()};
  const std::array<const char*, 3> names{"x", "y", "z"};
  ASSERT_EQ(DBPutQuadmesh(file, "mesh", names.data(), coordinates.data(), kNodes.data(), 3, DB_DOUBLE,
                          curvilinear ? DB_NONCOLLINEAR : DB_COLLINEAR, options),
            0);
  std::vector<int> list, next, material, zones;
  std::vector<double> fractions, density, mixed;
  for (int zone = 0; zone < 24; ++zone) {
    const int column = zone % kZones[0];
    density.push_back(column == 0 ? 7 : 1);
    if (column != 1) {
      list.push_back(column == 0 ? 10 : 20);
      continue;
    }
    list.push_back(-static_cast<int>(material.size() + 1));
    for (const int m : {10, 20}) {
      material.push_back(m);
      fractions.push_back(m == 10 ? 0.25 : 0.75);
      mixed.push_back(m == 10 ? 7 : 1);
      zones.push_back(zone);
      next.push_back(m == 10 ? static_cast<int>(material.size()) + 1 : 0);
    }
  }
  const std::array<int, 2> numbers{10, 20};
  std::array<const char*, 2> materials{"steel", "air"};
  DBAddOption(options, DBOPT_MATNAMES, materials.data());
  ASSERT_EQ(DBPutMaterial(file, "materials", "mesh", 2, numbers.data(), list.data(), kZones.data(), 3,
                          next.data(), material.data(), zones.data(), fractions.data(),
                          static_cast<int>(material.size()), DB_DOUBLE, options),
            0);
  ASSERT_EQ(DBPutQuadvar1(file, "density", "mesh", density.data(), kZones.data(), 3, mixed.data(),
                          static_cast<int>(mixed.size()), DB_DOUBLE, DB_ZONECENT, options),
            0);
  std::vector<double> temperature;
  for (int k = 0; k < kNodes[2]; ++k) {
    for (int j = 0; j < kNodes[1]; ++j) {
      for (int i = 0; i < kNodes[0]; ++i) temperature.push_back(x0 + i + 10 * j + 100 * k);
    }
  }
  ASSERT_EQ(DBPutQuadvar1(file, "temperature", "mesh", temperature.data(), kNodes.data(), 3, nullptr, 0,
                          DB_DOUBLE, DB_NODECENT, options),
            0);
  DBFreeOptlist(options);
}

DBfile* create(const std::filesystem::path& path, int driver) {
  DBfile* const file = DBCreate(path.c_str(), DB_CLOBBER, DB_LOCAL, "test", driver);
  EXPECT_NE(file, nullptr);
  return file;
}

/// Checks one or two blocks: of 24 zones each, 6 are steel and 6 steel by a quarter.
void expect_blocks(const MeshData& data, double blocks) {
  ASSERT_EQ(data.materials.size(), 2u);
  const auto of = [&](const char* name) {
    return MaterialId(
        static_cast<std::size_t>(std::ranges::find(data.materials, name) - data.materials.begin()));
  };
  const IdVector<MaterialId, double> volumes = data.volumes();
  EXPECT_NEAR(volumes[of("steel")], 7.5 * blocks, 1e-6);
  EXPECT_NEAR(volumes[of("air")], 16.5 * blocks, 1e-6);
  EXPECT_TRUE(data.mesh.fills_box());
  ASSERT_EQ(data.fields.size(), 2u);
  const MeshField& density = data.fields[0];
  EXPECT_EQ(density.name, "density");
  ASSERT_TRUE(density.per_material());
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    if (data.fraction(of("steel"), c) > 0) {
      EXPECT_EQ(density.material_values[of("steel")][c], 7);
    }
    if (data.fraction(of("air"), c) > 0) {
      EXPECT_EQ(density.material_values[of("air")][c], 1);
    }
  }
  const MeshField& temperature = data.fields[1];
  EXPECT_EQ(temperature.centering, Centering::kPoints);
  for (std::size_t p = 0; p < data.mesh.points().size(); ++p) {
    const Vec3& at = data.mesh.points()[p];
    EXPECT_EQ(temperature.values[p], at.x + 10 * at.y + 100 * at.z);
  }
}

TEST(Silo, MixedZonesAndVariablesOfBothFormsOfFiles) {
  const Scratch scratch;
  for (const int driver : {DB_PDB, DB_HDF5}) {
    for (const bool curvilinear : {false, true}) {
      DBfile* const file = create(scratch / "a.silo", driver);
      write_block(file, 0, curvilinear);
      DBClose(file);
      expect_blocks(read_mesh_data(scratch / "a.silo"), 1);
    }
  }
  std::filesystem::copy_file(scratch / "a.silo", scratch / "a.h5");
  EXPECT_TRUE(is_mesh_by_header(scratch / "a.h5"));
  expect_blocks(read_mesh_data(scratch / "a.h5"), 1);
}

TEST(Silo, ObjectsOfOtherKindsAreNamed) {
  const Scratch scratch;
  DBfile* const file = create(scratch / "a.silo", DB_HDF5);
  write_block(file, 0, false);
  std::array<double, 2> x{1, 2}, y{3, 4}, z{5, 6};
  std::array<void*, 3> places{x.data(), y.data(), z.data()};
  DBPutPointmesh(file, "tracers", 3, places.data(), 2, DB_DOUBLE, nullptr);
  DBPutCurve(file, "history", x.data(), y.data(), DB_DOUBLE, 2, nullptr);
  DBClose(file);
  EXPECT_EQ(read_mesh_file(scratch / "a.silo").remark,
            "meshes of points not read: 'tracers'; curves not read: 'history'");
}

/// A mesh whose last index is the fastest has the same cells and values.
TEST(Silo, OrdersOfArrays) {
  const Scratch scratch;
  constexpr std::array<int, 3> kNodes{3, 4, 5}, kZones{2, 3, 4};
  for (const int driver : {DB_PDB, DB_HDF5}) {
    for (const int order : {DB_ROWMAJOR, DB_COLMAJOR}) {
      const auto fill = [&](const std::array<int, 3>& n, const auto& value) {
        std::vector<double> result;
        const bool first_is_fastest = order == DB_ROWMAJOR;
        const auto [a, b, c] = first_is_fastest ? std::array{n[2], n[1], n[0]} : n;
        for (int i = 0; i < a; ++i) {
          for (int j = 0; j < b; ++j) {
            for (int k = 0; k < c; ++k) result.push_back(first_is_fastest ? value(k, j, i) : value(i, j, k));
          }
        }
        return result;
      };
      std::vector<double> x = fill(kNodes, [](int i, int, int) { return i; }),
                          y = fill(kNodes, [](int, int j, int) { return j; }),
                          z = fill(kNodes, [](int, int, int k) { return k; });
      const std::vector<double> of_zones =
          fill(kZones, [](int i, int j, int k) { return i + 10 * j + 100 * k; });
      DBfile* const file = create(scratch / "a.silo", driver);
      DBoptlist* const options = DBMakeOptlist(1);
      int stated = order;
      DBAddOption(options, DBOPT_MAJORORDER, &stated);
      const std::array<void*, 3> coordinates{x.data(), y.data(), z.data()};
      const std::array<const char*, 3> names{"x", "y", "z"};
      DBPutQuadmesh(file, "mesh", names.data(), coordinates.data(), kNodes.data(), 3, DB_DOUBLE,
                    DB_NONCOLLINEAR, options);
      DBPutQuadvar1(file, "v", "mesh", of_zones.data(), kZones.data(), 3, nullptr, 0, DB_DOUBLE, DB_ZONECENT,
                    options);
      const std::array<int, 1> numbers{1};
      const std::vector<int> list(24, 1);
      DBPutMaterial(file, "materials", "mesh", 1, numbers.data(), list.data(), kZones.data(), 3, nullptr,
                    nullptr, nullptr, nullptr, 0, DB_DOUBLE, options);
      DBFreeOptlist(options);
      DBClose(file);
      const MeshData data = read_mesh_data(scratch / "a.silo");
      ASSERT_EQ(data.mesh.cell_count(), 24u);
      EXPECT_TRUE(data.mesh.fills_box());
      ASSERT_EQ(data.fields.size(), 1u);
      for (std::size_t c = 0; c < 24; ++c) {
        const Vec3 p = data.mesh.cell_center(c) - Vec3{0.5, 0.5, 0.5};
        EXPECT_NEAR(data.fields[0].values[c], p.x + 10 * p.y + 100 * p.z, 1e-9) << driver << " " << order;
      }
    }
  }
}

TEST(Silo, BlocksInSeveralFilesBecomeOneMesh) {
  const Scratch scratch;
  for (const int n : {0, 1}) {
    DBfile* const file = create(scratch / ("block" + std::to_string(n) + ".silo"), DB_HDF5);
    write_block(file, 4 * n, n == 1);
    DBClose(file);
  }
  DBfile* const file = create(scratch / "all.silo", DB_HDF5);
  const std::array<int, 2> meshes{DB_QUAD_RECT, DB_QUAD_CURV}, variables{DB_QUADVAR, DB_QUADVAR};
  const auto names = [](const char* object) {
    return std::array<std::string, 2>{"block0.silo:" + std::string(object),
                                      "block1.silo:" + std::string(object)};
  };
  const auto put = [&](const char* object, const auto& write) {
    const std::array<std::string, 2> texts = names(object);
    const std::array<const char*, 2> pointers{texts[0].c_str(), texts[1].c_str()};
    ASSERT_EQ(write(pointers.data()), 0);
  };
  put("mesh",
      [&](const char* const* n) { return DBPutMultimesh(file, "all_mesh", 2, n, meshes.data(), nullptr); });
  put("materials", [&](const char* const* n) { return DBPutMultimat(file, "all_materials", 2, n, nullptr); });
  for (const char* variable : {"density", "temperature"})
    put(variable,
        [&](const char* const* n) { return DBPutMultivar(file, variable, 2, n, variables.data(), nullptr); });
  DBClose(file);
  expect_blocks(read_mesh_data(scratch / "all.silo"), 2);
  std::filesystem::remove(scratch / "block1.silo");
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "all.silo"); }), "expected a Silo file"));
}

TEST(Silo, FlatMeshesNeedAHeight) {
  const Scratch scratch;
  DBfile* const file = create(scratch / "a.silo", DB_PDB);
  std::array<double, 4> x{0, 1, 2, 3};
  std::array<double, 3> y{0, 1, 2};
  const std::array<void*, 2> coordinates{x.data(), y.data()};
  const std::array<const char*, 2> names{"x", "y"};
  const std::array<int, 2> nodes{4, 3}, zones{3, 2};
  DBPutQuadmesh(file, "mesh", names.data(), coordinates.data(), nodes.data(), 2, DB_DOUBLE, DB_COLLINEAR,
                nullptr);
  const std::array<int, 2> numbers{1, 2};
  const std::array<int, 6> list{1, 1, 2, 1, 2, 2};
  DBPutMaterial(file, "materials", "mesh", 2, numbers.data(), list.data(), zones.data(), 2, nullptr, nullptr,
                nullptr, nullptr, 0, DB_DOUBLE, nullptr);
  DBClose(file);
  EXPECT_TRUE(says(error_of([&] { read_mesh_data(scratch / "a.silo"); }), "pass --extrude H"));
  MaterialDataOptions options;
  options.extrude = 0.5;
  const MeshData data = read_mesh_data(scratch / "a.silo", options);
  EXPECT_NEAR(data.volumes()[MaterialId(0)], 1.5, 1e-14);
  EXPECT_NEAR(data.volumes()[MaterialId(1)], 1.5, 1e-14);
  EXPECT_TRUE(data.mesh.fills_box());
}

TEST(Silo, DamagedFilesAreAnsweredInOneLine) {
  const Scratch scratch;
  std::mt19937 random(11);
  for (const int driver : {DB_PDB, DB_HDF5}) {
    DBfile* const file = create(scratch / "a.silo", driver);
    write_block(file, 0, true);
    DBClose(file);
    const std::string whole = bytes_of(scratch / "a.silo");
    for (int n = 0; n < 100; ++n) {
      std::string damaged = whole;
      const std::size_t at = random() % whole.size();
      if (n % 2 == 0) {
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
      } else {
        damaged.resize(at);
      }
      put_bytes(scratch / "a.silo", damaged);
      try {
        read_mesh_data(scratch / "a.silo").check();
      } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_TRUE(says(message, "a.silo")) << message;
      }
    }
  }
}

/// Volumes of materials as Silo's own figures of the domains add up: the test of the data themselves, by
/// their mixed zones.
TEST(RealData, SiloFilesHaveTheVolumesOfTheirZones) {
  struct Case {
    const char* file;
    std::optional<double> height;
    std::size_t materials;
  };
  for (const auto& [file, height, materials] :
       {Case{"llnl/specmix_quad.silo", 1, 4}, Case{"llnl/poly3d.silo", {}, 3},
        Case{"conduit/curv3d.silo", {}, 3}, Case{"conduit/globe.silo", {}, 4},
        Case{"conduit/tire.silo", {}, 3}, Case{"llnl/xvers_data/multi_rect3d_v18.h5", {}, 3}}) {
    const auto path = test::shared_data(std::string("material/silo/") + file);
    if (!std::filesystem::exists(path)) GTEST_SKIP();
    MaterialDataOptions options;
    options.extrude = height;
    const MeshData data = read_mesh_data(path, options);
    EXPECT_EQ(data.materials.size(), materials) << file;
    double sum = 0, cells = 0;
    for (const double volume : data.volumes()) sum += volume;
    for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) cells += data.mesh.cell_volume(c);
    EXPECT_NEAR(sum, cells, 1e-6 * cells) << file;
  }
}

}  // namespace
}  // namespace adamas
