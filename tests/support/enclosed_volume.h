#ifndef BCCSKEL_TESTS_SUPPORT_ENCLOSED_VOLUME_H_
#define BCCSKEL_TESTS_SUPPORT_ENCLOSED_VOLUME_H_

namespace bccskel::test {

// The volume that the triangles of a closed mesh enclose; negative if they face inward.
template <typename Mesh>
double EnclosedBy(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_ENCLOSED_VOLUME_H_
