// Errors end a run with one message and one exit code; see the five rules below.
//   static_assert  what the compiler can know
//   assert         a broken promise between two functions of this code
//   InputError     what the user can mend: names file, key, value and fix; exit code 2
//   RangeError     a run that left the range its numbers can hold: names step, particle, value, cause; exit code 3
//   anything else  a defect; exit code 1
#pragma once

#include <stdexcept>
#include <string>

namespace mappm {

inline constexpr int exit_input_error = 2;
inline constexpr int exit_range_error = 3;

/// Something the user can mend. The message reads "FILE: KEY = VALUE: what is wrong; fix".
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& file, const std::string& key, const std::string& value, const std::string& fix)
      : InputError(file + ": " + key + (value.empty() ? "" : " = " + value) + ": " + fix) {}
  /// A message that is complete already: of a file as a whole, or received from another process.
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

/// Of a run for which there is not as much memory as was expected.
inline constexpr const char* memory_ran_out =
    "memory ran out; enlarge fluid.spacing, or give the run more memory or more machines";

/// A defect that all processes have learned of: reported once.
class AgreedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A value that left its range during a run.
class RangeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace mappm
