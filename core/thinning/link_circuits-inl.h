// What a point's 14 neighbors decide, for 512 points at once: logic circuits over the neighbor
// planes of a brick. Include it inside a Highway foreach_target source.
//
// The neighbors with their adjacency are a triangulated sphere, the link of the point: eight D8
// neighbors at the corners of a cube, six D6 neighbors over its faces, 36 edges, 24 triangles.

#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"

#if defined(BCCSKEL_CORE_THINNING_LINK_CIRCUITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BCCSKEL_CORE_THINNING_LINK_CIRCUITS_INL_H_
#undef BCCSKEL_CORE_THINNING_LINK_CIRCUITS_INL_H_
#else
#define BCCSKEL_CORE_THINNING_LINK_CIRCUITS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

// The D8 neighbors around each D6 neighbor, as a cycle; in the order of direction bits 8 to 13.
inline constexpr int kCornersOfFace[6][4] = {{1, 3, 7, 5}, {0, 2, 6, 4}, {2, 3, 7, 6},
                                             {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 1, 3, 2}};

// The neighbors around each D8 neighbor, as a cycle: D6 and D8 in turn.
struct Ring {
  int at[6];
};
constexpr Ring RingOfCorner(int v) {
  const int x = (v & 1) != 0 ? 8 : 9, y = (v & 2) != 0 ? 10 : 11, z = (v & 4) != 0 ? 12 : 13;
  return {{x, v ^ 4, y, v ^ 1, z, v ^ 2}};
}

HWY_INLINE Plane Xor(const Plane& a, const Plane& b, const Plane& c) { return Xor(Xor(a, b), c); }
HWY_INLINE Plane And(const Plane& a, const Plane& b, const Plane& c) { return And(And(a, b), c); }
HWY_INLINE Plane Or(const Plane& a, const Plane& b, const Plane& c) { return Or(Or(a, b), c); }
HWY_INLINE Plane Not(const Plane& a) {
  Plane out;
  for (size_t n = 0; n < kVectors; ++n) out.v[n] = hn::Not(a.v[n]);
  return out;
}

// At least two of three.
HWY_INLINE Plane Majority(const Plane& a, const Plane& b, const Plane& c) {
#if HWY_TARGET <= HWY_AVX3
  return {{BrickLane{_mm512_ternarylogic_epi64(a.v[0].raw, b.v[0].raw, c.v[0].raw, 0xe8)}}};
#else
  return Or(And(a, b), And(c, Or(a, b)));
#endif
}

// Counts planes by carry-save addition: bit 0 of the sum, and N / 2 planes that count twice.
template <size_t N>
HWY_INLINE Plane AddUp(const Plane (&in)[N], Plane* carries) {
  Plane sum = in[0];
  for (size_t n = 1; n + 1 < N; n += 2) {
    carries[n / 2] = Majority(sum, in[n], in[n + 1]);
    sum = Xor(sum, in[n], in[n + 1]);
  }
  if constexpr (N % 2 == 0) {
    carries[N / 2 - 1] = And(sum, in[N - 1]);
    sum = Xor(sum, in[N - 1]);
  }
  return sum;
}

// One D6 neighbor with the four D8 neighbors around it.
struct Face {
  Plane opposite_agree;  // opposite corners are alike, so they form no single arc
  Plane neighbors_differ;
};
HWY_INLINE Face FaceOf(const Plane (&link)[14], int face) {
  const int(&w)[4] = kCornersOfFace[face];
  return {Not(Or(Xor(link[w[0]], link[w[2]]), Xor(link[w[1]], link[w[3]]))),
          Xor(link[w[0]], link[w[1]])};
}

