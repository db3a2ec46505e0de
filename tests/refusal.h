#pragma once
// What is said of bad input, to be looked at field by field.

#include <utility>

#include "base/error.h"

namespace filum {

/// The InputError that `read` throws; one with the value "taken" if it throws none.
template <class Read>
InputError refusal_by(Read&& read) {
  try {
    std::forward<Read>(read)();
  } catch (const InputError& error) {
    return error;
  }
  return {"", "", "taken", ""};
}

}  // namespace filum
