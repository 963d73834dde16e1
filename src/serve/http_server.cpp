#include "http_server.hpp"

#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include "json_text.hpp"
#include "secret.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr std::size_t kThreads = 8;
constexpr std::size_t kTokenBytes = 16;

/// Takes as long whatever is in `given`.
bool is_same(std::string_view given, std::string_view secret) {
  unsigned difference = given.size() == secret.size() ? 0 : 1;
  for (std::size_t i = 0; i < secret.size(); ++i)
    difference |= static_cast<unsigned char>(i < given.size() ? given[i] : '\0') ^
                  static_cast<unsigned char>(secret[i]);
  return difference == 0;
}

std::vector<std::string> parts_of_path(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t first = 1; first < path.size();) {
    const std::size_t last = std::min(path.find('/', first), path.size());
    parts.push_back(path.substr(first, last - first));
    first = last + 1;
  }
  return parts;
}

std::string error_text(std::string_view text) { return json_text({{"error", text}}); }

}  // namespace

class HttpServer::Parts {
 public:
  Parts(int port, std::size_t most_bytes, Handler handler) : handler_(std::move(handler)) {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_keep_alive_max_count(1);  // a body that was not read ends with its connection
    server_.set_payload_max_length(most_bytes);
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_pre_routing_handler([this](const auto& request, auto& response) {
      const auto refused = refusal(request);
      if (!refused) return httplib::Server::HandlerResponse::Unhandled;
      response.status = refused->status;
      response.set_content(error_text(refused->what()), "application/json");
      return httplib::Server::HandlerResponse::Handled;
    });
    const auto answer = [this](const httplib::Request& request, httplib::Response& response) {
      answered(request, response);
    };
    server_.Get(".*", answer);
    server_.Post(".*", answer);
    server_.set_post_routing_handler([](const auto&, auto& response) { protect(response); });
    server_.set_error_handler([](const auto&, auto& response) {
      if (response.body.empty())
        response.set_content(error_text(response.status == 413 ? "too large" : "refused"),
                             "application/json");
      protect(response);
    });
    port_ = port == 0 ? server_.bind_to_any_port(kHost)
                      : (server_.bind_to_port(kHost, port) ? port : -1);
    if (port_ < 0)
      throw UsageError("serve: port " + std::to_string(port) + " is taken; accepted: a free one");
    host_ = std::string(kHost) + ":" + std::to_string(port_);
  }

  [[nodiscard]] std::string address() const { return "http://" + host_ + "/" + token_ + "/"; }
  void run() {
    server_.listen_after_bind();
    has_ended_ = true;
  }

  /// The library forgets a stop that comes before it listens.
  void stop() {
    constexpr std::chrono::milliseconds kLook{2};
    while (!server_.is_running() && !has_ended_) std::this_thread::sleep_for(kLook);
    server_.stop();
  }

 private:
  [[nodiscard]] std::optional<HttpFailure> refusal(const httplib::Request& request) const {
    if (request.get_header_value_count("Host") != 1 || request.get_header_value("Host") != host_)
      return HttpFailure(403, "not the host of this server");
    const std::string origin = request.get_header_value("Origin");
    if (!origin.empty() && origin != "http://" + host_)
      return HttpFailure(403, "not the origin of this server");
    const std::vector<std::string> parts = parts_of_path(request.path);
    if (!is_same(parts.empty() ? "" : parts[0], token_))
      return HttpFailure(403, "not the address that slideway serve printed");
    if (request.method == "POST" && (request.has_header("Transfer-Encoding") ||
                                     request.get_header_value_count("Content-Length") != 1))
      return HttpFailure(411, "a length is missing");
    if (request.method != "GET" && request.method != "HEAD" && request.method != "POST")
      return HttpFailure(405, "accepted: GET, POST");
    return std::nullopt;
  }

  void answered(const httplib::Request& request, httplib::Response& response) const {
    HttpRequest wanted{request.method == "HEAD" ? "GET" : request.method,
                       parts_of_path(request.path),
                       {},
                       request.body};
    wanted.path.erase(wanted.path.begin());
    for (const auto& [key, value] : request.params) wanted.query.emplace(key, value);
    HttpReply reply;
    try {
      reply = handler_(wanted);
    } catch (const HttpFailure& failure) {
      reply = {.status = failure.status, .body = error_text(failure.what())};
    } catch (const UsageError& error) {
      reply = {.status = 400, .body = error_text(error.what())};
    } catch (const DataError& error) {
      reply = {.status = 422, .body = error_text(error.what())};
    } catch (const std::exception& error) {
      reply = {.status = 500, .body = error_text(error.what())};
    }
    response.status = reply.status;
    for (const auto& [key, value] : reply.headers) response.set_header(key, value);
    response.set_content(reply.body, reply.type);
  }

  static void protect(httplib::Response& response) {
    const auto add = [&](const char* key, const char* value) {
      if (!response.has_header(key)) response.set_header(key, value);
    };
    add("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
    add("X-Content-Type-Options", "nosniff");
    add("Cache-Control", "no-store");
    add("Referrer-Policy", "no-referrer");
    add("Cross-Origin-Resource-Policy", "same-origin");
    add("Cross-Origin-Opener-Policy", "same-origin");
  }

  Handler handler_;
  std::string token_ = random_hexadecimal(kTokenBytes), host_;
  int port_ = -1;
  std::atomic<bool> has_ended_ = false;
  httplib::Server server_;
};

HttpServer::HttpServer(int port, std::size_t most_bytes, Handler handler)
    : parts_(std::make_unique<Parts>(port, most_bytes, std::move(handler))) {}
HttpServer::~HttpServer() = default;
std::string HttpServer::address() const { return parts_->address(); }
void HttpServer::run() { parts_->run(); }
void HttpServer::stop() { parts_->stop(); }

}  // namespace slideway
