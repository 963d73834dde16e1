#include "slideway/serve/serve.hpp"

#include <chrono>
#include <string_view>

#include "draft_session.hpp"
#include "http_server.hpp"
#include "jobs.hpp"
#include "json_text.hpp"
#include "page.hpp"
#include "results_view.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/compensation.hpp"
#include "slideway/report/report.hpp"
#include "worker.hpp"
#include "workspace.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostUpload = std::size_t{64} << 20;    // bytes of a file
constexpr std::size_t kMostProblem = std::size_t{256} << 10;  // bytes of a problem, of answers
constexpr std::chrono::seconds kCheckTime{60};

/// A report cannot reach the server: its origin is none, and it asks nothing of the network.
constexpr const char* kReportPolicy =
    "sandbox allow-scripts; default-src 'none'; style-src 'unsafe-inline'; script-src "
    "'unsafe-inline'; frame-ancestors 'self'";

HttpReply report_page(std::string body) {
  return {.type = "text/html; charset=utf-8",
          .body = std::move(body),
          .headers = {{"Content-Security-Policy", kReportPolicy}}};
}

HttpReply download(std::string body, const char* type, const std::string& name) {
  return {.type = type,
          .body = std::move(body),
          .headers = {{"Content-Disposition", "attachment; filename=\"" + name + "\""}}};
}

std::string choices() {
  nlohmann::ordered_json effects = nlohmann::ordered_json::array();
  for (const std::string& name : effect_names()) {
    effects.push_back({{"name", name}, {"plain_name", plain_name(name)}});
    if (const auto degree = needed_options(name).degree) effects.back()["degree"] = *degree;
  }
  return nlohmann::ordered_json{{"effects", effects}, {"tables", compensation_formats()}}.dump();
}

const std::string& text_of(const HttpRequest& request) {
  if (request.body.size() > kMostProblem)
    throw HttpFailure(413, "longer than " + std::to_string(kMostProblem >> 10) + " KiB");
  return request.body;
}

/// The page of a run; of one that has none it is made of the result.
std::string page_of(const std::filesystem::path& run) {
  std::error_code none;
  if (std::filesystem::symlink_status(run / run_file::kPage, none).type() !=
      std::filesystem::file_type::not_found)
    return bytes_of(run / run_file::kPage);
  return html_report(bytes_of(run / run_file::kResult), run_file::kResult);
}

std::string named(const char* name, const std::string& value) {
  return nlohmann::ordered_json{{name, value}}.dump();
}

}  // namespace

class PageServer::Parts {
 public:
  explicit Parts(const ServeOptions& options)
      : options_(options),
        workspace_(options.folder),
        drafts_(workspace_),
        results_(workspace_),
        jobs_(workspace_, options_),
        server_(options.port, kMostUpload,
                [this](const HttpRequest& request) { return reply(request); }) {}

  HttpServer& server() { return server_; }
  void stop() {
    stop_.request_stop();
    server_.stop();
  }

 private:
  HttpReply reply(const HttpRequest& request) {
    const std::vector<std::string>& path = request.path;
    const bool is_post = request.method == "POST";
    if (path.empty() && !is_post) return start_page();
    const std::string& first = path.empty() ? "" : path[0];
    if (first == "drafts" && is_post) return of_draft(request);
    if (first == "jobs" && path.size() > 1) return of_job(request);
    if (first == "runs") return of_run(request);
    if (is_post) throw HttpFailure(404, "no such address");
    if (first == "choices") return {.body = choices()};
    if (first == "diff")
      return {.body = results_.difference(request.parameter("a"), request.parameter("b"))};
    if (first == "batches" && path.size() == 2) return {.body = results_.batch_rows(path[1])};
    if (first == "batches" && path.size() == 3 && path[2] == "report")
      return report_page(results_.batch_page(path[1], request.parameter("id")));
    throw HttpFailure(404, "no such address");
  }

  HttpReply of_draft(const HttpRequest& request) {
    if (request.path.size() == 1) return {.body = named("id", drafts_.open())};
    const std::shared_ptr<DraftSession> draft = drafts_.at(request.path[1]);
    const std::string& what = request.path.size() == 3 ? request.path[2] : "";
    const std::string name = request.parameter("name");
    if (what == "files") return {.body = named("name", draft->add(name, request.body))};
    const std::string& text = text_of(request);
    if (what == "remove") return draft->remove(name), HttpReply{.body = "{}"};
    if (what == "questions") return {.body = draft->questions(text)};
    if (what == "traces") return {.body = draft->traces(text)};
    if (what == "check") return {.body = check(*draft, text)};
    if (what == "run") return {.body = named("job", jobs_.start(*draft, text, safe_name(name)))};
    throw HttpFailure(404, "no such address");
  }

  std::string check(DraftSession& draft, const std::string& problem) {
    const WorkerEnd end = draft.with_problem(problem, [&](const std::filesystem::path& folder) {
      return run_worker({.program = options_.program,
                         .folder = folder,
                         .arguments = {"check", run_file::kProblem, "--json", "-"},
                         .time = kCheckTime,
                         .memory_bytes = options_.memory_bytes},
                        stop_.get_token());
    });
    if (!end.cause.empty()) throw HttpFailure(422, "check: " + end.cause);
    if (end.text.empty()) throw HttpFailure(422, "check: no answer");
    return end.text;
  }

  HttpReply of_job(const HttpRequest& request) {
    const bool is_cancel = request.path.size() == 3 && request.path[2] == "cancel";
    if (is_cancel != (request.method == "POST")) throw HttpFailure(404, "no such address");
    if (is_cancel) jobs_.cancel(request.path[1]);
    return {.body = jobs_.state(request.path[1])};
  }

  HttpReply of_run(const HttpRequest& request) {
    const std::vector<std::string>& path = request.path;
    const bool is_post = request.method == "POST";
    if (path.size() == 1 && !is_post) return {.body = results_.list()};
    if (path.size() != 3) throw HttpFailure(404, "no such address");
    const std::filesystem::path run = workspace_.run(path[1]);
    const std::string& what = path[2];
    if (is_post && what == "open") return open_run(run);
    if (is_post) throw HttpFailure(404, "no such address");
    if (what == "table") {
      const std::string format = request.parameter("to");
      return download(results_.table(path[1], format), "text/plain; charset=utf-8",
                      path[1] + "-" + safe_name(format) + ".txt");
    }
    const bool is_file = what == run_file::kProblem || what == run_file::kResult;
    if (!is_file && what != run_file::kPage) throw HttpFailure(404, "no such address");
    std::string bytes = what == run_file::kPage ? page_of(run) : bytes_of(run / what);
    if (what == run_file::kPage && request.parameter("download").empty())
      return report_page(std::move(bytes));
    return download(std::move(bytes), "application/octet-stream", path[1] + "-" + what);
  }

  HttpReply open_run(const std::filesystem::path& run) {
    const std::string id = drafts_.open();
    const std::string problem = drafts_.at(id)->take(run, workspace_.folder());
    return {.body = json_text({{"id", id}, {"problem", problem}})};
  }

  ServeOptions options_;
  std::stop_source stop_;
  Workspace workspace_;
  Drafts drafts_;
  ResultsView results_;
  Jobs jobs_;
  HttpServer server_;
};

PageServer::PageServer(const ServeOptions& options) : parts_(std::make_unique<Parts>(options)) {}
PageServer::~PageServer() = default;
std::string PageServer::address() const { return parts_->server().address(); }
void PageServer::run() { parts_->server().run(); }
void PageServer::stop() { parts_->stop(); }

}  // namespace slideway
