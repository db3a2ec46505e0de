#pragma once
// Which file of the built viewer answers a request, and with what type. Nothing outside the viewer's folder is ever named.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace filum {

/// The path part of a request target: without query and fragment, percent-decoded. Empty optional where it is malformed.
std::optional<std::string> request_path(std::string_view target);

/// The existing regular file below `folder` that answers `path` ("/" is index.html), symbolic links resolved. Empty optional
/// where there is none or where it would lie outside `folder`.
std::optional<std::filesystem::path> find_static_file(const std::filesystem::path& folder, std::string_view path);

/// Media type by file name extension.
std::string_view media_type(const std::filesystem::path& file);

}  // namespace filum
