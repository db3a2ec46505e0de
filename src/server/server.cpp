#include "server/server.h"

#include <cstdio>
#include <map>
#include <thread>

#include "base/error.h"
#include "server/browser.h"
#include "server/connection.h"
#include "server/control.h"
#include "server/static_files.h"

namespace filum {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using Request = Connection::Request;
using Response = Connection::Response;

constexpr std::size_t kMaxBrowsers = 16;
constexpr std::size_t kMaxConnections = 128;
constexpr int kMaxBadMessages = 100;  // in a row
constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob:; "
    "connect-src 'self' ws:; frame-ancestors 'none'";

// Reports stand alone: no scripts, no network; the viewer may frame them.
constexpr const char* kDocumentPolicy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; frame-ancestors 'self'";

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

struct Server::Impl {
  Impl(ServerOptions options_in, ServerHost& host_in) : options(std::move(options_in)), host(host_in), acceptor(io) { listen(); }

  void listen() {
    error_code error;
    const auto address = asio::ip::make_address(options.address, error);
    if (error) throw InputError("--address", "address", options.address, "an IP address of this machine, e.g. 127.0.0.1");
    on_loopback = address.is_loopback();
    const tcp::endpoint endpoint(address, options.port);
    acceptor.open(endpoint.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error == asio::error::address_in_use) {
      throw InputError("--port", "port", std::to_string(options.port) + ", which another program is using",
                       "a free port: close the other program (perhaps a second trainer), or choose one with --port N; "
                       "--port 0 takes any free one");
    }
    if (error) {
      throw InputError("--address", "address", options.address + " (" + error.message() + ")",
                       "an address of this machine and a port that may be opened");
    }
    port = acceptor.local_endpoint().port();
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error && static_cast<std::size_t>(slot.use_count()) <= kMaxConnections) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<Connection>(
            std::move(socket), [this](const Request& request) { return answer_or_say(request); },
            [this](tcp::socket s, Request request) { add_browser(std::move(s), std::move(request)); }, slot)
            ->read();
      }
      accept();
    });
  }

  Response plain(const Request& request, http::status status, std::string_view type,
                                          std::string body) const {
    Response response(status, request.version());
    response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    response.set(http::field::cache_control, "no-cache");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Content-Security-Policy", kPolicy);
    response.keep_alive(request.keep_alive());
    response.body() = std::move(body);
    response.prepare_payload();
    return response;
  }

  Response fail(const Request& request, http::status status, std::string what) const {
    return plain(request, status, "text/plain; charset=utf-8", std::move(what) + "\n");
  }

  /// What fails for one page (a file, a store that another process holds) is that page's trouble, not the trainer's.
  Response answer_or_say(const Request& request) {
    try {
      return answer(request);
    } catch (const std::exception& error) {
      return fail(request, http::status::internal_server_error, error.what());
    }
  }

  Response answer(const Request& request) {
    const auto path = request_path(view_of(request.target()));
    if (!path) return fail(request, http::status::bad_request, "malformed path");
    if (!origin_allowed("", view_of(request[http::field::host]), on_loopback)) {
      return fail(request, http::status::forbidden, "addressed by a foreign name: open " + url());
    }
    if (websocket::is_upgrade(request)) return answer_upgrade(request, *path);
    if (request.method() == http::verb::post && path->starts_with("/api/")) return answer_change(request, *path, "application/json");
    if (is_part(request)) return answer_change(request, *path, "application/octet-stream");
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return fail(request, http::status::method_not_allowed, "only GET");
    }
    if (path->starts_with("/api/")) return answer_api(request, *path);
    if (path->starts_with("/documents/")) return answer_document(request, *path);
    return answer_file(request, *path);
  }

  /// Changes something: only for a page of this server, which names its origin, and never for a form (they cannot send these types).
  Response answer_change(const Request& request, const std::string& path, std::string_view type) {
    const std::string_view origin = view_of(request[http::field::origin]);
    const bool own = !origin.empty() && origin_allowed(origin, view_of(request[http::field::host]), on_loopback);
    if (!own) return fail(request, http::status::forbidden, "page of another origin");
    if (!view_of(request[http::field::content_type]).starts_with(type)) return fail(request, http::status::unsupported_media_type, "only " + std::string(type));
    const auto json = is_part(request) ? host.put(path, request.body()) : host.post(path, request.body());
    return json ? plain(request, http::status::ok, "application/json", *json) : fail(request, http::status::not_found, "no such resource");
  }

  Response answer_document(const Request& request, const std::string& path) {
    auto document = host.document(path);
    if (!document) return fail(request, http::status::not_found, "no such document");
    auto response = plain(request, http::status::ok, document->type, std::move(document->text));
    response.set("Content-Security-Policy", kDocumentPolicy);
    return response;
  }

  Response answer_upgrade(const Request& request, const std::string& path) const {
    if (path != "/ws") return fail(request, http::status::not_found, "the WebSocket is at /ws");
    if (!origin_allowed(view_of(request[http::field::origin]), view_of(request[http::field::host]), on_loopback)) {
      return fail(request, http::status::forbidden, "page of another origin");
    }
    if (browsers.size() >= kMaxBrowsers) return fail(request, http::status::service_unavailable, "too many browsers");
    return {http::status::switching_protocols, request.version()};
  }

  Response answer_api(const Request& request, const std::string& path) {
    if (path == "/api/tasks") return plain(request, http::status::ok, "application/json", task_list_json(options.hello.tasks));
    if (path == "/api/health") {
      return plain(request, http::status::ok, "application/json",
                   health_json(options.hello.version, trainer, control.clients(), real_time_factor, overruns));
    }
    const auto json = host.api(path);
    if (!json) return fail(request, http::status::not_found, "no such resource");
    return plain(request, http::status::ok, "application/json", *json);
  }

  Response answer_file(const Request& request, const std::string& path) const {
    const auto file = find_static_file(options.viewer_folder, path);
    if (!file && path == "/") {
      return fail(request, http::status::not_found, "The viewer is not built: run ./filum, which builds it, or `npm run build` in src/viewer.");
    }
    if (!file) return fail(request, http::status::not_found, "no such file");
    http::file_body::value_type reader;
    error_code error;
    reader.open(file->c_str(), beast::file_mode::scan, error);
    std::string body;
    if (!error) body.resize(static_cast<std::size_t>(reader.size()));
    if (!error && !body.empty()) body.resize(reader.file().read(body.data(), body.size(), error));
    if (error) return fail(request, http::status::internal_server_error, "file cannot be read");
    return plain(request, http::status::ok, media_type(*file), std::move(body));
  }

  void add_browser(tcp::socket socket, Request request) {
    auto browser = std::make_shared<Browser>(std::move(socket), ++last_browser);
    browser->open(
        std::move(request), [this, weak = std::weak_ptr(browser)](Browser& b) { greet(b, weak); },
        [this](Browser& b, std::string_view text) { receive(b, text); }, [this](Browser& b) { remove(b); });
  }

  void greet(Browser& browser, const std::weak_ptr<Browser>& owner) {
    browsers[browser.id] = owner.lock();
    control.join(browser.id);
    browser.send(shared(hello_message(options.hello, browser.id)));
    if (scene) browser.send(scene);
    if (result) browser.send(result);
    if (replay) browser.send(replay);
    send_states();
    if (last_frame) browser.offer_frame(last_frame);
  }

  void remove(Browser& browser) {
    const bool had_control = control.in_control(browser.id);
    control.leave(browser.id);
    browsers.erase(browser.id);
    if (had_control) host.controlled(false);
    send_states();
  }

  void send_states() {
    for (auto& [id, browser] : browsers) {
      browser->send(shared(session_state_message(trainer, control.controller(), control.in_control(id), control.clients())));
    }
  }

  bool acquire(Browser& browser, bool take_over) {
    if (control.in_control(browser.id)) return true;
    if (!control.acquire(browser.id, take_over)) return false;
    host.controlled(true);
    send_states();
    return true;
  }

  void receive(Browser& browser, std::string_view text) {
    const auto parsed = parse_client_message(text);
    if (const auto* refusal = std::get_if<Refusal>(&parsed)) {
      browser.send(shared(error_message(*refusal)));
      if (++browser.bad_in_a_row > kMaxBadMessages) browser.close();
      return;
    }
    browser.bad_in_a_row = 0;
    const ClientMessage& message = std::get<ClientMessage>(parsed);
    if (const auto* ack = std::get_if<AckMessage>(&message)) return browser.ack(ack->frame);
    if (std::holds_alternative<TakeControlMessage>(message)) {
      acquire(browser, true);
      return;
    }
    const auto* start = std::get_if<StartMessage>(&message);
    if (acquire(browser, start != nullptr && start->take_over)) return host.command(message);
    if (std::holds_alternative<PointerMessage>(message)) return;  // a watcher's pointer moves nothing
    browser.send(shared(error_message({"not-in-control", "Another browser is in control.",
                                       "Watch, or take over with the button \"Take control\"."})));
  }

  void broadcast(const Text& message) {
    for (auto& [id, browser] : browsers) browser->send(message);
  }

  std::string url() const {
    const bool any = options.address == "0.0.0.0" || options.address == "::";
    const std::string name = options.address.find(':') != std::string::npos ? "[" + options.address + "]" : options.address;
    return "http://" + (any ? "127.0.0.1" : name) + ":" + std::to_string(port) + "/";
  }

  template <class Function>
  void post(Function function) {
    asio::post(io, std::move(function));
  }

  ServerOptions options;
  ServerHost& host;
  asio::io_context io{1};
  tcp::acceptor acceptor;
  std::shared_ptr<void> slot = std::make_shared<int>(0);
  std::uint16_t port = 0;
  bool on_loopback = true;
  std::thread thread;

  // Below: only touched by the server's thread.
  std::map<int, std::shared_ptr<Browser>> browsers;
  int last_browser = 0;
  Control control;
  TrainerView trainer;
  Text scene, result, replay, last_frame;
  double real_time_factor = 1.0;
  std::uint64_t overruns = 0;
};

