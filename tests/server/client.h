#pragma once
// A browser's side of the server, for tests: requests by HTTP, and a WebSocket whose every message is compared with the schema.

#include <gtest/gtest.h>

#include <utility>  // before Asio

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/server/schema_check.h"

namespace filum {

class Client {
 public:
  explicit Client(std::uint16_t port, const std::string& origin = "", const std::string& host = "") : socket_(io_) {
    namespace websocket = boost::beast::websocket;
    boost::beast::get_lowest_layer(socket_).connect({boost::asio::ip::make_address("127.0.0.1"), port});
    socket_.set_option(websocket::stream_base::decorator([origin](websocket::request_type& request) {
      if (!origin.empty()) request.set(boost::beast::http::field::origin, origin);
    }));
    socket_.handshake(host.empty() ? "127.0.0.1:" + std::to_string(port) : host, "/ws");
  }
  void say(const std::string& text) { socket_.write(boost::asio::buffer(text)); }
  nlohmann::json hear() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer);
    const auto message = nlohmann::json::parse(boost::beast::buffers_to_string(buffer.data()));
    EXPECT_EQ(schema_.fault(message, "ServerMessage"), "");
    return message;
  }
  nlohmann::json hear(const std::string& type) {
    for (;;) {
      nlohmann::json message = hear();
      if (message.at("type") == type) return message;
    }
  }
  void vanish() { boost::beast::get_lowest_layer(socket_).close(); }

 private:
  boost::asio::io_context io_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_;
  SchemaCheck schema_;
};

/// What a request brings besides its target; empty: a browser's own.
struct Asked {
  boost::beast::http::verb verb = boost::beast::http::verb::get;
  std::string host{}, body{}, origin{}, type{};
};

inline boost::beast::http::response<boost::beast::http::string_body> fetch(std::uint16_t port, const std::string& target, const Asked& asked = {}) {
  namespace http = boost::beast::http;
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), port});
  http::request<http::string_body> request(asked.verb, target, 11);
  request.set(http::field::host, asked.host.empty() ? "127.0.0.1:" + std::to_string(port) : asked.host);
  if (!asked.origin.empty()) request.set(http::field::origin, asked.origin);
  if (!asked.type.empty()) request.set(http::field::content_type, asked.type);
  request.body() = asked.body;
  request.prepare_payload();
  boost::beast::error_code ignored;
  http::write(socket, request, ignored);
  http::response_parser<http::string_body> parser;
  parser.skip(asked.verb == http::verb::head);
  boost::beast::flat_buffer buffer;
  http::read(socket, buffer, parser, ignored);
  return parser.release();
}

}  // namespace filum
