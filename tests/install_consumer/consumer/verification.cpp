// Has the distance of two interfaces measured by CGAL.

#include <adamas/verify.h>

#include <cstdio>

int main() {
  adamas::set_reference_program(REFERENCE_PROGRAM);

  adamas::InterfaceTriangles low;
  low.materials = {"air", "water"};
  low.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  low.triangles = {{0, 1, 2}};
  low.sides = {{0, 1}};
  adamas::InterfaceTriangles high = low;
  for (adamas::Vec3& p : high.points) p.z += 0.25;

  // The distance lies between two figures that are at most 0.001 apart.
  const adamas::CgalVerdict verdict = adamas::verify_by_cgal(low, high, 0.001);
  std::printf("%.4f to %.4f\n", verdict.lower, verdict.upper);

  return verdict.lower <= 0.25 && verdict.upper >= 0.25 && verdict.upper - verdict.lower <= 0.0011 ? 0 : 1;
}
