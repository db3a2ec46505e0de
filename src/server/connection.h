#pragma once
// One HTTP connection: answers requests until it is closed or becomes a WebSocket.

#include <utility>  // before Asio: its awaitable.hpp uses std::exchange without including it

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <functional>
#include <memory>
#include <optional>

namespace filum {

inline constexpr std::size_t kMaxHeader = 16 * 1024;  // [byte]
inline constexpr std::size_t kMaxBody = 64 * 1024;    // [byte]
inline constexpr std::size_t kMaxPart = 1024 * 1024;  // [byte], of a file that is sent in parts

/// A part of a file: PUT below /api/upload/. Its body may be kMaxPart long.
bool is_part(const boost::beast::http::request_header<>& request);

/// All functions are called by the server's thread, and so are the callbacks.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;
  /// "Switching protocols" hands the socket over to `Upgrade`.
  using Answer = std::function<Response(const Request&)>;
  using Upgrade = std::function<void(Socket, Request)>;

  /// `slot` is kept as long as the connection: how many there are is counted by it.
  Connection(Socket socket, Answer answer, Upgrade upgrade, std::shared_ptr<void> slot)
      : stream_(std::move(socket)), answer_(std::move(answer)), upgrade_(std::move(upgrade)), slot_(std::move(slot)) {}

  void read();

 private:
  void on_header(boost::beast::error_code error);
  void on_read(boost::beast::error_code error);
  void refuse(boost::beast::http::status status);
  void write(Response response, bool head);

  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  Response response_;
  std::optional<boost::beast::http::response_serializer<boost::beast::http::string_body>> serializer_;
  Answer answer_;
  Upgrade upgrade_;
  std::shared_ptr<void> slot_;
};

}  // namespace filum
