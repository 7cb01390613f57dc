#include "core/distance/euclidean_stream.h"

#include <algorithm>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/distance/euclidean_parts.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

// Enough for several workers, few enough for the caches.
size_t BricksAtOnce(const Volume& object, size_t at_once) {
  constexpr size_t kParts = 8;
  const bool is_small = object.brick_count() * kBrickPoints <= at_once;
  return is_small ? object.brick_count() : at_once / kBrickPoints / kParts;
}

// A part of an object, with renumbered bricks.
struct Columns {
  const std::vector<BrickIndex>& bricks;  // of the object
  const Volume& volume;
  const SideRuns<uint32_t>& runs;
};

class EuclideanStream {
 public:
  EuclideanStream(const Volume& object, const exec::Context& context, SquareSink* sink,
                  KeepField keep, size_t at_once)
      : object_(object),
        context_(context),
        sink_(sink),
        may_be_whole_(AxisScaleOf(object.placement()) == kIsotropic),
        groups_(ColumnsOf(object, BricksAtX(object), BricksAtOnce(object, at_once))),
        keeps_floats_(keep == KeepField::kAlways ||
                      object.brick_count() * kBrickPoints <= kMostFloatsKept),
        has_field_(keeps_floats_ || (may_be_whole_ && !IsDeep(object))) {}

  absl::StatusOr<std::optional<DistanceField>> Run() && {
    for (const auto& bricks : groups_) most_bricks_ = std::max(most_bricks_, bricks.size());
    for (const std::vector<BrickIndex>& bricks : groups_) {
      BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
      if (groups_.size() == 1) {
        Measure({bricks, object_, SideRunsOf(object_, context_)});
      } else {
        const ObjectPart part = PartOf(object_, bricks, context_);
        Measure({bricks, part.volume, part.runs});
      }
    }
    BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    if (groups_.empty()) RoomFor<uint16_t>();
    return Field();
  }

 private:
  void Measure(const Columns& part) {
    const bool has_floats =
        has_field_ && std::holds_alternative<exec::UninitializedVector<float>>(field_);
    const bool whole = may_be_whole_ && !has_floats && !IsDeep(object_, part.bricks);
    if (whole && MeasureAs(part, whole_parts_)) return;
    MeasureAs(part, float_parts_);
  }

  // Returns whether T was enough.
  template <typename T>
  bool MeasureAs(const Columns& part, std::optional<EuclideanParts<T>>& room) {
    if (!room.has_value()) room.emplace(most_bricks_);
    EuclideanParts<T>& parts = *room;
    MeasureWithinLayers(part.volume, {0, part.volume.brick_count()}, part.runs, context_, parts);
    const bool is_all = groups_.size() == 1;
    T* const field = is_all ? nullptr : RoomFor<T>();
    const float largest =
        MeasureAcrossLayers<T>(part.volume, context_, parts, [&](BrickStack stack) {
          for (const BrickIndex n : stack) {
            const std::span squares = std::span(parts.own).subspan(n * kBrickPoints, kBrickPoints);
            const BrickIndex brick = part.bricks[n];
            if (field != nullptr) std::ranges::copy(squares, field + size_t{brick} * kBrickPoints);
            if (sink_ != nullptr) sink_->Take(brick, squares.data());
          }
        });
    if (sizeof(T) == sizeof(uint16_t) && largest >= kFirstUnsureSquare) return false;
    largest_ = std::max(largest_, largest);
    if (is_all) field_ = std::move(parts.own);
    return true;
  }

  // The storage of the field for squares of type T; null if no field is kept.
  template <typename T>
  T* RoomFor() {
    using Squares = exec::UninitializedVector<T>;
    if (!has_field_) return nullptr;
    if (!std::holds_alternative<Squares>(field_) || std::get<Squares>(field_).empty()) {
      has_field_ = sizeof(T) == sizeof(uint16_t) || keeps_floats_;
      field_ = has_field_ ? AsOtherSquares<T>() : Squares();
    }
    return has_field_ ? std::get<Squares>(field_).data() : nullptr;
  }

  // Squares measured so far are right in both types.
  template <typename T>
  exec::UninitializedVector<T> AsOtherSquares() const {
    exec::UninitializedVector<T> squares((object_.brick_count() + 1) * kBrickPoints);
    std::fill(squares.end() - kBrickPoints, squares.end(), T{0});
    std::visit([&](const auto& known) { std::ranges::copy(known, squares.begin()); }, field_);
    return squares;
  }

  std::optional<DistanceField> Field() {
    if (!has_field_) return std::nullopt;
    const bool is_whole = std::holds_alternative<exec::UninitializedVector<uint16_t>>(field_);
    const uint32_t rank =
        is_whole ? static_cast<uint32_t>(largest_) : DistanceField::RankOf(largest_);
    return DistanceField(DistanceKind::kEuclidean, ChamferWeights(), std::move(field_), rank);
  }

  const Volume& object_;
  const exec::Context& context_;
  SquareSink* const sink_;
  const bool may_be_whole_;
  const std::vector<std::vector<BrickIndex>> groups_;
  const bool keeps_floats_;
  bool has_field_;
  DistanceField::Values field_;
  size_t most_bricks_ = 0;  // of a part
  std::optional<EuclideanParts<uint16_t>> whole_parts_;
  std::optional<EuclideanParts<float>> float_parts_;
  float largest_ = 0;
};

}  // namespace

absl::StatusOr<std::optional<DistanceField>> StreamEuclidean(const Volume& object,
                                                             const exec::Context& context,
                                                             SquareSink* sink, KeepField keep,
                                                             size_t at_once) {
  return EuclideanStream(object, context, sink, keep, at_once).Run();
}

}  // namespace bccskel
