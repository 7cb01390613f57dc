#include "core/prepare/join_gaps.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/certificate/component_sets.h"
#include "core/distance/places.h"
#include "core/exec/status_macros.h"
#include "core/exec/stop_poll.h"
#include "core/exec/union_find.h"
#include "core/lattice/directions.h"
#include "core/lattice/lattice_point_hash.h"
#include "core/prepare/brick_sets.h"

namespace bccskel {
namespace {

constexpr uint64_t kBytesPerItem = 96;       // in a hash table or a queue
constexpr uint64_t kItemsAtOnce = 1u << 16;  // for which memory is taken
constexpr double kLeastProgress = 0.5;       // of a step toward the end, in its length

// Two points of different components.
struct Bridge {
  double length = 0;
  LatticePoint from, to;

  friend auto operator<=>(const Bridge& a, const Bridge& b) {
    return std::tie(a.length, a.from, a.to) <=> std::tie(b.length, b.from, b.to);
  }
};

class GapJoiner {
 public:
  GapJoiner(const Volume& object, double gap, exec::MemoryBudget& memory,
            const exec::Context& context)
      : object_(object),
        gap_(gap),
        memory_(memory),
        context_(context),
        scale_(AxisScaleOf(object.placement())),
        names_(object, Phase::kObject, context),
        joined_(names_.name_limit()),
        left_(names_.count()) {}

  absl::StatusOr<ChangedVolume> Run() {
    BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    if (names_.count() <= 1) return ChangedVolume{object_};
    BCCSKEL_RETURN_IF_ERROR(Start());
    BCCSKEL_RETURN_IF_ERROR(Grow());
    return Build();
  }

 private:
  // How a background point is reached from the nearest point found.
  struct Reached {
    LatticePoint source;
    size_t component = 0;
    double distance = 0;
  };
  // A background point that the component of `source` reaches.
  using Visit = std::tuple<double, LatticePoint, LatticePoint>;  // distance, point, source
  using Components = std::pair<size_t, size_t>;                  // in the order of their names
  using Found = std::pair<Bridge, Components>;

  double Between(LatticePoint a, LatticePoint b) const { return StraightDistance(a, b, scale_); }

  size_t ComponentOf(LatticePoint p) { return names_.ComponentOf(object_, p); }

  absl::Status Start() {
    StopPoll poll(context_);
    std::vector<std::pair<uint64_t, size_t>> sizes(names_.name_limit());  // and first points
    size_t order = sizes.size();
    object_.ForEachPoint([&](LatticePoint p) {
      if (poll.Stopped()) return;
      auto& [size, first] = sizes[ComponentOf(p)];
      if (size++ == 0) first = order--;
    });
    largest_ = static_cast<size_t>(std::ranges::max_element(sizes) - sizes.begin());
    absl::Status paid;
    object_.ForEachPoint([&](LatticePoint p) {
      if (poll.Stopped() || !paid.ok()) return;
      const size_t component = ComponentOf(p);
      if (component == largest_) return;
      Reach(p, p, component);
      paid = Pay();
    });
    BCCSKEL_RETURN_IF_ERROR(paid);
    return context_.StopStatus();
  }

  // Takes the memory of what was stored since the last call.
  absl::Status Pay() {
    const size_t stored = reached_.size() + visits_.size() + shortest_.size() + bridges_.size();
    for (; paid_ < stored; paid_ += kItemsAtOnce) {
      BCCSKEL_RETURN_IF_ERROR(
          memory_.TakeFor(kItemsAtOnce, kBytesPerItem, "points around components"));
    }
    return absl::OkStatus();
  }

  // Passes on from a point that the source's component reaches to its neighbors.
  void Reach(LatticePoint from, LatticePoint source, size_t component) {
    const double from_source = Between(source, from);
    for (LatticePoint offset : kDirections14) {
      const LatticePoint to = from + offset;
      const double distance = Between(source, to);
      if (distance > gap_ || distance <= from_source) continue;
      if (object_.Contains(to)) {
        const size_t other = ComponentOf(to);
        if (other != component) Meet(source, component, to, other);
        continue;
      }
      const auto [found, is_new] = reached_.try_emplace(to, Reached{source, component, distance});
      if (!is_new) {
        Reached& other = found->second;
        if (other.component != component) Meet(source, component, other.source, other.component);
        if (other.distance <= distance) continue;
        other = {source, component, distance};
      }
      visits_.emplace(distance, to, source);
    }
  }

