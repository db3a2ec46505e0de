#pragma once
// A folder that somebody named for results, looked at before the work: what cannot be written is then not found after it.
// Test: tests/base/out_folder_test.cpp.

#include <string>

namespace filum {

/// Throws InputError, naming `option`, unless `folder` can be written or can be made. Makes nothing.
void require_out_folder(const std::string& option, const std::string& folder);

}  // namespace filum
