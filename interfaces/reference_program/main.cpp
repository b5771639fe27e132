// The separate program for tasks that need libraries under the GPL and the AGPL. It reads a request from
// standard input and writes the reply to standard output. It meshes with TetGen or CGAL's Mesh_3,
// triangulates planes with CGAL's Triangulation_2, and measures distances between interfaces with CGAL's
// Polygon Mesh Processing. It is a separate process also because the libraries end their process on some
// faulty input. It never has sanitizers, which do not work with limits of memory.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "interfaces/reference_program/answers.h"

namespace {

using adamas::interfaces::DistanceReply;
using adamas::interfaces::DistanceRequest;
using adamas::interfaces::MesherKind;
using adamas::interfaces::MesherReply;
using adamas::interfaces::MesherRequest;
using adamas::interfaces::PlanarReply;
using adamas::interfaces::PlanarRequest;

std::vector<char> read_all(int descriptor) {
  std::vector<char> bytes;
  std::vector<char> buffer(1 << 20);
  for (ssize_t size = 0; (size = ::read(descriptor, buffer.data(), buffer.size())) > 0;)
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + size);
  return bytes;
}

bool write_all(int descriptor, const std::vector<char>& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t size = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (size <= 0) return false;
    done += static_cast<std::size_t>(size);
  }
  return true;
}

bool is_sound(const adamas::interfaces::LabelImage& image) {
  std::size_t boxes = 1;
  for (const auto* walls : {&image.walls_x, &image.walls_y, &image.walls_z}) {
    if (walls->size() < 2 || !std::is_sorted(walls->begin(), walls->end())) return false;
    boxes *= walls->size() - 1;
  }
  return image.labels.size() == boxes;
}

bool is_sound(const MesherRequest& request) {
  if (request.kind == MesherKind::kMesh3Labels && !is_sound(request.image)) return false;
  if (request.triangle_patches.size() != request.triangles.size()) return false;
  for (const auto& triangle : request.triangles) {
    for (const std::uint32_t point : triangle) {
      if (point >= request.points.size()) return false;
    }
  }
  for (const std::uint32_t patch : request.triangle_patches) {
    if (patch >= request.patch_regions.size()) return false;
  }
  return request.points.size() < (1u << 30) && request.triangles.size() < (1u << 30);
}

bool is_sound(const PlanarRequest& request) {
  const auto ends_fit = [](const std::vector<std::uint32_t>& ends, std::size_t count) {
    return !ends.empty() && std::is_sorted(ends.begin(), ends.end()) && ends.back() == count;
  };
  return request.point_ends.size() == request.segment_ends.size() &&
         ends_fit(request.point_ends, request.points.size()) &&
         ends_fit(request.segment_ends, request.segments.size());
}

bool is_sound(const DistanceRequest& request) {
  for (const DistanceRequest::Triangles& set : request.sets) {
    for (const auto& triangle : set.triangles) {
      if (std::max({triangle[0], triangle[1], triangle[2]}) >= set.points.size()) return false;
    }
  }
  return request.bound > 0;
}

MesherReply answer(const MesherRequest& request) {
  switch (request.kind) {
    case MesherKind::kMesh3:
      return adamas::interfaces::reference::run_mesh3(request);
    case MesherKind::kMesh3Labels:
      return adamas::interfaces::reference::run_mesh3_labels(request);
    default:
      return adamas::interfaces::reference::run_tetgen(request);
  }
}

PlanarReply answer(const PlanarRequest& request) {
  return adamas::interfaces::reference::triangulate_planes(request);
}

DistanceReply answer(const DistanceRequest& request) {
  return adamas::interfaces::reference::bracket_distance(request);
}

int refuse() {
  std::fputs("adamas-reference: expected a request of adamas, found something else\n", stderr);
  return 2;
}

/// Returns the greatest resident memory of this program alone. (The figure of getrusage is never below its
/// parent's.)
std::uint64_t peak_memory_bytes() {
  std::uint64_t kibibytes = 0;
  std::FILE* file = std::fopen("/proc/self/status", "r");
  if (file == nullptr) return 0;
  char line[256];
  while (std::fgets(line, sizeof line, file) != nullptr) {
    if (std::strncmp(line, "VmHWM:", 6) == 0) kibibytes = std::strtoull(line + 6, nullptr, 10);
  }
  std::fclose(file);
  return 1024 * kibibytes;
}

/// Writes the reply to a request; returns the program's status.
template <class Reply, class Request>
int serve(std::vector<char> bytes, int reply_descriptor) {
  const auto request = adamas::interfaces::decode<Request>(std::move(bytes));
  if (!request || !is_sound(*request)) return refuse();
  Reply reply;
  try {
    reply = answer(*request);
  } catch (const std::bad_alloc&) {
    reply.failure = std::is_same_v<Reply, MesherReply> ? "the mesher ran out of memory" : "ran out of memory";
  } catch (const std::exception& error) {
    reply.failure = error.what();
  }
  if constexpr (std::is_same_v<Reply, MesherReply>) reply.peak_memory_bytes = peak_memory_bytes();
  return write_all(reply_descriptor, encode(reply)) ? 0 : 1;
}

}  // namespace

int main() {
  // Libraries may print to standard output, so the reply has its own descriptor.
  const int reply_descriptor = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  std::vector<char> bytes = read_all(STDIN_FILENO);
  if (adamas::interfaces::is_message<PlanarRequest>(bytes))
    return serve<PlanarReply, PlanarRequest>(std::move(bytes), reply_descriptor);
  if (adamas::interfaces::is_message<DistanceRequest>(bytes))
    return serve<DistanceReply, DistanceRequest>(std::move(bytes), reply_descriptor);
  return serve<MesherReply, MesherRequest>(std::move(bytes), reply_descriptor);
}
