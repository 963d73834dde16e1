#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

/// The HTTP library stays behind this header.
namespace slideway {

struct HttpRequest {
  std::string method;             // GET POST
  std::vector<std::string> path;  // its parts behind the token
  std::map<std::string, std::string> query;
  std::string body;

  [[nodiscard]] std::string parameter(const std::string& name) const {
    const auto at = query.find(name);
    return at == query.end() ? "" : at->second;
  }
};

struct HttpReply {
  int status = 200;
  std::string type = "application/json", body = {};
  std::map<std::string, std::string> headers = {};
};

/// A request that is refused: `what()` is said in the reply.
struct HttpFailure : std::runtime_error {
  HttpFailure(int code, const std::string& what) : std::runtime_error(what), status(code) {}
  int status;
};

/// HTTP/1.1 on 127.0.0.1. A request reaches the handler only if its Host is this server, its Origin
/// (where it has one) too, and its path begins with a random token; its body is read only then.
class HttpServer {
 public:
  using Handler = std::function<HttpReply(const HttpRequest&)>;

  /// @param port        0: one that is free
  /// @param most_bytes  of a body
  /// @throws UsageError  the port is taken
  HttpServer(int port, std::size_t most_bytes, Handler handler);
  ~HttpServer();

  [[nodiscard]] std::string address() const;  // "http://127.0.0.1:40123/<token>/"
  void run();
  void stop();  // REQUIRES run() has been called or will be

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace slideway
