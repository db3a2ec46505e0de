#pragma once
// Parts of the program that need a library few have (OpenCV, MPI) are modules beside it, loaded when they are asked for.

#include <string>

namespace filum::reconcile {

/// The function `symbol` of the module lib`name`.so beside this program or where it was built; nullptr where there is no such module.
/// `why` gets the loader's reason.
void* module_function(const std::string& name, const char* symbol, std::string* why = nullptr);

}  // namespace filum::reconcile
