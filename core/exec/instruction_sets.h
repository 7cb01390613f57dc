#ifndef BCCSKEL_CORE_EXEC_INSTRUCTION_SETS_H_
#define BCCSKEL_CORE_EXEC_INSTRUCTION_SETS_H_

#include <string>
#include <vector>

// The kernels are compiled for several instruction sets. A process selects the best one at its
// first call. All give the same bits; tests and benchmarks select one explicitly.

namespace bccskel::exec {

// Names of the sets that this machine can run, best first.
std::vector<std::string> SupportedInstructionSets();

// Selects the instruction set of the whole process; an empty name selects the best again.
// Returns false, and changes nothing, when the machine cannot run it.
// Threads: not while kernels run.
bool ChooseInstructionSet(const std::string& name);

// The one in use.
std::string ChosenInstructionSet();

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_INSTRUCTION_SETS_H_
