// Blocks of several levels in files of Silo, which the tests write.

#include <gtest/gtest.h>
#include <silo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/io/mesh_data_reader.h"
#include "core/io/mesh_file.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace io;

namespace {

using test::error_of;
using test::says;
using test::Scratch;

/// A block of cells of one size, with its parent among the blocks (-1: none).
struct LevelBlock {
  Vec3 first;
  double size;
  std::array<int, 3> cells;
  int level, parent;
  bool is_float = false;
  int ghosts = 0;  ///< how many of its layers of cells on each side are ghosts
};

/// Where the materials part: a plane between cells of all levels.
constexpr double kParting = 0.875;

/// How the file says what its blocks are.
struct LevelOptions {
  bool tree = false, curved = false, flat = false;
};

class LevelFile {
 public:
  LevelFile(const std::filesystem::path& path, int driver, const std::vector<LevelBlock>& blocks,
            const LevelOptions& options = {})
      : file_(DBCreate(path.c_str(), DB_CLOBBER, DB_LOCAL, "test", driver)), blocks_(blocks), how_(options) {
    EXPECT_NE(file_, nullptr);
    for (std::size_t b = 0; b < blocks.size(); ++b) put_block(blocks[b], static_cast<int>(b));
    put_lists();
    if (options.tree) put_tree();
  }
  ~LevelFile() { DBClose(file_); }
  LevelFile(const LevelFile&) = delete;
  LevelFile& operator=(const LevelFile&) = delete;

 private:
  [[nodiscard]] int axes() const { return how_.flat ? 2 : 3; }

