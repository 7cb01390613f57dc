#include "core/pruning/thin_set.h"

#include <algorithm>

#include "core/certificate/neighbor_planes.h"
#include "core/exec/stop_poll.h"

namespace bccskel {

ThinSet::ThinSet(const ThinSkeleton& skeleton, const exec::Context& context)
    : scale_(AxisScaleOf(skeleton.points.placement())) {
  const Volume& thin = skeleton.points;
  StopPoll poll(context);
  points_.Reserve(skeleton.radii.size());
  size_t n = 0;
  for (BrickIndex brick = 0; brick < thin.brick_count(); ++brick) {
    const size_t first = n;
    const BrickCoordinates at = thin.keys()[brick].coordinates();
    const NeighborPlanes planes = NeighborPlanesOf(thin, brick);
    thin.bricks()[brick].ForEachSetBit([&](int bit) {
      const int32_t birth = skeleton.births.empty() ? 0 : skeleton.births[n];
      points_.Set(PointOf(at, bit), {skeleton.radii[n], birth, NeighborsAt(bit, planes), false});
      ++n;
    });
    if (poll.Stopped(n - first)) return;
  }
}

ThinSet ThinSet::Over(const ThinSet& below) {
  ThinSet set(below.scale_);
  set.below_ = &below;
  return set;
}

std::vector<ThinSet::Change> ThinSet::TakeChanges() {
  std::vector<Change> changes;
  points_.ForEach([&](LatticePoint p, const Entry& now) {
    const Entry* before = below_->points_.Find(p);
    const bool was_there = before != nullptr, is_there = !now.gone;
    const bool same = was_there && is_there && before->neighbors == now.neighbors;
    if ((!was_there && !is_there) || (same && before->radius == now.radius)) return;
    const NeighborMask neighbors = was_there ? before->neighbors : below_->NeighborsAround(p);
    changes.push_back({p, neighbors, was_there, is_there, now.radius});
  });
  points_ = {};
  return changes;
}

bool ThinSet::Apply(std::span<const Change> changes) {
  const bool as_before = std::ranges::all_of(changes, [&](const Change& change) {
    return change.was_there == Contains(change.point) &&
           change.neighbors == NeighborsAround(change.point);
  });
  if (!as_before) return false;
  for (const Change& change : changes) {
    if (change.was_there && !change.is_there) Remove(change.point);
    if (change.was_there && change.is_there) SetRadius(change.point, change.radius);
    if (!change.was_there) Add(change.point, change.radius);
  }
  return true;
}

ThinSet::Entry& ThinSet::Own(LatticePoint p) {
  if (below_ != nullptr && points_.Find(p) == nullptr) points_.Set(p, *below_->points_.Find(p));
  return *points_.Find(p);
}

NeighborMask ThinSet::NeighborsAround(LatticePoint p) const {
  NeighborMask mask = 0;
  ForEachDirection(kAllNeighbors, [&](Direction d) {
    if (Contains(p + d.offset())) mask = With(mask, d);
  });
  return mask;
}

void ThinSet::Add(LatticePoint p, float radius) {
  const NeighborMask neighbors = NeighborsAround(p);
  points_.Set(p, {radius, 0, neighbors, false});
  ForEachDirection(neighbors, [&](Direction d) {
    NeighborMask& mask = Own(p + d.offset()).neighbors;
    mask = With(mask, d.Opposite());
  });
}

void ThinSet::Remove(LatticePoint p) {
  const NeighborMask neighbors = NeighborsOf(p);
  if (below_ == nullptr) {
    points_.Remove(p);
  } else {
    Own(p).gone = true;
  }
  ForEachDirection(neighbors, [&](Direction d) {
    NeighborMask& mask = Own(p + d.offset()).neighbors;
    mask = Without(mask, d.Opposite());
  });
}

std::vector<LatticePoint> ThinSet::Ends() const {
  std::vector<LatticePoint> ends;
  points_.ForEach([&](LatticePoint p, const Entry& entry) {
    if (IsEndPoint(entry.neighbors)) ends.push_back(p);
  });
  std::ranges::sort(ends);
  return ends;
}

ThinSkeleton ThinSet::ToSkeleton(const ThinSkeleton& like) const {
  VolumeBuilder builder(like.points.extent(), like.points.placement());
  ForEachPoint([&](LatticePoint p) { builder.Add(p); });
  ThinSkeleton skeleton{*std::move(builder).Build(), {}};
  skeleton.radii.reserve(points_.size());
  skeleton.points.ForEachPoint([&](LatticePoint p) { skeleton.radii.push_back(RadiusOf(p)); });
  if (like.births.empty()) return skeleton;
  PointTable<int32_t> births;
  size_t n = 0;
  like.points.ForEachPoint([&](LatticePoint p) { births.Set(p, like.births[n++]); });
  skeleton.points.ForEachPoint([&](LatticePoint p) {
    const int32_t* birth = births.Find(p);
    skeleton.births.push_back(birth != nullptr ? *birth : 0);
  });
  return skeleton;
}

}  // namespace bccskel
