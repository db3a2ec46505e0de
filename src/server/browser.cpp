#include "server/browser.h"

#include "server/client_message.h"
#include "server/encode.h"

namespace filum {

using boost::beast::error_code;

void Browser::open(Request request, OnOpen on_open, OnText on_text, OnEnd on_end) {
  on_text_ = std::move(on_text);
  on_end_ = std::move(on_end);
  socket_.set_option(boost::beast::websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
  socket_.read_message_max(kMaxClientMessage);
  auto keep = std::make_shared<Request>(std::move(request));
  socket_.async_accept(*keep, [self = shared_from_this(), keep, on_open = std::move(on_open)](error_code error) {
    if (error) return self->end();
    on_open(*self);
    self->read();
  });
}

void Browser::send(Text message) {
  waiting_bytes_ += message->size();
  waiting_.push_back(std::move(message));
  if (waiting_bytes_ > kMaxWaiting) return close();
  write();
}

void Browser::offer_frame(Text body) {
  frame_ = std::move(body);
  write();
}

void Browser::ack(std::uint64_t frame) {
  credit_.ack(frame);
  write();
}

void Browser::close() {
  error_code ignored;
  boost::beast::get_lowest_layer(socket_).socket().close(ignored);
}

void Browser::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->end();
    const auto data = self->buffer_.cdata();
    self->on_text_(*self, std::string_view(static_cast<const char*>(data.data()), data.size()));
    self->buffer_.consume(self->buffer_.size());
    self->read();
  });
}

void Browser::write() {
  if (writing_ || ended_) return;
  if (!waiting_.empty()) {
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    waiting_bytes_ -= current_->size();
  } else if (frame_ && credit_.available()) {
    current_ = shared(frame_message(credit_.take(), *frame_));
    frame_.reset();
  } else {
    return;
  }
  writing_ = true;
  socket_.text(true);
  socket_.async_write(boost::asio::buffer(*current_), [self = shared_from_this()](error_code error, std::size_t) {
    self->writing_ = false;
    if (error) return self->end();
    self->write();
  });
}

void Browser::end() {
  if (std::exchange(ended_, true)) return;
  on_end_(*this);
}

}  // namespace filum
