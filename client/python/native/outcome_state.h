#ifndef BCCSKEL_CLIENT_PYTHON_NATIVE_OUTCOME_STATE_H_
#define BCCSKEL_CLIENT_PYTHON_NATIVE_OUTCOME_STATE_H_

#include <pybind11/pybind11.h>

#include <memory>

#include "client/python/native/compute.h"

namespace bccskel::python {

// Everything that an outcome holds as bytes, numbers and texts, for `pickle`.
pybind11::dict StateOf(const Outcome& outcome);
// Throws what absl::StatusCode::kDataLoss becomes, KeyError or TypeError for a state that StateOf()
// does not make.
std::shared_ptr<Outcome> OutcomeOfState(const pybind11::dict& state);

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_OUTCOME_STATE_H_
