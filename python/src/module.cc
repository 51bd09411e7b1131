#include "arguments.h"
#include "bindings.h"

namespace hvas::python {
void Throw(const Error& error) {
  ThrowInterrupt();
  const py::object type = py::module_::import("hvas.types").attr("Error");
  const py::object value = type(hvas::NameOf(error.code), error.message, error.where, error.remedy);
  PyErr_SetObject(type.ptr(), value.ptr());
  throw py::error_already_set();
}

py::object MakeDataclass(const char* name, const py::dict& fields) {
  return py::module_::import("hvas.types").attr(name)(**fields);
}

py::tuple ToTuple(const Vec3& v) {
  return py::make_tuple(v.x(), v.y(), v.z());
}

py::tuple ToTuple(const spatial::Pose& X) {
  return py::make_tuple(X.p().x(), X.p().y(), X.p().z(), X.q().w(), X.q().x(), X.q().y(),
                        X.q().z());
}

namespace {

// What Python raised while work ran without the interpreter's lock.
std::unique_ptr<py::error_already_set>& Interrupt() {
  static thread_local std::unique_ptr<py::error_already_set> interrupt;
  return interrupt;
}

}  // namespace

std::function<void(std::string_view stage, double fraction)> MakeProgress(
    const py::object& progress, std::stop_source* stop) {
  return [progress, stop](std::string_view stage, double fraction) {
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
      }
      if (!progress.is_none() && Interrupt() == nullptr) {
        progress(std::string(stage), fraction);
      }
    } catch (const py::error_already_set& error) {
      Interrupt() = std::make_unique<py::error_already_set>(error);
      stop->request_stop();
    }
  };
}

void ThrowInterrupt() {
  if (Interrupt() != nullptr) {
    const py::error_already_set error = *std::exchange(Interrupt(), nullptr);
    throw error;
  }
}

}  // namespace hvas::python

PYBIND11_MODULE(_hvas, module) {
  module.doc() = "The library of HVAS. Use the package hvas.";
  module.attr("__version__") = hvas::api::LibraryVersion();
  hvas::python::DefineArguments(&module);
  hvas::python::DefineFits(&module);
  hvas::python::DefineProduct(&module);
  hvas::python::DefineRun(&module);
  hvas::python::DefineRecord(&module);
}
