#ifndef BCCSKEL_CORE_LABELS_SKELETONIZE_LABELS_WITHIN_H_
#define BCCSKEL_CORE_LABELS_SKELETONIZE_LABELS_WITHIN_H_

#include "core/exec/memory_budget.h"
#include "core/labels/skeletonize_labels.h"

namespace bccskel {

// SkeletonizeLabels() in a budget: each label takes what SkeletonizeWithin() asks for, until the
// consumer has returned with its result.
// Errors: as SkeletonizeLabels(); the budget's, with the label.
absl::Status SkeletonizeLabelsWithin(exec::MemoryBudget& memory, const LabeledObjects& labels,
                                     const LabelsOptions& options, const LabelConsumer& consume,
                                     const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_SKELETONIZE_LABELS_WITHIN_H_
