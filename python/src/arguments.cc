#include "arguments.h"

#include <cmath>

#include <fmt/format.h>

namespace hvas::python {
namespace {

constexpr std::size_t kMostCharacters = 60;  // Of a value in a message: a choice.

/** Writes what was passed, as Python prints it: a list of a million numbers is cut. */
std::string Print(const py::handle& value) {
  try {
    std::string text = py::cast<std::string>(py::repr(value));
    return text.size() <= kMostCharacters ? text : text.substr(0, kMostCharacters) + "...";
  } catch (const std::exception&) {  // An object that cannot be printed, or is no UTF-8.
    return "one that cannot be printed";
  }
}

[[noreturn]] void FailType(const char* name, const py::handle& value, const std::string& wanted) {
  const std::string text =
      fmt::format("{} has to be {}, not {}", name, wanted, Py_TYPE(value.ptr())->tp_name);
  const py::object type = py::module_::import("hvas.types").attr("ArgumentTypeError");
  PyErr_SetString(type.ptr(), text.c_str());
  throw py::error_already_set();
}

[[noreturn]] void FailValue(const char* name, const py::handle& value, const std::string& wanted) {
  throw py::value_error(fmt::format("{} has to be {}, not {}", name, wanted, Print(value)));
}

std::string DescribeRange(const Range& range) {
  constexpr double kNone = std::numeric_limits<double>::max();
  if (range.most >= kNone && range.least <= -kNone) {
    return "a finite number";
  }
  return range.is_above ? fmt::format("a number above {} and at most {}", range.least, range.most)
                        : fmt::format("a number of {} to {}", range.least, range.most);
}

/** The letter of NumPy for the kind of a scalar or an array of it; 0 for all other objects. */
char KindOf(const py::handle& value) {
  if (!py::hasattr(value, "dtype") || !py::hasattr(value, "ndim")) {
    return '\0';
  }
  return py::cast<std::string>(value.attr("dtype").attr("kind")).front();
}

bool IsScalar(const py::handle& value) {
  return KindOf(value) == '\0' || py::cast<int>(value.attr("ndim")) == 0;
}

/** Whether it is an integer of Python or NumPy. */
bool IsInteger(const py::handle& value) {
  const char kind = KindOf(value);
  return PyIndex_Check(value.ptr()) != 0 && !PyBool_Check(value.ptr()) && IsScalar(value) &&
         (kind == '\0' || kind == 'i' || kind == 'u');
}

bool IsNumber(const py::handle& value) {
  const PyNumberMethods* methods = Py_TYPE(value.ptr())->tp_as_number;
  const bool has_float = methods != nullptr && methods->nb_float != nullptr;
  return IsInteger(value) || (has_float && !PyBool_Check(value.ptr()) && IsScalar(value) &&
                              (KindOf(value) == '\0' || KindOf(value) == 'f'));
}

/** An integer as Python's own; what its type raises goes on. */
py::int_ ToPythonInteger(const py::handle& value) {
  PyObject* number = PyNumber_Index(value.ptr());
  if (number == nullptr) {
    throw py::error_already_set();
  }
  return py::reinterpret_steal<py::int_>(number);
}

}  // namespace

double ToNumber(const char* name, const py::handle& value, const Range& range) {
  if (!IsNumber(value)) {
    FailType(name, value, "a number");
  }
  PyObject* made = PyNumber_Float(value.ptr());
  if (made == nullptr) {
    const py::error_already_set error;
    if (!error.matches(PyExc_OverflowError)) {
      throw error;
    }
    FailValue(name, value, DescribeRange(range));
  }
  const double number = PyFloat_AS_DOUBLE(made);
  Py_DECREF(made);
  const bool is_over = range.is_above ? number > range.least : number >= range.least;
  if (!std::isfinite(number) || !is_over || number > range.most) {
    FailValue(name, value, DescribeRange(range));
  }
  return number;
}

std::int64_t ToInteger(const char* name, const py::handle& value, std::int64_t least,
                       std::int64_t most) {
  if (!IsInteger(value)) {
    FailType(name, value, "a whole number");
  }
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(ToPythonInteger(value).ptr(), &overflow);
  if (overflow != 0 || number < least || number > most) {
    FailValue(name, value, fmt::format("a whole number of {} to {}", least, most));
  }
  return number;
}

std::uint64_t ToSeed(const char* name, const py::handle& value) {
  if (!IsInteger(value)) {
    FailType(name, value, "a whole number");
  }
  const unsigned long long number = PyLong_AsUnsignedLongLong(ToPythonInteger(value).ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    FailValue(name, value, "a whole number of 0 to 2^64 - 1");
  }
  return number;
}

std::size_t ToIndex(const char* name, const py::handle& value, std::size_t count) {
  if (!IsInteger(value)) {
    FailType(name, value, "a whole number");
  }
  int overflow = 0;
  const long long index = PyLong_AsLongLongAndOverflow(ToPythonInteger(value).ptr(), &overflow);
  if (overflow != 0 || index < 0 || static_cast<std::size_t>(index) >= count) {
    throw py::index_error(
        fmt::format("{} has to be an index below {}, not {}", name, count, Print(value)));
  }
  return static_cast<std::size_t>(index);
}

std::vector<double> ToNumbers(const char* name, const py::handle& value, std::size_t length,
                              const Range& range) {
  const std::string wanted = fmt::format("a sequence of {} numbers", length);
  const bool is_text =
      PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr()) || PyByteArray_Check(value.ptr());
  if (is_text || PySequence_Check(value.ptr()) == 0 || PyDict_Check(value.ptr()) ||
      (KindOf(value) != '\0' && IsScalar(value))) {
    FailType(name, value, wanted);
  }
  if (KindOf(value) != '\0' && py::cast<int>(value.attr("ndim")) != 1) {
    FailValue(name, value.attr("shape"), fmt::format("a one-dimensional array of {}", length));
  }
  const auto sequence = py::reinterpret_borrow<py::sequence>(value);
  if (sequence.size() != length) {
    throw py::value_error(fmt::format("{} has to be {}, not of {}", name, wanted, sequence.size()));
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < length; ++i) {
    const py::object item = sequence[i];
    numbers.push_back(ToNumber(fmt::format("{}[{}]", name, i).c_str(), item, range));
  }
  return numbers;
}

