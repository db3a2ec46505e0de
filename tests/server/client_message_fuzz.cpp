// Whatever bytes a browser sends: an accepted pose is finite with a unit quaternion; a path asked for never leaves the folder served, names
// of hosts and origins are taken or not.

#include <cctype>
#include <cmath>

#include "fuzz_folder.h"
#include "server/client_message.h"
#include "server/server.h"
#include "server/static_files.h"

namespace {

using namespace filum;

void read_message(std::string_view text) {
  const auto parsed = parse_client_message(text);
  const auto* message = std::get_if<ClientMessage>(&parsed);
  if (message == nullptr) return;
  if (const auto* pointer = std::get_if<PointerMessage>(message)) {
    const bool good = pointer->X_WD.finite() && std::abs(pointer->X_WD.q.norm() - 1.0) < 1e-9 && pointer->grip >= 0.0 && pointer->grip <= 1.0 &&
                      pointer->tool >= 0 && pointer->tool <= 2;
    if (!good) std::abort();
  }
}

void read_target(std::string_view text) {
  static const fuzz::Folder outside;
  static const bool made = std::filesystem::create_directory(outside.file("served")) && !outside.write("secret", "x").empty() &&
                           !outside.write("served/index.html", "x").empty();
  const auto path = request_path(text);
  if (!path || !made) return;
  const auto file = find_static_file(outside.file("served"), *path);
  if (file && !file->string().starts_with(std::filesystem::canonical(outside.file("served")).string() + "/")) std::abort();
}

/// "ORIGIN HOST": on loopback, only names of this machine are served.
void read_origin(std::string_view text) {
  const std::size_t blank = std::min(text.find(' '), text.size());
  std::string host(text.substr(std::min(blank + 1, text.size())));
  if (!origin_allowed(text.substr(0, blank), host, true)) return;
  for (char& c : host) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (!host.starts_with("localhost") && !host.starts_with("127.") && !host.starts_with("[::1]")) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  if (text.starts_with("/")) read_target(text);
  else if (text.starts_with("http")) read_origin(text);
  else read_message(text);
  return 0;
}
