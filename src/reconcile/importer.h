#pragma once
// Published tables turned into datasets of the contract (filum-experiment/1).

#include <string>
#include <vector>

namespace filum::reconcile {

/// Kinds that import knows: brain-budday2017, muscle-vanloocke, loadcells-fareke.
std::vector<std::string> import_kinds();
/// Writes one or more dataset folders below `out` and returns their names. Throws InputError.
std::vector<std::string> import_data(const std::string& kind, const std::string& folder, const std::string& out);

}  // namespace filum::reconcile
