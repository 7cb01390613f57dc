#ifndef BCCSKEL_CORE_EXEC_INSTRUCTION_SETS_H_
#define BCCSKEL_CORE_EXEC_INSTRUCTION_SETS_H_

#include <string>
#include <vector>

// The kernels are compiled for several instruction sets and the best is picked when a process first
// runs one. Results have the same bits on all; tests and benchmarks pick by hand.

namespace bccskel::exec {

// Names of the sets that this machine can run, best first.
std::vector<std::string> SupportedInstructionSets();

// Uses this one from now on, in the whole process; an empty name goes back to the best.
// Returns false, and changes nothing, when the machine cannot run it.
// Threads: not while kernels run.
bool ChooseInstructionSet(const std::string& name);

// The one in use.
std::string ChosenInstructionSet();

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_INSTRUCTION_SETS_H_
