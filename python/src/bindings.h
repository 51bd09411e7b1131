#pragma once

#include <string>
#include <utility>

#include <hvas/hvas.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

/** The Python package's view of the library. Python has its own words for what is passed: positions
 as sequences of three numbers, poses as seven (x, y, z, then the quaternion w, x, y, z), SI. */
namespace hvas::python {

namespace py = pybind11;

/** Throws an hvas.Error with all that the error says. */
[[noreturn]] void Throw(const Error& error);

/** The value of a result, or an hvas.Error. */
template <typename T>
T Take(Result<T> result) {
  if (!result) {
    Throw(result.error());
  }
  return std::move(*result);
}

/** One of the dataclasses in hvas/types.py. */
[[nodiscard]] py::object MakeDataclass(const char* name, const py::dict& fields);

[[nodiscard]] py::tuple ToTuple(const Vec3& v);
[[nodiscard]] py::tuple ToTuple(const spatial::Pose& X);

/** A progress function for work that runs without the interpreter's lock: takes the lock, calls
 `progress` where it is not None, and asks for a stop where Python was interrupted (Ctrl-C). */
[[nodiscard]] std::function<void(std::string_view stage, double fraction)> MakeProgress(
    const py::object& progress, std::stop_source* stop);

/** Throws what MakeProgress stopped the work for, if it did. With the interpreter's lock. */
void ThrowInterrupt();

void DefineFits(py::module_* module);
void DefineProduct(py::module_* module);
void DefineRun(py::module_* module);
void DefineRecord(py::module_* module);

}  // namespace hvas::python
