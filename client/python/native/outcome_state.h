#ifndef BCCSKEL_CLIENT_PYTHON_NATIVE_OUTCOME_STATE_H_
#define BCCSKEL_CLIENT_PYTHON_NATIVE_OUTCOME_STATE_H_

#include <pybind11/pybind11.h>

#include <memory>

#include "client/python/native/compute.h"

namespace bccskel::python {

// The content of an outcome as bytes, numbers and texts, for `pickle`.
pybind11::dict StateOf(const Outcome& outcome);
// Throws the exception for DATA_LOSS, KeyError, TypeError or ValueError for a state that StateOf()
// does not produce.
std::shared_ptr<Outcome> OutcomeOfState(const pybind11::dict& state);

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_OUTCOME_STATE_H_
