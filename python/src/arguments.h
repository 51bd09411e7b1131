#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bindings.h"

/** The one check that each number passes on its way from Python into the library. Functions take
 numeric arguments as objects, and one of the functions below makes the number. */
namespace hvas::python {

/** What a number may be; the ends belong to it. */
struct Range {
  double least{-std::numeric_limits<double>::max()};
  double most{std::numeric_limits<double>::max()};
  bool is_above{false};  ///< The lower end does not belong to it.
};

// Limits far beyond what machines are made of, so that no sum or product of numbers within them
// overflows: choices.
inline constexpr double kMostLength = 1e4;     // [m]
inline constexpr double kMostForce = 1e6;      // [N]
inline constexpr double kMostStiffness = 1e6;  // [N/m], [N m/rad], [N s/m], [N m s/rad]
inline constexpr double kMostTime = 1e9;       // [s]
inline constexpr double kMostWeight = 1e9;     // Of a cost.
inline constexpr double kMostFriction = 2;  // Coulomb's coefficient, as a side file may state it.

inline constexpr Range kLength{0, kMostLength, true};  ///< [m]
inline constexpr Range kLengthOrNone{0, kMostLength};  ///< [m]; 0 stands for a default.
inline constexpr Range kFriction{0, kMostFriction};
inline constexpr Range kImpedance{0, kMostStiffness};

/** Makes a number of what Python passes as the argument `name`: a float, an integer or a scalar of
 NumPy. Throws hvas.ArgumentTypeError for another type (also for a truth value), ValueError for what
 is not finite or out of range; each names the argument, what it is and what it may be. */
[[nodiscard]] double ToNumber(const char* name, const py::handle& value, const Range& range);

/** Makes a whole number between two. Throws as ToNumber(); TypeError for a float, too. */
[[nodiscard]] std::int64_t ToInteger(const char* name, const py::handle& value, std::int64_t least,
                                     std::int64_t most);

/** Makes a seed: a whole number of 0 to 2^64 - 1. Throws as ToInteger(). */
[[nodiscard]] std::uint64_t ToSeed(const char* name, const py::handle& value);

/** Makes an index into `count` items. Throws TypeError as ToInteger(), and IndexError. */
[[nodiscard]] std::size_t ToIndex(const char* name, const py::handle& value, std::size_t count);

/** Makes a list of numbers of a sequence or a one-dimensional array of this length. Throws as
 ToNumber(), TypeError for what is no sequence, and ValueError for another length or shape. */
[[nodiscard]] std::vector<double> ToNumbers(const char* name, const py::handle& value,
                                            std::size_t length, const Range& range);

[[nodiscard]] Vec3 ToVector(const char* name, const py::handle& value, const Range& range);

/** Makes a pose of seven numbers. Throws as ToNumbers(), and ValueError for a quaternion that is
 not of unit length. */
[[nodiscard]] spatial::Pose ToPose(const char* name, const py::handle& value);

void DefineArguments(py::module_* module);

}  // namespace hvas::python