// The Euler characteristic of the object neighbors, which is b - w + 1 for b components of object
// and w of background neighbors, plus 20, as four bits modulo 16. It lies between -4 and 6.
//
// Corners less edges of the cube: along x, a + b - ab = (a or b) for each of four edges; along y
// and z, less ab for each of eight. An object point over a face adds itself, less its edges, plus
// its triangles: 1 - (arcs of object corners around it), which is 1 if all four are alike, -1 if
// opposite ones are alike and neighboring ones differ, else 0. Sums of complements avoid negative
// numbers.
struct EulerBits {
  Plane bit[4];
};
HWY_INLINE EulerBits EulerCharacteristic(const Plane (&link)[14]) {
  Plane ones[18], twos[15], fours[7], eights[3];
  for (int v = 0; v < 4; ++v) ones[v] = Or(link[2 * v], link[2 * v + 1]);
  for (int v = 0; v < 4; ++v) {
    const int y = (v & 1) | (v & 2) << 1;  // the corners with bit 1 clear, then with bit 2 clear
    ones[4 + v] = Not(And(link[y], link[y | 2]));
    ones[8 + v] = Not(And(link[v], link[v | 4]));
  }
  for (int f = 0; f < 6; ++f) {
    const Face face = FaceOf(link, f);
    ones[12 + f] = And(link[8 + f], face.opposite_agree);
    twos[9 + f] = Not(And(ones[12 + f], face.neighbors_differ));
  }
  EulerBits sum;
  sum.bit[0] = AddUp(ones, twos);
  sum.bit[1] = AddUp(twos, fours);
  sum.bit[2] = AddUp(fours, eights);
  sum.bit[3] = Xor(eights[0], eights[1], eights[2]);
  return sum;
}

// The 104 neighborhoods with two components of object and two of background neighbors, whose Euler
// characteristic is that of a simple point: rings around rings. Either a lone point over one face
// and a lone hole over the opposite one (96), or a lone corner and a lone hole in the opposite
// corner (8).
HWY_INLINE Plane RingsAroundRings(const Plane (&link)[14]) {
  Plane lone_point[6], lone_hole[6];
  for (int f = 0; f < 6; ++f) {
    const Plane& a = link[kCornersOfFace[f][0]];
    const Plane& b = link[kCornersOfFace[f][1]];
    const Plane alike = FaceOf(link, f).opposite_agree;
    lone_point[f] = AndNot(Or(a, b), And(alike, link[8 + f]));
    lone_hole[f] = And(AndNot(link[8 + f], alike), a, b);
  }
  Plane nested = None();
  for (int f = 0; f < 6; ++f) nested = Or(nested, And(lone_point[f], lone_hole[f ^ 1]));
  // Corners 1, 2, 4, 7 and 0, 3, 5, 6 are the two tetrahedra of the cube.
  const Plane odd_all = And(And(link[1], link[2]), And(link[4], link[7]));
  const Plane even_all = And(And(link[0], link[3]), And(link[5], link[6]));
  const Plane odd_some = Or(Or(link[1], link[2]), Or(link[4], link[7]));
  const Plane even_some = Or(Or(link[0], link[3]), Or(link[5], link[6]));
  const Plane differ = And(Xor(link[8], link[9]), Xor(link[10], link[11]), Xor(link[12], link[13]));
  const Plane parity = Xor(link[8], link[10], link[12]);
  const Plane odd_only = AndNot(parity, AndNot(even_some, odd_all));
  const Plane even_only = And(parity, AndNot(odd_some, even_all));
  return Or(nested, And(differ, Or(odd_only, even_only)));
}

// Condition 1: characteristic 1, and not two components of each.
HWY_INLINE Plane Simple(const Plane (&link)[14]) {
  const EulerBits sum = EulerCharacteristic(link);
  return AndNot(Or(sum.bit[1], RingsAroundRings(link)), And(sum.bit[0], sum.bit[2]));
}

// Condition 2.
HWY_INLINE Plane SeveralNeighbors(const Plane (&link)[14]) {
  Plane some = link[0], several = None();
  for (int n = 1; n < 14; ++n) {
    several = Or(several, And(some, link[n]));
    some = Or(some, link[n]);
  }
  return several;
}

// Characteristic 2 or more: several components of object neighbors; or no background at all.
HWY_INLINE Plane OneIsthmus(const Plane (&link)[14]) {
  const EulerBits sum = EulerCharacteristic(link);
  Plane all = link[0];
  for (int n = 1; n < 14; ++n) all = And(all, link[n]);
  return AndNot(all, Or(sum.bit[3], And(sum.bit[2], sum.bit[1])));
}

