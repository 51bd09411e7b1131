#pragma once

#include <cstdint>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace hvas::app {

/** Ranges of numeric options, as check() takes them. Each names its range in the help, which
 CLI11's own (PositiveNumber, NonNegativeNumber) do not for numbers without an upper limit. */
[[nodiscard]] const CLI::Validator& Positive();
[[nodiscard]] const CLI::Validator& NotNegative();
[[nodiscard]] const CLI::Validator& AnyNumber();

/** Range without its ends. */
[[nodiscard]] CLI::Validator Between(double least, double most);

/** Range with its lower end, and without its upper one. */
[[nodiscard]] CLI::Validator FromBelow(double least, double most);

/** Transforms a whole number between 1 and some most, as "1000000" or "1e6". */
[[nodiscard]] CLI::Validator Count(std::int64_t most);

/** Transforms a number of bytes, with or without a unit: 8GB, where 1kB is 1024 bytes. */
[[nodiscard]] const CLI::Validator& Bytes();

/** Makes each numeric option of the command and of those below it refuse, with its own name, what
 is not the decimal text of one finite number, or does not fit its type: CLI11 takes "-1" for
 2^64 - 1, "0x10" and "010" for hexadecimal and octal numbers, " 5" for 5, "nan" for a number, and
 "1e400" for infinity. Called after all options were added. */
void CheckNumbers(CLI::App* app);

}  // namespace hvas::app
