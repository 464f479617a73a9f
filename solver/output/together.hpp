// Work in which one process of a group may fail alone: all of them learn of it, so that none waits for a process that
// has given up, and the error is reported once.
#pragma once

#include <exception>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "base/group.hpp"

namespace mappm {

/// An error as text, to be sent: its kind and its message; empty where there is none.
std::string describe_failure(const std::exception& error);

/// Collective. Returns where every process gave an empty text; otherwise all throw the failure of the lowest rank.
void agree(const Group& group, const std::string& failure);

/// Collective. Does `work` on every process and returns its result. If it threw on any, all throw the error of the
/// lowest rank that failed, with the same type (InputError or RangeError; any other becomes an AgreedError) and text.
template <class Work>
auto together(const Group& group, Work&& work) {
  using Result = std::invoke_result_t<Work>;
  std::string failure;
  if constexpr (std::is_void_v<Result>) {
    try {
      work();
    } catch (const std::exception& error) {
      failure = describe_failure(error);
    }
    agree(group, failure);
  } else {
    std::optional<Result> result;
    try {
      result.emplace(work());
    } catch (const std::exception& error) {
      failure = describe_failure(error);
    }
    agree(group, failure);
    return std::move(*result);
  }
}

/// Collective. The same for work of the first process alone.
template <class Work>
void on_first(const Group& group, Work&& work) {
  together(group, [&] {
    if (group.is_first()) work();
  });
}

}  // namespace mappm
