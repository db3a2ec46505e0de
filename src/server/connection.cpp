#include "server/connection.h"

namespace filum {

namespace http = boost::beast::http;
using boost::beast::error_code;

constexpr std::chrono::seconds kHttpTimeout{30};

bool is_part(const http::request_header<>& request) { return request.method() == http::verb::put && request.target().starts_with("/api/upload/"); }

void Connection::read() {
  parser_.emplace();
  parser_->header_limit(kMaxHeader);
  parser_->body_limit(kMaxPart);
  stream_.expires_after(kHttpTimeout);
  http::async_read_header(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) { self->on_header(error); });
}

/// How long the body may be depends on what the header asks for.
void Connection::on_header(error_code error) {
  if (error) return on_read(error);
  if (!is_part(parser_->get())) {
    if (parser_->content_length().value_or(0) > kMaxBody) return refuse(http::status::payload_too_large);
    parser_->body_limit(kMaxBody);
  }
  http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code failed, std::size_t) { self->on_read(failed); });
}

void Connection::on_read(error_code error) {
  if (error == http::error::body_limit) return refuse(http::status::payload_too_large);
  if (error == http::error::header_limit) return refuse(http::status::request_header_fields_too_large);
  if (error) return;
  Request request = parser_->release();
  Response response = answer_(request);
  if (response.result() == http::status::switching_protocols) {
    stream_.expires_never();
    return upgrade_(stream_.release_socket(), std::move(request));
  }
  write(std::move(response), request.method() == http::verb::head);
}

void Connection::refuse(http::status status) {
  Response response(status, 11);
  response.keep_alive(false);
  response.prepare_payload();
  write(std::move(response), false);
}

void Connection::write(Response response, bool head) {
  response_ = std::move(response);
  serializer_.emplace(response_);
  serializer_->split(head);
  auto done = [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return;
    if (self->response_.keep_alive()) return self->read();
    error_code ignored;
    self->stream_.socket().shutdown(Socket::shutdown_send, ignored);
  };
  if (head) return http::async_write_header(stream_, *serializer_, done);
  http::async_write(stream_, *serializer_, done);
}

}  // namespace filum
