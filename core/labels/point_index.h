#ifndef BCCSKEL_CORE_LABELS_POINT_INDEX_H_
#define BCCSKEL_CORE_LABELS_POINT_INDEX_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace bccskel {

// A place with a value.
struct ValuePoint {
  std::array<double, 3> at = {};
  uint32_t value = 0;
};

// The point nearest to a place, exactly; of several the one with the smallest value.
struct NearestCurvePoint {
  double squared = std::numeric_limits<double>::infinity();
  uint32_t value = std::numeric_limits<uint32_t>::max();
  size_t point = 0;

  void Offer(double offered_squared, uint32_t offered_value, size_t offered_point) {
    if (offered_squared > squared) return;
    if (offered_squared == squared && offered_value >= value) return;
    *this = {offered_squared, offered_value, offered_point};
  }
};

// Finds the nearest of a set of points: a k-d tree whose node is the median of its range.
// Cost: n log n to build; a query with a near hint visits a few leaves.
class PointIndex {
 public:
  explicit PointIndex(std::vector<ValuePoint> points);

  // `hint` is the position of a point that may be near, such as that of the last answer.
  // Needs: at least one point; hint < their number.
  NearestCurvePoint Find(const std::array<double, 3>& at, size_t hint) const;

 private:
  void Build(size_t begin, size_t end);
  void Search(const std::array<double, 3>& at, size_t begin, size_t end,
              const std::array<double, 3>& away, NearestCurvePoint& best) const;
  void Offer(const std::array<double, 3>& at, size_t point, NearestCurvePoint& best) const;

  std::vector<ValuePoint> points_;
  std::vector<uint8_t> axes_;  // that the node splits
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_POINT_INDEX_H_
