#include "tests/support/reference_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/lattice/directions.h"

namespace bccskel::test {
namespace {

uint32_t StepCounts(Direction d) { return d.is_diagonal() ? kReferenceDiagonal : kReferenceAxial; }

enum class Scan { kForward, kBackward };

// The distance of p by way of its neighbors that the scan has already seen.
uint32_t Relaxed(const ReferencePointSet& object, const std::vector<uint32_t>& counts,
                 LatticePoint p, Scan scan) {
  uint32_t best = counts[object.Index(p)];
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const LatticePoint q = p + Direction(bit).offset();
    if ((q < p) != (scan == Scan::kForward)) continue;
    best = std::min(best, counts[object.Index(q)] + StepCounts(Direction(bit)));
  }
  return best;
}

}  // namespace

std::vector<uint32_t> ReferenceChamfer(const ReferencePointSet& object) {
  std::vector<uint32_t> counts(object.box_size(), 0);
  const std::vector<LatticePoint> points = object.SortedPoints();
  for (LatticePoint p : points) {
    counts[object.Index(p)] = std::numeric_limits<uint32_t>::max() / 2;
  }
  for (LatticePoint p : points) {
    counts[object.Index(p)] = Relaxed(object, counts, p, Scan::kForward);
  }
  for (auto p = points.rbegin(); p != points.rend(); ++p) {
    counts[object.Index(*p)] = Relaxed(object, counts, *p, Scan::kBackward);
  }
  return counts;
}

uint32_t ReferenceChamferBetween(LatticePoint a, LatticePoint b) {
  const LatticePoint d = b - a;
  const int reach = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  uint32_t best = std::numeric_limits<uint32_t>::max();
  // n diagonal steps reach exactly the offsets of their parity with no coordinate beyond n.
  for (int n = 0; n <= reach; ++n) {
    if (((n ^ d.x) & 1) != 0) continue;
    int axial = 0;
    for (int c : {d.x, d.y, d.z}) axial += std::max(0, std::abs(c) - n) / 2;
    best = std::min(best, static_cast<uint32_t>(n) * kReferenceDiagonal +
                              static_cast<uint32_t>(axial) * kReferenceAxial);
  }
  return best;
}

int32_t ReferenceShell(uint32_t counts, double shell_width) {
  const double lattice_units = 2.0 * counts / kReferenceAxial;
  return std::max(1, static_cast<int32_t>(std::floor(lattice_units / shell_width + 0.5)));
}

}  // namespace bccskel::test
