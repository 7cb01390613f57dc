#ifndef BCCSKEL_CLIENT_PYTHON_NATIVE_SKELETON_CLASS_H_
#define BCCSKEL_CLIENT_PYTHON_NATIVE_SKELETON_CLASS_H_

#include <pybind11/pybind11.h>

namespace bccskel::python {

// Adds the class of results: numpy arrays in the order x, y, z, facts as plain Python values, and
// functions that write files.
void AddSkeletonClass(pybind11::module_& module);

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_SKELETON_CLASS_H_