Vec3 ToVector(const char* name, const py::handle& value, const Range& range) {
  const std::vector<double> numbers = ToNumbers(name, value, 3, range);
  return {numbers[0], numbers[1], numbers[2]};
}

spatial::Pose ToPose(const char* name, const py::handle& value) {
  const std::vector<double> n = ToNumbers(name, value, 7, {-kMostLength, kMostLength});
  const Quat q(n[3], n[4], n[5], n[6]);
  // A quaternion of another length than 1 is more often a mistake than a rounding.
  constexpr double kTolerance = 1e-3;
  if (!(std::abs(q.norm() - 1) < kTolerance)) {
    FailValue(name, value, "a position x, y, z [m], then a quaternion w, x, y, z of length 1");
  }
  return {q.normalized(), Vec3(n[0], n[1], n[2])};
}

void DefineArguments(py::module_* module) {
  module->def(
      "check_number",
      [](const std::string& name, const py::object& value, double least, double most) {
        return ToNumber(name.c_str(), value, {least, most});
      },
      py::arg("name"), py::arg("value"), py::arg("least"), py::arg("most"));
  module->def(
      "check_integer",
      [](const std::string& name, const py::object& value, std::int64_t least, std::int64_t most) {
        return ToInteger(name.c_str(), value, least, most);
      },
      py::arg("name"), py::arg("value"), py::arg("least"), py::arg("most"));
}

}  // namespace hvas::python