// Characteristic 0 or less: several components of background neighbors; or no object at all.
HWY_INLINE Plane TwoIsthmus(const Plane (&link)[14]) {
  const EulerBits sum = EulerCharacteristic(link);
  Plane some = link[0];
  for (int n = 1; n < 14; ++n) some = Or(some, link[n]);
  const Plane more = Or(sum.bit[3], And(sum.bit[2], Or(sum.bit[0], sum.bit[1])));
  return AndNot(more, some);
}

// Ends of arcs in three consecutive places of a cycle: a set one before a clear one. There is one
// at most, because the next one needs a clear place between.
HWY_INLINE Plane ArcEnd(const Plane& a, const Plane& b, const Plane& c) {
#if HWY_TARGET <= HWY_AVX3
  return {{BrickLane{_mm512_ternarylogic_epi64(a.v[0].raw, b.v[0].raw, c.v[0].raw, 0x74)}}};
#else
  return Or(AndNot(b, a), AndNot(c, b));
#endif
}

// Exactly one of three.
HWY_INLINE Plane JustOne(const Plane& a, const Plane& b, const Plane& c) {
#if HWY_TARGET <= HWY_AVX3
  return {{BrickLane{_mm512_ternarylogic_epi64(a.v[0].raw, b.v[0].raw, c.v[0].raw, 0x16)}}};
#else
  return AndNot(And(a, b, c), Xor(a, b, c));
#endif
}

// Whether the object part of a cycle of six is one arc: arcs are counted by their ends.
HWY_INLINE Plane IsOneArc(const Plane (&link)[14], const Ring& ring) {
  const auto end_after = [&](int n) HWY_ATTR {
    return ArcEnd(link[ring.at[n]], link[ring.at[n + 1]], link[ring.at[(n + 2) % 6]]);
  };
  return JustOne(end_after(0), end_after(2), end_after(4));
}

// Neighbors with which the point forms a critical pair: both in `among`, and their common neighbors
// in the object are not one arc.
HWY_INLINE void CriticalPairs(const Plane (&link)[14], const Plane (&among)[14], Plane (&out)[14]) {
  for (int v = 0; v < 8; ++v) out[v] = AndNot(IsOneArc(link, RingOfCorner(v)), among[v]);
  for (int f = 0; f < 6; ++f) out[8 + f] = And(among[8 + f], FaceOf(link, f).opposite_agree);
}

// Points with two adjacent neighbors in `among` with which they form a critical triple: of its two
// common neighbors both or neither are object points.
HWY_INLINE Plane InCriticalTriple(const Plane (&link)[14], const Plane (&among)[14]) {
  Plane critical = None();
  for (int f = 0; f < 6; ++f) {
    const int(&w)[4] = kCornersOfFace[f];
    const Plane first = AndNot(Xor(link[w[0]], link[w[2]]), Or(among[w[1]], among[w[3]]));
    const Plane second = AndNot(Xor(link[w[1]], link[w[3]]), Or(among[w[0]], among[w[2]]));
    critical = Or(critical, And(among[8 + f], Or(first, second)));
  }
  // The edges of the cube lie between two faces.
  for (int v = 0; v < 8; ++v) {
    const Ring ring = RingOfCorner(v);
    for (int n = 1; n < 6; n += 2) {
      if (ring.at[n] < v) continue;
      const Plane differ = Xor(link[ring.at[n - 1]], link[ring.at[(n + 1) % 6]]);
      critical = Or(critical, AndNot(differ, And(among[v], among[ring.at[n]])));
    }
  }
  return critical;
}

// Points with three mutually adjacent neighbors in `among`.
HWY_INLINE Plane InTetrahedron(const Plane (&among)[14]) {
  Plane any = None();
  for (int f = 0; f < 6; ++f) {
    const int(&w)[4] = kCornersOfFace[f];
    const Plane edge = And(Or(among[w[0]], among[w[2]]), Or(among[w[1]], among[w[3]]));
    any = Or(any, And(among[8 + f], edge));
  }
  return any;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
