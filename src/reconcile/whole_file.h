#pragma once
// A file that appears whole or not at all: written beside its place and renamed.

#include <string>

namespace filum::reconcile {

/// Throws std::runtime_error where it cannot be written.
void write_whole(const std::string& path, const std::string& text);

}  // namespace filum::reconcile
