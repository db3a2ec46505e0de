#include "server/connection.h"

#include <gtest/gtest.h>

#include <thread>

namespace filum {
namespace connection_test {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;

/// One connection to a server that answers every request with its target.
class ConnectionTest : public testing::Test {
 protected:
  ConnectionTest() : acceptor_(io_, {asio::ip::make_address("127.0.0.1"), 0}), client_(client_io_) {
    client_.connect(acceptor_.local_endpoint());
    std::make_shared<Connection>(
        acceptor_.accept(),
        [](const Connection::Request& request) {
          Connection::Response response(request.target() == "/ws" ? http::status::switching_protocols : http::status::ok, request.version());
          response.keep_alive(request.keep_alive());
          response.body() = std::string(request.target());
          response.prepare_payload();
          return response;
        },
        [this](tcp::socket socket, Connection::Request request) {
          handed_over_ = std::string(request.target());
          socket_.emplace(std::move(socket));
        },
        slot_)
        ->read();
    thread_ = std::thread([this] { io_.run(); });  // ends with the connection
  }
  ~ConnectionTest() override {
    boost::beast::error_code ignored;
    client_.close(ignored);
    if (thread_.joinable()) thread_.join();
  }
  void ask(http::verb verb, const std::string& target, const std::string& body = "", bool keep_alive = true) {
    http::request<http::string_body> request(verb, target, 11);
    request.keep_alive(keep_alive);
    request.body() = body;
    request.prepare_payload();
    boost::beast::error_code ignored;
    http::write(client_, request, ignored);
  }
  http::response<http::string_body> hear(bool head = false) {
    http::response_parser<http::string_body> parser;
    parser.skip(head);
    boost::beast::error_code ignored;
    http::read(client_, buffer_, parser, ignored);
    return parser.release();
  }
  asio::io_context io_, client_io_;
  tcp::acceptor acceptor_;
  std::shared_ptr<void> slot_ = std::make_shared<int>(0);
  tcp::socket client_;
  boost::beast::flat_buffer buffer_;
  std::optional<tcp::socket> socket_;
  std::string handed_over_;
  std::thread thread_;
};

TEST_F(ConnectionTest, AnswersOneRequestAfterAnotherAndEndsWhenAskedTo) {
  for (const char* target : {"/one", "/two"}) {
    ask(http::verb::get, target);
    EXPECT_EQ(hear().body(), target);
  }
  ask(http::verb::head, "/three");
  const auto head = hear(true);
  EXPECT_EQ(head.body(), "");
  EXPECT_EQ(head[http::field::content_length], "6");
  EXPECT_EQ(slot_.use_count(), 2);
  ask(http::verb::get, "/last", "", false);
  EXPECT_EQ(hear().body(), "/last");
  thread_.join();
  EXPECT_EQ(slot_.use_count(), 1) << "its place is free again";
}

TEST_F(ConnectionTest, RefusesWhatIsTooLongAndLetsGo) {
  ask(http::verb::post, "/", std::string(kMaxBody + 1, 'x'));
  EXPECT_EQ(hear().result(), http::status::payload_too_large);
  client_.close();
  thread_.join();
  EXPECT_EQ(slot_.use_count(), 1);
}

TEST_F(ConnectionTest, RefusesAHeaderWithoutEnd) {
  ask(http::verb::get, "/" + std::string(kMaxHeader + 1, 'x'));
  EXPECT_EQ(hear().result(), http::status::request_header_fields_too_large);
}

TEST_F(ConnectionTest, HandsTheSocketOver) {
  ask(http::verb::get, "/ws");
  thread_.join();
  EXPECT_EQ(handed_over_, "/ws");
  ASSERT_TRUE(socket_.has_value());
  EXPECT_TRUE(socket_->is_open());
  EXPECT_EQ(slot_.use_count(), 1);
}

}  // namespace connection_test
}  // namespace filum
