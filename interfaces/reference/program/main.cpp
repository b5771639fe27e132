// The separate program that meshes with TetGen or CGAL's Mesh_3: a request on standard input, the reply on
// standard output. It is a process of its own because the libraries end theirs on input that they do not
// like, and never has sanitizers, which limits of memory do not go with.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "interfaces/reference/program/meshers.h"

namespace {

using adamas::interfaces::MesherKind;
using adamas::interfaces::MesherReply;
using adamas::interfaces::MesherRequest;

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

MesherReply answer(const MesherRequest& request) {
  MesherReply reply;
  try {
    switch (request.kind) {
      case MesherKind::kMesh3:
        return adamas::interfaces::reference::run_mesh3(request);
      case MesherKind::kMesh3Labels:
        return adamas::interfaces::reference::run_mesh3_labels(request);
      default:
        return adamas::interfaces::reference::run_tetgen(request);
    }
  } catch (const std::bad_alloc&) {
    reply.failure = "the mesher ran out of memory";
  } catch (const std::exception& error) {
    reply.failure = error.what();
  }
  return reply;
}

/// Greatest resident memory of this program alone: what getrusage tells is never below what its parent had.
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

}  // namespace

int main() {
  // The libraries print where they like.
  const int reply_descriptor = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  const auto request = adamas::interfaces::decode<adamas::interfaces::MesherRequest>(read_all(STDIN_FILENO));
  if (!request || !is_sound(*request)) {
    std::fputs("adamas-reference: expected a request of adamas compare, found something else\n", stderr);
    return 2;
  }
  MesherReply reply = answer(*request);
  reply.peak_memory_bytes = peak_memory_bytes();
  return write_all(reply_descriptor, encode(reply)) ? 0 : 1;
}