Server::Server(ServerOptions options, ServerHost& host) : impl_(std::make_unique<Impl>(std::move(options), host)) {}

Server::~Server() { stop(); }

void Server::start() {
  impl_->accept();
  impl_->thread = std::thread([this] {
    while (!impl_->io.stopped()) {
      try {
        impl_->io.run();
      } catch (const std::exception& error) {
        std::fprintf(stderr, "filum: server: %s\n", error.what());
      }
    }
  });
}

void Server::stop() {
  impl_->io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
  for (auto& [id, browser] : impl_->browsers) browser->close();
  impl_->browsers.clear();
  beast::error_code ignored;
  impl_->acceptor.close(ignored);
}

std::uint16_t Server::port() const { return impl_->port; }

std::string Server::url() const { return impl_->url(); }

void Server::publish_trainer(const TrainerView& trainer) {
  impl_->post([impl = impl_.get(), trainer] {
    impl->trainer = trainer;
    impl->send_states();
  });
}

void Server::publish_devices(std::vector<DeviceView> devices) {
  impl_->post([impl = impl_.get(), devices = std::move(devices)] { impl->options.hello.devices = devices; });
}

void Server::publish_scene(const SceneDescription& scene, const std::vector<StitchGuide>& guides) {
  impl_->post([impl = impl_.get(), text = shared(scene_message(scene, guides))] {
    impl->scene = text;
    impl->result.reset();
    impl->replay.reset();
    impl->last_frame.reset();
    for (auto& [id, browser] : impl->browsers) browser->forget_frame();
    impl->broadcast(text);
  });
}

void Server::publish_result(std::string result_message) {
  impl_->post([impl = impl_.get(), text = shared(std::move(result_message))] { impl->broadcast(impl->result = text); });
}

void Server::publish_replay(const ReplayView& replay) {
  impl_->post([impl = impl_.get(), text = shared(replay_state_message(replay))] { impl->broadcast(impl->replay = text); });
}

void Server::publish_frame(std::string body, double real_time_factor, std::uint64_t overruns) {
  impl_->post([impl = impl_.get(), text = shared(std::move(body)), real_time_factor, overruns] {
    impl->last_frame = text;
    impl->real_time_factor = real_time_factor;
    impl->overruns = overruns;
    for (auto& [id, browser] : impl->browsers) browser->offer_frame(text);
  });
}

void Server::publish_event(const EventView& event) {
  impl_->post([impl = impl_.get(), text = shared(event_message(event))] { impl->broadcast(text); });
}

void Server::publish_error(const Refusal& refusal) {
  impl_->post([impl = impl_.get(), text = shared(error_message(refusal))] {
    const auto controller = impl->browsers.find(impl->control.controller());
    if (controller == impl->browsers.end()) return impl->broadcast(text);
    controller->second->send(text);
  });
}

}  // namespace filum