  void Meet(LatticePoint a, size_t of_a, LatticePoint b, size_t of_b) {
    const Bridge bridge = {Between(a, b), std::min(a, b), std::max(a, b)};
    if (bridge.length > gap_) return;
    const Components pair = std::minmax({of_a, of_b});
    const auto [best, is_new] = shortest_.try_emplace(pair, bridge);
    if (!is_new && !(bridge < best->second)) return;
    best->second = bridge;
    bridges_.emplace(bridge, pair);
  }

  absl::Status Grow() {
    StopPoll poll(context_);
    while (!visits_.empty() && left_ > 1) {
      if (poll.Stopped()) return context_.StopStatus();
      const auto [distance, point, source] = visits_.top();
      visits_.pop();
      // Bridges not found yet are no shorter than this.
      JoinUpTo(distance);
      const Reached reached = reached_.at(point);
      if (reached.source != source) continue;  // a nearer one reached it since
      // The others grow toward what is joined to the largest.
      if (joined_.Find(reached.component) == joined_.Find(largest_)) continue;
      Reach(point, source, reached.component);
      BCCSKEL_RETURN_IF_ERROR(Pay());
    }
    JoinUpTo(gap_);
    return absl::OkStatus();
  }

  // Names depend on threads, but no two bridges have the same points.
  void JoinUpTo(double length) {
    for (; !bridges_.empty() && bridges_.top().first.length <= length; bridges_.pop()) {
      const auto& [bridge, pair] = bridges_.top();
      if (!joined_.Unite(pair.first, pair.second)) continue;
      built_.push_back(bridge);
      --left_;
    }
  }

  absl::StatusOr<ChangedVolume> Build() const {
    VolumeBuilder added(object_.extent(), object_.placement());
    for (const Bridge& bridge : built_) Draw(bridge, added);
    BCCSKEL_ASSIGN_OR_RETURN(const Volume points, std::move(added).Build());
    ChangedVolume result = {Union(object_, points), built_.size()};
    result.points_added = result.object.PointCount() - object_.PointCount();
    return result;
  }

  void Draw(const Bridge& bridge, VolumeBuilder& added) const {
    for (LatticePoint at = bridge.from; at != bridge.to; at = NextOf(bridge, at)) added.Add(at);
  }

  // The neighbor nearest to the straight line, of those that lead on; the one nearest to the end
  // where none leads on far enough, as in long cells.
  LatticePoint NextOf(const Bridge& bridge, LatticePoint at) const {
    const Coordinates line = WayBetween(bridge.from, bridge.to, scale_);
    std::tuple<bool, double, LatticePoint> best(true, std::numeric_limits<double>::infinity(), at);
    for (LatticePoint offset : kDirections14) {
      const LatticePoint next = at + offset;
      if (next == bridge.to) return next;
      if (!object_.extent().Contains(next)) continue;
      const double left = Between(next, bridge.to);
      const bool is_slow = Between(at, bridge.to) - left < kLeastProgress * Between(at, next);
      const Coordinates aside = Cross(line, WayBetween(next, bridge.to, scale_));
      best = std::min(best, {is_slow, is_slow ? left : Dot(aside, aside), next});
    }
    return std::get<LatticePoint>(best);
  }

  const Volume& object_;
  const double gap_;
  exec::MemoryBudget& memory_;
  const exec::Context& context_;
  const AxisScale scale_;
  ComponentSets names_;
  UnionFind<size_t> joined_;
  int64_t left_;  // sets in joined_
  size_t largest_ = 0;
  std::priority_queue<Visit, std::vector<Visit>, std::greater<>> visits_;
  std::unordered_map<LatticePoint, Reached, LatticePointHash> reached_;  // background points
  std::map<Components, Bridge> shortest_;
  std::priority_queue<Found, std::vector<Found>, std::greater<>> bridges_;
  std::vector<Bridge> built_;
  uint64_t paid_ = 0;  // items for which memory is taken
};

}  // namespace

absl::StatusOr<ChangedVolume> JoinGaps(const Volume& object, double gap, exec::MemoryBudget& memory,
                                       const exec::Context& context) {
  if (object.empty()) return ChangedVolume{object};
  exec::MemoryShare share(memory);
  return GapJoiner(object, gap, share, context).Run();
}

}  // namespace bccskel
