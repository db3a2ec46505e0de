#pragma once
// One browser's WebSocket. At most one read and one write are under way; messages wait in order, of frames only the newest.

#include <utility>  // before Asio: its awaitable.hpp uses std::exchange without including it

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/control.h"

namespace filum {

using Text = std::shared_ptr<const std::string>;
inline Text shared(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

inline constexpr std::size_t kMaxWaiting = 8 * 1024 * 1024;  // [byte] a browser may be behind before it is let go

/// All functions are called by the server's thread, and so are the callbacks.
class Browser : public std::enable_shared_from_this<Browser> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using OnOpen = std::function<void(Browser&)>;
  using OnText = std::function<void(Browser&, std::string_view)>;
  using OnEnd = std::function<void(Browser&)>;

  Browser(boost::asio::ip::tcp::socket socket, int id) : id(id), socket_(std::move(socket)) {}

  /// Answers the request to upgrade. on_end is called once, whoever ends it.
  void open(Request request, OnOpen on_open, OnText on_text, OnEnd on_end);
  void send(Text message);
  void offer_frame(Text body);
  void forget_frame() { frame_.reset(); }
  void ack(std::uint64_t frame);
  void close();

  const int id;
  int bad_in_a_row = 0;

 private:
  void read();
  void write();
  void end();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_buffer buffer_;
  std::deque<Text> waiting_;
  std::size_t waiting_bytes_ = 0;
  Text current_, frame_;
  FrameCredit credit_;
  bool writing_ = false;
  bool ended_ = false;
  OnText on_text_;
  OnEnd on_end_;
};

}  // namespace filum
