#include "core/ranks/rank_skeletonize.h"

#include <exception>
#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/ranks/agreement.h"
#include "core/ranks/packing.h"
#include "core/ranks/rank_bricks.h"
#include "core/ranks/rank_peeling.h"

namespace bccskel::ranks {
namespace {

enum class Task : uint8_t { kBringParts, kPeel, kLeave };

// What all ranks must know of the object and the options for peeling; for sending parts, only of
// the object.
struct Order {
  Task task = Task::kLeave;
  LatticeExtent extent;
  Placement placement;
  DistanceKind distance = DistanceKind::kEuclidean;
  ThinningOptions thinning;
};

Bytes Packed(const Order& order) {
  Bytes bytes;
  const ThinningOptions& thinning = order.thinning;
  Pack(order.task, bytes);
  Pack(order.extent, bytes);
  Pack(order.placement, bytes);
  Pack(order.distance, bytes);
  Pack(thinning.method, bytes);
  Pack(thinning.kind, bytes);
  Pack(thinning.stubble, bytes);
  Pack(thinning.cleanup, bytes);
  Pack(thinning.shell_width, bytes);
  Pack(thinning.last_shell, bytes);
  Pack(std::span<const LatticePoint>(thinning.keep), bytes);
  return bytes;
}

Order Unpacked(const Bytes& bytes) {
  Unpacker from(bytes);
  Order order;
  order.task = from.Take<Task>();
  order.extent = from.Take<LatticeExtent>();
  order.placement = from.Take<Placement>();
  order.distance = from.Take<DistanceKind>();
  order.thinning.method = from.Take<ThinningMethod>();
  order.thinning.kind = from.Take<SkeletonKind>();
  order.thinning.stubble = from.Take<StubblePolicy>();
  order.thinning.cleanup = from.Take<ThinnessCleanup>();
  order.thinning.shell_width = from.Take<double>();
  order.thinning.last_shell = from.Take<int32_t>();
  order.thinning.keep = from.TakeRest<LatticePoint>();
  return order;
}

void Send(Exchange& exchange, const Order& order) {
  std::vector<int> peers;
  for (int rank = 1; rank < exchange.size(); ++rank) peers.push_back(rank);
  const std::vector<Bytes> out(peers.size(), Packed(order));
  std::vector<Bytes> in(peers.size());
  exchange.Trade(peers, out, in);
}

Order Receive(Exchange& exchange) {
  const int lead = 0;
  const Bytes nothing;
  Bytes in;
  exchange.Trade({&lead, 1}, {&nothing, 1}, {&in, 1});
  return Unpacked(in);
}

// The part, if it has the extent and placement of the object.
absl::StatusOr<Volume> FitPart(absl::StatusOr<Volume> part, const Volume& object) {
  if (!part.ok() || part->empty()) return part.ok() ? object : std::move(part);
  if (part->extent() == object.extent() && part->placement() == object.placement()) return part;
  return absl::InvalidArgumentError(
      "differs from the object that rank 0 has read; all ranks must read the same file");
}

// Called by all ranks together; returns the whole object on rank 0, nothing elsewhere.
absl::StatusOr<Volume> BringParts(Exchange& exchange, absl::StatusOr<Volume> part) {
  BCCSKEL_RETURN_IF_ERROR(AgreeOn(exchange, part.status()));
  BCCSKEL_ASSIGN_OR_RETURN(Volume own, ShareEvenly(exchange, *std::move(part)));
  return GatherBricks(exchange, own, {0, own.brick_count()});
}

}  // namespace

absl::Status CheckRankOptions(const SkeletonizeOptions& options) {
  if (options.border == Border::kContinues) {
    return absl::InvalidArgumentError(
        "--border continues: ranks treat the border as the end of the object; omit "
        "it, or run `bccskel skeletonize --local` on one machine");
  }
  return absl::OkStatus();
}

// After an exception the others wait in another call, where this message would never arrive: the
// code that catches the exception ends the job. If there is no memory even for the message, the
// process and so the job end.
Lead::~Lead() {  // NOLINT(bugprone-exception-escape)
  if (std::uncaught_exceptions() == exceptions_) Send(exchange_, {});
}

absl::StatusOr<SkeletonizeResult> Lead::Skeletonize(Volume& object,
                                                    const SkeletonizeOptions& options,
                                                    const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckRankOptions(options));
  // Ranks measure distances to all background; an object of one slice is small enough for one.
  const bool one_slice = AxisOfOneSlice(object.extent(), options).has_value();
  if (one_slice || options.preparing.Wanted()) {
    Order order;
    order.task = Task::kBringParts;
    order.extent = object.extent();
    order.placement = object.placement();
    Send(exchange_, order);
    BCCSKEL_ASSIGN_OR_RETURN(object, BringParts(exchange_, std::move(object)));
  }
  if (one_slice) return bccskel::Skeletonize(object, options, context);
  const Peeler peeler = [&](Volume& prepared,
                            const ThinningOptions& thinning) -> absl::StatusOr<PeeledObject> {
    Send(exchange_,
         {Task::kPeel, prepared.extent(), prepared.placement(), options.distance, thinning});
    BCCSKEL_RETURN_IF_ERROR(AgreeOn(exchange_, absl::OkStatus()));
    return PeelOverRanks(exchange_, prepared, options.distance, thinning, checkpoints_, context);
  };
  return SkeletonizeBy(peeler, object, options, context);
}

absl::Status FollowLead(Exchange& exchange, const exec::Context& context,
                        absl::StatusOr<Volume> part, const CheckpointOptions& checkpoints) {
  absl::Status last;
  while (true) {
    const Order order = Receive(exchange);
    if (order.task == Task::kLeave) return last;
    const Volume nothing = Volume::FromSortedBricks(order.extent, order.placement, {}, {});
    if (order.task == Task::kBringParts) {
      last = BringParts(exchange, FitPart(std::exchange(part, nothing), nothing)).status();
      continue;
    }
    absl::StatusOr<Volume> own = FitPart(std::exchange(part, nothing), nothing);
    last = AgreeOn(exchange, own.status());
    if (!last.ok()) continue;
    last = PeelOverRanks(exchange, *own, order.distance, order.thinning, checkpoints, context)
               .status();
  }
}

}  // namespace bccskel::ranks
