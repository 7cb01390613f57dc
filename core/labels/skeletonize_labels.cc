#include <algorithm>
#include <atomic>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/machine_memory.h"
#include "core/exec/status_macros.h"
#include "core/labels/convert_label.h"
#include "core/labels/ordered_delivery.h"
#include "core/labels/skeletonize_labels_within.h"
#include "core/pipeline/skeletonize_within.h"

namespace bccskel {
namespace {

constexpr size_t kWaitingPerThread = 64;

absl::Status WithLabel(const absl::Status& status, uint64_t label) {
  if (absl::IsCancelled(status) || absl::IsDeadlineExceeded(status)) return status;
  return absl::Status(status.code(),
                      absl::StrFormat("label %d: %s", label, std::string(status.message())));
}

absl::StatusOr<LabelSkeleton> SkeletonOf(const MaskGrid& grid, const LabeledObject& object,
                                         const LabelsOptions& options, exec::MemoryBudget& memory,
                                         const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const ConvertedMask converted,
                           ConvertLabel(grid, object, options.mask, context));
  LabelSkeleton skeleton{object.label, object.voxels, {}};
  BCCSKEL_ASSIGN_OR_RETURN(
      skeleton.result, SkeletonizeWithin(memory, converted.volume,
                                         ForMask(options.skeleton, grid, options.mask), context));
  Certificate& certificate = skeleton.result.certificate;
  certificate.mask = converted.mask;
  const std::string changes = DescribeChanges(converted.mask, certificate.Given());
  if (changes.empty() || options.mask.sampling) return skeleton;
  return absl::InternalError("the exact conversion changed the topology: " + changes);
}

class LabelWork {
 public:
  LabelWork(const LabeledObjects& labels, const LabelsOptions& options,
            const LabelConsumer& consume, exec::MemoryBudget& memory, const exec::Context& context)
      : labels_(labels),
        options_(options),
        memory_(memory),
        context_(context),
        alone_(context),
        shares_(labels.objects.size()),
        consume_([this, &consume](LabelSkeleton&& skeleton) {
          absl::Status status = consume(std::move(skeleton));
          shares_[delivered_++].reset();
          return status;
        }),
        delivery_(consume_, kWaitingPerThread * static_cast<size_t>(context.threads())) {
    // Shells of single labels are no progress of the whole.
    alone_.on_shell = nullptr;
    together_ = alone_;
    alone_.team = nullptr;
  }

  // In ascending order: small objects up to the next large one in parallel, then that one by all.
  absl::Status Run() {
    for (size_t begin = 0; begin < labels_.objects.size() && delivery_.status().ok();) {
      size_t end = begin;
      while (end < labels_.objects.size() && !IsLarge(end)) ++end;
      if (end > begin) RunSmall(begin, end);
      if (end < labels_.objects.size()) RunOne(end++, together_);
      begin = end;
    }
    return delivery_.status();
  }

 private:
  bool IsLarge(size_t n) const { return labels_.objects[n].voxels >= options_.large_voxels; }

  void RunSmall(size_t begin, size_t end) {
    std::atomic<size_t> next = begin;
    context_.Offer([&](int) {
      for (size_t n = next++; n < end && RunOne(n, alone_); n = next++) {
      }
    });
  }

  // False when the work is over. Workers must not throw: memory that cannot be had ends the work.
  bool RunOne(size_t n, const exec::Context& context) {
    const uint64_t label = labels_.objects[n].label;
    try {
      const absl::Status status = ComputeOne(n, context);
      if (!status.ok()) delivery_.Fail(WithLabel(status, label));
      return status.ok();
    } catch (const std::bad_alloc&) {
      delivery_.Fail(WithLabel(absl::ResourceExhaustedError("out of memory"), label));
      return false;
    }
  }

  absl::Status ComputeOne(size_t n, const exec::Context& context) {
    if (!delivery_.WaitForTurn(n, context)) return delivery_.status();
    shares_[n].emplace(memory_);
    BCCSKEL_ASSIGN_OR_RETURN(LabelSkeleton skeleton, SkeletonOf(labels_.grid, labels_.objects[n],
                                                                options_, *shares_[n], context));
    delivery_.Add(n, std::move(skeleton));
    return absl::OkStatus();
  }

  const LabeledObjects& labels_;
  const LabelsOptions& options_;
  exec::MemoryBudget& memory_;
  const exec::Context& context_;
  exec::Context alone_;
  exec::Context together_;
  std::vector<std::optional<exec::MemoryShare>> shares_;  // by object, until it is delivered
  size_t delivered_ = 0;
  LabelConsumer consume_;
  OrderedDelivery delivery_;
};

}  // namespace

absl::Status SkeletonizeLabels(const LabeledObjects& labels, const LabelsOptions& options,
                               const LabelConsumer& consume, const exec::Context& context) {
  exec::MachineMemory memory;
  return SkeletonizeLabelsWithin(memory, labels, options, consume, context);
}

absl::Status SkeletonizeLabelsWithin(exec::MemoryBudget& memory, const LabeledObjects& labels,
                                     const LabelsOptions& options, const LabelConsumer& consume,
                                     const exec::Context& context) {
  return LabelWork(labels, options, consume, memory, context).Run();
}

}  // namespace bccskel
