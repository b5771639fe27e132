#include <exodusII.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/base/error.h"
#include "core/base/output_file.h"
#include "core/io/solver_mesh_io.h"

namespace adamas::io {

namespace {

constexpr int kLongestName = 255;

/// An ExodusII file that is being written; every call is checked.
class ExodusFile {
 public:
  explicit ExodusFile(const std::filesystem::path& path) : file_(path) {
    ex_opts(EX_DEFAULT);  // no messages of the library's own
    int computed = sizeof(double), stored = sizeof(double);
    id_ = ex_create(file_.temporary().c_str(), EX_CLOBBER | EX_LARGE_MODEL, &computed, &stored);
    if (id_ < 0) refuse();
  }
  ~ExodusFile() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  [[nodiscard]] int id() const { return id_; }
  void check(int status) const {
    if (status < 0) refuse();
  }
  void finish() {
    const int id = std::exchange(id_, -1);
    check(ex_close(id));
    file_.commit();
  }

 private:
  [[noreturn]] void refuse() const {
    fail("{}: expected to write an ExodusII file, found that it cannot be written", file_.path().string());
  }

  OutputFile file_;
  int id_ = -1;
};

std::string short_name(const std::string& name) { return name.substr(0, kLongestName); }

/// The order of tetrahedra by block: those of a block follow each other in the file.
struct BlockOrder {
  std::vector<std::uint32_t> tetrahedra;
  std::vector<std::size_t> starts;  ///< the first place of each block, and the end

  explicit BlockOrder(const SolverMesh& mesh)
      : tetrahedra(mesh.tetrahedra.size()), starts(mesh.blocks.size() + 1) {
    for (const std::uint32_t b : mesh.block) ++starts[b + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) tetrahedra[next[mesh.block[t]]++] = t;
  }
  [[nodiscard]] std::size_t size(std::size_t block) const { return starts[block + 1] - starts[block]; }
};

void put_points(const SolverMesh& mesh, const ExodusFile& file) {
  std::array<std::vector<double>, 3> x;
  for (const Vec3& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) x[static_cast<std::size_t>(axis)].push_back(p[axis]);
  }
  file.check(ex_put_coord(file.id(), x[0].data(), x[1].data(), x[2].data()));
}

void put_blocks(const SolverMesh& mesh, const BlockOrder& order, const ExodusFile& file) {
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    if (order.size(b) == 0) continue;
    const auto number = static_cast<ex_entity_id>(b + 1);
    std::vector<int> corners;
    for (std::size_t i = order.starts[b]; i < order.starts[b + 1]; ++i) {
      for (const std::uint32_t v : mesh.tetrahedra[order.tetrahedra[i]])
        corners.push_back(static_cast<int>(v + 1));
    }
    file.check(ex_put_block(file.id(), EX_ELEM_BLOCK, number, "TETRA",
                            static_cast<std::int64_t>(order.size(b)), 4, 0, 0, 0));
    file.check(ex_put_conn(file.id(), EX_ELEM_BLOCK, number, corners.data(), nullptr, nullptr));
    file.check(ex_put_name(file.id(), EX_ELEM_BLOCK, number, short_name(mesh.blocks[b]).c_str()));
  }
}

/// Writes side sets; the sides of a tetrahedron are numbered as in the manual of ExodusII.
void put_sides(const SolverMesh& mesh, const BlockOrder& order, const ExodusFile& file) {
  constexpr std::array<int, 4> kSide{2, 3, 1, 4};  // the side opposite to each corner
  std::vector<int> place(mesh.tetrahedra.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[order.tetrahedra[i]] = static_cast<int>(i + 1);
  for (std::size_t g = 0; g < mesh.face_groups.size(); ++g) {
    const auto& group = mesh.face_groups[g];
    if (group.faces.empty()) continue;
    const auto number = static_cast<ex_entity_id>(g + 1);
    std::vector<int> elements, sides;
    for (const SolverMesh::Face& face : group.faces) {
      elements.push_back(place[face.tetrahedron]);
      sides.push_back(kSide[face.opposite]);
    }
    file.check(ex_put_set_param(file.id(), EX_SIDE_SET, number, static_cast<std::int64_t>(sides.size()), 0));
    file.check(ex_put_set(file.id(), EX_SIDE_SET, number, elements.data(), sides.data()));
    file.check(ex_put_name(file.id(), EX_SIDE_SET, number, short_name(group.name).c_str()));
  }
}

/// Names of the variables for the components of the fields.
std::vector<std::string> variable_names(const SolverMesh& mesh) {
  std::vector<std::string> names;
  for (const NamedArray& field : mesh.fields) {
    for (int k = 0; k < field.components; ++k) {
      const std::string suffix = field.components == 1   ? ""
                                 : field.components <= 3 ? std::string("_") + "xyz"[k]
                                                         : fmt::format("_{}", k + 1);
      names.push_back(short_name(field.name + suffix));
    }
  }
  return names;
}

void put_fields(const SolverMesh& mesh, const BlockOrder& order, const ExodusFile& file) {
  const std::vector<std::string> names = variable_names(mesh);
  if (names.empty()) return;
  std::vector<std::string> texts = names;
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  const int count = static_cast<int>(names.size());
  file.check(ex_put_variable_param(file.id(), EX_ELEM_BLOCK, count));
  file.check(ex_put_variable_names(file.id(), EX_ELEM_BLOCK, count, pointers.data()));
  const double time = 0;
  file.check(ex_put_time(file.id(), 1, &time));
  int variable = 0;
  for (const NamedArray& field : mesh.fields) {
    const auto& values = std::get<std::vector<double>>(field.values);
    const auto components = static_cast<std::size_t>(field.components);
    for (std::size_t k = 0; k < components; ++k) {
      ++variable;
      for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
        if (order.size(b) == 0) continue;
        std::vector<double> of_block;
        for (std::size_t i = order.starts[b]; i < order.starts[b + 1]; ++i)
          of_block.push_back(values[order.tetrahedra[i] * components + k]);
        file.check(ex_put_var(file.id(), 1, EX_ELEM_BLOCK, variable, static_cast<ex_entity_id>(b + 1),
                              static_cast<std::int64_t>(of_block.size()), of_block.data()));
      }
    }
  }
}

}  // namespace

void write_exodus(const std::filesystem::path& path, const SolverMesh& mesh) {
  if (mesh.tetrahedra.empty()) fail("{}: expected tetrahedra to write, found none", path.string());
  const BlockOrder order(mesh);
  std::int64_t blocks = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) blocks += order.size(b) > 0 ? 1 : 0;
  const auto sets = std::count_if(mesh.face_groups.begin(), mesh.face_groups.end(),
                                  [](const auto& group) { return !group.faces.empty(); });
  ExodusFile file(path);
  file.check(ex_set_max_name_length(file.id(), kLongestName));
  file.check(ex_put_init(file.id(), "adamas", 3, static_cast<std::int64_t>(mesh.points.size()),
                         static_cast<std::int64_t>(mesh.tetrahedra.size()), blocks, 0, sets));
  put_points(mesh, file);
  put_blocks(mesh, order, file);
  put_sides(mesh, order, file);
  put_fields(mesh, order, file);
  file.finish();
}

}  // namespace adamas::io