  /// Calls `use` with the index of each item of a block, x fastest.
  template <class Use>
  void for_each(const std::array<int, 3>& counts, const Use& use) const {
    for (int k = 0; k < (how_.flat ? 1 : counts[2]); ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) use(std::array{i, j, k});
      }
    }
  }

  void put_block(const LevelBlock& block, int number) {
    const std::string directory = "block" + std::to_string(number);
    DBMkDir(file_, directory.c_str());
    DBSetDir(file_, directory.c_str());
    const std::array<int, 3> nodes{block.cells[0] + 1, block.cells[1] + 1, block.cells[2] + 1};
    put_mesh(block, nodes);
    std::vector<int> materials;
    std::vector<double> of_cells, of_nodes;
    for_each(block.cells, [&](const std::array<int, 3>& at) {
      const double x = block.first.x + (at[0] + 0.5) * block.size;
      materials.push_back(x < kParting ? 1 : 2);
      of_cells.push_back(x);
    });
    for_each(nodes, [&](const std::array<int, 3>& at) {
      of_nodes.push_back(block.first.x + at[0] * block.size + 10 * (block.first.y + at[1] * block.size));
    });
    const std::array<int, 2> numbers{1, 2};
    std::array<const char*, 2> names{"left", "right"};
    int order = DB_ROWMAJOR;
    DBoptlist* const options = DBMakeOptlist(2);
    DBAddOption(options, DBOPT_MATNAMES, names.data());
    DBAddOption(options, DBOPT_MAJORORDER, &order);
    DBPutMaterial(file_, "material", "mesh", 2, numbers.data(), materials.data(), block.cells.data(), axes(),
                  nullptr, nullptr, nullptr, nullptr, 0, DB_DOUBLE, options);
    DBPutQuadvar1(file_, "x", "mesh", of_cells.data(), block.cells.data(), axes(), nullptr, 0, DB_DOUBLE,
                  DB_ZONECENT, options);
    DBPutQuadvar1(file_, "place", "mesh", of_nodes.data(), nodes.data(), axes(), nullptr, 0, DB_DOUBLE,
                  DB_NODECENT, options);
    DBFreeOptlist(options);
    DBSetDir(file_, "..");
  }

  void put_mesh(const LevelBlock& block, const std::array<int, 3>& nodes) const {
    std::array<std::vector<double>, 3> places;
    std::array<std::vector<float>, 3> floats;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      if (how_.curved) {
        for_each(nodes, [&](const std::array<int, 3>& at) {
          places[axis].push_back(block.first[a] + at[axis] * block.size);
        });
      } else {
        for (int i = 0; i < nodes[axis]; ++i) places[axis].push_back(block.first[a] + i * block.size);
      }
      floats[axis].assign(places[axis].begin(), places[axis].end());
    }
    std::array<const void*, 3> coordinates{};
    for (std::size_t a = 0; a < 3; ++a)
      coordinates[a] = block.is_float ? static_cast<const void*>(floats[a].data()) : places[a].data();
    const std::array<const char*, 3> names{"x", "y", "z"};
    std::array<int, 3> offsets{block.ghosts, block.ghosts, block.ghosts};
    DBoptlist* const options = DBMakeOptlist(2);
    DBAddOption(options, DBOPT_LO_OFFSET, offsets.data());
    DBAddOption(options, DBOPT_HI_OFFSET, offsets.data());
    DBPutQuadmesh(file_, "mesh", names.data(), coordinates.data(), nodes.data(), axes(),
                  block.is_float ? DB_FLOAT : DB_DOUBLE, how_.curved ? DB_NONCOLLINEAR : DB_COLLINEAR,
                  options);
    DBFreeOptlist(options);
  }

  void put_lists() {
    const auto count = static_cast<int>(blocks_.size());
    const auto put = [&](const char* object, const auto& write) {
      std::vector<std::string> texts;
      for (int b = 0; b < count; ++b) texts.push_back("/block" + std::to_string(b) + "/" + object);
      std::vector<const char*> names;
      for (const std::string& text : texts) names.push_back(text.c_str());
      ASSERT_EQ(write(names.data()), 0);
    };
    const std::vector<int> meshes(blocks_.size(), how_.curved ? DB_QUAD_CURV : DB_QUAD_RECT),
        variables(blocks_.size(), DB_QUADVAR);
    DBoptlist* const options = DBMakeOptlist(1);
    std::string tree = "tree";
    if (how_.tree) DBAddOption(options, DBOPT_MRGTREE_NAME, tree.data());
    put("mesh", [&](const char* const* names) {
      return DBPutMultimesh(file_, "mesh", count, names, meshes.data(), options);
    });
    DBFreeOptlist(options);
    put("material",
        [&](const char* const* names) { return DBPutMultimat(file_, "material", count, names, nullptr); });
    for (const char* variable : {"x", "place"})
      put(variable, [&](const char* const* names) {
        return DBPutMultivar(file_, variable, count, names, variables.data(), nullptr);
      });
  }

  /// Writes the tree of regions as Silo's manual has it for adaptive meshes: the patches of each level, the
  /// patches that refine each patch, and the ratios of the levels.
  void put_tree() const {
    int levels = 0;
    for (const LevelBlock& block : blocks_) levels = std::max(levels, block.level + 1);
    const auto patches = static_cast<int>(blocks_.size());
    DBmrgtree* const tree = DBMakeMrgtree(DB_MULTIMESH, 0, 1, nullptr);
    DBAddRegion(tree, "amr_decomp", 0, 2, nullptr, 0, nullptr, nullptr, nullptr, nullptr);
    DBSetCwr(tree, "amr_decomp");
    add_regions(tree, "levels", "@level%d@n", "levelMaps", levels);
    add_regions(tree, "patches", "@patch%d@n", "childMaps", patches);
    DBSetCwr(tree, "..");
    DBPutMrgtree(file_, "tree", "mesh", tree, nullptr);
    DBFreeMrgtree(tree);
    put_map("levelMaps", levels, [this](std::size_t b) { return blocks_[b].level; });
    put_map("childMaps", patches, [this](std::size_t b) { return blocks_[b].parent; });
    const std::array<const char*, 3> axis_names{"iRatio", "jRatio", "kRatio"};
    const std::array<const char*, 1> regions{"@level%d@n"};
    std::vector<int> ratios(static_cast<std::size_t>(levels), 2);
    const std::array<const void*, 3> values{ratios.data(), ratios.data(), ratios.data()};
    DBPutMrgvar(file_, "ratios", "tree", 3, axis_names.data(), levels, regions.data(), DB_INT, values.data(),
                nullptr);
  }

  static void add_regions(DBmrgtree* tree, const char* name, const char* scheme, const char* map, int count) {
    DBAddRegion(tree, name, 0, count, nullptr, 0, nullptr, nullptr, nullptr, nullptr);
    DBSetCwr(tree, name);
    const std::array<const char*, 1> names{scheme};
    const std::vector<int> zeros(static_cast<std::size_t>(count), 0);
    DBAddRegionArray(tree, count, names.data(), 0, map, 1, zeros.data(), zeros.data(), zeros.data(), nullptr);
    DBSetCwr(tree, "..");
  }

  /// Writes which blocks belong to each of `count` segments.
  template <class Segment>
  void put_map(const char* name, int count, const Segment& segment) const {
    std::vector<std::vector<int>> blocks(static_cast<std::size_t>(count));
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (segment(b) >= 0) blocks[static_cast<std::size_t>(segment(b))].push_back(static_cast<int>(b));
    }
    std::vector<int> lengths;
    std::vector<const int*> data;
    for (const std::vector<int>& own : blocks) {
      lengths.push_back(static_cast<int>(own.size()));
      data.push_back(own.data());
    }
    const std::vector<int> types(blocks.size(), DB_BLOCKCENT);
    DBPutGroupelmap(file_, name, count, types.data(), lengths.data(), nullptr, data.data(), nullptr, 0,
                    nullptr);
  }

  DBfile* file_;
  const std::vector<LevelBlock>& blocks_;
  LevelOptions how_;
};

