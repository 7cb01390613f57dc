#include "core/ranks/rank_skeletonize.h"

#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/ranks/packing.h"
#include "core/ranks/rank_peeling.h"

namespace bccskel::ranks {
namespace {

enum class Task : uint8_t { kPeel, kLeave };

// What all must know of the object and the options to peel.
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

}  // namespace

absl::Status CheckRankOptions(const SkeletonizeOptions& options) {
  if (options.border == Border::kContinues) {
    return absl::InvalidArgumentError(
        "an object that continues beyond the border: ranks take the border for an end; leave "
        "--border out, or run `bccskel skeletonize --local` on one machine");
  }
  return absl::OkStatus();
}

Lead::~Lead() { Send(exchange_, {}); }

absl::StatusOr<SkeletonizeResult> Lead::Skeletonize(const Volume& object,
                                                    const SkeletonizeOptions& options,
                                                    const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckRankOptions(options));
  const Peeler peeler = [&](const Volume& prepared, const ThinningOptions& thinning) {
    Send(exchange_,
         {Task::kPeel, prepared.extent(), prepared.placement(), options.distance, thinning});
    return PeelOverRanks(exchange_, prepared, options.distance, thinning, checkpoints_, context);
  };
  return SkeletonizeBy(peeler, object, options, context);
}

absl::Status FollowLead(Exchange& exchange, const exec::Context& context,
                        const CheckpointOptions& checkpoints) {
  absl::Status last;
  while (true) {
    const Order order = Receive(exchange);
    if (order.task == Task::kLeave) return last;
    const Volume nothing = Volume::FromSortedBricks(order.extent, order.placement, {}, {});
    last = PeelOverRanks(exchange, nothing, order.distance, order.thinning, checkpoints, context)
               .status();
  }
}

}  // namespace bccskel::ranks
