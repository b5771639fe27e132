#include "viewer/contents/mesh_maker.h"

#include <utility>

namespace adamas::viewer {

MeshMaker::MeshMaker(const Vec3& origin, Kind kind) {
  mesh_.origin = origin;
  mesh_.is_lines = kind == Kind::kLines;
}

std::uint32_t MeshMaker::add_vertex(const Vec3& place, const Vec3& normal, const Values& values) {
  mesh_.box.extend(place);
  mesh_.vertices.push_back({in_single(place - mesh_.origin), in_single(normal),
                            static_cast<float>(values.front), static_cast<float>(values.back)});
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

SharedMesh MeshMaker::finish() {
  const Kind kind = mesh_.is_lines ? Kind::kLines : Kind::kTriangles;
  DrawnMesh mesh = std::exchange(mesh_, MeshMaker(mesh_.origin, kind).mesh_);
  if (mesh.indices.empty()) return nullptr;
  return std::make_shared<const DrawnMesh>(std::move(mesh));
}

std::string counted(std::size_t count, std::string_view one, std::string_view several) {
  std::string text = std::to_string(count);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  text += ' ';
  return text.append(count == 1 ? one : several);
}

}  // namespace adamas::viewer