/// A box of 2 x 1 x 1 with cells of 1/8, a part of it with cells of 1/16, and a part of that with 1/64.
std::vector<LevelBlock> three_levels() {
  return {{{0, 0, 0}, 0.125, {16, 8, 8}, 0, -1},
          {{0.25, 0.25, 0.25}, 0.0625, {16, 8, 8}, 1, 0},
          {{0.75, 0.5, 0.5}, 0.015625, {8, 8, 8}, 2, 1}};
}

/// Expects that cells are as `volume` says in all, share their faces, and have the values of their places.
void expect_levels(const MeshData& data, std::size_t cells, double left, double right) {
  EXPECT_EQ(data.mesh.cell_count(), cells);
  EXPECT_TRUE(data.mesh.fills_box());
  const IdVector<MaterialId, double> volumes = data.volumes();
  ASSERT_EQ(volumes.size(), 2u);
  EXPECT_EQ(data.materials[MaterialId(0)], "left");
  EXPECT_NEAR(volumes[MaterialId(0)], left, 1e-6);
  EXPECT_NEAR(volumes[MaterialId(1)], right, 1e-6);
  ASSERT_EQ(data.fields.size(), 2u);
  const bool place_first = data.fields[0].name == "place";
  const MeshField &place = data.fields[place_first ? 0 : 1], &x = data.fields[place_first ? 1 : 0];
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    Box3 box;
    for (const auto p : data.mesh.points_of_cell(c)) box.extend(data.mesh.points()[p]);
    EXPECT_NEAR(x.values[c], box.center().x, 1e-6);
  }
  for (std::size_t p = 0; p < data.mesh.points().size(); ++p) {
    const Vec3& at = data.mesh.points()[p];
    EXPECT_NEAR(place.values[p], at.x + 10 * at.y, 1e-5);
  }
  // A face with one cell is at the boundary of the box.
  const Box3 box = data.mesh.box();
  for (std::size_t f = 0; f < data.mesh.face_count(); ++f) {
    if (data.mesh.cells_of_face(f)[1] != PolyhedralMesh::kNone) continue;
    const Vec3 low = data.mesh.face_center(f) - box.min, high = box.max - data.mesh.face_center(f);
    EXPECT_NEAR(std::min({low.x, low.y, low.z, high.x, high.y, high.z}), 0, 1e-9);
  }
}

TEST(SiloLevels, CoveredCellsAreLeftOutWithAndWithoutATree) {
  const Scratch scratch;
  std::vector<LevelBlock> blocks = three_levels();
  for (const int driver : {DB_PDB, DB_HDF5}) {
    for (const bool tree : {false, true}) {
      { const LevelFile file(scratch / "a.silo", driver, blocks, {.tree = tree}); }
      const MeshData data = read_mesh_data(scratch / "a.silo");
      // 8 x 4 x 4 cells are covered by the second level, and 2 x 2 x 2 of that by the third.
      expect_levels(data, 1024 - 128 + 1024 - 8 + 512, kParting, 2 - kParting);
    }
  }
}

