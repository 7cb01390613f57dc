#include "core/exec/instruction_sets.h"

#include <cstdint>

#include "hwy/highway.h"
#include "hwy/targets.h"

namespace bccskel::exec {
namespace {

void Use(int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

std::vector<int64_t> AllTargets() {
  hwy::SetSupportedTargetsForTest(0);
  return hwy::SupportedAndGeneratedTargets();
}

int64_t& Chosen() {
  static int64_t chosen = 0;  // 0: the best
  return chosen;
}

}  // namespace

std::vector<std::string> SupportedInstructionSets() {
  std::vector<std::string> names;
  for (int64_t target : AllTargets()) names.emplace_back(hwy::TargetName(target));
  Use(Chosen());
  return names;
}

bool ChooseInstructionSet(const std::string& name) {
  int64_t found = 0;
  for (int64_t target : AllTargets()) {
    if (name == hwy::TargetName(target)) found = target;
  }
  const bool known = name.empty() || found != 0;
  if (known) Chosen() = found;
  Use(Chosen());
  return known;
}

std::string ChosenInstructionSet() {
  const int64_t targets = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(targets & -targets);  // lower bits are better targets
}

}  // namespace bccskel::exec
