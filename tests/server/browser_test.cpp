#include "server/browser.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

namespace filum {
namespace browser_test {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;

/// One browser and its page; what the server's thread does is done by pump().
class BrowserTest : public testing::Test {
 protected:
  BrowserTest() : acceptor_(io_, {asio::ip::make_address("127.0.0.1"), 0}), page_(page_io_) {
    page_.next_layer().connect(acceptor_.local_endpoint());
    tcp::socket socket = acceptor_.accept();
    std::thread shakes([this] { page_.handshake("127.0.0.1", "/ws"); });
    boost::beast::flat_buffer buffer;
    http::request<http::string_body> request;
    http::read(socket, buffer, request);
    browser_ = std::make_shared<Browser>(std::move(socket), 7);
    browser_->open(
        std::move(request), [this](Browser&) { opened_ = true; }, [this](Browser&, std::string_view text) { said_.emplace_back(text); }, [this](Browser&) { ++ended_; });
    pump([this] { return opened_; });
    shakes.join();
  }
  template <class Condition>
  void pump(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition() && std::chrono::steady_clock::now() < end) io_.run_one_for(std::chrono::milliseconds(50));
    EXPECT_TRUE(condition());
  }
  std::string hear() {
    boost::beast::flat_buffer buffer;
    page_.read(buffer);
    return boost::beast::buffers_to_string(buffer.data());
  }
  asio::io_context io_, page_io_;
  tcp::acceptor acceptor_;
  websocket::stream<tcp::socket> page_;
  std::shared_ptr<Browser> browser_;
  bool opened_ = false;
  std::vector<std::string> said_;
  int ended_ = 0;
};

TEST_F(BrowserTest, MessagesKeepTheirOrderAndOfFramesTheNewestIsSent) {
  for (const char* text : {"one", "two", "three"}) browser_->send(shared(text));
  for (int n = 1; n <= 9; ++n) browser_->offer_frame(shared(",\"step\":" + std::to_string(n) + "}"));
  io_.run_for(std::chrono::milliseconds(50));
  for (const char* text : {"one", "two", "three"}) EXPECT_EQ(hear(), text);
  EXPECT_EQ(nlohmann::json::parse(hear()).at("step"), 9);
  page_.write(asio::buffer(std::string("hello")));
  pump([this] { return !said_.empty(); });
  EXPECT_EQ(said_[0], "hello");
}

TEST_F(BrowserTest, FramesBeyondItsCreditWaitForAnAck) {
  for (int n = 1; n <= 3; ++n) {
    browser_->offer_frame(shared(",\"step\":" + std::to_string(n) + "}"));
    io_.run_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(nlohmann::json::parse(hear()).at("step"), 1);
  EXPECT_EQ(nlohmann::json::parse(hear()).at("step"), 2);
  browser_->offer_frame(shared(",\"step\":4}"));  // takes the place of 3
  browser_->ack(2);
  io_.run_for(std::chrono::milliseconds(20));
  EXPECT_EQ(nlohmann::json::parse(hear()).at("step"), 4);
}

TEST_F(BrowserTest, OneThatNeverReadsIsLetGoAndItsEndIsToldOnce) {
  const Text megabyte = shared(std::string(1 << 20, 'x'));
  for (std::size_t sent = 0; sent <= 4 * kMaxWaiting && ended_ == 0; sent += megabyte->size()) {
    browser_->send(megabyte);
    io_.run_for(std::chrono::milliseconds(2));
  }
  pump([this] { return ended_ == 1; });
  browser_->send(shared("to nobody"));
  io_.run_for(std::chrono::milliseconds(50));
  EXPECT_EQ(ended_, 1);
}

}  // namespace browser_test
}  // namespace filum
