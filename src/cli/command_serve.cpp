#include <csignal>
#include <memory>
#include <thread>

#include "command.hpp"
#include "output.hpp"
#include "slideway/serve/serve.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class ServeCommand : public Command {
 public:
  ServeCommand()
      : Command("serve", "[DIR] [--port N] [options]",
                "A page on this machine: from data files to reports in a browser") {
    add_input("DIR", &folder_, false);
    add_options()("port", po::value(&port_)->value_name("N"),
                  "port of 127.0.0.1; default one that is free");
    add_options()("open", po::bool_switch(&open_), "show the page with xdg-open");
    add_options()("timeout", po::value(&seconds_)->value_name("SECONDS"),
                  "end a run that takes longer; default 3600");
    add_options()("memory", po::value(&megabytes_)->value_name("MB"),
                  "end a run that needs more; default 4096");
  }

  int run() override {
    // Blocked before any thread is started, so that none of them gets these signals.
    sigset_t ends;
    ::sigemptyset(&ends);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&ends, signal);
    ::pthread_sigmask(SIG_BLOCK, &ends, nullptr);
    PageServer server({.folder = folder_,
                       .port = port_,
                       .time = std::chrono::seconds(seconds_),
                       .memory_bytes = static_cast<std::uint64_t>(megabytes_) << 20});
    std::jthread answering([&] { server.run(); });
    print("Open this address in a browser on this machine; Ctrl-C ends it:\n" + server.address() +
          "\n");
    if (open_ && show_page(server.address()) < 0) say("no program shows the page; open it by hand");
    int signal = 0;
    ::sigwait(&ends, &signal);
    server.stop();
    return kDone;
  }

 private:
  void check(const po::variables_map& /*given*/) override {
    constexpr int kMostPort = 65535, kMostSeconds = 7 * 24 * 3600, kLeastMemory = 64,
                  kMostMemory = 1 << 24;
    if (port_ < 0 || port_ > kMostPort) fail("--port: accepted: 1 to 65535, 0 for a free one");
    if (seconds_ < 1 || seconds_ > kMostSeconds) fail("--timeout: accepted: 1 to 604800 s");
    if (megabytes_ < kLeastMemory || megabytes_ > kMostMemory)
      fail("--memory: accepted: 64 to 16777216 MB");
  }

  std::string folder_ = "slideway-runs";
  int port_ = 0, seconds_ = 3600, megabytes_ = 4096;
  bool open_ = false;
};

}  // namespace

std::unique_ptr<Command> make_serve() { return std::make_unique<ServeCommand>(); }

}  // namespace slideway