TEST(SiloLevels, OrderAndRoundingOfBlocksDoNotMatter) {
  const Scratch scratch;
  std::vector<LevelBlock> blocks = three_levels();
  std::ranges::reverse(blocks);
  for (LevelBlock& block : blocks) {
    block.first += Vec3{0, 1.0 / 3, 100.0 / 7};
    block.is_float = true;
  }
  { const LevelFile file(scratch / "a.silo", DB_HDF5, blocks); }
  expect_levels(read_mesh_data(scratch / "a.silo"), 2424, kParting, 2 - kParting);
}

/// Ghost cells of blocks, which lie in others and outside of all, are no cells of their levels.
TEST(SiloLevels, GhostCellsAreLeftOut) {
  const Scratch scratch;
  std::vector<LevelBlock> blocks = three_levels();
  for (LevelBlock& block : blocks) {
    block.first -= Vec3{block.size, block.size, block.size};
    for (int& cells : block.cells) cells += 2;
    block.ghosts = 1;
  }
  { const LevelFile file(scratch / "a.silo", DB_HDF5, blocks, {.tree = true}); }
  expect_levels(read_mesh_data(scratch / "a.silo"), 2424, kParting, 2 - kParting);
}

/// Blocks that lie side by side, of which none covers another.
TEST(SiloLevels, BlocksBesideEachOtherShareFaces) {
  const Scratch scratch;
  const std::vector<LevelBlock> blocks{{{0, 0, 0}, 0.0625, {14, 16, 16}, 1, -1},
                                       {{0.875, 0, 0}, 0.125, {9, 8, 8}, 0, -1}};
  { const LevelFile file(scratch / "a.silo", DB_HDF5, blocks); }
  expect_levels(read_mesh_data(scratch / "a.silo"), 14 * 256 + 9 * 64, kParting, 2 - kParting);
}

TEST(SiloLevels, FlatBlocks) {
  const Scratch scratch;
  const std::vector<LevelBlock> blocks = three_levels();
  { const LevelFile file(scratch / "a.silo", DB_HDF5, blocks, {.tree = true, .flat = true}); }
  MaterialDataOptions options;
  options.extrude = 0.5;
  expect_levels(read_mesh_data(scratch / "a.silo", options), 128 - 32 + 128 - 4 + 64, 0.5 * kParting,
                0.5 * (2 - kParting));
}

TEST(SiloLevels, LevelsThatDoNotFitAreRefused) {
  const Scratch scratch;
  const auto refusal = [&](const std::vector<LevelBlock>& blocks, const LevelOptions& options) {
    { const LevelFile file(scratch / "a.silo", DB_HDF5, blocks, options); }
    return error_of([&] { read_mesh_data(scratch / "a.silo"); });
  };
  std::vector<LevelBlock> blocks = three_levels();
  EXPECT_TRUE(says(refusal(blocks, {.tree = true, .curved = true}), "a.silo: expected rectilinear blocks"));
  blocks[1].size = 0.05;
  EXPECT_TRUE(says(refusal(blocks, {.tree = true}), "a.silo: expected levels of blocks whose cells refine"));
  EXPECT_TRUE(says(refusal(blocks, {}), "refine each other by a whole number"));
  blocks = three_levels();
  blocks[1].first.x += 0.02;
  EXPECT_TRUE(says(refusal(blocks, {}), "begin where others do"));
  blocks = three_levels();
  blocks[1].cells[0] = 15;
  EXPECT_TRUE(says(refusal(blocks, {}), "cover whole or not at all"));
}

TEST(SiloLevels, DamagedFilesAreAnsweredInOneLine) {
  const Scratch scratch;
  { const LevelFile file(scratch / "a.silo", DB_HDF5, three_levels(), {.tree = true}); }
  const std::string whole = test::bytes_of(scratch / "a.silo");
  std::mt19937 random(5);
  for (int n = 0; n < 40; ++n) {
    std::string damaged = whole;
    const std::size_t at = random() % whole.size();
    if (n % 4 != 0) {
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    } else {
      damaged.resize(at);
    }
    test::put_bytes(scratch / "a.silo", damaged);
    try {
      read_mesh_data(scratch / "a.silo").check();
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_TRUE(says(message, "a.silo")) << message;
    }
  }
}

}  // namespace
}  // namespace adamas
