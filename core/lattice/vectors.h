#ifndef BCCSKEL_CORE_LATTICE_VECTORS_H_
#define BCCSKEL_CORE_LATTICE_VECTORS_H_

#include <array>
#include <cmath>
#include <type_traits>

namespace bccskel {

template <typename T>
using Vector3 = std::array<T, 3>;

template <typename T>
constexpr T Dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename T>
constexpr Vector3<T> Cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <typename T>
constexpr Vector3<T> Minus(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// a + t * b.
template <typename T>
constexpr Vector3<T> Sum(const Vector3<T>& a, std::type_identity_t<T> t, const Vector3<T>& b) {
  return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}

template <typename T>
constexpr Vector3<T> Times(std::type_identity_t<T> t, const Vector3<T>& a) {
  return Sum({0, 0, 0}, t, a);
}

template <typename T>
T LengthOf(const Vector3<T>& way) {
  return std::sqrt(Dot(way, way));
}

// Normalizes a vector. Needs: its length is not 0.
template <typename T>
Vector3<T> Unit(const Vector3<T>& way) {
  return Times(1 / LengthOf(way), way);
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LATTICE_VECTORS_H_
