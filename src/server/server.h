#pragma once
// HTTP and WebSocket server of the trainer, in a thread of its own. It serves the built viewer at /, answers under /api and
// speaks messages.schema.json at /ws. Whatever browsers do, the simulation is not slowed: it hands over copies and goes on.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/client_message.h"
#include "server/encode.h"
#include "server/views.h"

namespace filum {

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8137;  // 0: any free port
  std::string viewer_folder;
  HelloView hello;
};

/// Who carries out what browsers ask for. All functions are called by the server's thread and must return at once.
struct Document {
  std::string type;  // "text/html; charset=utf-8"
  std::string text;
};

class ServerHost {
 public:
  virtual ~ServerHost() = default;
  /// A message of the browser in control; never AckMessage or TakeControlMessage.
  virtual void command(const ClientMessage& message) = 0;
  /// A browser came into control (true), or nobody is in control any more (false): the pointer falls silent.
  virtual void controlled(bool by_somebody) = 0;
  /// JSON text for GET `path` below /api; empty optional: not found.
  virtual std::optional<std::string> api(std::string_view path) = 0;
  /// JSON text for POST `path` below /api with a JSON body, from a page of this server only; empty optional: not found.
  virtual std::optional<std::string> post(std::string_view /*path*/, const std::string& /*body*/) { return std::nullopt; }
  /// JSON text for PUT `path` below /api/upload/ with a part of a file, from a page of this server only; empty optional: not found.
  virtual std::optional<std::string> put(std::string_view /*path*/, const std::string& /*body*/) { return std::nullopt; }
  /// A page or picture below /documents, shown in a frame of the viewer.
  virtual std::optional<Document> document(std::string_view /*path*/) { return std::nullopt; }
};

class Server {
 public:
  /// Binds and listens; throws InputError when the address is not of this machine or the port is in use.
  Server(ServerOptions options, ServerHost& host);
  /// stop()
  ~Server();

  void start();
  /// Closes all connections and joins the thread. Safe to call twice.
  void stop();

  std::uint16_t port() const;
  /// "http://127.0.0.1:8137/"
  std::string url() const;

  // Any thread. What is published last is what a browser that connects later gets to see first.
  void publish_trainer(const TrainerView& trainer);
  void publish_devices(std::vector<DeviceView> devices);
  /// A new scene also takes back the result and the replay of the one before.
  void publish_scene(const SceneDescription& scene, const std::vector<StitchGuide>& guides = {});
  void publish_result(std::string result_message);
  void publish_replay(const ReplayView& replay);
  /// `body` from frame_body(); each browser gets the newest one it has credit for.
  void publish_frame(std::string body, double real_time_factor, std::uint64_t overruns);
  void publish_event(const EventView& event);
  /// To the browser in control, or to all if there is none.
  void publish_error(const Refusal& refusal);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// True if a WebSocket may be opened: `origin` is empty (no browser) or of the same host and port as `host`; and a server on
/// a loopback address is only addressed by a loopback name, so that no foreign name can be pointed at it.
bool origin_allowed(std::string_view origin, std::string_view host, bool on_loopback);

}  // namespace filum
